// A frame on the device for passes that are not the module's: they read the images and constants that the
// module's plan binds.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/gpu_image.h"
#include "compute_pass.h"
#include "replay/replay.h"
#include "variant.h"

namespace pellucid::bench {

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

  // Least device-memory traffic of a dispatch of the plan: each image that it binds is read or written once.
  // Formats that the module does not know are the common ones.
  uint64_t modeledBytes(uint32_t dispatch) const;

  // The plan's constants, anew.
  void writeConstants() const;

  const harness::FrameRun& run() const { return run_; }

  // A cleared image of the frame's size.
  std::shared_ptr<harness::GpuImage> image(VkFormat format) const;

private:
  std::vector<PellucidBinding> bindings(uint32_t dispatch) const;
  std::optional<PellucidBinding> find(uint32_t binding) const;

  harness::Device& device_;
  int width_, height_;
  PellucidMaterial material_;
  harness::FrameRun run_;
  harness::HostBuffer constants_;
};

// The module's own way: all of the frame's plan.
Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name);

}  // namespace pellucid::bench
