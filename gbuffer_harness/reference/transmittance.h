// Slab transmittance of a compiled material in double precision.
#pragma once

#include <glm/glm.hpp>

#include "pellucid/pellucid.h"

namespace pellucid::harness::reference {

// T(d) per channel for d >= 0 mm: the model of PellucidMaterial::transmittanceModel as pellucid.h
// defines it. Throws InputError for an unknown model.
glm::dvec3 transmittance(const PellucidMaterial& material, double thickness);

}  // namespace pellucid::harness::reference
