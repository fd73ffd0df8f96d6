#include "stress/checks.h"

#include <algorithm>

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

namespace {

// Irradiance as sanitize.glsl makes it, and room for twice its sum with other light.
void limitIrradiance(Image& irradiance) {
  for (std::size_t i = 0; i < irradiance.data.size(); ++i)
    if (i % 4 < 3)
      irradiance.data[i] = irradiance.data[i] > 0 ? std::min(irradiance.data[i], 16000.0f) : 0.0f;
}

StressFrame plainFrame(const StressFrame& frame) {
  StressFrame plain = frame;
  plain.settings.debugView = PELLUCID_DEBUG_NONE;
  plain.settings.reuse = PELLUCID_REUSE_NONE;
  limitIrradiance(plain.capture.irradiance);
  if (frame.wild) plain.capture.albedo = {};
  return plain;
}

StressFrame withoutLights(StressFrame frame) {
  frame.capture.lights.clear();
  return frame;
}

}  // namespace

Subject::Subject(Renderer& r, const StressFrame& f)
    : renderer(r),
      frame(f),
      owned(ownedPixels(f)),
      run(r.prepare(f)),
      before([&] {
        run->fillGarbage(f.index);
        return run->output();
      }()),
      output(r.render(f, *run, f.index)),
      plain_(plainFrame(f)),
      unlit_(withoutLights(plain_)) {}

bool Subject::translucent() const {
  return frame.settings.features & PELLUCID_FEATURE_TRANSLUCENCY && !frame.capture.lights.empty();
}

Random Subject::random(const char* check) const {
  std::uint64_t hash = 0xCBF29CE484222325u;  // FNV-1a
  for (const char* c = check; *c; ++c) hash = (hash ^ static_cast<unsigned char>(*c)) * 0x100000001B3u;
  return Random(frame.seed ^ hash, frame.index);
}

const Image& Subject::plainOutput() {
  if (plainOutput_.empty()) plainOutput_ = renderer.render(plain_);
  return plainOutput_;
}

const Image& Subject::unlitOutput() {
  if (unlitOutput_.empty()) unlitOutput_ = renderer.render(unlit_);
  return unlitOutput_;
}

const Image& Subject::dimOutput() {
  if (dimOutput_.empty()) dimOutput_ = renderer.render(withLights(plain_, kDim));
  return dimOutput_;
}

bool Subject::saturates() {
  if (!saturates_) {
    StressFrame read = plain_;
    read.settings.debugView = PELLUCID_DEBUG_IRRADIANCE;
    const Image image = renderer.render(read);
    saturates_ = false;
    for (std::size_t i = 0; i < image.data.size(); ++i)
      // Twice of it must fit, too.
      if (owned[i / 4] && i % 4 < 3 && !(static_cast<double>(image.data[i]) < kCeiling / 2))
        saturates_ = true;
  }
  return *saturates_;
}

StressFrame withLights(StressFrame frame, double factor) {
  for (Light& light : frame.capture.lights) light.intensity *= factor;
  return frame;
}

std::span<const Check> checks() {
  static const std::vector<Check> all = [] {
    std::vector<Check> joined(bitChecks().begin(), bitChecks().end());
    joined.insert(joined.end(), energyChecks().begin(), energyChecks().end());
    return joined;
  }();
  return all;
}

}  // namespace pellucid::harness::stress
