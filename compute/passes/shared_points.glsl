// What the gather's points share, where the diffusion adds it.
#ifndef PELLUCID_SHARED_POINTS_GLSL
#define PELLUCID_SHARED_POINTS_GLSL

#include "passes/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_SHARED_POINTS) uniform utexture2D pointsImage;

uvec4 pointBits(ivec2 cell) {
  return contains(cellsOf(frame.rect, PELLUCID_DIFFUSE_CELL), cell) ? texelFetch(pointsImage, cell, 0) : kNoPoint;
}

uvec4 pointOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  Point p = unpackPoint(pointBits(cell));
  vec4 plane = tangentPlane(p, pixelInCell(cell, PELLUCID_DIFFUSE_CELL, p.index), pixel);
  off = (front - plane.x) * plane.w;
  return uvec4(packLight(p.added, p.convexity), p.material);
}

#endif
