// Materials of a capture's manifest.
#pragma once

#include <string>

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// One material; docs/materials.md has its keys. Throws InputError for what it does not know.
MaterialSource readMaterial(const Field& field);

// A material of the command line: a preset's name, or a manifest's object in braces. Throws InputError naming
// `option`.
MaterialSource parseMaterial(const std::string& option, const std::string& text);

}  // namespace pellucid::harness
