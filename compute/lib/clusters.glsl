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

// As texels of the pyramid; in the last 8 bits of the depth the center in sixteenths, in place of the slope the moments.
uvec4 packCluster(Cluster c) {
  uvec2 center = uvec2(clamp(floor(c.center * 16.0 + 8.5), vec2(0.0), vec2(15.0)));
  return uvec4(packColor(c.color, packArea(c.mass) | c.material << 8),
               ((floatBitsToUint(c.depth) + 0x80u) & ~0xFFu) | center.x | center.y << 4,
               packMoments(c.momentX) | packMoments(c.momentY) << 15);
}

Cluster unpackCluster(uvec4 u) {
  Cluster c;
  c.color = unpackColor(u.xy);
  c.mass = massOf(u.y);
  c.material = materialBits(u);
  c.depth = uintBitsToFloat(u.z & ~0xFFu);
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

// How far behind the nearest one, in sides of the merged cluster, what belongs to it may lie: surfaces 85 degrees from facing
// the camera do. Smaller limits lose light at the limbs of round things, larger ones join what lies far behind others.
const float kClusterReach = 12.0;

// Four of a level, rows first, as one of level `level`: of the nearest one's material, those that lie not far behind it.
Cluster merged(Cluster from[4], uint level) {
  Cluster c = kNoCluster;
  float nearest = kNoDepth;
  for (int i = 0; i < 4; ++i) {
    bool nearer = from[i].mass > 0.0 && from[i].depth < nearest;
    nearest = nearer ? from[i].depth : nearest;
    c.material = nearer ? from[i].material : c.material;
  }
  if (c.material == 0u) return c;
  vec2 side = texelSize(nearest, level);
  float reach = kClusterReach * sqrt(side.x * side.y);
  vec2 place[4];
  float masses[4];
  for (int i = 0; i < 4; ++i) {
    bool counts = from[i].mass > 0.0 && from[i].material == c.material && from[i].depth - nearest <= reach;
    masses[i] = counts ? from[i].mass : 0.0;
    place[i] = 0.5 * (vec2(i & 1, i >> 1) - 0.5 + from[i].center);
    c.mass += masses[i];
    c.color += masses[i] * from[i].color;
    c.depth += counts ? masses[i] * (from[i].depth - nearest) : 0.0;
    c.center += masses[i] * place[i];
  }
  // The nearest one counts, so the mass is positive.
  float inverse = 1.0 / c.mass;
  c.color *= inverse;
  c.depth = nearest + c.depth * inverse;
  c.center *= inverse;
  for (int i = 0; i < 4; ++i) {
    vec3 light = masses[i] * from[i].color;
    c.momentX += light * (place[i].x - c.center.x + 0.5 * from[i].momentX);
    c.momentY += light * (place[i].y - c.center.y + 0.5 * from[i].momentY);
  }
  // Where a channel has no light its moments do not matter.
  vec3 scale = inverse / max(c.color, vec3(1.0e-20));
  c.momentX *= scale;
  c.momentY *= scale;
  c.mass *= 0.25;
  return c;
}

#endif
