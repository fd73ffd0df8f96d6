#version 450
// All lights at once: irradiance for Pellucid, and the color of everything else.
#extension GL_GOOGLE_include_directive : require
#include "frame.glsl"
#include "lib/packing.glsl"

layout(set = 0, binding = 1) uniform sampler2D normalImage;
layout(set = 0, binding = 2) uniform sampler2D albedoImage;
layout(set = 0, binding = 3) uniform usampler2D surfaceImage;
layout(set = 0, binding = 4) uniform sampler2D depthImage;
layout(set = 0, binding = 5) uniform sampler2DArrayShadow cascades;
layout(set = 0, binding = 6) uniform sampler2DArrayShadow atlas;
layout(set = 0, binding = 7) uniform sampler2DArrayShadow cube;

layout(location = 0) out vec4 outIrradiance;
layout(location = 1) out vec4 outColor;

const float kPi = 3.14159265;

// Irradiance of a sky that is given by coefficients of radiance (Ramamoorthi and Hanrahan 2001).
vec3 ambientIrradiance(vec3 n) {
  vec3 band1 = frame.ambient[1].rgb * n.y + frame.ambient[2].rgb * n.z + frame.ambient[3].rgb * n.x;
  vec3 band2 = 1.092548 * (frame.ambient[4].rgb * n.x * n.y + frame.ambient[5].rgb * n.y * n.z + frame.ambient[7].rgb * n.x * n.z) +
               0.315392 * frame.ambient[6].rgb * (3.0 * n.z * n.z - 1.0) + 0.546274 * frame.ambient[8].rgb * (n.x * n.x - n.y * n.y);
  vec3 e = kPi * 0.282095 * frame.ambient[0].rgb + 2.0 * kPi / 3.0 * 0.488603 * band1 + kPi / 4.0 * band2;
  return max(e, 0.0);
}

float compared(uint image, vec3 at, float depth) {
  vec4 where = vec4(at, depth);
  return image == 0u ? texture(cascades, where) : image == 1u ? texture(atlas, where) : texture(cube, where);
}

// Visibility by the first tile that contains the point. Depths are reversed.
float visibility(Light light, vec3 p, vec3 n) {
  for (uint i = 0u; i < light.tiles.y; ++i) {
    Tile tile = frame.tiles[light.tiles.x + i];
    vec4 clip = tile.clipFromWorld * vec4(p, 1.0);
    // Off the surface by two texels: an offset of the receiver, which a map need not tell Pellucid.
    clip = tile.clipFromWorld * vec4(p + n * (2.0 * tile.places.z * clip.w), 1.0);
    if (clip.w <= 0.0 || any(greaterThan(abs(clip.xy), vec2(clip.w)))) continue;
    vec2 uv = tile.rect.xy + (clip.xy / clip.w * 0.5 + 0.5) * tile.rect.zw;
    vec2 low = tile.rect.xy + 0.5 * tile.places.w, high = tile.rect.xy + tile.rect.zw - 0.5 * tile.places.w;
    float sum = 0.0;
    for (int k = 0; k < 9; ++k) {
      vec2 tap = clamp(uv + (vec2(k % 3, k / 3) - 1.0) * tile.places.w, low, high);
      sum += compared(uint(tile.places.x), vec3(tap, tile.places.y), clamp(clip.z / clip.w, 0.0, 1.0));
    }
    return sum / 9.0;
  }
  return 1.0;
}

// KHR_lights_punctual: irradiance at normal incidence.
vec3 arriving(Light light, vec3 p, out vec3 toLight) {
  toLight = -light.direction.xyz;
  if (light.position.w == 0.0) return light.color.rgb;
  vec3 offset = light.position.xyz - p;
  toLight = normalize(offset);
  float cone = 1.0;
  if (light.position.w == 2.0)
    cone = clamp((dot(-toLight, light.direction.xyz) - light.color.w) / (light.direction.w - light.color.w), 0.0, 1.0);
  return light.color.rgb * cone * cone / dot(offset, offset);
}

// GGX with the height-correlated visibility of Heitz 2014 as Hammon 2017 has it, of a dielectric.
float reflected(float roughness, vec3 n, vec3 v, vec3 l) {
  float a = max(roughness * roughness, 0.01), a2 = a * a;
  vec3 h = normalize(v + l);
  float nh = clamp(dot(n, h), 0.0, 1.0), nv = max(dot(n, v), 1e-3), nl = max(dot(n, l), 1e-3);
  float d = a2 / (kPi * pow(nh * nh * (a2 - 1.0) + 1.0, 2.0));
  float f = 0.028 + 0.972 * pow(1.0 - clamp(dot(v, h), 0.0, 1.0), 5.0);
  return d * f * 0.5 / mix(2.0 * nl * nv, nl + nv, a);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depthImage, pixel, 0).r;
  vec4 point = frame.worldFromClip * vec4(gl_FragCoord.xy * frame.rect.zw * 2.0 - 1.0, depth, 1.0);
  outIrradiance = vec4(0.0, 0.0, 0.0, 1.0);
  if (depth == 0.0) { // reversed, infinite: the sky
    outColor = vec4(frame.scale.y * 0.25 * ambientIrradiance(normalize(point.xyz)), 1.0);
    return;
  }
  vec3 p = point.xyz / point.w;
  vec3 v = normalize(frame.eye.xyz - p);
  vec3 n = fromOctahedral(texelFetch(normalImage, pixel, 0).rg * 2.0 - 1.0);
  vec3 albedo = texelFetch(albedoImage, pixel, 0).rgb;
  uint surface = texelFetch(surfaceImage, pixel, 0).r;
  vec3 e = ambientIrradiance(n), specular = vec3(0.0);
  for (uint i = 0u; i < frame.flags.x; ++i) {
    vec3 l;
    vec3 light = arriving(frame.lights[i], p, l) * max(dot(n, l), 0.0);
    if (light == vec3(0.0)) continue;
    light *= visibility(frame.lights[i], p, n);
    e += light;
    specular += light * reflected(roughnessOf(surface), n, v, l);
  }
  specular *= frame.scale.z;
  vec3 stored = e;
  if (frame.flags.y == MISTAKE_ALBEDO_TWICE) stored *= albedo;
  if (frame.flags.y == MISTAKE_SPECULAR_DIFFUSED) stored += kPi * specular / max(albedo, 0.01);
  bool added = frame.flags.y == MISTAKE_SPECULAR_DIFFUSED; // with the diffuse light, and not here
  bool translucent = frame.flags.z == 1u && materialOf(surface) != 0u;
  outIrradiance.rgb = stored * frame.scale.y;
  outColor = vec4((translucent && added ? vec3(0.0) : specular * frame.scale.x) +
                      (translucent ? vec3(0.0) : albedo * e * frame.scale.y),
                  1.0);
}
