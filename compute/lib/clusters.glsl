// Clusters: what stands for all that lies under a texel of a level where edges are summed (Barnes and Hut 1986, on a grid). One
// has the mean color, the center of the area and the first moments of the light around it, exact to the order of the side
// over the distance.
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
  c.color = unpackColor(u.xy);
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

// The center of child `i` of a cluster from the cluster's, in the cluster's sides.
vec2 placeInParent(int i, vec2 center) { return 0.5 * (vec2(i & 1, i >> 1) - 0.5 + center); }

// How far behind the nearest one, in sides of the merged cluster, what belongs to it may lie: surfaces 85 degrees from facing
// the camera do. Smaller limits lose light at the limbs of round things, larger ones join what lies far behind others.
float clusterReach(uint level) { return level == 1u ? 12.0 : 16.0; }

// The nearest of four: what belongs to it has its material and lies not far behind it.
struct Nearest {
  float depth;   // 0 where there is none
  uint material; // the same
  float reach;
};

// `material`: 0 where there is none.
Nearest nearestOf(float depth[4], uint material[4], uint level) {
  Nearest n = Nearest(kNoDepth, 0u, 0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    bool nearer = material[i] != 0u && depth[i] < n.depth;
    n.depth = nearer ? depth[i] : n.depth;
    n.material = nearer ? material[i] : n.material;
  }
  n.depth = n.material != 0u ? n.depth : 0.0;
  vec2 side = texelSize(n.depth, level);
  n.reach = clusterReach(level) * sqrt(side.x * side.y);
  return n;
}

bool belongs(Nearest n, float depth, uint material) {
  return n.material != 0u && material == n.material && depth - n.depth <= n.reach;
}

// Four packed ones of a level, rows first, as one of level `level`. `mass`: theirs, 0 where there is none, which would be rounded
// once a level if it were taken from the packed ones.
Cluster merged(uvec4 from[4], float mass[4], uint level) {
  float depths[4];
  uint materials[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    depths[i] = clusterDepth(from[i]);
    materials[i] = mass[i] > 0.0 ? materialBits(from[i]) : 0u;
  }
  Nearest nearest = nearestOf(depths, materials, level);
  Cluster c = kNoCluster;
  if (nearest.material == 0u) return c;
  c.material = nearest.material;
  float masses[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    Cluster f = unpackCluster(from[i]);
    bool counts = belongs(nearest, f.depth, materials[i]);
    masses[i] = counts ? mass[i] : 0.0;
    c.mass += masses[i];
    c.color += masses[i] * f.color;
    c.depth += counts ? masses[i] * (f.depth - nearest.depth) : 0.0;
    c.center += masses[i] * placeInParent(i, f.center);
  }
  // The nearest one counts, so the mass is positive.
  float inverse = 1.0 / c.mass;
  c.color *= inverse;
  c.depth = nearest.depth + c.depth * inverse;
  c.center *= inverse;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    Cluster f = unpackCluster(from[i]);
    vec3 light = masses[i] * f.color;
    vec2 place = placeInParent(i, f.center) - c.center;
    c.momentX += light * (place.x + 0.5 * f.momentX);
    c.momentY += light * (place.y + 0.5 * f.momentY);
  }
  // Where a channel has no light its moments do not matter.
  vec3 scale = inverse / max(c.color, vec3(1.0e-20));
  c.momentX *= scale;
  c.momentY *= scale;
  c.mass *= 0.25;
  return c;
}

#endif
