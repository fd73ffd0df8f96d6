// Gather probes share what they found with those that lie near on the same side.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_FILTER_GROUP
#include "frame/work_group.glsl"
#include "gather/probe.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_POINTS) uniform utexture2D foundImage;
layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform writeonly uimage2D sharedImage;

const int kReach = 2; // cells, across and along together
const int kSquare = 2 * kReach + 1, kRow = PELLUCID_FILTER_GROUP + 2 * kReach;
const int kBorder = kRow * kRow - PELLUCID_FILTER_GROUP * PELLUCID_FILTER_GROUP;

shared vec4 places[kRow * kRow];  // position; w: bits of the material, 0: nothing there
shared uvec4 found[kRow * kRow];  // as probes have light; the normal in halves, in place of the probes' own
shared uint someLight, someConvexity;

uvec4 probeAt(ivec2 cell, ivec4 cells) {
  return contains(cells, cell) ? texelFetch(foundImage, cell, 0) : kNoProbe;
}

void keepProbe(ivec2 local, ivec2 cell, int side, uvec4 bits) {
  int at = (local.y + kReach) * kRow + local.x + kReach;
  vec3 normal = normalOf(bits);
  places[at] = vec4(viewPosition(cell, side, unpackProbe(bits)), uintBitsToFloat(bits.z & 0xFFu));
  found[at] = uvec4(bits.x, (bits.y & 0xFFFFu) | packHalf2x16(vec2(0.0, normal.x)), packHalf2x16(normal.yz), bits.w);
}

// The i-th cell of the border: whole rows above and below, then by rows.
ivec2 borderCell(int i) {
  bool whole = i < 2 * kReach * kRow;
  if (!whole) i -= 2 * kReach * kRow;
  int columns = whole ? kRow : 2 * kReach, across = i % columns, along = i / columns;
  int skips = (whole ? along : across) < kReach ? 0 : PELLUCID_FILTER_GROUP;
  return (whole ? ivec2(across, along + skips) : ivec2(across + skips, along + kReach)) - kReach;
}

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 local = ivec2(gl_LocalInvocationID.xy), first = cells.xy + ivec2(workGroup(PELLUCID_LIST_FILTER_PROBES)) * PELLUCID_FILTER_GROUP;
  ivec2 cell = first + local, border = borderCell(index);
  bool hasBorder = index < kBorder;
  uvec4 own = probeAt(cell, cells), beside = kNoProbe;
  if (hasBorder) beside = probeAt(first + border, cells);
  if (index == 0) someLight = someConvexity = 0u;
  barrier();
  if (hasLight(own) || hasLight(beside)) someLight = 1u;
  if (hasConvexity(own) || hasConvexity(beside)) someConvexity = 1u;
  barrier();
  bool shares = someLight != 0u;
  if (shares) {
    keepProbe(local, cell, side, own);
    if (hasBorder) keepProbe(border, first + border, side, beside);
  }
  barrier();
  if (any(greaterThanEqual(cell, cells.zw))) return;
  uint material = own.z & 0xFFu;
  if (!shares || material == 0u) {
    imageStore(sharedImage, cell, own);
    return;
  }
  int center = (local.y + kReach) * kRow + local.x + kReach;
  vec3 place = places[center].xyz, normal = vec3(unpackHalf2x16(found[center].y).y, unpackHalf2x16(found[center].z));
  float mm = frame.camera.range.w;
  float perSquare = materials[material - 1u].gather.profile.w * mm * mm, total = 0.0;
  vec3 added = vec3(0.0), convexity = vec3(0.0);
  [[unroll]] for (int i = 0; i < kSquare * kSquare; ++i) {
    ivec2 away = ivec2(i % kSquare, i / kSquare) - kReach;
    if (abs(away.x) + abs(away.y) > kReach) continue; // known when compiled
    int other = center + away.y * kRow + away.x;
    vec4 theirs = places[other];
    uvec4 bits = found[other];
    vec3 apart = theirs.xyz - place;
    vec2 middle = unpackHalf2x16(bits.y);
    float facing = max(dot(vec3(middle.y, unpackHalf2x16(bits.z)), normal), 0.0);
    // To the fourth: alike on planes, and what surfaces turn over is not evened out.
    facing *= facing;
    float weight = floatBitsToUint(theirs.w) == material ? exp2(-dot(apart, apart) * perSquare) * facing * facing : 0.0;
    added += weight * vec3(unpackHalf2x16(bits.x), middle.x);
    if (someConvexity != 0u) convexity += weight * convexityOf(bits);
    total += weight;
  }
  // The point itself is among them.
  imageStore(sharedImage, cell, replaceLight(own, added / total, convexity / total));
}
