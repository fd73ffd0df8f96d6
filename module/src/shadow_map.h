// Lengths that follow from a shadow map's fields. Pure.
#pragma once

#include "pellucid/pellucid.h"

namespace pellucid {

bool isPerspective(const PellucidShadowMap& map);

// Longer side of a texel, scene units across the light; perspective: at planar distance 1.
double texelSide(const PellucidShadowMap& map);

// mm that light goes in a material before it falls to 1/e, the mean of the channels; 0 where T's model has no
// rate.
float meanFreePath(const PellucidMaterial& material);

}  // namespace pellucid
