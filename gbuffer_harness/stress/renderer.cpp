#include "stress/renderer.h"

#include "capture/shadow_images.h"

namespace pellucid::harness::stress {

const Context& Renderer::contextFor(const Capture& capture) {
  if (!hasLayers(capture.lights)) return context_;
  if (!arrays_)
    arrays_ = std::make_unique<Context>(
        device_, [](PellucidContextDesc& desc) { desc.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY; });
  return *arrays_;
}

std::unique_ptr<FrameRun> Renderer::prepare(const StressFrame& frame, const FrameRun* previous) {
  const bool aliased = frame.settings.aliasOutput && frame.settings.debugView == PELLUCID_DEBUG_NONE;
  if (aliased || previous)
    return std::make_unique<FrameRun>(device_, contextFor(frame.capture), frame.capture, frame.materials,
                                      frame.settings, previous);
  // Without the picture that an engine would have around the surface: garbage takes its place.
  return std::make_unique<FrameRun>(device_, contextFor(frame.capture), frame.capture, frame.materials,
                                    frame.settings,
                                    std::make_shared<InputImages>(device_, frame.capture, frame.settings));
}

Image Renderer::render(const StressFrame& frame, const FrameRun& run, std::uint64_t garbage) {
  run.restoreIrradiance(frame.capture);
  run.fillGarbage(garbage);
  device_.run([&](VkCommandBuffer commandBuffer) { run.record(commandBuffer); });
  ++recordings_;
  pixels_ += frame.capture.irradiance.pixels();
  return run.output();
}

}  // namespace pellucid::harness::stress
