// Clusters, which edges are summed from, of what the pyramid has resolved: levels 1 and 2 where these levels were, coarser ones
// beside them, the second of two elsewhere. An invocation does what lies under a texel of level 2, a group what lies under one
// of level 6. What is summed are those of four texels together, so the coarsest level has none.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_CLUSTERS_GROUP
#include "passes/normal_image.glsl"
#include "passes/clusters.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

// Of levels 2 to 5, one after the other. Masses: x of the first, y of the second of two, 0 where there is none.
const int kSide = PELLUCID_CLUSTERS_GROUP, kKept = kSide * kSide * (64 + 16 + 4 + 1) / 64;
shared uvec4 kept[kKept], seconds[kKept];
shared vec2 masses[kKept];

// Planes that much larger than facing the camera, 25 degrees from it, have an area for each pixel.
const float kMostFacing = 1.1;

// A pixel with the area of its own normal.
Cluster clusterOfPixel(ivec2 pixel) {
  ivec2 at = withinRect(pixel);
  float area = areaOf(vec2(at), normalAt(at));
  Cluster c = kNoCluster;
  c.depth = frontDistance(at);
  c.material = materialOf(pixel, c.depth);
  c.mass = c.material == 0u ? 0.0 : area > 0.0 ? area : 1.0;
  c.color = sanitize(texelFetch(sourceImage, at, 0).rgb);
  return c;
}

// Quads that are no planes or tilted are averaged from their pixels, in place of the level's texel, which has the area of one.
// `range`: of all that the quad's texel of level 2 has.
Cluster clusterOfQuad(ivec2 quad, uvec4 bits, inout Range range) {
  Cluster c = clusterOfTexel(bits);
  if (c.mass == 0.0 || (isPlane(bits) && c.mass < kMostFacing)) {
    extend(range, c.depth, c.mass > 0.0 ? c.material : 0u);
    return c;
  }
  Cluster pixels[4];
  Range of = kNoRange;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    pixels[i] = clusterOfPixel(childOf(quad, i));
    extend(of, pixels[i].depth, pixels[i].material);
    extend(range, pixels[i].depth, pixels[i].material);
  }
  ClusterSums sums = kNoSums;
  [[unroll]] for (int i = 0; i < 4; ++i)
    if (pixels[i].material != 0u && pixels[i].material == of.material)
      addCluster(sums, pixels[i], pixels[i].mass, of.nearest, placeInParent(i), 0.5);
  c = together(sums, of.nearest, of.material, 4.0);
  writeLevel(1u, quad, packCluster(c));
  return c;
}

// One of two of level 2, from its pixels.
Cluster clusterOfPixels(ivec2 texel, Split split, bool second, float nearest) {
  ClusterSums sums = kNoSums;
  for (int i = 0; i < 16; ++i) {
    ivec2 inTexel = ivec2(i % 4, i / 4);
    Cluster c = clusterOfPixel(4 * texel + inTexel);
    if (belongs(split, second, c.depth, c.material))
      addCluster(sums, c, c.mass, nearest, 0.25 * vec2(inTexel) - 0.375, 0.25);
  }
  return together(sums, nearest, second ? split.second : split.first, 16.0);
}

// Writes a texel's only one or one of two, and keeps it for the next level. `place`: in kept[].
void writeCluster(uint level, ivec2 texel, int place, Cluster c, bool second, bool ofTwo) {
  uvec4 bits = packCluster(c);
  bits.x |= ofTwo && !second ? kIsSplit : 0u;
  if (level < pass.value.x - 1u) {
    if (second)
      seconds[place] = bits, masses[place].y = c.mass;
    else
      kept[place] = bits, masses[place] = vec2(c.mass, 0.0);
  }
  if (contains(clusterRect(level), texel))
    imageStore(levelsDestination, second ? secondPlace(level, texel) : clusterPlace(level, texel), bits);
}

void main() {
  if (texelFetch(pyramidImage, summedPlace(), 0).x == 0u) return; // of all invocations
  int invocation = int(gl_LocalInvocationIndex), side = kSide, before = 0;
  ivec2 group = ivec2(frame.rect.xy) / (4 * kSide) + ivec2(gl_WorkGroupID.xy);
  ivec2 texel = side * group + ivec2(gl_LocalInvocationID.xy);
  uvec4 quads[4];
  // All before the first is used.
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 quad = childOf(texel, i);
    quads[i] = contains(clusterRect(1u), quad) ? texelFetch(pyramidImage, inAtlas(1u, quad), 0) : uvec4(0u);
  }
  Range range = kNoRange;
  ClusterSums sums = kNoSums;
  float from = 0.0; // a depth near which the texel's are
  [[unroll]] for (int i = 0; i < 4; ++i) {
    Cluster c = clusterOfQuad(childOf(texel, i), quads[i], range);
    if (c.mass > 0.0) {
      from = from > 0.0 ? from : c.depth;
      addCluster(sums, c, c.mass, from, placeInParent(i), 0.5);
    }
  }
  Split split = splitOf(range, 2u);
  bool two = split.second != 0u;
  if (!two)
    writeCluster(2u, texel, invocation, together(sums, from, split.first, 4.0), false, false);
  else
    [[dont_unroll]] for (int i = 0; i < 2; ++i) {
      bool second = i != 0;
      writeCluster(2u, texel, invocation, clusterOfPixels(texel, split, second, range.nearest), second, true);
    }
  for (uint level = 3u; level < pass.value.x; ++level) {
    barrier();
    // The level before has twice as many to a side.
    int finer = side;
    side /= 2;
    if (invocation < side * side) {
      ivec2 at = ivec2(invocation % side, invocation / side);
      range = kNoRange;
      for (int i = 0; i < 8; ++i) {
        ivec2 child = childOf(at, i & 3);
        int place = before + child.y * finer + child.x;
        uvec4 bits = i < 4 ? kept[place] : seconds[place];
        float mass = i < 4 ? masses[place].x : masses[place].y;
        extend(range, clusterDepth(bits), mass > 0.0 ? materialBits(bits) : 0u);
      }
      split = splitOf(range, level);
      two = split.second != 0u;
      [[dont_unroll]] for (int j = 0; j < (two ? 2 : 1); ++j) {
        bool second = j != 0;
        sums = kNoSums;
        [[dont_unroll]] for (int i = 0; i < 8; ++i) {
          ivec2 child = childOf(at, i & 3);
          int place = before + child.y * finer + child.x;
          Cluster c = unpackCluster(i < 4 ? kept[place] : seconds[place]);
          float mass = i < 4 ? masses[place].x : masses[place].y;
          if (mass > 0.0 && belongs(split, second, c.depth, c.material))
            addCluster(sums, c, mass, range.nearest, placeInParent(i & 3), 0.5);
        }
        writeCluster(level, side * group + at, before + finer * finer + invocation,
                     together(sums, range.nearest, second ? split.second : split.first, 4.0), second, two);
      }
    }
    before += finer * finer;
  }
}
