// Slab transmittance of a compiled material in double precision.
#pragma once

#include <glm/glm.hpp>

#include "pellucid/pellucid.h"

namespace pellucid::harness::reference {

// T(d) per channel for d >= 0 mm: the model of PellucidMaterial::transmittanceModel as pellucid.h
// defines it. Throws InputError for an unknown model.
glm::dvec3 transmittance(const PellucidMaterial& material, double thickness);

// mm at which the mean of the channels' T falls to half of T(0), from .001 to 1000.
double halfThickness(const PellucidMaterial& material);

// mm beyond which each channel's T is below 2e-5; INFINITY where some is not below at 1000.
double opaqueThickness(const PellucidMaterial& material);

}  // namespace pellucid::harness::reference
