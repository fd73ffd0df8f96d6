#version 450
// The nearest surface: everything that a G-buffer holds besides light.
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colorMark;
layout(location = 3) in float planar;

layout(location = 0) out vec4 outNormalPlanar;
layout(location = 1) out vec4 outAlbedoObject;
layout(location = 2) out uint outMaterial;
layout(location = 3) out float outDepth;

// Mean over the pixel's footprint: there are no mip levels.
vec3 textureColor() {
  const int n = 4;
  vec2 dx = dFdx(uv), dy = dFdy(uv);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < n * n; ++i) {
    vec2 offset = (vec2(i % n, i / n) + 0.5) / float(n) - 0.5;
    sum += textureLod(baseColorTexture, uv + dx * offset.x + dy * offset.y, 0.0).rgb;
  }
  return sum / float(n * n);
}

void main() {
  vec3 albedo = textureColor() * draw.baseColor.rgb * colorMark.rgb + draw.addedColor.rgb;
  if (isHole(uv)) discard;
  // Opposite normals of a crease may cancel; any direction is then as good.
  float size = length(normal);
  vec3 n = size > 0.0 ? normal / size : vec3(0.0, 0.0, 1.0);
  outNormalPlanar = vec4(gl_FrontFacing ? n : -n, planar);
  outAlbedoObject = vec4(albedo, draw.addedColor.a);
  outMaterial = colorMark.a >= 0.5 ? draw.ids.x : 0u;
  outDepth = gl_FragCoord.z;
}
