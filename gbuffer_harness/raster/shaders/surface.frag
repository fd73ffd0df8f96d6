#version 450
// The nearest surface: everything that a G-buffer holds besides light.
#extension GL_GOOGLE_include_directive : require
#include "lobes.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colorMark;
layout(location = 3) in float planar;
layout(location = 4) in vec2 normalUv;
layout(location = 5) in vec4 tangent;
layout(location = 6) in vec3 position;
layout(location = 7) in vec2 lobeUv;
layout(location = 8) in float alpha;

layout(location = 0) out vec4 outNormalPlanar;
layout(location = 1) out vec4 outAlbedoObject;
layout(location = 2) out uint outMaterial;
layout(location = 3) out vec4 outDepthNormal; // yzw: without the normal map

// The map's x is along growing u, its y along falling v (glTF 2.0, 3.9.3). The supplied tangent, or the
// derivatives of position with respect to uv (Schueler 2006, "Normal Mapping without Precomputed Tangents").
vec3 mappedNormal(vec3 n) {
  float scale = uintBitsToFloat(draw.ids.w);
  if (scale == 0.0) return n;
  vec3 m = meanOf(normalMap, normalUv, scale != 0.0).rgb * vec3(scale, scale, 1.0);
  vec2 ux = dFdx(normalUv), uy = dFdy(normalUv);
  vec3 px = dFdx(position), py = dFdy(position);
  float orientation = sign(ux.x * uy.y - uy.x * ux.y);
  vec3 alongU = (px * uy.y - py * ux.y) * orientation, alongV = (py * ux.x - px * uy.x) * orientation;
  bool supplied = dot(tangent.xyz, tangent.xyz) > 0.0;
  vec3 t = supplied ? tangent.xyz : alongU;
  t -= n * dot(n, t);
  float size = length(t);
  if (!(size > 0.0)) return n; // uv do not change
  t /= size;
  vec3 b = cross(n, t);
  if (supplied ? tangent.w < 0.0 : dot(b, alongV) > 0.0) b = -b;
  vec3 mapped = m.x * t + m.y * b + m.z * n;
  float mappedSize = length(mapped);
  return mappedSize > 0.0 ? mapped / mappedSize : n;
}

void main() {
  vec3 albedo = albedoOf(lobesOf(uv, lobeUv, colorMark.rgb));
  // Opposite normals of a crease may cancel; any direction is then as good.
  float size = length(normal);
  vec3 n = size > 0.0 ? normal / size : vec3(0.0, 0.0, 1.0);
  vec3 mapped = mappedNormal(n);
  if (isHole(uv, alpha)) discard; // after the derivatives
  float facing = gl_FrontFacing ? 1.0 : -1.0;
  bool inFront = planar > 0.0; // always, but in orthographic views whose near plane lies behind the eye
  outNormalPlanar = vec4(inFront ? facing * mapped : vec3(0.0), planar);
  outAlbedoObject = vec4(inFront ? albedo : vec3(0.0), draw.addedColor.a);
  outMaterial = inFront && colorMark.a >= 0.5 ? partMaterial() : 0u;
  outDepthNormal = vec4(gl_FragCoord.z, facing * n);
}
