// How the G-buffer stores normals, materials and depths. PELLUCID_GBUFFER_DECODE of CMake names an engine's own file in place
// of this one; it defines these three functions.
#ifndef PELLUCID_GBUFFER_DECODE_GLSL
#define PELLUCID_GBUFFER_DECODE_GLSL

#include "lib/packing.glsl"
#include "shared/pellucid_shared.h"

// PellucidContextDesc::normalEncoding
layout(constant_id = PELLUCID_CONSTANT_NORMALS) const uint kNormals = PELLUCID_SHADER_NORMALS_SNORM;

// Outward normal from a texel of the normal image; any length > 0. (0, 0, 0): none at this pixel.
vec3 decodeNormal(vec4 texel) {
  if (kNormals == PELLUCID_SHADER_NORMALS_UNORM) return texel.xyz == vec3(0.0) ? vec3(0.0) : 2.0 * texel.xyz - 1.0;
  if (kNormals == PELLUCID_SHADER_NORMALS_OCTAHEDRAL) return fromOctahedral(texel.xy);
  if (kNormals == PELLUCID_SHADER_NORMALS_OCTAHEDRAL_UNORM) return fromOctahedral(2.0 * texel.xy - 1.0);
  return texel.xyz;
}

// The word that options.materialShift and materialMask take the index from; `texel`: of the material image.
uint decodeMaterial(uvec4 texel) { return texel.x; }

// Depth in the encoding of the frame, from the first channel of the front or back depth.
float decodeDepth(float stored) { return stored; }

#endif
