// Gather probes: in each cell of 2x2 or 4x4 pixels one gathers, from entry points, what each light brings beyond its diffused
// irradiance. Neighbors take samples of their own, by 25 patterns; filter_probes.comp shares what they find.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_PROBES_GROUP
#include "frame/work_group.glsl"
#include "frame/chord.glsl"
#include "gather/probe.glsl"
#include "gather/entry_point.glsl"
#include "lib/surface.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;
layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_POINTS) uniform utexture2D entriesImage;
layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform uimage2D probesImage;
layout(set = 0, binding = PELLUCID_BINDING_GATHER_DISPATCHES) coherent buffer Dispatches { GatherDispatches dispatches; };

#include "frame/thin_walls.glsl"
layout(local_size_z_id = PELLUCID_CONSTANT_SHARERS) in; // invocations of a cell: they share its lights

#include "gather/translucent_pixels.glsl"
#include "gather/lit_probe.glsl"

// Decides about the dispatches that follow.
void someProbeHasLight() {
  // Read first: atomics of all probes would queue at the same place. Both are 0 in plans that do not go by them.
  if (dispatches.light.x == dispatches.light.w || atomicMax(dispatches.light.x, dispatches.light.w) != 0u) return;
  atomicMax(dispatches.filterProbes.x, dispatches.filterProbes.w);
  atomicMin(dispatches.noLight.x, 0u);
}

void main() {
  int side = int(pass.value.x);
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 firstCell = cells.xy + ivec2(workGroup(PELLUCID_LIST_PROBES)) * GROUP_SIDE;
  ivec2 cell = firstCell + ivec2(gl_LocalInvocationID.xy);
  if (gl_LocalInvocationID.z == 0u) translucent[cellInGroup()] = 0u;
  barrier();
  markTranslucent(firstCell, side);
  barrier();
  bool inside = all(lessThan(cell, cells.zw));
  Probe probe = unpackProbe(kNoProbe);
  vec4 normal;
  bool found = inside && findSurface(cell, side, probe, normal);
  lightProbe(probe, found, cell, side, normal);
  if (gl_LocalInvocationID.z != 0u || !inside) return;
  uvec4 bits = found ? packProbe(probe) : kNoProbe;
  imageStore(probesImage, cell, bits);
  if (hasLight(bits)) someProbeHasLight();
}
