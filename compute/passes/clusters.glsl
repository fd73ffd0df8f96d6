// Where the clusters of the levels lie.
#ifndef PELLUCID_CLUSTERS_GLSL
#define PELLUCID_CLUSTERS_GLSL

#include "lib/clusters.glsl"
#include "passes/pyramid.glsl"

// Texels [xy, zw) of a level that the rect touches, which have clusters.
ivec4 clusterRect(uint level) {
  ivec4 rect = ivec4(frame.rect);
  return ivec4(rect.xy >> int(level), ((rect.zw - 1) >> int(level)) + 1);
}

// Of levels 3 and coarser.
ivec2 clusterPlace(uint level, ivec2 texel) { return frame.level[level].zw + texel; }

#endif
