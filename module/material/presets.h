// Named materials.
#pragma once

#include <span>
#include <string_view>

#include "source.h"

namespace pellucid::material {

struct Preset {
  const char* name;
  double ior;
  bool layered;                // three-layer skin; otherwise the coefficients
  Rgb scattering, absorption;  // sigma_s', sigma_a, 1/mm
};

std::span<const Preset> presets();

// Ignores case, and the difference between ' ', '-' and '_'. nullptr: none of that name.
const Preset* findPreset(std::string_view name);

}  // namespace pellucid::material
