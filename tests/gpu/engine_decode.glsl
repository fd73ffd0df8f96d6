// An engine's own G-buffer: materials count down from 255, and view z is negative.
#ifndef PELLUCID_GBUFFER_DECODE_GLSL
#define PELLUCID_GBUFFER_DECODE_GLSL

uint decodeMaterial(uvec4 texel) { return 255u - texel.x; }

float decodeDepth(float stored) { return -stored; }

#endif
