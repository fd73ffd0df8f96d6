// Level 2 of the pyramid with all coarser ones in it. Each texel takes two texels of the image of level 1. One is packed as
// a texel of the pyramid, whose kPlane says that all around lies on its plane, too. The other holds the shares of the pixels
// under it and in w the kernel coverage, a byte a channel, and flags.

#include "diffusion/pyramid.glsl"

ivec2 upsampledPlace(ivec2 texel) { return frame.level[0].xy + texel; }
ivec2 sharesPlace(ivec2 texel) { return frame.level[0].zw + texel; }

// A foreshortened surface's kernel is longer in one direction. The fine filter is wider along rows or columns of pixels,
// whichever is nearer to that direction, and a filter along them alone has part of its share.
struct FineShape {
  float wider; // 0: the fine filter to 1: the wide one; negative: along columns
  vec3 thin;   // part of fine
};
const FineShape kNoShape = FineShape(0.0, vec3(0.0));

// Shares of a pixel on the surface of a texel: what level 2 and coarser ones have, with the texel's kernel coverage already
// in it, and of the rest the fine filters.
struct PixelShares {
  vec3 coarser, fine;
  FineShape shape;
};

const float kMostFine = 1.2; // of fine

// The share of the fine filter at which the pixel itself counts 0, less what 8 bits round: 1 - f + f w = 0 of the filter's
// weight w of it, the narrow filter's along one axis and either's along the other.
float mostFine(float wider) {
  float own = PELLUCID_FINE_OWN * mix(PELLUCID_FINE_OWN, PELLUCID_WIDE_FINE_OWN, abs(wider));
  return min(kMostFine, 1.0 / (1.0 - own) - 0.003);
}

uvec3 packShares(PixelShares s) {
  uvec3 fine = uvec3(s.fine * (255.0 / kMostFine) + 0.5), thin = uvec3(s.shape.thin * 63.0 + 0.5);
  // Edges write x and y while the shape, which is in z, is read.
  uint shape = uint(int(s.shape.wider * 31.0 + (s.shape.wider < 0.0 ? -0.5 : 0.5))) << 26;
  return uvec3(packHalves(s.coarser, fine.r | fine.g << 8),
               shape | thin.b << 20 | thin.g << 14 | thin.r << 8 | fine.b);
}

bool hasShape(uint z) { return z >> 8 != 0u; }

FineShape unpackShape(uint z) {
  return FineShape(float(int(z) >> 26) * (1.0 / 31.0), vec3((z >> 8) & 63u, (z >> 14) & 63u, (z >> 20) & 63u) * (1.0 / 63.0));
}

PixelShares unpackShares(uvec3 u) {
  vec3 fine = vec3((u.y >> 16) & 255u, u.y >> 24, u.z & 255u) * (kMostFine / 255.0);
  return PixelShares(unpackHalves(u.xy), fine, unpackShape(u.z));
}

// A flag of a texel's shares says that all under the texel's filter is one plane.
const uint kFull = 0x1000000u;
bool isFull(uvec4 its) { return (its.w & kFull) != 0u; }
