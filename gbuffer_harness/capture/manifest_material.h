// Materials of a capture's manifest.
#pragma once

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// One material; docs/capture.md has its keys. Throws InputError for what it does not know.
MaterialSource readMaterial(const Field& field);

}  // namespace pellucid::harness
