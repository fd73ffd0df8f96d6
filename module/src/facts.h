// Hashes of the frame that a plan was made from, so that recording can refuse another frame by name.
#pragma once

#include "pellucid/pellucid.h"

namespace pellucid {

struct Facts {
  uint32_t hash[PELLUCID_FACT_COUNT];
};

// Hashes all that a frame holds but its views. Equal frames have equal facts; others differ but for one in
// 2^32.
Facts factsOf(const PellucidFrame& frame);

const char* nameOf(PellucidFact fact);

}  // namespace pellucid
