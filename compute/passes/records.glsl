// Records of the gather: what a sample needs to know of a texel of a shadow map, made once for all pixels.
#ifndef PELLUCID_RECORDS_GLSL
#define PELLUCID_RECORDS_GLSL

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(set = 0, binding = PELLUCID_BINDING_GATHER_MAPS) uniform GatherMaps { GatherMapConstants maps[PELLUCID_DISPATCH_SHADOWS]; };

struct Record {
  float depth;         // of the lit surface, see GatherMapConstants::depth
  vec3 normal;         // towards the light
  float enters;        // which part of the light gets there and is in no irradiance; 0: seen by the camera
  float inverseCosine; // between normal and light
};

const uvec4 kNoRecord = uvec4(0u);

// Beside the records lie their summaries, one for each square of this side: whether light enters anywhere in it.
const int kSummarySide = PELLUCID_RECORDS_GROUP;

uvec4 packRecord(Record r) {
  return uvec4(floatBitsToUint(r.depth), packHalf2x16(r.normal.xy), packHalf2x16(vec2(r.normal.z, r.enters)),
               packHalf2x16(vec2(r.inverseCosine, 1.0)));
}

bool holdsSurface(uvec4 bits) { return bits.w != 0u; }

bool lightEnters(uvec4 bits) { return bits.z >> 16 != 0u; }

Record unpackRecord(uvec4 bits) {
  vec2 xy = unpackHalf2x16(bits.y), rest = unpackHalf2x16(bits.z);
  return Record(uintBitsToFloat(bits.x), vec3(xy, rest.x), rest.y, unpackHalf2x16(bits.w).x);
}

#endif
