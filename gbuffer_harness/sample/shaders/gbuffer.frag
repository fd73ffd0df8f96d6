#version 450
#extension GL_GOOGLE_include_directive : require
#include "../../common/shaders/srgb.glsl"
#include "frame.glsl"
#include "lib/packing.glsl"

layout(location = 0) in vec3 normal;
layout(location = 1) in vec3 color;

layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outAlbedo;
layout(location = 2) out uint outSurface;

void main() {
  vec3 albedo = draw.baseColor.rgb * color;
  outNormal = vec4(octahedral(normalize(normal)) * 0.5 + 0.5, 0.0, 0.0);
  outAlbedo = vec4(frame.flags.y == MISTAKE_GAMMA ? srgb(albedo) : albedo, 1.0);
  outSurface = packedSurface(draw.surface.y, uint(draw.surface.x));
}
