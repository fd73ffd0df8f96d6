#version 450
#extension GL_GOOGLE_include_directive : require
#include "../../common/shaders/srgb.glsl"
#include "frame.glsl"
#include "lib/packing.glsl"

layout(set = 0, binding = 1) uniform sampler2D baseColorTexture;
layout(set = 0, binding = 2) uniform sampler2D normalMap; // vectors

layout(location = 0) in vec3 normal;
layout(location = 1) in vec4 uvs;
layout(location = 2) in vec4 colorMark;
layout(location = 3) in vec4 tangent; // 0: the file has none, and the normal map is not used
layout(location = 4) in float alpha;

layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outAlbedo;
layout(location = 2) out uint outSurface;

vec3 mappedNormal(vec3 n) {
  vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
  if (draw.surface.z == 0.0 || dot(t, t) < 1e-8) return n;
  t = normalize(t);
  vec3 m = texture(normalMap, uvs.zw).rgb * vec3(draw.surface.zz, 1.0);
  return normalize(m.x * t + m.y * tangent.w * cross(n, t) + m.z * n);
}

void main() {
  vec4 texel = texture(baseColorTexture, uvs.xy);
  if (texel.a * alpha < draw.baseColor.a) discard;
  vec3 n = mappedNormal(normalize(normal)) * (gl_FrontFacing ? 1.0 : -1.0);
  vec3 albedo = texel.rgb * draw.baseColor.rgb * colorMark.rgb;
  outNormal = vec4(octahedral(n) * 0.5 + 0.5, 0.0, 0.0);
  outAlbedo = vec4(frame.flags.y == MISTAKE_GAMMA ? srgb(albedo) : albedo, 1.0);
  outSurface = packedSurface(draw.surface.y, colorMark.a >= 0.5 ? uint(draw.surface.x) : 0u);
}
