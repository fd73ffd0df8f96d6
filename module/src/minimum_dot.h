// Whelan 2009, 4.6: how far around the head a light must be before anything comes through.
#pragma once

#include <glm/glm.hpp>

#include "pellucid/pellucid_thesis.h"

namespace pellucid {

// World direction from the object to the light, of any length; 0 for a light at its center.
glm::dvec3 fromObject(const PellucidThesisOptions& thesis, const PellucidLight& light);

// The minimum dot of a light, [-1, 0]: the options' minimumDot or their table's entry for where the light is,
// and 0 for models without one. Models that are prescaled have minimumDot.
double minimumDotOf(const PellucidThesisOptions& thesis, const PellucidLight& light);

// The largest minimumDotTableSize of the two models with a table.
inline constexpr uint32_t kMostAzimuths = 360, kMostSphereSide = 16;

// Entries that minimumDotTable must have; 0 for models without a table, and for sizes beyond the domain's.
uint32_t minimumDotEntries(const PellucidThesisOptions& thesis);

}  // namespace pellucid
