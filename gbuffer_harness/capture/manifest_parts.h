// Parts of a manifest as JSON, which other files than captures hold, too.
#pragma once

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// The light without its shadow maps, and the material.
nlohmann::ordered_json lightJson(const Light& light);
nlohmann::ordered_json materialJson(const MaterialSource& source);

// With its shadow maps, but for their images. Throws InputError for what it does not know. The materials' is
// readMaterial() of capture/manifest_material.h.
Light readLight(const Field& field);

}  // namespace pellucid::harness
