// Finds the cells of 8 x 8 pixels with material and how far away their surfaces are, a block a group.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_FIND_GROUP
#include "tiles/tile_commands.glsl"

const int kAcross = PELLUCID_BLOCK / PELLUCID_FIND_GROUP, kPixels = kAcross * kAcross; // of an invocation

// The invocation's i-th pixel of the block.
ivec2 pixelInBlock(int i) { return ivec2(gl_LocalInvocationID.xy) + PELLUCID_FIND_GROUP * ivec2(i % kAcross, i / kAcross); }

shared uint cells[2]; // bits of rows 0 to 3 and 4 to 7
shared uint nearest, farthest; // bits of planar distances, which are above 0

void main() {
  uint invocation = gl_LocalInvocationIndex;
  uvec2 block = gl_WorkGroupID.xy;
  ivec2 first = firstBlockPixel() + PELLUCID_BLOCK * ivec2(block);
  uint values[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = first + pixelInBlock(i);
    values[i] = insideRect(pixel) ? materialIndex(materialValueAt(pixel)) : 0u;
  }
  if (invocation < 2u) cells[invocation] = 0u;
  if (invocation == 0u) {
    nearest = floatBitsToUint(kNoDepth);
    farthest = 0u;
  }
  barrier();
  uint own[2] = uint[2](0u, 0u), any = 0u;
  float least = kNoDepth, most = 0.0, stored[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) any |= values[i];
  // All loads come before the first use.
  if (any != 0u && pass.value.x != 0u)
    [[unroll]] for (int i = 0; i < kPixels; ++i)
      stored[i] = texelFetch(frontDepthImage, withinRect(first + pixelInBlock(i)), 0).x;
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    if (values[i] == 0u) continue;
    own[i / (kPixels / 2)] |= bitOfCell(cellOfPixel(pixelInBlock(i)));
    float front = pass.value.x != 0u ? frontDistanceOf(stored[i]) : -1.0;
    if (!(front > 0.0)) continue;
    least = min(least, front);
    most = max(most, front);
  }
  // Read first: most invocations have nothing to add. An old value costs an atomic more and changes nothing.
  for (int i = 0; i < 2; ++i)
    if ((own[i] & ~cells[i]) != 0u) atomicOr(cells[i], own[i]);
  if (most > 0.0) {
    if (floatBitsToUint(least) < nearest) atomicMin(nearest, floatBitsToUint(least));
    if (floatBitsToUint(most) > farthest) atomicMax(farthest, floatBitsToUint(most));
  }
  barrier();
  uint word = blockWord(block);
  if (invocation < 2u) writeTileWord(word + invocation, cells[invocation]);
  if (invocation == 2u) writeTileWord(word + 2u, nearest);
  if (invocation == 3u) writeTileWord(word + 3u, farthest);
  if (block == uvec2(0u)) clearLists(invocation, uint(GROUP_SIDE * GROUP_SIDE));
}
