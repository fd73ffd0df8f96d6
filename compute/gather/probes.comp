// Gather probes: in each cell of 2x2 or 4x4 pixels one gathers, from entry probes, what each light brings beyond its diffused
// irradiance. Neighbors take samples of their own, by thirteen patterns; filter_probes.comp shares what they find.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_PROBES_GROUP
#include "frame/work_group.glsl"
#include "frame/chord.glsl"
#include "gather/probe.glsl"
#include "gather/entry_point.glsl"
#include "lib/light.glsl"
#include "lib/surface.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;
layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_POINTS) uniform utexture2D entriesImage;
layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform uimage2D probesImage;
layout(set = 0, binding = PELLUCID_BINDING_GATHER_DISPATCHES) coherent buffer Dispatches { GatherDispatches dispatches; };

#include "lib/gather.glsl"
#include "gather/probe_light.glsl"
#include "gather/probe_shape.glsl"

const uint kAdds = 1u << 31; // of pass.value.z

// A bit for each pixel of a cell whose material light may come through.
shared uint translucent[GROUP_SIDE * GROUP_SIDE];

// Fills translucent[] for all cells of the group. Neighboring invocations read neighboring pixels, so that a cell without a
// material costs one coalesced read a pixel.
void findTranslucent(ivec2 firstCell, int side) {
  const int kCells = GROUP_SIDE * GROUP_SIDE;
  int shift = shiftOf(side), columns = GROUP_SIDE * side, rowShift = findMSB(columns), pixels = kCells * side * side;
  translucent[gl_LocalInvocationIndex] = 0u;
  barrier();
  for (int first = int(gl_LocalInvocationIndex); first < pixels; first += 4 * kCells) {
    uint values[4];
    // Four at once, so that their latencies overlap.
    [[unroll]] for (int i = 0; i < 4; ++i) {
      int at = first + i * kCells;
      ivec2 pixel = firstCell * side + ivec2(at & (columns - 1), at >> rowShift);
      values[i] = at < pixels && insideRect(pixel) ? materialValueAt(pixel) : 0u;
    }
    [[unroll]] for (int i = 0; i < 4; ++i) {
      int at = first + i * kCells;
      ivec2 inGroup = ivec2(at & (columns - 1), at >> rowShift), cell = inGroup >> shift, inCell = inGroup & (side - 1);
      if (materialIndex(values[i]) != 0u && (values[i] & frame.marks.x) == 0u)
        atomicOr(translucent[cell.y * GROUP_SIDE + cell.x], 1u << (inCell.y * side + inCell.x));
    }
  }
  barrier();
}

// The first of these pixels with a surface. Its texels are fetched at once, so that the latencies overlap.
bool pixelOf(ivec2 cell, int side, out int index, out uint material, out float front, out vec4 normal) {
  index = 0;
  for (uint bits = translucent[gl_LocalInvocationIndex]; bits != 0u; bits &= bits - 1u) {
    index = findLSB(bits);
    ivec2 pixel = pixelInCell(cell, side, index);
    uint value = materialValueAt(pixel);
    front = frontDistance(pixel);
    normal = texelFetch(normalImage, pixel, 0);
    material = materialIndex(value);
    if (front > 0.0) return true;
  }
  return false;
}

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
  bool inside = all(lessThan(cell, cells.zw));
  findTranslucent(firstCell, side);
  Probe result = unpackProbe(kNoProbe);
  vec4 normalTexel;
  bool some = inside && pixelOf(cell, side, result.index, result.material, result.front, normalTexel);
  ivec2 pixel = pixelInCell(cell, side, result.index);
  ViewRay ray = viewRay(frame.camera, pixel);
  Surface x;
  if (some) {
    vec3 normal = vec3(0.0);
    if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
    x = makeSurface(ray, result.front, -1.0, normal);
    result.normal = x.hasNormal ? x.normal : -x.view;
  }
  if (some) {
    uint m = result.material - 1u;
    vec3 loss = vec3(0.0);
    if (x.hasNormal && hasFlag(PELLUCID_FLAG_DIFFUSED)) {
      result.convexity = convexityAt(pixel, x, ray, result.front, m);
      loss = thinLoss(pixel, x, m);
    }
    Pattern pattern = patternOf(cell, m, result.front);
    for (uint i = 0u; i < pass.value.y; ++i) {
      LightConstants light = lights[i];
      if (kDirectional) light.meta.xz = uvec2(PELLUCID_SHADER_LIGHT_DIRECTIONAL, 1u);
      result.added += light.radiance.rgb * gatherLight(m, light, x, pattern, loss);
    }
    if ((pass.value.z & kAdds) != 0u) result.added += addedOf(imageLoad(probesImage, cell));
  }
  uvec4 bits = some ? packProbe(result) : kNoProbe;
  if (inside) imageStore(probesImage, cell, bits);
  if (hasLight(bits)) someProbeHasLight();
}
