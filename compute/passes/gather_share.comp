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

shared vec4 places[kRow * kRow];  // position; w: bits of the material, 0: nothing there
shared uvec4 found[kRow * kRow];  // light; w: normal in three bytes
shared uint someLight;            // 0: no point has any

vec3 normalOf(uvec4 bits) { return unpackSnorm4x8(bits.w).xyz; }

uvec4 pointAt(ivec2 cell, ivec4 cells) {
  bool inside = all(greaterThanEqual(cell, cells.xy)) && all(lessThan(cell, cells.zw));
  return inside ? texelFetch(foundImage, cell, 0) : kNoPoint;
}

void keepPoint(ivec2 local, ivec2 cell, int side, uvec4 bits) {
  Point p = unpackPoint(bits);
  int at = (local.y + 1) * kRow + local.x + 1;
  places[at] = vec4(viewPosition(cell, side, p), uintBitsToFloat(p.material));
  found[at] = uvec4(packLight(p.added, p.displaced), packSnorm4x8(vec4(p.normal, 0.0)));
}

// The i-th cell of the border: above, below, then by rows.
ivec2 borderCell(int i) {
  if (i < 2 * kRow) return i < kRow ? ivec2(i - 1, -1) : ivec2(i - kRow - 1, kRow - 2);
  return ivec2((i & 1) * (kRow - 1) - 1, (i - 2 * kRow) >> 1);
}

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 local = ivec2(gl_LocalInvocationID.xy), first = cells.xy + ivec2(gl_WorkGroupID.xy) * PELLUCID_SHARE_GROUP;
  ivec2 cell = first + local, border = borderCell(index);
  bool hasBorder = index < 4 * kRow - 4;
  uvec4 own = pointAt(cell, cells), beside = kNoPoint;
  if (hasBorder) beside = pointAt(first + border, cells);
  if (index == 0) someLight = 0u;
  barrier();
  if (hasLight(own) || hasLight(beside)) someLight = 1u;
  barrier();
  bool shares = someLight != 0u;
  if (shares) {
    keepPoint(local, cell, side, own);
    if (hasBorder) keepPoint(border, first + border, side, beside);
  }
  barrier();
  if (any(greaterThanEqual(cell, cells.zw))) return;
  Point result = unpackPoint(own);
  if (!shares || result.material == 0u) {
    imageStore(sharedImage, cell, own);
    return;
  }
  int center = (local.y + 1) * kRow + local.x + 1;
  vec4 place = places[center];
  float mm = frame.camera.range.w;
  float perSquare = materials[result.material - 1u].gather.profile.w * mm * mm, total = 0.0;
  vec3 normal = normalOf(found[center]), added = vec3(0.0), displaced = vec3(0.0);
  for (int i = 0; i < 9; ++i) {
    int other = center + (i / 3 - 1) * kRow + i % 3 - 1;
    vec4 theirs = places[other];
    if (floatBitsToUint(theirs.w) != result.material) continue;
    uvec4 bits = found[other];
    vec3 apart = theirs.xyz - place.xyz;
    float weight = exp2(-dot(apart, apart) * perSquare) * max(dot(normalOf(bits), normal), 0.0);
    addLight(bits.xyz, weight, added, displaced);
    total += weight;
  }
  // The point itself is among them.
  result.added = added / total;
  result.displaced = displaced / total;
  imageStore(sharedImage, cell, packPoint(result));
}
