// Clusters, which edges are summed from, of what the pyramid has resolved: levels 1 and 2 where these levels were, coarser ones
// beside them. An invocation does what lies under a texel of level 2, a group what lies under one of level 6. What is summed
// are four of them together, so the coarsest level has none.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_CLUSTERS_GROUP
#include "passes/normal_image.glsl"
#include "passes/clusters.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

// Of levels 2 to 5, one after the other.
const int kSide = PELLUCID_CLUSTERS_GROUP, kKept = kSide * kSide * (64 + 16 + 4 + 1) / 64;
shared uvec4 kept[kKept];
shared float masses[kKept];

// Planes that much larger than facing the camera, 25 degrees from it, have an area for each pixel.
const float kMostFacing = 1.1;

// A pixel with the area of its own normal.
uvec4 clusterOfPixel(ivec2 pixel, out float mass) {
  ivec2 at = withinRect(pixel);
  float depth = frontDistance(at), area = areaOf(vec2(at), normalAt(at));
  uint material = at == pixel && depth > 0.0 ? materialAt(at) : 0u;
  mass = material == 0u ? 0.0 : area > 0.0 ? area : 1.0;
  Cluster c = kNoCluster;
  c.color = sanitize(texelFetch(sourceImage, at, 0).rgb);
  c.material = material;
  c.depth = depth;
  return packCluster(c);
}

// Quads that are no planes or tilted are averaged from their pixels, in place of the level's texel, which has the area of one.
uvec4 clusterOfQuad(ivec2 quad, uvec4 bits, out float mass) {
  mass = massOf(bits.y);
  if (mass == 0.0 || (isPlane(bits) && mass < kMostFacing)) return packCluster(clusterOfTexel(bits));
  uvec4 pixels[4];
  float areas[4];
  [[unroll]] for (int i = 0; i < 4; ++i) pixels[i] = clusterOfPixel(childOf(quad, i), areas[i]);
  Cluster c = merged(pixels, areas, 1u);
  mass = c.mass;
  uvec4 cluster = packCluster(c);
  writeLevel(1u, quad, cluster);
  return cluster;
}

void main() {
  if (texelFetch(pyramidImage, summedPlace(), 0).x == 0u) return; // of all invocations
  int invocation = int(gl_LocalInvocationIndex), side = kSide, before = 0;
  ivec2 group = ivec2(frame.rect.xy) / (4 * kSide) + ivec2(gl_WorkGroupID.xy);
  ivec2 texel = side * group + ivec2(gl_LocalInvocationID.xy);
  uvec4 children[4];
  float areas[4];
  // All before the first is used.
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 quad = childOf(texel, i);
    children[i] = contains(clusterRect(1u), quad) ? texelFetch(pyramidImage, inAtlas(1u, quad), 0) : uvec4(0u);
  }
  [[unroll]] for (int i = 0; i < 4; ++i) children[i] = clusterOfQuad(childOf(texel, i), children[i], areas[i]);
  Cluster c = merged(children, areas, 2u);
  uvec4 bits = packCluster(c);
  kept[invocation] = bits;
  masses[invocation] = c.mass;
  if (contains(clusterRect(2u), texel)) writeLevel(2u, texel, bits);
  uint last = pass.value.x - 1u;
  for (uint level = 3u; level <= last; ++level) {
    barrier();
    // The level before has twice as many to a side.
    int finer = side;
    side /= 2;
    if (invocation < side * side) {
      ivec2 at = ivec2(invocation % side, invocation / side);
      texel = side * group + at;
      [[unroll]] for (int i = 0; i < 4; ++i) {
        ivec2 child = childOf(at, i);
        children[i] = kept[before + child.y * finer + child.x];
        areas[i] = masses[before + child.y * finer + child.x];
      }
      c = merged(children, areas, level);
      bits = packCluster(c);
      if (level < last) {
        kept[before + finer * finer + invocation] = bits;
        masses[before + finer * finer + invocation] = c.mass;
      }
      if (contains(clusterRect(level), texel)) imageStore(levelsDestination, clusterPlace(level, texel), bits);
    }
    before += finer * finer;
  }
}
