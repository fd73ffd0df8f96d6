// Entry points of light: the facts of a texel of a shadow map that a sample needs, made once for all pixels.
#ifndef PELLUCID_ENTRY_POINT_GLSL
#define PELLUCID_ENTRY_POINT_GLSL

#include "frame/frame.glsl"
#include "frame/light_tables.glsl"
#include "lib/packing.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(set = 0, binding = PELLUCID_BINDING_GATHER_MAPS) uniform GatherMaps {
  GatherMapConstants maps[PELLUCID_DISPATCH_SHADOWS];
};

struct EntryPoint {
  float depth;  // of the lit surface, see GatherMapConstants::depth
  vec3 normal;  // unit; of the map towards the light, of a pixel up to 30 degrees away from it
  float hidden; // part of the light that enters where the camera does not see it
  float seen;   // part that enters where the camera does, and is in the irradiance
  float cosine; // between normal and light, above 0; not held to kLeastCosine
  float exit;   // scene units along the light from the surface to the nearest back face behind it; kNoExit: not known
  uint material; // index + 1 of what light enters; 0: not known
  bool opaque;   // light enters no medium there, or a clamped depth does not say where
};

// Least cosine at which a surface counts: a sample that stands for more than five times its own area shows as a dot at
// terminators. Measured: procedural shells and balls of skin, rings of marble.
const float kLeastCosine = 0.2;

const float kNoExit = 6.0e4; // fits in a half
const uvec4 kNoEntry = uvec4(0u);
const uint kOpaqueBit = 0x80000000u; // the sign of the exit, which is not below 0

uvec4 packEntry(EntryPoint r) {
  uint cosine = uint(clamp(r.cosine * 255.0 + 0.5, 1.0, 255.0));
  return uvec4(floatBitsToUint(r.depth), packSnorm2x16(octahedral(r.normal)), packHalf2x16(vec2(r.hidden, r.seen)),
               cosine | r.material << 8 | packHalf2x16(vec2(min(r.exit, kNoExit), 0.0)) << 16 | (r.opaque ? kOpaqueBit : 0u));
}

bool holdsSurface(uvec4 bits) { return (bits.w & 0xFFu) != 0u; }
bool isOpaque(uvec4 bits) { return (bits.w & kOpaqueBit) != 0u; }
bool lightEnters(uvec4 bits) { return bits.z != 0u; }

EntryPoint unpackEntry(uvec4 bits) {
  vec2 parts = unpackHalf2x16(bits.z);
  return EntryPoint(uintBitsToFloat(bits.x), fromOctahedral(unpackSnorm2x16(bits.y)), parts.x, parts.y,
                    float(bits.w & 0xFFu) / 255.0, unpackHalf2x16((bits.w & ~kOpaqueBit) >> 16).x, bits.w >> 8 & 0xFFu,
                    isOpaque(bits));
}

#endif
