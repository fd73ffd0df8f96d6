// What the float64 reference makes of a replay.
#pragma once

#include <vector>

#include "reference/reference.h"
#include "replay/settings.h"

namespace pellucid::test {

// RGB. Light is not gathered.
inline harness::Image referenceOf(const harness::Capture& capture, const std::vector<PellucidMaterial>& materials,
                                  const harness::ReplaySettings& settings) {
  harness::reference::Settings s;
  s.features = settings.features;
  s.translucency = settings.translucency;
  s.ambient = settings.ambient.value_or(false);
  s.debugView = settings.debugView;
  return harness::reference::compute(capture, materials, s).image;
}

}  // namespace pellucid::test
