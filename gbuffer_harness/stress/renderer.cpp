#include "stress/renderer.h"

namespace pellucid::harness::stress {

std::unique_ptr<FrameRun> Renderer::prepare(const StressFrame& frame, const FrameRun* previous) {
  const bool aliased = frame.settings.aliasOutput && frame.settings.debugView == PELLUCID_DEBUG_NONE;
  const Context& context = contexts_.of(frame.capture);
  if (aliased || previous)
    return std::make_unique<FrameRun>(device_, context, frame.capture, frame.materials, frame.settings,
                                      previous);
  // Without the picture that an engine would have around the surface: garbage takes its place.
  return std::make_unique<FrameRun>(device_, context, frame.capture, frame.materials, frame.settings,
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
