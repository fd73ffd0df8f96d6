// The curves beside the sliders.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/translucency_settings.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

struct Curves {
  double end = 1;                             // x runs from 0 to here, evenly, both ends included
  std::array<std::vector<double>, 3> values;  // R G B
};

// T(d), d in mm, as far as some channel lets 1 % through, 0.1 to 100 mm. points: >= 2.
Curves transmittanceCurves(const PellucidMaterial& material, int points);

// The angle model's values for 0..90 degrees beyond the right angle between the directions to the eye and to
// the light. Models with tables and -N.L have no one curve: no values.
Curves angleCurve(const TranslucencySettings& settings, int points);

// 2 pi r R(r), 1/mm, r in mm to the largest radius within which a channel has 95 % of its energy; no channel
// of a material that does not diffuse has values.
Curves profileCurves(const PellucidMaterial& material, int points);

}  // namespace pellucid::harness
