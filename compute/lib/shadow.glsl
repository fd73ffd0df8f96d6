// The one place that projects a receiver into a shadow map, for occlusion and thickness alike.
#ifndef PELLUCID_SHADOW_GLSL
#define PELLUCID_SHADOW_GLSL

#include "lib/camera.glsl"
#include "lib/light.glsl"

struct ShadowReceiver {
  vec4 clip;
  ivec2 texel; // of the image
  vec2 place;  // in the map, texels from its corner
  float beyond; // texels that the point lies outside of the map, at most 0 inside
};

// A map says nothing about points outside, so that no light comes through them. But cubes and cascades have no seams: where none of
// a light's maps contains a point, the nearest one does if the point is at most this outside. Faces of 90 degrees leave a rounding between.
const float kSeam = 0.5;       // texels

// Texels that a place lies outside of a map of this size.
float beyondMap(vec2 place, vec2 size) {
  vec2 outside = max(-place, place - size);
  return max(outside.x, outside.y);
}

// The first texel of the map's tile in the image. occluder: ShadowConstants::occluder.
ivec2 firstTexel(uvec4 occluder) { return ivec2(occluder.w & 0xFFFFu, occluder.w >> 16); }

// Columns of the texels to the right and to the left of a texel, rows of the texels below and above. Beyond the tile [first, last]
// its border is read again: then the column or row is the texel's own.
ivec4 besideTexel(ivec2 texel, ivec2 first, ivec2 last) {
  return ivec4(min(texel.x + 1, last.x), max(texel.x - 1, first.x), min(texel.y + 1, last.y), max(texel.y - 1, first.y));
}

ShadowReceiver projectReceiver(ShadowConstants shadow, vec3 x) {
  vec4 clip = shadow.clipFromView * vec4(x, 1.0);
  bool inFront = clip.w > 0.0;
  vec2 ndc = clip.xy / (inFront ? clip.w : 1.0);
  vec2 place = (ndc * 0.5 + 0.5) * shadow.depth.zw;
  ivec2 texel = ivec2(clamp(floor(place), vec2(0.0), shadow.depth.zw - 1.0));
  return ShadowReceiver(clip, texel + firstTexel(shadow.occluder), place, inFront ? beyondMap(place, shadow.depth.zw) : kFarthest);
}

// The four texels around a receiver, of the image, and their bilinear weights: low, (high.x, low.y), (low.x, high.y), high.
struct ShadowFootprint {
  ivec2 low, high;
  vec2 part; // of the way from low to high
  vec4 weight;
};

ShadowFootprint footprintOf(ShadowConstants shadow, ShadowReceiver receiver) {
  vec2 from = floor(receiver.place - 0.5), part = receiver.place - 0.5 - from;
  ivec2 first = firstTexel(shadow.occluder), last = ivec2(shadow.depth.zw) - 1;
  vec2 x = vec2(1.0 - part.x, part.x);
  return ShadowFootprint(first + clamp(ivec2(from), ivec2(0), last), first + clamp(ivec2(from) + 1, ivec2(0), last), part,
                         vec4(x * (1.0 - part.y), x * part.y));
}

// True where the texel holds a surface. meta: ShadowConstants::meta.
bool shadowHolds(uvec4 meta, float stored) {
  if (meta.y == PELLUCID_SHADER_DEPTH_DEVICE)
    return isWithin(stored, 0.0, kAboveOne) && stored != uintBitsToFloat(meta.w);
  return isWithin(stored, 0.0, kNoDepth) && stored != 0.0;
}

const float kNearRounding = 1.0e-7; // of device depths, besides the map's smallest step: 1.7 steps of floats below 1

// True where the texel lies on the map's near plane. Engines clamp there what lies before it ("pancaking"): something nearer is lit,
// and nobody knows where. meta, offsets: of ShadowConstants.
bool isClamped(uvec4 meta, vec4 offsets, float stored) {
  float near = 1.0 - uintBitsToFloat(meta.w); // the other end holds nothing
  float off = min(abs(stored - near), abs(stored - offsets.x - near)); // depth clamp comes after the bias, vertices before
  return meta.y == PELLUCID_SHADER_DEPTH_DEVICE && off <= max(0.5 * offsets.w, kNearRounding);
}

// The depth of the surface that was drawn, without the biases that the drawing added; in units of the stored depth.
struct DrawnDepth {
  float depth;
  float uncertain; // how far it may be off
};

// Part of a step of depth that the nearer neighbor may miss: between the last texels before a sphere's limb it is 27 % of the slope there.
const float kMissedSlope = 0.3;

// A texel's change of depth along an axis, x: to the nearer of its two neighbors, as the other may lie across an edge;
// 0 where there is none. y: how much that may miss, as far as the other neighbor says so.
vec2 stepAlong(float own, vec2 beside, bvec2 holds) {
  vec2 change = vec2(1.0, -1.0) * (beside - own), apart = mix(vec2(kFarthest), abs(change), holds);
  float least = min(apart.x, apart.y);
  if (!any(holds)) return vec2(0.0);
  return vec2(least, max(kMissedSlope * least, all(holds) ? abs(change.x - change.y) : least));
}

// How far a texel lies behind both of its neighbors along an axis, the way that a bias moves it.
float pitAlong(float own, vec2 beside, bvec2 holds, float way) {
  vec2 behind = way * (own - beside);
  return all(holds) ? max(min(behind.x, behind.y), 0.0) : 0.0;
}

// A triangle that the light grazes is moved far beyond its neighbors; a pit one texel wide is more likely that.
float withoutPit(vec4 offsets, float own, vec4 beside, bvec4 holds) {
  float way = sign(offsets.y);
  return own - way * max(pitAlong(own, beside.xy, holds.xy, way), pitAlong(own, beside.zw, holds.zw, way));
}

// offsets: ShadowConstants::offsets; beside: texels to the right, to the left, below and above; `holds`: which of them hold
// a surface of the tile.
DrawnDepth drawnDepth(vec4 offsets, float own, vec4 beside, bvec4 holds) {
  if (offsets.y == 0.0) return DrawnDepth(own - offsets.x, 0.5 * offsets.w);
  own = withoutPit(offsets, own, beside, holds);
  vec2 x = stepAlong(own, beside.xy, holds.xy), y = stepAlong(own, beside.zw, holds.zw);
  return DrawnDepth(own - offsets.x - offsets.y * max(x.x, y.x),
                    0.5 * offsets.w + abs(offsets.y) * (offsets.w + max(x.y, y.y)));
}

// A receiver's light ray, along which a map's depths tell how far a stored surface lies before the receiver. With g = scale *
// stored + offset, which is 0 at the receiver itself, that is g * perGap, or of perspective device depths g / (lightZ + g) *
// perGap.
struct StoredRay {
  float scale, offset;
  float lightZ; // clip z of a perspective device map's light; 0: of other maps
  float perGap; // scene units
};

// Each g subtracts before it scales, so that equal depths give exactly 0.
StoredRay storedRay(ShadowConstants shadow, ShadowReceiver receiver, vec3 x, Incident light) {
  bool perspective = shadow.meta.z != 0u;
  if (shadow.meta.y == PELLUCID_SHADER_DEPTH_DEVICE) // on the ray, clip = (0, 0, lightZ, 0) + t (clip(x) - (0, 0, lightZ, 0))
    return StoredRay(receiver.clip.w, -receiver.clip.z, perspective ? shadow.depth.x : 0.0, perspective ? light.distanceTo : -shadow.depth.x);
  if (shadow.meta.y != PELLUCID_SHADER_DEPTH_VIEW_Z) return StoredRay(-1.0, light.distanceTo, 0.0, 1.0);
  float planar = dot(shadow.planar, vec4(x, 1.0)); // inside of a perspective map: above 0
  return StoredRay(-1.0, planar, 0.0, perspective ? light.distanceTo / max(planar, 1.0e-12) : shadow.depth.x);
}

// Scene units along the light ray from the stored surface to the receiver; negative: the surface is beyond the receiver.
float lightThickness(StoredRay ray, float stored) {
  float gap = ray.scale * stored + ray.offset, total = ray.lightZ + gap;
  if (ray.lightZ == 0.0) return gap * ray.perGap;
  // The stored depth is at t = lightZ / total: total has the sign of lightZ for every t > 0.
  return total * ray.lightZ > 0.0 ? gap / total * ray.perGap : -1.0;
}

// Scene units along the light ray per unit of the stored depth, at that depth: the derivative of lightThickness.
float lengthPerDepth(StoredRay ray, float stored) {
  float total = ray.lightZ + ray.scale * stored + ray.offset;
  if (ray.lightZ == 0.0) return abs(ray.scale * ray.perGap);
  // A surface at the light itself has no bound.
  return total * ray.lightZ > 0.0 ? min(abs(ray.scale * ray.lightZ) / max(total * total, 1.0e-30), kNoDepth) * ray.perGap : 0.0;
}

// ---- What lies behind the surface that a map stores: the receiver's own medium, another body, or air. Functions take texels of
// the optional images beside the map; see PellucidShadowMap.

// depthTolerance ends at a slope of 7, a cosine of .14. Only below .09 a receiver's
// own exit can be farther off than this. More would hide gaps: 8 texels of a head's map of 1024 texels are 1.8 mm.
const float kMostTexels = 8.0;

// Slope of a surface across a light's rays, from the cosine between them and its normal; at most 1000.
float slopeOf(float cosine) { return sqrt(max(1.0 - cosine * cosine, 0.0)) / max(abs(cosine), 1.0e-3); }

// True where light that meets the stored surface enters the receiver's material. `stored`: texel of the caster's image;
// `scale`: as ShadowConstants::occluder.z; `material`: index + 1.
bool casterIsMedium(float stored, float scale, uint material) {
  return isWithin(abs(stored * scale - float(material)), 0.0, 0.5);
}

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
