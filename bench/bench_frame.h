// Passes of published methods, and a frame on the device for these passes, which read the images and
// constants that the module's plan binds.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/barrier.h"
#include "common/gpu_image.h"
#include "common/push_layout.h"
#include "replay/replay.h"

namespace pellucid::bench {

// The image or buffer of a binding.
using Resource = std::variant<PellucidImage, VkDescriptorBufferInfo>;

// How many pixels one workgroup does, and the constants 0.. that say so to the shader.
struct Tile {
  uint32_t width = 8, height = 8;
  std::vector<uint32_t> specialization = {};
};

class ComputePass {
public:
  // types[i] is binding i of set 0. Combined image samplers are linear and clamp to the edge. The shader may
  // have four words of push constants.
  ComputePass(harness::Device& device, std::span<const uint32_t> spirv,
              const std::vector<VkDescriptorType>& types, const Tile& tile = {});

  // Without a barrier.
  void record(VkCommandBuffer commandBuffer, int width, int height, const std::vector<Resource>& resources,
              const std::array<uint32_t, 4>& push = {}) const;

private:
  std::vector<VkDescriptorType> types_;
  Tile tile_;
  harness::Owned<VkSampler, vkDestroySampler> sampler_;
  harness::PushLayout layout_;
  harness::Pipeline pipeline_;
};

// The next dispatch may read and overwrite the writes of the dispatch before.
inline void computeBarrier(VkCommandBuffer commandBuffer) {
  harness::barrier(commandBuffer, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
                   harness::kComputing);
}

// A way to do a part of the frame, the module's or another, as the tables compare them.
struct Variant {
  std::string name;
  uint32_t dispatches, barriers;
  std::uint64_t transientBytes;                 // of its images between dispatches
  std::function<void(VkCommandBuffer)> record;  // the barriers within, none around
  std::function<harness::Image()> output;       // RGB; after a run
};

// The output of a run of the variant.
harness::Image outputOf(harness::Device& device, const Variant& variant);

// Unit normals in view space, of the surfaces that front depths show, 8 bits a component: what published
// passes read of a G-buffer.
std::shared_ptr<const harness::GpuImage> normalsOf(harness::Device& device, const harness::Capture& capture);

class BenchFrame {
public:
  // `inputs`: the capture's on the device, if frames share them. `normals`: for published passes, as
  // normalsOf() makes them.
  BenchFrame(harness::Device& device, const harness::Context& context, const harness::Capture& capture,
             const std::vector<PellucidMaterial>& materials, const harness::ReplaySettings& settings,
             const std::shared_ptr<const harness::InputImages>& inputs = nullptr,
             const std::shared_ptr<const harness::GpuImage>& normals = nullptr);

  harness::Device& device() const { return device_; }
  const PellucidFrame& images() const { return run_.frame(); }
  const harness::GpuImage& normals() const { return *normals_; }
  const PellucidMaterial& material() const { return material_; }  // the first
  int width() const { return width_; }
  int height() const { return height_; }

  // A PELLUCID_BINDING_* of the plan's first dispatch: constants or an image, as the module binds it.
  Resource planned(uint32_t binding) const;
  bool isPlanned(uint32_t binding) const;

  // The plan's constants, anew.
  void writeConstants() const;

  const harness::FrameRun& run() const { return run_; }

  // A cleared image of the frame's size, RGBA of halves.
  std::shared_ptr<harness::GpuImage> image() const;
  // Bytes of so many of them.
  std::uint64_t bytesOf(std::uint64_t images) const;

private:
  const PellucidBinding* find(uint32_t binding) const;

  harness::Device& device_;
  int width_, height_;
  PellucidMaterial material_;
  std::shared_ptr<const harness::GpuImage> normals_;
  harness::FrameRun run_;
  harness::HostBuffer constants_;
  std::vector<PellucidBinding> bindings_;  // of the first dispatch
};

// The module's own way: all of the frame's plan.
Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name);

}  // namespace pellucid::bench
