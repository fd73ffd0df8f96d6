// Filtered probes, where the diffusion adds their light.
#include "gather/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_FILTERED_PROBES) uniform utexture2D probesImage;

uvec4 probeBits(ivec2 cell) {
  return contains(cellsOf(frame.rect, PELLUCID_DIFFUSE_CELL), cell) ? texelFetch(probesImage, cell, 0) : kNoProbe;
}

uvec4 probeOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  Probe p = unpackProbe(probeBits(cell));
  vec4 plane = tangentPlane(p, pixelInCell(cell, PELLUCID_DIFFUSE_CELL, p.index), pixel);
  off = (front - plane.x) * plane.w;
  return uvec4(packLight(p.added, p.convexity), p.material);
}
