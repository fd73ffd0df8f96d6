// Clusters: what stands for all that lies under a texel of a level where edges are summed (Barnes and Hut 1986, on a grid):
// one, or two where that is two surfaces, the second behind the first or of another material. Each has the mean color, the
// center of the area and the first moments of the light around it, exact to the order of the side over the distance.
#ifndef PELLUCID_CLUSTERS_LIB_GLSL
#define PELLUCID_CLUSTERS_LIB_GLSL

#include "lib/pyramid.glsl"

struct Cluster {
  vec3 color;    // mean over the surface's area
  float mass;    // area of surface over that of a texel facing the camera; 0: there is none
  uint material;
  float depth;   // planar, of the center
  vec2 center;   // of the area, from the texel's center, sides
  vec3 momentX;  // of the light over the color, from that center: where each channel's own center is, sides
  vec3 momentY;
};

const Cluster kNoCluster = Cluster(vec3(0.0), 0.0, 0u, 0.0, vec2(0.0), vec3(0.0), vec3(0.0));

// Moments are at most this in 5 bits with 0 exact; light in one corner of a texel has 3/8.
const float kMostMoment = 0.375, kMomentOne = 15.0 / kMostMoment;

uint packMoments(vec3 moment) {
  uvec3 u = uvec3(ivec3(floor(clamp(moment, vec3(-kMostMoment), vec3(kMostMoment)) * kMomentOne + 15.5)));
  return u.r | u.g << 5 | u.b << 10;
}

vec3 unpackMoments(uint u) { return (vec3(u & 31u, (u >> 5) & 31u, (u >> 10) & 31u) - 15.0) * (1.0 / kMomentOne); }

// Of x, where the sign of green is: of two, the first.
const uint kIsSplit = 0x80000000u;

bool isSplit(uvec4 u) { return (u.x & kIsSplit) != 0u; }

// As texels of the pyramid; in the last 8 bits of the depth the center in sixteenths, in place of the slope the moments and two
// more bits of the area.
uvec4 packCluster(Cluster c) {
  // Anything at all must not round to 0, of the first seven bits either.
  uint mass = uint(clamp(128.0 * sqrt(c.mass) + 0.5, c.mass > 0.0 ? 4.0 : 0.0, 511.0));
  uvec2 center = uvec2(clamp(floor(c.center * 16.0 + 8.5), vec2(0.0), vec2(15.0)));
  return uvec4(packColor(c.color, mass >> 2 | c.material << 8),
               ((floatBitsToUint(c.depth) + 0x80u) & ~0xFFu) | center.x | center.y << 4,
               packMoments(c.momentX) | packMoments(c.momentY) << 15 | mass << 30);
}

float clusterDepth(uvec4 u) { return uintBitsToFloat(u.z & ~0xFFu); }

float clusterMass(uvec4 u) {
  float root = float((u.y >> 14 & 0x1FCu) | u.w >> 30);
  return root * root * (1.0 / 16384.0);
}

Cluster unpackCluster(uvec4 u) {
  Cluster c;
  c.color = unpackColor(uvec2(u.x & ~kIsSplit, u.y));
  c.mass = clusterMass(u);
  c.material = materialBits(u);
  c.depth = clusterDepth(u);
  c.center = (vec2(u.z & 15u, (u.z >> 4) & 15u) - 8.0) * (1.0 / 16.0);
  c.momentX = unpackMoments(u.w);
  c.momentY = unpackMoments(u.w >> 15);
  return c;
}

// A texel of level 1 of the pyramid, without moments.
Cluster clusterOfTexel(uvec4 bits) {
  Texel t = unpackTexel(bits);
  return Cluster(t.color, t.mass, t.material, t.depth, vec2(0.0), vec3(0.0), vec3(0.0));
}

// The four under a texel, rows first.
ivec2 childOf(ivec2 texel, int i) { return 2 * texel + ivec2(i & 1, i >> 1); }

// The center of child `i` from the texel's, in the texel's sides.
vec2 placeInParent(int i) { return 0.5 * vec2(i & 1, i >> 1) - 0.25; }

// What is known of all that lies under a texel before it is one or two.
struct Range {
  float nearest, farthest; // depths of the nearest material
  uint material;           // 0: nothing is there
  uint other;              // the nearest one of others; 0: none
  float otherNearest;
};

const Range kNoRange = Range(kNoDepth, 0.0, 0u, 0u, kNoDepth);

// `material`: 0 where there is nothing.
void extend(inout Range r, float depth, uint material) {
  if (material == 0u) return;
  if (material == r.material) {
    r.nearest = min(r.nearest, depth);
    r.farthest = max(r.farthest, depth);
  } else if (depth < r.nearest) {
    // What it was is behind it.
    if (r.material != 0u) r.other = r.material, r.otherNearest = r.nearest;
    r.nearest = r.farthest = depth;
    r.material = material;
  } else if (depth < r.otherNearest) {
    r.other = material;
    r.otherNearest = depth;
  }
}

// How one differs from the other.
struct Split {
  uint first, second; // materials; second 0: there is one alone
  float depth;        // where both have the same material: the second lies beyond it
};

// In sides of the texel, over which depths surfaces of one material are two. Coarser ones are made of those of level 2: .7 has
// half the error of 2 with an ear before a head, at other levels both have the same.
float leastApart(uint level) { return level == 2u ? 0.7 : 2.0; }

Split splitOf(Range r, uint level) {
  if (r.other != 0u) return Split(r.material, r.other, 0.0);
  vec2 side = texelSize(r.material != 0u ? r.nearest : 0.0, level);
  float apart = r.farthest - r.nearest, least = leastApart(level);
  bool two = r.material != 0u && apart * apart > least * least * side.x * side.y;
  return Split(r.material, two ? r.material : 0u, 0.5 * (r.nearest + r.farthest));
}

// Whether something is part of the first or the second. Of three materials and more, all but two are lost.
bool belongs(Split s, bool second, float depth, uint material) {
  uint its = second ? s.second : s.first;
  return its != 0u && material == its && (s.first != s.second || (depth > s.depth) == second);
}

// Sums of clusters times their masses: places from a texel's center in its sides, depths from one that all have, near them.
struct ClusterSums {
  float mass, depth;
  vec3 color;
  vec2 center;
  vec3 momentX, momentY;
};

const ClusterSums kNoSums = ClusterSums(0.0, 0.0, vec3(0.0), vec2(0.0), vec3(0.0), vec3(0.0));

// `mass`: the packed one would be rounded once a level. `place`, `side`: of the texel that it stands for.
void addCluster(inout ClusterSums sums, Cluster c, float mass, float near, vec2 place, float side) {
  vec2 center = place + side * c.center;
  vec3 light = mass * c.color;
  sums.mass += mass;
  sums.depth += mass * (c.depth - near);
  sums.color += light;
  sums.center += mass * center;
  sums.momentX += light * (center.x + side * c.momentX);
  sums.momentY += light * (center.y + side * c.momentY);
}

// `texels`: how many it stands for, that have those masses.
Cluster together(ClusterSums sums, float near, uint material, float texels) {
  Cluster c = kNoCluster;
  if (!(sums.mass > 0.0)) return c;
  float inverse = 1.0 / sums.mass;
  c.color = inverse * sums.color;
  c.mass = sums.mass / texels;
  c.material = material;
  c.depth = near + inverse * sums.depth;
  c.center = inverse * sums.center;
  // Where a channel has no light its moments do not matter.
  vec3 scale = 1.0 / max(sums.color, vec3(1.0e-20));
  c.momentX = scale * sums.momentX - c.center.x;
  c.momentY = scale * sums.momentY - c.center.y;
  return c;
}

#endif
