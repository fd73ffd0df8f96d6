// What a shader may take for granted, so that the compiler drops the rest.
#ifndef PELLUCID_COMMON_CASE_GLSL
#define PELLUCID_COMMON_CASE_GLSL

// DIRECTIONAL: every light of the gather is directional with one shadow map, of device depth; thickness is light-space,
// front depth is device depth, normals are given and stand for the angle, and all materials are EXP2.
#ifdef DIRECTIONAL
const bool kDirectional = true;
#else
const bool kDirectional = false;
#endif

// GATHER: lights with a shadow map are gathered from, and the pass does the others.
#ifdef GATHER
const bool kUnmapped = true;
#else
const bool kUnmapped = false;
#endif

// SUMS_EDGES: pixels of edges have a dispatch of their own, which sums over clusters, and planes one with two fine filters.
#ifdef SUMS_EDGES
const bool kSumsEdges = true;
#else
const bool kSumsEdges = false;
#endif

// SUMS_FAST: those are summed over the pyramid, with less to do for each, beside its resolve, and planes are as without it.
#ifdef SUMS_FAST
const bool kSumsFast = true;
#else
const bool kSumsFast = false;
#endif

#endif
