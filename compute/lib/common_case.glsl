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

#endif
