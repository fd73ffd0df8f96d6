// What lies behind the surface that a shadow map stores: the receiver's own medium, another body, or air. Both tests take
// texels of the optional images beside the map; see PellucidShadowMap.
#ifndef PELLUCID_OCCLUDER_GLSL
#define PELLUCID_OCCLUDER_GLSL

#include "shared/pellucid_shared.h"

// Texels by which the depth of a receiver's own exit may be off, beyond which light at a grazing angle counts as shadowed:
// such light has a cosine below .14, and wider gaps than this must still be found behind faces that it does not graze.
const float kMostExitTexels = 8.0;

bool hasExitImage(ShadowConstants shadow) { return shadow.occluder.x != 0u; }
bool hasCasterImage(ShadowConstants shadow) { return shadow.occluder.y != 0u; }

// Whether light that meets the stored surface enters the receiver's material. `stored`: texel of the caster's image;
// `scale`: as ShadowConstants::occluder.z; `material`: index + 1. False for NaN.
bool casterIsMedium(float stored, float scale, uint material) { return abs(stored * scale - float(material)) < 0.5; }

// Scene units along the light ray that a receiver may lie behind the exit depth of its own texel. A receiver of the exit
// surface is off by that surface's slope between it and the texel's center, half a texel's diagonal away; one texel more
// stands for curvature. `distanceTo`: of the light; `cosine`: between the receiver's normal and the light; 0: not known.
float exitTolerance(ShadowConstants shadow, float distanceTo, float cosine) {
  float side = uintBitsToFloat(shadow.occluder.w) * (shadow.meta.z != 0u ? distanceTo : 1.0);
  // The floor of the cosine is far beyond kMostExitTexels.
  float tangent = sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1.0e-3);
  return shadow.depth.y + side * min(1.0 + tangent, kMostExitTexels);
}

// Whether air or another body lies between a receiver and the stored surface. `fromExit`: from the exit to the receiver,
// scene units along the light ray.
bool liesBeyondExit(float fromExit, float tolerance) { return fromExit > tolerance; }

#endif
