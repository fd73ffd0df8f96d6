// The four texels of a light's shadow map around a point: how far the light that they store would go through the medium, and
// which of them let light come there. transmission.glsl says what the includer declares.
#ifndef PELLUCID_LIGHT_TEXELS_GLSL
#define PELLUCID_LIGHT_TEXELS_GLSL

#include "lib/occluder.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

// `texel`: of the image, which holds `stored`. Neighbors are read for maps with a slope bias alone.
DrawnDepth drawnDepth(ShadowConstants shadow, ivec2 texel, float stored) {
  if (shadow.offsets.y == 0.0) return drawnDepth(shadow.offsets, stored, vec4(stored), bvec4(false));
  uint image = shadow.meta.x;
  ivec2 first = firstTexel(shadow.occluder), last = first + ivec2(shadow.depth.zw) - 1;
  ivec2 low = max(texel - 1, first), high = min(texel + 1, last);
  vec4 beside = shadowTexels(image, texel, first, last).beside;
  bvec4 holds = bvec4(high.x > texel.x && shadowHolds(shadow.meta, beside.x), low.x < texel.x && shadowHolds(shadow.meta, beside.y),
                      high.y > texel.y && shadowHolds(shadow.meta, beside.z), low.y < texel.y && shadowHolds(shadow.meta, beside.w));
  return drawnDepth(shadow.offsets, stored, beside, holds);
}

// The four texels around a point in the first of the light's maps that contains it.
struct LightTexels {
  vec4 held;      // bilinear weights of the texels that have a surface; 0 of others
  vec4 entering;  // of those where light enters the point's own medium
  vec4 thickness; // scene units along the light ray; negative: the surface is beyond the point
  float side;      // of a texel, scene units
  float uncertain; // scene units that the thickness may be off by, besides what depthTolerance says
};

const float kEverywhere = 3.0e38;

float receiverCosine(Surface s, Incident incident) { return s.hasNormal ? dot(s.normal, incident.toLight) : 0.0; }

// True of each texel where light enters the receiver's medium and has not left the medium before the receiver.
bvec4 entersMedium(ShadowConstants shadow, ShadowReceiver receiver, ShadowFootprint footprint, Incident incident, Surface s,
                   vec3 x, float tolerance) {
  vec4 caster = vec4(0.0), exits = vec4(0.0);
  if (hasCasterImage(shadow)) caster = shadowQuad(shadow.occluder.y - 1u, footprint.low, footprint.high);
  if (hasExitImage(shadow)) exits = shadowQuad(shadow.occluder.x - 1u, footprint.low, footprint.high);
  bvec4 enters = bvec4(true);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if (hasCasterImage(shadow)) enters[i] = casterIsMedium(caster[i], uintBitsToFloat(shadow.occluder.z), s.material);
    if (!hasExitImage(shadow) || !enters[i] || !shadowHolds(shadow.meta, exits[i])) continue;
    float step = shadow.offsets.w > 0.0 ? shadow.offsets.w * lengthPerDepth(shadow, receiver, x, incident, exits[i]) : 0.0;
    enters[i] = !liesBeyondExit(lightThickness(shadow, receiver, x, incident, exits[i]), tolerance + step);
  }
  return enters;
}

// `farthest`: texels further ahead count as if no light entered there.
LightTexels lightTexels(ShadowConstants shadow, ShadowReceiver receiver, Incident incident, Surface s, vec3 x, float cosine,
                        float farthest) {
  ShadowFootprint footprint = footprintOf(shadow, receiver);
  vec4 stored = shadowQuad(shadow.meta.x, footprint.low, footprint.high);
  vec2 row = footprint.part.y < 0.5 ? stored.xy : stored.zw;
  float nearest = footprint.part.x < 0.5 ? row.x : row.y;
  // All texels were moved as far as the nearest one, or by the constant alone where that has no surface.
  DrawnDepth drawn = DrawnDepth(-shadow.offsets.x, 0.5 * shadow.offsets.w);
  if (shadowHolds(shadow.meta, nearest)) {
    drawn = drawnDepth(shadow, receiver.texel, nearest);
    drawn.depth -= nearest;
  }
  LightTexels l = LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), texelSideAt(shadow, incident.distanceTo), 0.0);
  bvec4 counts = bvec4(false);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if (!shadowHolds(shadow.meta, stored[i])) continue;
    l.held[i] = footprint.weight[i];
    l.thickness[i] = lightThickness(shadow, receiver, x, incident, stored[i] + drawn.depth) + shadow.offsets.z;
    counts[i] = l.thickness[i] < farthest;
    if (drawn.uncertain > 0.0)
      l.uncertain = max(l.uncertain, drawn.uncertain * lengthPerDepth(shadow, receiver, x, incident, stored[i]));
  }
  if (!any(counts)) return l;
  bvec4 enters = entersMedium(shadow, receiver, footprint, incident, s, x, depthTolerance(l.side, cosine));
  l.entering = l.held * vec4(enters) * vec4(counts);
  return l;
}

// x: a point on or behind the surface s; cosine: between its normal and the light; 0: not known.
LightTexels lightTexels(LightConstants light, Incident incident, Surface s, vec3 x, float cosine, float farthest) {
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver receiver = projectReceiver(shadow, x);
    if (receiver.inside) return lightTexels(shadow, receiver, incident, s, x, cosine, farthest);
  }
  return LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0);
}

// Unit normal of the front or back depths, towards the eye; 0: not known.
vec3 facetAt(ivec2 pixel, uint material, bool back) {
  vec4 beside = vec4(distanceOf(pixel + ivec2(1, 0), material, back), distanceOf(pixel - ivec2(1, 0), material, back),
                     distanceOf(pixel + ivec2(0, 1), material, back), distanceOf(pixel - ivec2(0, 1), material, back));
  return normalOfDepths(frame.camera, pixel, distanceOf(pixel, material, back), beside);
}

// Beyond this cosine a face that turns away from the light is not the one that a map stores, whose texels would have to
// reach around 30 degrees of curvature.
const float kLeastTurnedCosine = 0.5;

// The least value of texels that count.
float leastEntering(LightTexels l, vec4 values) {
  vec4 counted = mix(vec4(3.0e38), values, greaterThan(l.entering, vec4(0.0)));
  return min(min(counted.x, counted.y), min(counted.z, counted.w));
}

// True where a texel may store the receiver itself. Depths of pixels are read only where they may decide, here and below.
bool mayStoreReceiver(LightTexels l) { return leastEntering(l, l.thickness) < 2.0 * (kMostTexels * l.side + l.uncertain); }

// Weights of texels that do not store the receiver itself: there, light lies on it or is blocked, but does not come through.
// `cosine`: between the normal of the front depths and the light; 0: not known.
vec4 throughWeights(LightTexels l, float cosine) {
  float tolerance = (depthTolerance(l.side, cosine) + l.uncertain) * clamp(1.0 + cosine / kLeastTurnedCosine, 0.0, 1.0);
  return tolerance > 0.0 ? l.entering * clamp(l.thickness / tolerance - 1.0, 0.0, 1.0) : l.entering;
}

// Part of the texels that let light come to a hidden face, whose map holds it or the face that light leaves by. It fades over
// one tolerance.
float litPart(LightTexels l, ivec2 pixel, uint material, vec3 toLight, bool holdsExits) {
  float tolerance = kMostTexels * l.side;
  if (leastEntering(l, abs(l.thickness)) <= 2.0 * (tolerance + l.uncertain))
    tolerance = depthTolerance(l.side, dot(facetAt(pixel, material, true), toLight));
  tolerance = max(tolerance + l.uncertain, 1.0e-30);
  return dot(l.entering, clamp((holdsExits ? 0.0 : 2.0) - l.thickness / tolerance, 0.0, 1.0));
}

// Mean of thicknesses as an exponential has it that halves at the same depth as T. Scene units; 0 without weights.
float meanThickness(vec4 weight, vec4 thickness, uint m) {
  float total = dot(weight, vec4(1.0));
  if (total <= 0.0) return 0.0;
  float rate = materials[m].inverseReflectance.w * frame.camera.range.w;
  thickness = max(thickness, 0.0);
  vec4 counted = mix(vec4(3.0e38), thickness, greaterThan(weight, vec4(0.0)));
  float least = min(min(counted.x, counted.y), min(counted.z, counted.w));
  // 0 < sum <= total: the least thickness has a weight above 0. rate > 0: no material's T takes more than 1000 mm to halve.
  float sum = dot(weight, exp2(rate * min(least - thickness, 0.0)));
  return least - log2(sum / total) / rate;
}

#endif
