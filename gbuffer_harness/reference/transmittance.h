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

// True if each channel's T is below 2e-5 at d >= 0 mm.
bool isOpaque(const PellucidMaterial& material, double thickness);

}  // namespace pellucid::harness::reference
