// The one place that projects a receiver into a shadow map, for occlusion and thickness alike.
#ifndef PELLUCID_SHADOW_GLSL
#define PELLUCID_SHADOW_GLSL

#include "lib/camera.glsl"
#include "lib/light.glsl"

struct ShadowReceiver {
  vec4 clip;
  ivec2 texel; // of the image
  vec2 place;  // in the map, texels from its corner
  bool inside; // false: the map says nothing about this point, so no light comes through it
};

// The first texel of the map's tile in the image. occluder: ShadowConstants::occluder.
ivec2 firstTexel(uvec4 occluder) { return ivec2(occluder.w & 0xFFFFu, occluder.w >> 16); }

ShadowReceiver projectReceiver(ShadowConstants shadow, vec3 x) {
  vec4 clip = shadow.clipFromView * vec4(x, 1.0);
  bool inFront = clip.w > 0.0;
  vec2 ndc = clip.xy / (inFront ? clip.w : 1.0);
  vec2 place = (ndc * 0.5 + 0.5) * shadow.depth.zw;
  ivec2 texel = ivec2(floor(place));
  bool inside = inFront && all(lessThanEqual(abs(ndc), vec2(1.0))) &&
                all(lessThan(texel, ivec2(shadow.depth.zw)));
  return ShadowReceiver(clip, texel + firstTexel(shadow.occluder), place, inside);
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

// True where the texel holds a surface; false for NaN. meta: ShadowConstants::meta.
bool shadowHolds(uvec4 meta, float stored) {
  if (meta.y == PELLUCID_SHADER_DEPTH_DEVICE)
    return stored >= 0.0 && stored <= 1.0 && stored != uintBitsToFloat(meta.w);
  return stored > 0.0 && stored < kNoDepth;
}

// The depth of the surface that was drawn, without the biases that the drawing added; in units of the stored depth.
struct DrawnDepth {
  float depth;
  float uncertain; // how far it may be off
};

// Part of a slope that the nearer neighbor may miss: between the last texels before a sphere's limb it is 27 %.
const float kMissedSlope = 0.3;

// A texel's change of depth along an axis, x: to the nearer of its two neighbors, as the other may lie across an edge;
// 0 where there is none. y: how much that may miss, as far as the other neighbor says so.
vec2 stepAlong(float own, vec2 beside, bvec2 holds) {
  vec2 change = vec2(1.0, -1.0) * (beside - own), apart = mix(vec2(3.0e38), abs(change), holds);
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

// Scene units along the light ray from the stored surface to the receiver x; negative: the surface is
// beyond x. Each form subtracts before it scales, so equal depths give exactly 0.
float lightThickness(ShadowConstants shadow, ShadowReceiver receiver, vec3 x, Incident light, float stored) {
  bool perspective = shadow.meta.z != 0u;
  if (shadow.meta.y == PELLUCID_SHADER_DEPTH_DEVICE) {
    float gap = stored * receiver.clip.w - receiver.clip.z;
    if (!perspective) return -gap * shadow.depth.x;
    // On the ray from the light, clip = (0,0,zL,0) + t (clip(x) - (0,0,zL,0)); the stored depth is at
    // t = zL / (zL + gap). zL + gap = zL / t has zL's sign for every t > 0.
    float total = shadow.depth.x + gap;
    return total * shadow.depth.x > 0.0 ? gap / total * light.distanceTo : -1.0;
  }
  if (shadow.meta.y == PELLUCID_SHADER_DEPTH_VIEW_Z) {
    float planar = dot(shadow.planar, vec4(x, 1.0));
    if (!perspective) return (planar - stored) * shadow.depth.x;
    // inside the map: planar > 0
    return (planar - stored) / max(planar, 1.0e-12) * light.distanceTo;
  }
  return light.distanceTo - stored;
}

// Scene units along the receiver's light ray per unit of the stored depth, at that depth: the derivative of lightThickness.
float lengthPerDepth(ShadowConstants shadow, ShadowReceiver receiver, vec3 x, Incident light, float stored) {
  bool perspective = shadow.meta.z != 0u;
  if (shadow.meta.y == PELLUCID_SHADER_DEPTH_DEVICE) {
    if (!perspective) return abs(shadow.depth.x);
    float total = shadow.depth.x + stored * receiver.clip.w - receiver.clip.z;
    return total * shadow.depth.x > 0.0 ? abs(receiver.clip.w * shadow.depth.x) / (total * total) * light.distanceTo : 0.0;
  }
  if (shadow.meta.y != PELLUCID_SHADER_DEPTH_VIEW_Z) return 1.0;
  if (!perspective) return abs(shadow.depth.x);
  return light.distanceTo / max(dot(shadow.planar, vec4(x, 1.0)), 1.0e-12); // inside the map: above 0
}

#endif
