// Descriptions of one material: the panel goes from one to the other.
#pragma once

#include <array>

#include "capture/capture.h"

namespace pellucid::harness {

// In the order of MaterialSource.
enum class MaterialKind { Preset, Coefficients, Burley, Gaussians, ThinWall, OpenPbr, Skin };

// Those that a person may choose; profiles come from captures alone.
inline constexpr std::array<MaterialKind, 4> kOfferedKinds = {
    MaterialKind::Preset, MaterialKind::Coefficients, MaterialKind::OpenPbr, MaterialKind::Skin};

MaterialKind kindOf(const MaterialSource& source);
const char* materialKindName(MaterialKind kind);

// The material in another description. COEFFICIENTS are exact. OPENPBR has the medium's mean free paths,
// anisotropy and index, and its diffuse reflectance as color. PRESET and SKIN begin with their defaults,
// "skin1" and that of the compiler. Throws InputError where the material has no coefficients, for
// COEFFICIENTS and OPENPBR.
MaterialSource asKind(const MaterialSource& source, MaterialKind kind);

}  // namespace pellucid::harness
