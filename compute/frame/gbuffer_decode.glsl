// The one file an engine replaces for its own normal and material encoding.
#ifndef PELLUCID_GBUFFER_DECODE_GLSL
#define PELLUCID_GBUFFER_DECODE_GLSL

// Outward normal from a texel of the normal image; any length > 0. (0, 0, 0): none at this pixel.
vec3 decodeNormal(vec4 texel) { return texel.xyz; }

// Material index from a texel of the material image; 0: none.
uint decodeMaterial(uvec4 texel) { return texel.x; }

#endif
