// Probes: in each cell of 1, 2 or 4 pixels a side one gathers, from entry points, what each light brings beyond its diffused
// irradiance. Neighbors take samples of their own, by 25 patterns; filter_probes.comp shares what they find.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_PROBES_GROUP
#include "gather/probe.glsl"
#include "gather/probe_light.glsl"
#include "gather/probe_shape.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PROBES_DESTINATION, rgba32ui) uniform uimage2D probesImage;
layout(local_size_z_id = PELLUCID_CONSTANT_SHARERS) in; // invocations of a cell: they share its lights

const uint kAdds = 1u << 31; // of pass.value.z

// A cell may have two invocations, which pays where it has two lights: half of the probe's chain is left to each.
const bool kShares = gl_WorkGroupSize.z > 1u;
// One tells the other how thin the body is, then light.
shared vec3 told[GROUP_SIDE * GROUP_SIDE];
shared uint materialPixels[GROUP_SIDE * GROUP_SIDE]; // a bit for each pixel of a cell that has a material

// Invocations of a cell are apart in z.
uint cellInGroup() { return gl_LocalInvocationID.y * GROUP_SIDE + gl_LocalInvocationID.x; }

// Fills materialPixels[], which is 0, for all cells of the group. Neighboring invocations read neighboring pixels, so that a cell
// without a material costs one coalesced read a pixel.
void markMaterial(ivec2 firstCell, int side) {
  const int kInvocations = GROUP_SIDE * GROUP_SIDE * int(gl_WorkGroupSize.z);
  int shift = shiftOf(side), columns = GROUP_SIDE * side, rowShift = findMSB(columns), pixels = GROUP_SIDE * GROUP_SIDE * side * side;
  for (int first = int(gl_LocalInvocationIndex); first < pixels; first += 4 * kInvocations) {
    uint values[4];
    // Four loads at once, so that their latencies overlap.
    [[unroll]] for (int i = 0; i < 4; ++i) {
      int at = first + i * kInvocations;
      ivec2 pixel = firstCell * side + ivec2(at & (columns - 1), at >> rowShift);
      values[i] = at < pixels && insideRect(pixel) ? materialValueAt(pixel) : 0u;
    }
    [[unroll]] for (int i = 0; i < 4; ++i) {
      int at = first + i * kInvocations;
      ivec2 inGroup = ivec2(at & (columns - 1), at >> rowShift), cell = inGroup >> shift, inCell = inGroup & (side - 1);
      if (materialIndex(values[i]) != 0u)
        atomicOr(materialPixels[cell.y * GROUP_SIDE + cell.x], 1u << (inCell.y * side + inCell.x));
    }
  }
}

// Finds the first pixel of the invocation's cell with a solid's surface: index, material and front of the probe.
// Texels are fetched at once, so that the latencies overlap.
bool findSurface(ivec2 cell, int side, inout Probe probe, out vec4 normal) {
  for (uint bits = materialPixels[cellInGroup()]; bits != 0u; bits &= bits - 1u) {
    probe.index = findLSB(bits);
    ivec2 pixel = pixelInCell(cell, side, probe.index);
    uint value = materialValueAt(pixel);
    probe.front = frontDistance(pixel);
    normal = texelFetch(normalImage, pixel, 0);
    probe.material = materialIndex(value);
    bool thin = hasFlag(PELLUCID_FLAG_THIN_WALLS) && materials[probe.material - 1u].meta.z != 0u; // a material: not 0
    if (probe.front > 0.0 && !thin) return true;
  }
  return false;
}

// Sets the probe's normal and light, where one was found. `normalTexel`: of the normal image at the probe's pixel. For all
// invocations, as they wait for each other.
void lightProbe(inout Probe probe, bool found, ivec2 cell, int side, vec4 normalTexel) {
  bool first = gl_LocalInvocationID.z == 0u, last = gl_LocalInvocationID.z == gl_WorkGroupSize.z - 1u, shaped = false;
  uint m = probe.material - 1u;
  vec3 loss = vec3(0.0);
  Surface x;
  if (found) {
    ivec2 pixel = pixelInCell(cell, side, probe.index);
    ViewRay ray = viewRay(frame.camera, pixel);
    vec3 normal = vec3(0.0);
    if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
    x = makeSurface(ray, probe.front, -1.0, normal);
    probe.normal = x.hasNormal ? x.normal : -x.view;
    shaped = x.hasNormal;
    if (shaped && first) probe.convexity = convexityAt(pixel, x, ray, probe.front, m);
    if (shaped && last) loss = thinLoss(pixel, x, m);
  }
  if (kShares) {
    if (last) told[cellInGroup()] = loss;
    barrier();
    loss = told[cellInGroup()];
    barrier();
  }
  if (found) {
    Pattern pattern = patternOf(cell, m, probe.front);
    for (uint i = gl_LocalInvocationID.z; i < pass.value.y; i += gl_WorkGroupSize.z) {
      LightConstants light = lights[i];
      probe.added += light.radiance.rgb * gatherLight(m, light, x, pattern, loss);
    }
  }
  if (kShares) {
    if (last) told[cellInGroup()] = probe.added;
    barrier();
    if (first) probe.added += told[cellInGroup()];
  }
  if (found && first && (pass.value.z & kAdds) != 0u) probe.added += addedOf(imageLoad(probesImage, cell));
}

// Makes the probes of the cells from `firstCell` on, for all invocations, as they wait for each other.
void makeProbes(ivec2 firstCell, int side) {
  ivec2 cell = firstCell + ivec2(gl_LocalInvocationID.xy);
  if (gl_LocalInvocationID.z == 0u) materialPixels[cellInGroup()] = 0u;
  barrier();
  markMaterial(firstCell, side);
  barrier();
  bool inside = contains(cellsOf(frame.rect, side), cell);
  Probe probe = unpackProbe(kNoProbe);
  vec4 normal;
  bool found = inside && findSurface(cell, side, probe, normal);
  lightProbe(probe, found, cell, side, normal);
  if (gl_LocalInvocationID.z == 0u && inside) imageStore(probesImage, cell, found ? packProbe(probe) : kNoProbe);
}

void main() {
  int side = int(pass.value.x);
  ivec2 first;
  if (materialPart(ivec2(side * PELLUCID_PROBES_GROUP), first)) makeProbes(first / side, side);
}
