// Tests of what lies behind the surface that a shadow map stores: the receiver's own medium, another body, or air. Both
// take texels of the optional images beside the map; see PellucidShadowMap.
#ifndef PELLUCID_OCCLUDER_GLSL
#define PELLUCID_OCCLUDER_GLSL

#include "shared/pellucid_shared.h"

// depthTolerance ends here. Only light that grazes a face reaches it, at a cosine of .14, and only below .09 a receiver's
// own exit can be farther off than this. More would hide gaps: 8 texels of a head's map of 1024 texels are 1.8 mm.
const float kMostTexels = 8.0;

// Slope of a surface across a light's rays, from the cosine between them and its normal; at most 1000.
float slopeOf(float cosine) { return sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1.0e-3); }

bool hasExitImage(ShadowConstants shadow) { return shadow.occluder.x != 0u; }
bool hasCasterImage(ShadowConstants shadow) { return shadow.occluder.y != 0u; }

// True where light that meets the stored surface enters the receiver's material. `stored`: texel of the caster's image;
// `scale`: as ShadowConstants::occluder.z; `material`: index + 1. False for NaN.
bool casterIsMedium(float stored, float scale, uint material) { return abs(stored * scale - float(material)) < 0.5; }

// Side of a texel, scene units across the light's ray, where a point is. `distanceTo`: of the light.
float texelSideAt(ShadowConstants shadow, float distanceTo) { return shadow.depth.y * (shadow.meta.z != 0u ? distanceTo : 1.0); }

// Scene units along the light ray that a point of a stored surface may lie off the depth of its own texel: that surface's
// slope between the point and the texel's center, half a texel's diagonal away; one texel more stands for curvature.
// `side`: of a texel; `cosine`: between the point's normal and the light; 0: not known.
float depthTolerance(float side, float cosine) { return side * min(1.0 + slopeOf(cosine), kMostTexels); }

// True where air or another body lies between a receiver and the stored surface. `fromExit`: from the exit to the receiver,
// scene units along the light ray.
bool liesBeyondExit(float fromExit, float tolerance) { return fromExit > tolerance; }

#endif
