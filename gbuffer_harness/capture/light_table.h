// A light's own falloff in a manifest.
#pragma once

#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// Reads factors 0..1 at equal steps, two or more, as the PELLUCID_LIGHT_TABLE_ENTRIES of the module between
// which they are linear. `error`: the largest difference from the factors that were given. Throws InputError
// for other values, and for a light of that type.
std::vector<double> readLightTable(const Field& field, PellucidLightType type, double& error);

// A sentence for each table of the capture's lights whose profile has narrower lobes than the module's steps.
std::vector<std::string> coarseTables(const Capture& capture);

}  // namespace pellucid::harness
