// A light's own falloff in a manifest.
#pragma once

#include <vector>

#include "capture/json_field.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

// Factors 0..1 at equal steps, two or more, as the PELLUCID_LIGHT_TABLE_ENTRIES of the module between which
// they are linear. Throws InputError for other values, and for a light of that type.
std::vector<double> readLightTable(const Field& field, PellucidLightType type);

}  // namespace pellucid::harness
