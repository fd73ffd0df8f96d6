// How the G-buffer stores materials and depths. PELLUCID_GBUFFER_DECODE of CMake names an engine's own file in place of this one;
// it defines these two functions.
#ifndef PELLUCID_GBUFFER_DECODE_GLSL
#define PELLUCID_GBUFFER_DECODE_GLSL

// The word that options.materialShift and materialMask take the index from; `texel`: of the material image.
uint decodeMaterial(uvec4 texel) { return texel.x; }

// Depth in the encoding of the frame, from the first channel of the front or back depth. Thicknesses (mm) do not pass through here.
float decodeDepth(float stored) { return stored; }

#endif
