// The pixels of a group's cells whose material light may come through.

// A bit for each pixel of a cell.
shared uint translucent[GROUP_SIDE * GROUP_SIDE];

// Invocations of a cell are apart in z.
uint cellInGroup() { return gl_LocalInvocationID.y * GROUP_SIDE + gl_LocalInvocationID.x; }

// Fills translucent[], which is 0, for all cells of the group. Neighboring invocations read neighboring pixels, so that a cell
// without a material costs one coalesced read a pixel.
void markTranslucent(ivec2 firstCell, int side) {
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
      if (materialIndex(values[i]) != 0u && (values[i] & frame.marks.x) == 0u)
        atomicOr(translucent[cell.y * GROUP_SIDE + cell.x], 1u << (inCell.y * side + inCell.x));
    }
  }
}

// Finds the first translucent pixel of the invocation's cell with a solid's surface: index, material and front of the probe.
// Texels are fetched at once, so that the latencies overlap.
bool findSurface(ivec2 cell, int side, inout Probe probe, out vec4 normal) {
  for (uint bits = translucent[cellInGroup()]; bits != 0u; bits &= bits - 1u) {
    probe.index = findLSB(bits);
    ivec2 pixel = pixelInCell(cell, side, probe.index);
    uint value = materialValueAt(pixel);
    probe.front = frontDistance(pixel);
    normal = texelFetch(normalImage, pixel, 0);
    probe.material = materialIndex(value);
    if (probe.front > 0.0 && !isThinWalled(probe.material)) return true;
  }
  return false;
}
