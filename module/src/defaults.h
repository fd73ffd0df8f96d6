// The structs of the API that callers fill, with the values that fields have which callers leave alone, and
// the least size of each.
#pragma once

#include "pellucid/pellucid_thesis.h"
#include "struct_size.h"

namespace pellucid {

constexpr size_t kLeastFrame = PELLUCID_LEAST_SIZE(PellucidFrame, options);
constexpr size_t kLeastMaterial = PELLUCID_LEAST_SIZE(PellucidMaterial, burleyDistance);
constexpr size_t kLeastThesisOptions = PELLUCID_LEAST_SIZE(PellucidThesisOptions, angleModel);
constexpr size_t kLeastContextDesc = PELLUCID_LEAST_SIZE(PellucidContextDesc, options);

PellucidFrame defaultFrame();
PellucidThesisOptions defaultThesisOptions();
PellucidContextDesc defaultContextDesc();

}  // namespace pellucid
