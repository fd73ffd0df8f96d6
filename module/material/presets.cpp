#include "presets.h"

#include <algorithm>

namespace pellucid::material {
namespace {

// Jensen et al. 2001, "A Practical Model for Subsurface Light Transport", figure 5, with its indices of
// refraction; 1.4 for skin, as Donner & Jensen 2005 take it.
constexpr Preset kPresets[] = {
    {"apple", 1.3, false, {2.29, 2.39, 1.97}, {0.0030, 0.0034, 0.046}},
    {"chicken1", 1.3, false, {0.15, 0.21, 0.38}, {0.015, 0.077, 0.19}},
    {"chicken2", 1.3, false, {0.19, 0.25, 0.32}, {0.018, 0.088, 0.20}},
    {"cream", 1.3, false, {7.38, 5.47, 3.15}, {0.0002, 0.0028, 0.0163}},
    {"ketchup", 1.3, false, {0.18, 0.07, 0.03}, {0.061, 0.97, 1.45}},
    {"marble", 1.5, false, {2.19, 2.62, 3.00}, {0.0021, 0.0041, 0.0071}},
    {"potato", 1.3, false, {0.68, 0.70, 0.55}, {0.0024, 0.0090, 0.12}},
    {"skim_milk", 1.3, false, {0.70, 1.22, 1.90}, {0.0014, 0.0025, 0.0142}},
    {"skin1", 1.4, false, {0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}},
    {"skin2", 1.4, false, {1.09, 1.59, 1.79}, {0.013, 0.070, 0.145}},
    {"skin_three_layer", 1.4, true, {}, {}},
    {"whole_milk", 1.3, false, {2.55, 3.21, 3.77}, {0.0011, 0.0024, 0.014}},
};

char folded(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<char>(c - 'A' + 'a');
  return c == ' ' || c == '-' ? '_' : c;
}

}  // namespace

std::span<const Preset> presets() { return kPresets; }

const Preset* findPreset(std::string_view name) {
  for (const Preset& preset : kPresets)
    if (std::ranges::equal(name, std::string_view(preset.name), {}, folded)) return &preset;
  return nullptr;
}

}  // namespace pellucid::material
