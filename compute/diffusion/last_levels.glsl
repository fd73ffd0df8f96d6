// Levels 6 and 7 of the pyramid. The upsampling groups that need them make them.

#include "diffusion/downsampled.glsl"

// Part of all energy. A plane of 84 pixels' radius has as much beyond level 5; plans that know radii begin to use level 6
// there.
const float kLeastBeyondMade = 0.003;

// True where a texel of level 5 has energy at coarser levels. In plans that do not know how large radii are, most texels have
// next to none.
bool reachesBeyond(ivec2 texel, uvec4 bits) {
  if (!hasSurface(bits)) return false;
  uint m = materialBits(bits) - 1u;
  Foreshortening f = foreshortening(texel, 5u, uintBitsToFloat(bits.z), unpackHalf2x16(bits.w));
  vec3 beyond = vec3(1.0);
  [[unroll]] for (uint level = 2u; level <= 5u; ++level)
    beyond *= coarserShare(m, level, shareEntry(m, f.lengthMm * exp2(float(level) - 5.0)));
  return any(greaterThan(beyond, vec3(kLeastBeyondMade)));
}

// Makes levels 6 and 7 where windows of group k are. For all invocations, as they wait for each other.
void makeLevels(ivec2 k, int invocation) {
  ivec2 first7 = firstMade(7u, k), first6 = firstMade(6u, k), first5 = 2 * first6 - 1;
  for (int i = invocation; i < kSide5 * kSide5; i += PELLUCID_UPSAMPLE_GROUP * PELLUCID_UPSAMPLE_GROUP) {
    ivec2 at = ivec2(i % kSide5, i / kSide5), texel = first5 + at;
    keepTexel(slot(at, kSide5), contains(levelRect(5u), texel) ? storedTexel(5u, texel) : uvec4(0u));
  }
  barrier();
  // One reduction in a loop takes fewer registers than two in a row.
  for (uint finer = 5u; finer < 7u; ++finer) {
    bool isFirst = finer == 5u;
    int side = isFirst ? kSide6 : 3, width = isFirst ? kSide5 : kSide6;
    ivec2 at = ivec2(invocation % side, invocation / side), texel = (isFirst ? first6 : first7) + at;
    bool makes = at.y < side && contains(levelRect(finer + 1u), texel);
    uvec4 bits = makes ? downsampled(finer, texel, 2 * at.y * width + at.x, width, taps()) : uvec4(0u);
    barrier();
    if (at.y < side) {
      upsampled[(isFirst ? kMade : kMade + kSide6 * kSide6) + invocation] = bits;
      if (isFirst) keepTexel(slot(at, side), bits);
    }
    barrier();
  }
}
