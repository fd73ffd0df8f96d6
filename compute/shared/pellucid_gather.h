// Constants of the gather, for C++ and GLSL; pellucid_shared.h includes this file.
#ifndef PELLUCID_GATHER_H
#define PELLUCID_GATHER_H

#ifdef __cplusplus
namespace pellucid::shared {
#endif

// A probe shares with cells up to this far away, across and along together. These diamonds tile the plane, and each cell of one has a
// pattern of its own.
#define PELLUCID_SHARE_REACH 5
#define PELLUCID_PATTERNS 61       // cells of a diamond, 2 reach (reach + 1) + 1
#define PELLUCID_PATTERNS_A_ROW 11 // 2 reach + 1

// Constants of the light-space gather; see gather/probe_light.glsl. rgb: per channel.
struct GatherConstants {
  vec4 lengths; // mm; x: shortest; y: log2(longest / shortest); z: largest distance looked for, 2 / kappa; w: depth scale
  vec4 profile; // rgb: 1/(3 d) of Burley's profile, 0: none, 1/mm; w: of the spatial filter between probes, 1/mm^2
  vec4 body;    // x: how far to both sides of a probe its curvature is measured, mm; 0: nothing is diffused
  // A slab of thickness h sends back R(h) = x - sqrt(y T(h)^2 + z) of a half-space's light, x, y, z of each channel.
  vec4 reflectance[3];
  vec4 entries[3 * PELLUCID_GATHER_ENTRIES]; // see gatherSlab
  // Factors of a ball of diameter h, as halves: rgb of its diffused irradiance beyond a slab's R(h) / rho, rgb of what comes through
  // it beyond 1. w: in bytes, rgb of the diffused irradiance that takes the place of what comes through no more.
  uvec4 ball[PELLUCID_GATHER_ENTRIES];
};

// Places and depths of a map's entry points (compute/gather/entry_point.glsl), from a view-space point (x, 1):
struct GatherMapConstants {
  vec4 column, row; // in entry points from the map's first one; perspective: times depth
  vec4 depth;       // what entry points store. Directional: scene units towards the light; perspective: clip w
  ivec4 place;      // x, y: of the first entry in the image; z, w: how many
  vec4 stepX, stepY; // from an entry point to the next, scene units; perspective: times depth. stepX.w: 1 perspective
};

// The surface that a map stores, by its texel coordinates p. Affine in p:
struct EntryMapConstants {
  vec4 origin, stepX, stepY; // xyz: directional: a point of the light's ray; perspective: its direction, of clip w 1.
                             // w: of depth, see ray
  vec4 ray;    // xyz: directional: towards the light, scene units; perspective: the light. w, directional: depth is
               // stored w + affine; perspective: w / (stored - affine), or stored / affine where planar
  uvec4 meta;  // as ShadowConstants::meta
  uvec4 map;   // x, y: texels; z: how many a side for one entry; w: the light, of lights[]
  vec4 seen;   // x: how far behind what the camera sees a point may lie, scene units; perspective: per depth
  vec4 offsets; // as ShadowConstants::offsets
  vec4 toLight; // xyz: directional: unit
  uvec4 occluder; // as ShadowConstants::occluder
};

#ifdef __cplusplus
} // namespace pellucid::shared
#endif
#endif
