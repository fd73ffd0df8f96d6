// The one place that projects a receiver into a shadow map, for occlusion and thickness alike.
#ifndef PELLUCID_SHADOW_GLSL
#define PELLUCID_SHADOW_GLSL

#include "lib/camera.glsl"
#include "lib/light.glsl"

struct ShadowReceiver {
  vec4 clip;
  ivec2 texel;
  bool inside; // false: the map says nothing about this point, so no light comes through it
};

ShadowReceiver projectReceiver(ShadowConstants shadow, vec3 x) {
  vec4 clip = shadow.clipFromView * vec4(x, 1.0);
  bool inFront = clip.w > 0.0;
  vec2 ndc = clip.xy / (inFront ? clip.w : 1.0);
  ivec2 texel = ivec2(floor((ndc * 0.5 + 0.5) * shadow.depth.zw));
  bool inside = inFront && all(lessThanEqual(abs(ndc), vec2(1.0))) &&
                all(lessThan(texel, ivec2(shadow.depth.zw)));
  return ShadowReceiver(clip, texel, inside);
}

// True where the texel holds a surface; false for NaN. meta: ShadowConstants::meta.
bool shadowHolds(uvec4 meta, float stored) {
  if (meta.y == PELLUCID_SHADER_DEPTH_DEVICE)
    return stored >= 0.0 && stored <= 1.0 && stored != uintBitsToFloat(meta.w);
  return stored > 0.0 && stored < kNoDepth;
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

#endif
