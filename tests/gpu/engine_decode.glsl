// An engine's own G-buffer: normals point inwards and lie in BGR, materials count down from 255, and view z is negative.
#ifndef PELLUCID_GBUFFER_DECODE_GLSL
#define PELLUCID_GBUFFER_DECODE_GLSL

vec3 decodeNormal(vec4 texel) { return -texel.bgr; }

uint decodeMaterial(uvec4 texel) { return 255u - texel.x; }

float decodeDepth(float stored) { return -stored; }

#endif
