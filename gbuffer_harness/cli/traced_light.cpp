#include "cli/traced_light.h"

#include <algorithm>

#include "reference/path_tracer/visible_surface.h"

namespace pellucid::harness {

namespace {

// Noise of some 1 % in half shadow, which diffusion averages further.
constexpr int kSamples = 512;

}  // namespace

bool needsTracing(const std::vector<Light>& lights, const std::optional<Environment>& environment) {
  return environment ||
         std::any_of(lights.begin(), lights.end(), [](const Light& light) { return light.radius > 0; });
}

void addTracedLight(Capture& capture, const reference::TraceScene& scene,
                    const std::optional<Environment>& environment) {
  if (!needsTracing(capture.lights, environment)) return;
  reference::Emitters emitters;
  emitters.environment = environment;
  std::copy_if(capture.lights.begin(), capture.lights.end(), std::back_inserter(emitters.lights),
               [](const Light& light) { return light.radius > 0; });
  for (Light& light : emitters.lights) light.shadowMaps.clear();
  const Image added =
      reference::tracedIrradiance(reference::visibleSurface(capture, scene), scene, emitters, kSamples);
  for (std::size_t i = 0; i < added.data.size(); ++i) capture.irradiance.data[i] += added.data[i];
}

}  // namespace pellucid::harness
