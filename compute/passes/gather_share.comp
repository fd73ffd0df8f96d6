// Points of the gather share what they found with those that lie near on the same side.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_SHARE_GROUP
#include "passes/bindings.glsl"
#include "passes/points.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_RECORDS) uniform utexture2D foundImage;
layout(set = 0, binding = PELLUCID_BINDING_POINTS, rgba32ui) uniform writeonly uimage2D sharedImage;

const int kRow = PELLUCID_SHARE_GROUP + 2; // a border of one
const int kThreads = PELLUCID_SHARE_GROUP * PELLUCID_SHARE_GROUP;

shared vec4 places[kRow * kRow];  // position; w: bits of the material, 0: nothing there
shared uvec4 found[kRow * kRow];  // light; w: normal in three bytes

vec3 normalOf(uvec4 bits) { return unpackSnorm4x8(bits.w).xyz; }

void main() {
  int side = int(pass.value.x);
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 group = cells.xy + ivec2(gl_WorkGroupID.xy) * PELLUCID_SHARE_GROUP;
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  ivec2 cell = group + local;
  for (int i = int(gl_LocalInvocationIndex); i < kRow * kRow; i += kThreads) {
    ivec2 at = group + ivec2(i % kRow, i / kRow) - 1;
    bool inside = all(greaterThanEqual(at, cells.xy)) && all(lessThan(at, cells.zw));
    Point p = unpackPoint(inside ? texelFetch(foundImage, at, 0) : kNoPoint);
    places[i] = vec4(viewPosition(at, side, p), uintBitsToFloat(p.material));
    found[i] = uvec4(packLight(p.added, p.displaced), packSnorm4x8(vec4(p.normal, 0.0)));
  }
  barrier();
  if (any(greaterThanEqual(cell, cells.zw))) return;
  int center = (local.y + 1) * kRow + local.x + 1;
  vec4 place = places[center];
  uint material = floatBitsToUint(place.w);
  if (material == 0u) {
    imageStore(sharedImage, cell, kNoPoint);
    return;
  }
  float mm = frame.camera.range.w;
  float perSquare = materials[material - 1u].gather.profile.w * mm * mm, total = 0.0;
  vec3 normal = normalOf(found[center]), added = vec3(0.0), displaced = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    int other = center + (i / 3 - 1) * kRow + i % 3 - 1;
    vec4 theirs = places[other];
    if (floatBitsToUint(theirs.w) != material) continue;
    uvec4 bits = found[other];
    vec3 apart = theirs.xyz - place.xyz;
    float weight = exp2(-dot(apart, apart) * perSquare) * max(dot(normalOf(bits), normal), 0.0);
    addLight(bits.xyz, weight, added, displaced);
    total += weight;
  }
  // The point itself is among them.
  Point own = unpackPoint(texelFetch(foundImage, cell, 0));
  own.added = added / total;
  own.displaced = displaced / total;
  imageStore(sharedImage, cell, packPoint(own));
}
