#version 450
// Adds one light's irradiance, with its shadow, to what the lights before it gave.
#extension GL_GOOGLE_include_directive : require
#include "lib/light.glsl"

layout(local_size_x = PELLUCID_GROUP_X, local_size_y = PELLUCID_GROUP_Y) in;

layout(set = 0, binding = 0) uniform Constants {
  mat4 viewFromWorld;
  mat4 shadowFromView; // clip space of the shadow map
  vec4 shadowPlanar;   // dot(shadowPlanar, (x, 1)): planar distance from the light
  vec4 shadow;         // x: texels across, 0: no map; y: 1 perspective; z: size of a texel, at planar
                       // distance 1 if perspective
  vec4 eye;            // ndc to view at planar distance 1: x, y; z: 1 perspective
  LightConstants light;
};
layout(set = 0, binding = 1) uniform sampler2D normalPlanar;
layout(set = 0, binding = 2) uniform sampler2D shadowMap; // planar distances
layout(set = 0, binding = 3, rgba32f) uniform image2D irradiance;

// Fraction of the four texels around x that see it, weighted bilinearly.
float visibility(vec3 x, vec3 n, vec3 toLight) {
  if (shadow.x == 0.0) return 1.0;
  float planar = dot(shadowPlanar, vec4(x, 1.0));
  float texel = shadow.z * (shadow.y != 0.0 ? planar : 1.0);
  // A texel away, a plane at angle a to the light is texel tan(a) nearer; moving by h along the normal
  // gains h / cos(a). 1.5 covers the diagonal of the four texels; the rest covers rounding.
  float cosine = dot(n, toLight);
  float offset = texel * 1.5 * sqrt(max(1.0 - cosine * cosine, 0.0)) + 4.0e-6 * planar;
  x += n * offset;
  planar = dot(shadowPlanar, vec4(x, 1.0)) - 4.0e-6 * planar;
  vec4 clip = shadowFromView * vec4(x, 1.0);
  if (!(clip.w > 0.0)) return 1.0;
  vec2 position = (clip.xy / clip.w * 0.5 + 0.5) * shadow.x - 0.5;
  ivec2 base = ivec2(floor(position));
  vec2 f = position - vec2(base);
  float lit = 0.0;
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    ivec2 t = base + corner;
    bool outside = any(lessThan(t, ivec2(0))) || any(greaterThanEqual(t, ivec2(shadow.x)));
    bool seen = outside || texelFetch(shadowMap, t, 0).r >= planar;
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
  vec3 x = vec3(ndc * eye.xy * (eye.z != 0.0 ? surface.w : 1.0), -surface.w);
  vec3 n = mat3(viewFromWorld) * surface.xyz;
  Incident incident = incidentLight(light, x);
  float cosine = dot(n, incident.toLight);
  if (!(cosine > 0.0)) return;
  vec3 e = incident.irradiance * cosine * visibility(x, n, incident.toLight);
  imageStore(irradiance, pixel, imageLoad(irradiance, pixel) + vec4(e, 0.0));
}
