// A frame on the device for passes that are not the module's: they read the images and constants that the
// module's plan binds.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/gpu_image.h"
#include "compute_pass.h"
#include "replay/replay.h"

namespace pellucid::bench {

// A way to do a part of the frame, the module's or another, as the tables compare them.
struct Variant {
  std::string name;
  uint32_t dispatches, barriers;
  std::uint64_t transientBytes;                 // of its images between dispatches
  std::function<void(VkCommandBuffer)> record;  // the barriers within, none around
  std::function<harness::Image()> output;       // RGB; after a run
};

// Of a run.
harness::Image outputOf(harness::Device& device, const Variant& variant);

class BenchFrame {
public:
  // `inputs`: the capture's on the device, if frames share them.
  BenchFrame(harness::Device& device, const harness::Context& context, const harness::Capture& capture,
             const std::vector<PellucidMaterial>& materials, const harness::ReplaySettings& settings,
             const std::shared_ptr<const harness::InputImages>& inputs = nullptr);

  harness::Device& device() const { return device_; }
  const PellucidFrame& images() const { return run_.frame(); }
  const PellucidMaterial& material() const { return material_; }  // the first
  int width() const { return width_; }
  int height() const { return height_; }

  // A PELLUCID_BINDING_* of the plan's first dispatch: constants or an image, as the module binds it.
  Resource planned(uint32_t binding) const;
  bool isPlanned(uint32_t binding) const;

  // The plan's constants, anew.
  void writeConstants() const;

  const harness::FrameRun& run() const { return run_; }

  // A cleared image of the frame's size.
  std::shared_ptr<harness::GpuImage> image(VkFormat format = VK_FORMAT_R16G16B16A16_SFLOAT) const;
  // Of so many images of the default format.
  std::uint64_t bytesOf(std::uint64_t images) const;

private:
  const PellucidBinding* find(uint32_t binding) const;

  harness::Device& device_;
  int width_, height_;
  PellucidMaterial material_;
  harness::FrameRun run_;
  harness::HostBuffer constants_;
  std::vector<PellucidBinding> bindings_;  // of the first dispatch
};

// The module's own way: all of the frame's plan.
Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name);

}  // namespace pellucid::bench
