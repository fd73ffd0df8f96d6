// R_l = (1 - s) E_l + s R_(l+1) from the coarsest level of the pyramid to level 2, s the profile's share of the coarser
// levels at the texel, and the shares of the pixels under level 2. A group makes 32 x 16 texels of level 2 and, before
// them, as much of each coarser level as they need. It makes levels 6 and 7 itself, from level 5, so that no dispatch of few
// texels holds up the others.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_UPSAMPLE_GROUP
#include "frame/work_group.glsl"
#include "diffusion/upsampled.glsl"

layout(set = 0, binding = PELLUCID_BINDING_COARSER_LEVELS) uniform utexture2D coarserLevelsImage;
layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

// Upsampled texels of level 3 and coarser ones, level after level; see Window. Color and material as packed, depth, and in
// place of the slope the share of the kernel that the surface fills, of each channel.
const int kUpsampled = 153 + 60 + 24 + 12 + 9;
const int kMade = kUpsampled; // then levels 6 and, 3 x 3, 7, where the group makes them
// Sides of what a group needs of level 5 to make level 6, and of that to make level 7.
const int kSide5 = 18, kSide6 = 8;

shared uvec4 upsampled[kMade + kSide6 * kSide6 + 9];
shared uvec2 colors[kSide5 * kSide5];
shared float depths[kSide5 * kSide5];
shared uint needsMade; // whether the group makes levels 6 and 7

#include "diffusion/downsampled.glsl"
#include "diffusion/profile_table.glsl"
#include "diffusion/window.glsl"
#include "diffusion/level_filter.glsl"
#include "diffusion/last_levels.glsl"

void writeUpsampled(ivec2 texel, uvec4 color, uvec4 shares) {
  imageStore(levelsDestination, upsampledPlace(texel), color);
  imageStore(levelsDestination, sharesPlace(texel), shares);
}

uvec4 packLevel(Level r, uvec4 bits) {
  return uvec4(packColor(r.color, bits.y >> 16), bits.z, packDensity(r.density));
}

// A texel of level 2 and its pixels' shares.
void upsampleFine(ivec2 texel, ivec2 k, uvec4 bits) {
  if (!contains(levelRect(2u), texel)) return;
  uvec4 color = uvec4(0u, bits.y & 0xFFFF0000u, 0u, 0u), shares = uvec4(0u);
  if (hasSurface(bits)) {
    Foreshortening f;
    Own own = ownPart(2u, texel, k, bits, f);
    uint m = own.texel.material - 1u;
    Level r = withCoarser(own, 2u, texel, windowOf(3u, k));
    uint upper = bits.y >> 16 & ~(kPlane >> 16);
    color = uvec4(packColor(r.color, (bits.x & kFlat) != 0u ? upper | kPlane >> 16 : upper), bits.zw);
    PixelShares share = pixelShares(m, f);
    share.coarser = share.coarser * r.density / max(1.0 - share.coarser + share.coarser * r.density, vec3(1.0e-6));
    shares = uvec4(packShares(share), packDensity(r.density) | (isPlane(bits) ? kFull : 0u));
  }
  writeUpsampled(texel, color, shares);
}

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
  bool checks = readsUnwritten(PELLUCID_LIST_UPSAMPLE);
  if (invocation == 0) needsMade = 0u;
  // All before the first is used.
  uvec4 bits = inside && level <= 5u ? writtenTexel(level, texel, checks) : uvec4(0u);
  uvec4 lastBits = uvec4(0u);
  uvec4 fineBits = contains(levelRect(2u), fine) ? writtenTexel(2u, fine, checks) : uvec4(0u);
  uvec4 nextBits = contains(levelRect(2u), nextFine) ? writtenTexel(2u, nextFine, checks) : uvec4(0u);
  barrier();
  if (coarsest == 7u && level == 5u && reachesBeyond(texel, bits)) needsMade = 1u; // whoever writes, writes this
  barrier();
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
    upsampled[last.first + invocation] = own.texel.mass > 0.0 ? packLevel(alone(own), lastBits) : uvec4(0u);
  }
  Own own = ownPart(level, texel, k, bits, unused);
  for (uint l = min(coarsest, 6u); l > 2u; --l) {
    barrier();
    if (level == l && within) {
      Level r = l == coarsest ? alone(own) : withCoarser(own, level, texel, windowOf(level + 1u, k));
      upsampled[invocation] = own.texel.mass > 0.0 ? packLevel(r, bits) : uvec4(0u);
    }
  }
  barrier();
  // In a loop, because both in a row are a third more code and no faster.
  for (int i = 0; i < 2; ++i) {
    upsampleFine(fine, k, fineBits);
    fine = nextFine;
    fineBits = nextBits;
  }
}
