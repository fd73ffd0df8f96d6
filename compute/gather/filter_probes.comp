// Gather probes share what they found with those that lie near on the same side.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_FILTER_GROUP
#include "frame/work_group.glsl"
#include "gather/probe.glsl"
#include "gather/spatial_filter.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_POINTS) uniform utexture2D foundImage;
layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform writeonly uimage2D sharedImage;

uvec4 probeAt(ivec2 cell, ivec4 cells) {
  return contains(cells, cell) ? texelFetch(foundImage, cell, 0) : kNoProbe;
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
  // Cells that no group of probes wrote hold anything, a material beyond the list, too. No pixel reads what becomes of them.
  uint material = own.z & 0xFFu;
  if (shares && material != 0u && material <= frame.flags.y) {
    float mm = frame.camera.range.w;
    own = filtered(local, own, materials[material - 1u].gather.profile.w * mm * mm);
  }
  imageStore(sharedImage, cell, own);
}
