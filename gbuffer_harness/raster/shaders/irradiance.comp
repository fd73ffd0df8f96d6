#version 450
// Adds one light's irradiance, with its shadow, to what the lights before it gave.
#extension GL_GOOGLE_include_directive : require
#include "lib/light.glsl"

layout(local_size_x = 8, local_size_y = 8) in; // kGroup of common/pixel_pass.cpp

#define SHADOW_MAPS 6
layout(constant_id = 0) const uint kMaps = SHADOW_MAPS; // at most

struct ShadowView {
  mat4 clipFromView; // clip space of the shadow map from the camera's view space
  vec4 planar;       // dot(planar, (x, 1)): planar distance from the light
  vec4 texel;        // x: size of a texel, at planar distance 1 if perspective
};
layout(set = 0, binding = 0) uniform Constants {
  mat4 viewFromWorld;
  ShadowView shadowViews[SHADOW_MAPS];
  vec4 shadow;  // x: texels across; y: 1 perspective
  vec4 eye;     // ndc to view at planar distance 1: x, y; zw: ndc of the axis
  ivec4 lookup; // x: maps; y: 1 a cube's faces, else cascades; z: taps across as ShadowDrawing::filter, 0: plain maps;
                // w: 1 the camera is a perspective
  LightConstants light;
};
layout(set = 0, binding = 1) uniform sampler2D normalPlanar;
layout(set = 0, binding = 2) uniform sampler2D shadowMaps[SHADOW_MAPS]; // planar distances; filtered: device depths
layout(set = 0, binding = 3, rgba32f) uniform image2D irradiance;
layout(set = 0, binding = 4) uniform sampler2D depthNormal; // yzw: the triangles' normal

// Constant indices: not every device can index samplers otherwise.
float shadowTexel(int map, ivec2 t) {
  if (kMaps == 1u) return texelFetch(shadowMaps[0], t, 0).r;
  switch (map) {
    case 0: return texelFetch(shadowMaps[0], t, 0).r;
    case 1: return texelFetch(shadowMaps[1], t, 0).r;
    case 2: return texelFetch(shadowMaps[2], t, 0).r;
    case 3: return texelFetch(shadowMaps[3], t, 0).r;
    case 4: return texelFetch(shadowMaps[4], t, 0).r;
    default: return texelFetch(shadowMaps[5], t, 0).r;
  }
}

// Of a cube's faces, that in whose middle x lies: it is farthest along that face's axis. Of cascades, the first that
// contains x.
int mapOf(vec3 x) {
  int map = 0;
  float farthest = dot(shadowViews[0].planar, vec4(x, 1.0));
  for (int i = lookup.y != 0 ? 1 : 0; i < lookup.x; ++i) {
    if (lookup.y == 0) {
      vec4 clip = shadowViews[i].clipFromView * vec4(x, 1.0);
      if (all(lessThanEqual(abs(clip.xy), vec2(clip.w)))) return i;
      continue;
    }
    float planar = dot(shadowViews[i].planar, vec4(x, 1.0));
    if (planar > farthest) {
      map = i;
      farthest = planar;
    }
  }
  return map;
}

// As an engine filters: taps a texel apart, of each the bilinear part of its four texels that lie no nearer to the
// light. Depths are reversed.
float filteredVisibility(int map, vec3 x) {
  vec4 clip = shadowViews[map].clipFromView * vec4(x, 1.0);
  if (!(clip.w > 0.0)) return 1.0;
  float depth = clip.z / clip.w;
  vec2 position = (clip.xy / clip.w * 0.5 + 0.5) * shadow.x - 0.5;
  if (any(lessThan(position, vec2(-0.5))) || any(greaterThan(position, vec2(shadow.x - 0.5)))) return 1.0;
  ivec2 base = ivec2(floor(position));
  vec2 f = position - vec2(base);
  int reach = lookup.z / 2;
  float lit = 0.0;
  // A texel counts in as many taps as it lies within: all but those at the rim in all of them.
  for (int y = -reach; y <= reach + 1; ++y)
    for (int x = -reach; x <= reach + 1; ++x) {
      vec2 w = vec2(x == -reach ? 1.0 - f.x : x == reach + 1 ? f.x : 1.0, y == -reach ? 1.0 - f.y : y == reach + 1 ? f.y : 1.0);
      ivec2 t = clamp(base + ivec2(x, y), ivec2(0), ivec2(shadow.x) - 1);
      lit += depth >= shadowTexel(map, t) ? w.x * w.y : 0.0;
    }
  return lit / float(lookup.z * lookup.z);
}

// Fraction of the four texels around x that see it, weighted bilinearly.
float visibility(vec3 x, vec3 n) {
  if (lookup.x == 0) return 1.0;
  int map = lookup.x == 1 ? 0 : mapOf(x);
  if (lookup.z > 0) return filteredVisibility(map, x);
  float planar = dot(shadowViews[map].planar, vec4(x, 1.0));
  float texel = shadowViews[map].texel.x * (shadow.y != 0.0 ? planar : 1.0);
  // One texel along the map, the planar distance of a surface to which the map's axis stands at angle a
  // changes by texel sin(a) / d, where the ray goes d along the normal per planar distance; moving by h along
  // the normal gains h / d. 1.5 covers the diagonal of the four texels. 0.05 covers hollows of more than 22
  // texels' radius and interpolated normals 2 degrees off; the rest covers rounding.
  float axial = dot(shadowViews[map].planar.xyz, n);
  float offset = texel * (1.5 * sqrt(max(1.0 - axial * axial, 0.0)) + 0.05) + 4.0e-6 * planar;
  x += n * offset;
  planar = dot(shadowViews[map].planar, vec4(x, 1.0)) - 4.0e-6 * planar;
  vec4 clip = shadowViews[map].clipFromView * vec4(x, 1.0);
  if (!(clip.w > 0.0)) return 1.0;
  vec2 position = (clip.xy / clip.w * 0.5 + 0.5) * shadow.x - 0.5;
  ivec2 base = ivec2(floor(position));
  vec2 f = position - vec2(base);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 t = base + corner;
    bool outside = any(lessThan(t, ivec2(0))) || any(greaterThanEqual(t, ivec2(shadow.x)));
    bool seen = outside || shadowTexel(map, t) >= planar;
    vec2 w = mix(1.0 - f, f, vec2(corner));
    lit += seen ? w.x * w.y : 0.0;
  }
  return lit;
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  ivec2 size = imageSize(irradiance);
  if (any(greaterThanEqual(pixel, size))) return;
  vec4 surface = texelFetch(normalPlanar, pixel, 0);
  if (!(surface.w > 0.0)) return;
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
  vec3 x = vec3((ndc - eye.zw) * eye.xy * (lookup.w != 0 ? surface.w : 1.0), -surface.w);
  vec3 n = mat3(viewFromWorld) * surface.xyz;
  Incident incident = incidentLight(light, x);
  float cosine = dot(n, incident.toLight);
  if (!(cosine > 0.0)) return;
  vec3 e = incident.irradiance * cosine * visibility(x, mat3(viewFromWorld) * texelFetch(depthNormal, pixel, 0).yzw);
  imageStore(irradiance, pixel, imageLoad(irradiance, pixel) + vec4(e, 0.0));
}
