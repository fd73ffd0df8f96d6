// From scene light to what a display shows.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace pellucid::harness {

enum class ToneMap {
  None,  // linear
  Agx,   // Sobotka's AgX, base look
  Aces   // Narkowicz 2016, a fit of ACES' reference and output transforms
};

// "none", "agx", "aces", in the order of the enumeration.
const std::vector<std::string>& toneMapNames();

// Linear Rec. 709, times exposure, to linear display light, which sRGB then encodes. AgX and ACES are within
// 0..1 for finite light; negative light counts as 0 there.
std::array<float, 3> toneMapped(ToneMap map, std::array<float, 3> color);

}  // namespace pellucid::harness
