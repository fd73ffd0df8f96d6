// Where the clusters of the levels lie, and what pixels they are made of.
#ifndef PELLUCID_CLUSTERS_GLSL
#define PELLUCID_CLUSTERS_GLSL

#include "lib/clusters.glsl"
#include "passes/pyramid.glsl"

// Texels [xy, zw) of a level that the rect touches, which have clusters.
ivec4 clusterRect(uint level) {
  ivec4 rect = ivec4(frame.rect);
  return ivec4(rect.xy >> int(level), ((rect.zw - 1) >> int(level)) + 1);
}

ivec2 clusterPlace(uint level, ivec2 texel) {
  return level >= uint(PELLUCID_FIRST_BESIDE) ? frame.level[level].zw + texel : inAtlas(level, texel);
}

// Of the second of two, from level 2 on: of level 2 in the place of the first of its quads, none of which is read then.
ivec2 secondPlace(uint level, ivec2 texel) {
  return level >= uint(PELLUCID_FIRST_BESIDE) ? frame.second[level].xy + texel
                                              : inAtlas(1u, max(2 * texel, clusterRect(1u).xy));
}

// 0 where there is no surface.
uint materialOf(ivec2 pixel, float depth) {
  ivec2 at = withinRect(pixel);
  return at == pixel && depth > 0.0 ? materialAt(at) : 0u;
}

#endif
