// The pixels' own shares of the profile plus the upsampled pyramid's. A texel of level 2 that lies on one plane with all
// around it has its 4 x 4 pixels filtered without looking at their depths; the rest, edges, are collected and done a
// pixel an invocation.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "frame/group_order.glsl"
#include "diffusion/upsampled.glsl"
#include "gather/probe_image.glsl"

// Without the fine filter the material's table gives its share to the pixel and level 2.
layout(constant_id = PELLUCID_CONSTANT_FINE) const bool kFine = true;
// Gathered light is added.
layout(constant_id = PELLUCID_CONSTANT_GATHERS) const bool kGathers = false;

const int kInvocations = PELLUCID_DIFFUSE_GROUP * PELLUCID_DIFFUSE_GROUP;
// Texels of level 2 that a group does, and with a border of one; pixels around them that the fine filter reads.
const int kTexelsX = kFine ? PELLUCID_DIFFUSE_TEXELS_X : PELLUCID_DIFFUSE_COARSE_TEXELS_X, kTexelsY = PELLUCID_DIFFUSE_TEXELS_Y;
const int kWindowX = kTexelsX + 2, kWindowY = kTexelsY + 2, kRing = kFine ? 2 : 0;
const int kMostTexels = PELLUCID_DIFFUSE_COARSE_TEXELS_X * kTexelsY;
const int kMostWindow = (PELLUCID_DIFFUSE_COARSE_TEXELS_X + 2) * kWindowY;
// An invocation does the four rows of a texel in a column, the outer columns only what their neighbors need.
const int kColumns = 4 * PELLUCID_DIFFUSE_COARSE_TEXELS_X, kRows = 4, kMostRing = 2;

// Colors after the fine filter's vertical half. Later, of a row of texels with edges, its pixels with a ring: colors and
// materials, then depths.
shared uvec2 vertical[kRows * kTexelsY * kColumns];
const int kRowPixels = (4 + 2 * kMostRing) * kColumns;
shared uvec4 upsampled[kMostWindow];
shared uvec4 shares[kMostWindow];
shared float spreads[kMostWindow]; // inverseSpread of upsampled[], in groups with edges
// Columns of edges, row by row of texels: first those around whose pixels all is one plane, though their neighbors are not,
// from the end on the others; their numbers, in 16 bits each; a bit for each row that has any.
shared uint edges[kMostTexels];
shared uint edgeCounts[kTexelsY];
shared uint edgeRows, anySurface, anyShape; // anyShape: whether a texel has a FineShape
shared uint someLight;                      // kSome* of the probes around all pixels

// The invocation's column of the group's pixels with their ring, and the first of its rows.
int ownColumn() { return int(gl_LocalInvocationIndex) % kColumns; }
int ownRow() { return int(gl_LocalInvocationIndex) / kColumns * kRows; }

#include "diffusion/fine_filter.glsl"
#include "diffusion/spline.glsl"
#include "diffusion/edges.glsl"
#include "diffusion/planes.glsl"

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 firstTexel = (ivec2(frame.rect.xy) >> 2) + ivec2(workGroupBordersFirst(PELLUCID_LIST_DIFFUSE)) * ivec2(kTexelsX, kTexelsY);
  // All loads before the first barrier, so that a group waits for memory once.
  uvec4 texel = uvec4(0u), texelShares = uvec4(0u);
  ivec2 inWindow = ivec2(invocation % kWindowX, invocation / kWindowX);
  bool hasTexel = inWindow.y < kWindowY;
  if (hasTexel && contains(levelRect(2u), firstTexel + inWindow - 1)) {
    texel = texelFetch(pyramidImage, upsampledPlace(firstTexel + inWindow - 1), 0);
    texelShares = texelFetch(pyramidImage, sharesPlace(firstTexel + inWindow - 1), 0);
  }
  // Cells of probes are texels of level 2. By invocations that hold no texel.
  int probe = kInvocations - 1 - invocation;
  bool hasProbe = kGathers && probe < (kTexelsX + 1) * (kTexelsY + 1);
  if (hasProbe) texel = probeBits(firstTexel + ivec2(probe % (kTexelsX + 1), probe / (kTexelsX + 1)));
  ivec2 first = 4 * firstTexel + ivec2(ownColumn() - kRing, ownRow());
  vec4 sources[kRows + 2 * kMostRing];
  [[unroll]] for (int i = 0; i < kRows + 2 * kMostRing; ++i)
    if (kFine || (i >= kMostRing && i < kRows + kMostRing))
      sources[i] = texelFetch(sourceImage, withinRect(first + ivec2(0, i - kMostRing)), 0);
  if (invocation < kTexelsY) edgeCounts[invocation] = 0u;
  if (invocation == 0) anySurface = edgeRows = anyShape = someLight = 0u;
  barrier();
  if (hasTexel) {
    upsampled[invocation] = texel;
    shares[invocation] = texelShares;
    if (texel.y >> 16 != 0u) {
      anySurface = 1u; // whoever writes, writes this
      if (hasShape(texelShares.z)) anyShape = 1u;
      if (!isPlane(texel) && contains(ivec4(0, 0, kTexelsX, kTexelsY), inWindow - 1))
        atomicOr(edgeRows, 1u << (inWindow.y - 1));
    }
  }
  uint light = hasProbe ? kindsOfLight(texel) : 0u;
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (anySurface != 0u) { // the same for all invocations
    collectEdges(invocation);
    [[unroll]] for (int i = 0; i < kRows + 2 * kMostRing; ++i)
      if (kFine || (i >= kMostRing && i < kRows + kMostRing)) sources[i].rgb = sanitize(sources[i].rgb);
    // Twice the code, so that what faces the camera has filters of constants.
    if (kFine && anyShape != 0u)
      diffusePlanes(firstTexel, sources, true);
    else
      diffusePlanes(firstTexel, sources, false);
    diffuseEdges(firstTexel, invocation);
  }
}
