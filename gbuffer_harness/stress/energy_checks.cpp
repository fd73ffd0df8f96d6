// Checks of energies: what must come of changed light and thickness.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "stress/checks.h"

namespace pellucid::harness::stress {

namespace {

// A constant comes back as it is where nothing is added and nothing multiplied.
std::optional<Worst> constant(Subject& s) {
  if (!s.diffuses()) return {};
  StressFrame other = s.unlit();
  other.settings.features = PELLUCID_FEATURE_DIFFUSION;
  other.capture.albedo = {};
  Random random = s.random("constant");
  const float level = random.of({0.25f, 1.0f, 3.0f, 1000.0f});  // halves
  for (std::size_t i = 0; i < other.capture.irradiance.data.size(); ++i)
    if (i % 4 < 3) other.capture.irradiance.data[i] = level * static_cast<float>(i % 4 + 1);
  const Image& expected = other.capture.irradiance;
  return apart(s.renderer.render(other), expected, s.owned);
}

StressFrame withTwiceIrradiance(StressFrame frame) {
  for (std::size_t i = 0; i < frame.capture.irradiance.data.size(); ++i)
    if (i % 4 < 3) frame.capture.irradiance.data[i] *= 2;
  return frame;
}

std::optional<Worst> twiceIrradiance(Subject& s) {
  return notTwice(s.unlitOutput(), s.renderer.render(withTwiceIrradiance(s.unlit())), s.owned);
}

std::optional<Worst> moreIrradiance(Subject& s) {
  Random random = s.random("more-irradiance");
  StressFrame more = s.unlit();
  std::vector<float>& e = more.capture.irradiance.data;
  const double share = random.chance(0.3) ? 0 : random.magnitude(1e-3, 1), most = random.magnitude(0.1, 1000);
  for (std::size_t i = 0; i < e.size(); i += 4) {
    if (share == 0 || !random.chance(share)) continue;
    for (std::size_t k = 0; k < 3; ++k) e[i + k] += static_cast<float>(random.real(0, most));
  }
  if (share == 0)  // one bright pixel
    e[4 * static_cast<std::size_t>(random.whole(0, static_cast<int>(s.owned.size()) - 1))] +=
        static_cast<float>(most);
  return less(s.unlitOutput(), s.renderer.render(more), s.owned);
}

// Half the lights and not twice, as a gather takes from irradiance that the lights themselves bring.
std::optional<Worst> halfLights(Subject& s) {
  if (!s.translucent() || s.saturates()) return {};
  const Image half = s.renderer.render(withLights(s.plain(), 0.5));
  return notSum(s.dimOutput(), {half, half}, s.plainOutput(), s.owned);
}

// Light and irradiance together: holds where the output ends at 0, too.
std::optional<Worst> twiceAll(Subject& s) {
  const std::vector<Light>& lights = s.plain().capture.lights;
  const bool inDomain =
      std::all_of(lights.begin(), lights.end(), [](const Light& l) { return l.intensity <= 5e14; });
  if (!s.translucent() || !inDomain || s.saturates()) return {};
  return notTwice(s.plainOutput(), s.renderer.render(withTwiceIrradiance(withLights(s.plain(), 2))), s.owned);
}

std::optional<Worst> sumOfLights(Subject& s) {
  const std::size_t count = s.frame.capture.lights.size();
  if (!s.translucent() || count < 2 || count > 4 || s.saturates()) return {};
  std::vector<Image> parts;
  for (std::size_t i = 0; i < count; ++i) {
    StressFrame one = withLights(s.plain(), kDim);
    one.capture.lights[i] = s.plain().capture.lights[i];
    parts.push_back(s.renderer.render(one));
  }
  return notSum(s.dimOutput(), parts, s.plainOutput(), s.owned);
}

// The frame with light that is not gathered.
const StressFrame* ungathered(Subject& s, StressFrame& frame) {
  if (!s.translucent()) return nullptr;
  frame = s.plain();
  frame.settings.translucency.gatherSamples = 0;
  return &frame;
}

std::optional<Worst> thinnerLimit(Subject& s) {
  StressFrame frame;
  if (!ungathered(s, frame)) return {};
  StressFrame thinner = frame;
  float& most = thinner.settings.translucency.maximumThickness;
  Random random = s.random("thinner-limit");
  most = static_cast<float>(random.magnitude(0.01, 100)) * (most > 0 ? most / 100 : 1);
  return less(s.renderer.render(thinner), s.renderer.render(frame), s.owned);
}

std::optional<Worst> darkerFilter(Subject& s) {
  StressFrame frame;
  if (!ungathered(s, frame)) return {};
  StressFrame darker = frame;
  Random random = s.random("darker-filter");
  for (float& f : darker.settings.translucency.transmittanceFilter) f *= static_cast<float>(random.real());
  return less(s.renderer.render(darker), s.renderer.render(frame), s.owned);
}

// A back depth farther away, where it says the thickness and nothing else: the hidden point of a directional
// light without a map.
std::optional<Worst> fartherBacks(Subject& s) {
  StressFrame frame;
  Capture& c = frame.capture;
  if (!ungathered(s, frame) || c.backDepth.image.empty() || c.frontDepth.encoding != PELLUCID_DEPTH_VIEW_Z ||
      c.backDepth.encoding != PELLUCID_DEPTH_VIEW_Z)
    return {};
  std::erase_if(frame.capture.lights,
                [](const Light& light) { return light.type != PELLUCID_LIGHT_DIRECTIONAL; });
  if (frame.capture.lights.empty()) return {};
  for (Light& light : frame.capture.lights) light.shadowMaps.clear();
  StressFrame thicker = frame;
  Random random = s.random("farther-backs");
  const auto factor = 1 + static_cast<float>(random.magnitude(1e-4, 1));
  for (std::size_t i = 0; i < s.owned.size(); ++i) {
    float& back = thicker.capture.backDepth.image.data[i];
    // One in front of the front is none.
    if (back > c.frontDepth.image.data[i] && back < 1e8f) back *= factor;
  }
  return less(s.renderer.render(thicker), s.renderer.render(frame), s.owned);
}

// The next frame of a camera that stands still shows what it kept.
std::optional<Worst> reuse(Subject& s) {
  if (s.frame.settings.reuse == PELLUCID_REUSE_NONE || s.frame.settings.debugView != PELLUCID_DEBUG_NONE)
    return {};
  // In place, a frame with nothing to do keeps irradiance that is no number.
  if (s.run->plan().dispatchCount == 0) return {};
  const std::unique_ptr<FrameRun> next = s.renderer.prepare(s.frame, s.run.get());
  return apart(s.renderer.render(s.frame, *next, s.frame.index + 2), s.output, s.owned);
}

constexpr const char* kRounding = "passes round colors to halves, 5e-4 each";
constexpr const char* kLight = "colors are rounded to halves once with and once without the light, 5e-4 each";

}  // namespace

std::span<const Check> energyChecks() {
  static const Check table[] = {
      {"constant", "constant irradiance comes back from the diffusion",
       "frames that diffuse, without lights and albedo", 1e-3, 1e-3, kRounding, &constant},
      {"twice-irradiance", "twice the irradiance gives twice the output", "all, without lights", 2e-3, 2e-3,
       kRounding, &twiceIrradiance},
      {"more-irradiance", "more irradiance at some pixels gives no pixel less", "all, without lights", 2e-3,
       2e-3, kRounding, &moreIrradiance},
      {"half-lights", "lights of half the intensity add half as much",
       "frames with lights that stay below 65504", 6e-3, 6e-3, kLight, &halfLights},
      {"twice-all",
       "twice the lights and irradiance give twice the output",
       "frames with lights that stay below 65504",
       2e-3,
       {},
       "as above; wild lights reach 65504 in the gather's probes, which hold halves",
       &twiceAll},
      {"sum-of-lights", "a frame of lights adds the sum of what each adds",
       "frames of 2 to 4 lights that stay below 65504", 5e-3, 5e-3, kLight, &sumOfLights},
      {"thinner-limit", "a smaller maximumThickness gives no pixel more", "frames with lights, not gathered",
       2e-3, 2e-3, kRounding, &thinnerLimit},
      {"darker-filter", "a smaller transmittanceFilter gives no pixel more",
       "frames with lights, not gathered", 2e-3, 2e-3, kRounding, &darkerFilter},
      {"farther-backs", "a back depth farther away gives no pixel more",
       "frames with directional lights and depths in view z", 2e-3, 2e-3, kRounding, &fartherBacks},
      {"reuse", "the next frame of a still camera is the frame", "frames that reuse light", 2e-3, 2e-3,
       kRounding, &reuse},
  };
  return table;
}

}  // namespace pellucid::harness::stress
