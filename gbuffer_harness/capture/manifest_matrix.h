// Matrices of a manifest: 16 numbers, column-major.
#pragma once

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// Throw InputError naming the field: for a matrix that is singular, and for one that is no rotation and
// translation.
Matrix invertible(const Field& field);
Matrix rigid(const Field& field);

}  // namespace pellucid::harness
