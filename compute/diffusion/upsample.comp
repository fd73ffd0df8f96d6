// Computes R_l = (1 - s) E_l + s R_(l+1), s the coarser levels' share of the profile, from the coarsest level of the pyramid
// to level 2, and the shares of level 2's pixels. A group makes 32 x 16 texels of level 2 and, before them, what they need of
// each coarser level. It makes levels 6 and 7 itself, so that no dispatch of few texels holds up the others.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_UPSAMPLE_GROUP
#include "diffusion/upsampled.glsl"
#include "diffusion/level_filter.glsl"
#include "diffusion/last_levels.glsl"
#include "diffusion/level_2.glsl"

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint coarsest = pass.value.x;
  // An invocation does two texels of level 2 and, before them, one of levels 3 to 6. The first ones have level 7, too.
  ivec2 k = (((levelRect(2u).xy + 1) >> ivec2(5, 4)) + ivec2(workGroup(PELLUCID_LIST_UPSAMPLE))) * ivec2(2, 1);
  ivec2 fine = 16 * k - 1 + ivec2(gl_LocalInvocationID.xy), nextFine = fine + ivec2(PELLUCID_UPSAMPLE_GROUP, 0);
  uint level = 3u + uint(invocation >= 153) + uint(invocation >= 213) + uint(invocation >= 237);
  Window window = windowOf(level, k), last = windowOf(7u, k);
  bool within = invocation < last.first, hasLast = last.first + invocation < kUpsampled;
  ivec2 texel = texelOf(window, invocation - window.first), lastTexel = texelOf(last, invocation);
  bool inside = level <= coarsest && within && contains(levelRect(level), texel);
  bool lastInside = coarsest == 7u && hasLast && contains(levelRect(7u), lastTexel);
  if (invocation == 0) needsMade = 0u;
  // All loads come before the first use.
  uvec4 bits = inside && level <= 5u ? writtenTexel(level, texel) : uvec4(0u), lastBits = uvec4(0u);
  uvec4 fineBits = contains(levelRect(2u), fine) ? writtenTexel(2u, fine) : uvec4(0u);
  uvec4 nextBits = contains(levelRect(2u), nextFine) ? writtenTexel(2u, nextFine) : uvec4(0u);
  barrier();
  if (coarsest == 7u && level == 5u && reachesBeyond(texel, bits)) needsMade = 1u; // whoever writes, writes this
  barrier();
  // One value for all invocations, as the barriers within need: none writes it after the last barrier.
  if (needsMade != 0u) {
    makeLevels(k, invocation);
    if (inside && level == 6u) bits = texelAt(6u, texel, k);
    if (lastInside) lastBits = texelAt(7u, lastTexel, k);
  } else {
    coarsest = min(coarsest, 5u);
  }
  Foreshortening unused;
  if (coarsest == 7u && hasLast) {
    Own own = ownPart(7u, lastTexel, k, lastBits, unused);
    upsampled[last.first + invocation] = own.texel.area > 0.0 ? packLevel(alone(own), lastBits) : uvec4(0u);
  }
  Own own = ownPart(level, texel, k, bits, unused);
  for (uint l = min(coarsest, 6u); l > 2u; --l) {
    barrier();
    if (level == l && within) {
      Level r = l == coarsest ? alone(own) : withCoarser(own, level, texel, windowOf(level + 1u, k));
      upsampled[invocation] = own.texel.area > 0.0 ? packLevel(r, bits) : uvec4(0u);
    }
  }
  barrier();
  // The loop runs once for each texel of level 2: both in a row are a third more code and no faster.
  for (int i = 0; i < 2; ++i) {
    upsampleFine(fine, k, fineBits);
    fine = nextFine;
    fineBits = nextBits;
  }
}
