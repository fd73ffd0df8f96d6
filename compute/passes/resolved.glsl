// Level 2 of the pyramid with all coarser ones in it: two texels each, where level 1 was. One is packed as a texel of
// the pyramid, whose kPlane says that all around lies on its plane, too. The other holds the shares of the pixels under it
// and in w the share of the kernel that the surface fills, a byte a channel, and flags.
#ifndef PELLUCID_RESOLVED_GLSL
#define PELLUCID_RESOLVED_GLSL

#include "passes/pyramid.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

ivec2 resolvedPlace(ivec2 texel) { return frame.level[0].xy + texel; }

ivec2 sharesPlace(ivec2 texel) { return frame.level[0].zw + texel; }

// Shares of a pixel on the surface of a texel: what level 2 and coarser ones have, with the texel's density already
// in it, and of the rest the fine filter.
struct PixelShares {
  vec3 coarser, fine;
};

uvec3 packShares(PixelShares s) {
  return uvec3(packHalf2x16(s.coarser.rg), packHalf2x16(vec2(s.coarser.b, s.fine.r)), packHalf2x16(s.fine.gb));
}

PixelShares unpackShares(uvec3 u) {
  vec2 middle = unpackHalf2x16(u.y);
  return PixelShares(vec3(unpackHalf2x16(u.x), middle.x), vec3(middle.y, unpackHalf2x16(u.z)));
}

// Of texels' shares: all under the texel's filter is one plane; its pixels are edges that have a dispatch of their own.
const uint kFull = 0x1000000u, kSummed = 0x2000000u;

bool isFull(uvec4 its) { return (its.w & kFull) != 0u; }

bool isSummed(uvec4 its) { return (its.w & kSummed) != 0u; }

#endif
