// Sizes and shared memory of a diffusing group.

// Without the fine filter, the material's table gives its share to the pixel and level 2.
layout(constant_id = PELLUCID_CONSTANT_FINE) const bool kFine = true;
// The pass adds gathered light.
layout(constant_id = PELLUCID_CONSTANT_GATHERS) const bool kGathers = false;

const int kInvocations = PELLUCID_DIFFUSE_GROUP * PELLUCID_DIFFUSE_GROUP;
// A group does kTexels of level 2 and holds a window, which has a border of one; the fine filter reads a ring of pixels.
const int kTexelsX = kFine ? PELLUCID_DIFFUSE_TEXELS_X : PELLUCID_DIFFUSE_COARSE_TEXELS_X, kTexelsY = PELLUCID_DIFFUSE_TEXELS_Y;
const int kWindowX = kTexelsX + 2, kWindowY = kTexelsY + 2, kRing = kFine ? 2 : 0;
const int kMostTexels = PELLUCID_DIFFUSE_COARSE_TEXELS_X * kTexelsY;
const int kMostWindow = (PELLUCID_DIFFUSE_COARSE_TEXELS_X + 2) * kWindowY;
// An invocation does the four rows of a texel in a column, the outer columns only what their neighbors need.
const int kColumns = 4 * PELLUCID_DIFFUSE_COARSE_TEXELS_X, kRows = 4, kMostRing = 2;

// Edges are done a band of rows of texels at a time: the fine filter needs their pixels in shared memory.
const int kBandRows = kFine ? 2 : kTexelsY, kBandTexels = kBandRows * kTexelsX;
const int kBandPixels = (4 * 2 + 2 * kMostRing) * kColumns;

// Colors after the fine filter's vertical half. Later the colors and materials of a band's pixels and their ring.
shared uvec2 vertical[kRows * kTexelsY * kColumns];
shared float bandDepths[kBandPixels];
shared uvec4 upsampled[kMostWindow];
shared uvec4 shares[kMostWindow];
shared float spreads[kMostWindow]; // inverseSpread of upsampled[], in groups with edges
// Edges, band by band: columns and, from bit 8 on, rows of texels. Full texels, around whose pixels all is one plane though
// their neighbors are none, come first; the others come last, from the end on.
shared uint edges[kMostTexels];
shared uint edgeCounts[kTexelsY]; // of each band: full texels, and in the upper 16 bits others
shared uint edgeBands;            // a bit for each band that has edges
shared uint anySurface, anyShape; // some texel has a surface, a FineShape
shared uint someLight;            // kSome* of the probes around all pixels

// The invocation's column of the group's pixels with their ring, and the first of its rows.
int ownColumn() { return int(gl_LocalInvocationIndex) % kColumns; }
int ownRow() { return int(gl_LocalInvocationIndex) / kColumns * kRows; }

// `inWindow`: place of the texel with index `index` in upsampled[].
void keepTexel(int index, ivec2 inWindow, uvec4 texel, uvec4 texelShares) {
  upsampled[index] = texel;
  shares[index] = texelShares;
  if (texel.y >> 16 == 0u) return;
  anySurface = 1u; // whoever writes, writes this
  if (hasShape(texelShares.z)) anyShape = 1u;
  if (!isPlane(texel) && contains(ivec4(0, 0, kTexelsX, kTexelsY), inWindow - 1))
    atomicOr(edgeBands, 1u << ((inWindow.y - 1) / kBandRows));
}
