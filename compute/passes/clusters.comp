// Clusters, which edges are summed from, of what the pyramid has resolved: levels 1 and 2 where these levels were, coarser ones
// beside them. A group does what lies under a texel of the last level, an invocation of it what lies under one of level 3.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_CLUSTERS_GROUP
#include "passes/normal_image.glsl"
#include "passes/clusters.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

// Of levels 3 to 7, one after the other.
shared uvec4 kept[256 + 64 + 16 + 4 + 1];

// Planes that much larger than facing the camera, 25 degrees from it, have an area for each pixel.
const float kMostFacing = 1.1;

// Of four pixels, each with the area of its own normal, in place of the level's texel, which has that of one of them.
Cluster clusterOfPixels(ivec2 quad) {
  Cluster pixels[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 pixel = childOf(quad, i), at = withinRect(pixel);
    float depth = frontDistance(at), area = areaOf(vec2(at), normalAt(at));
    uint material = at == pixel && depth > 0.0 ? materialAt(at) : 0u;
    pixels[i] = kNoCluster;
    pixels[i].color = sanitize(texelFetch(sourceImage, at, 0).rgb);
    pixels[i].mass = material == 0u ? 0.0 : area > 0.0 ? area : 1.0;
    pixels[i].material = material;
    pixels[i].depth = depth;
  }
  return merged(pixels, 1u);
}

Cluster clusterOfQuad(ivec2 quad) {
  uvec4 bits = contains(clusterRect(1u), quad) ? texelFetch(pyramidImage, inAtlas(1u, quad), 0) : uvec4(0u);
  if (!hasSurface(bits)) return kNoCluster;
  if (isPlane(bits) && massOf(bits.y) < kMostFacing) return clusterOfTexel(bits);
  Cluster c = clusterOfPixels(quad);
  writeLevel(1u, quad, packCluster(c));
  return c;
}

Cluster clusterOfQuads(ivec2 texel) {
  Cluster quads[4];
  for (int i = 0; i < 4; ++i) quads[i] = clusterOfQuad(childOf(texel, i));
  Cluster c = merged(quads, 2u);
  if (contains(clusterRect(2u), texel)) writeLevel(2u, texel, packCluster(c));
  return c;
}

void main() {
  int invocation = int(gl_LocalInvocationIndex), side = PELLUCID_CLUSTERS_GROUP, first = 0;
  ivec2 last = clusterRect(PELLUCID_LAST_LEVEL).xy + ivec2(gl_WorkGroupID.xy);
  for (uint level = 3u; level <= pass.value.x; ++level) {
    if (invocation < side * side) {
      ivec2 at = ivec2(invocation % side, invocation / side), texel = side * last + at;
      Cluster children[4];
      if (level == 3u) {
        for (int i = 0; i < 4; ++i) children[i] = clusterOfQuads(childOf(texel, i));
      } else {
        // The level before has twice as many to a side.
        int before = first - 4 * side * side;
        for (int i = 0; i < 4; ++i) {
          ivec2 child = childOf(at, i);
          children[i] = unpackCluster(kept[before + child.y * 2 * side + child.x]);
        }
      }
      uvec4 bits = packCluster(merged(children, level));
      kept[first + invocation] = bits;
      if (contains(clusterRect(level), texel)) imageStore(levelsDestination, clusterPlace(level, texel), bits);
    }
    barrier();
    first += side * side;
    side /= 2;
  }
}
