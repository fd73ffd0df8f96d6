// The pixels' own shares of the profile plus the resolved pyramid's. Where a texel of level 2 lies on one plane with all
// around it, its 4 x 4 pixels are filtered without looking at their depths; the rest, edges, are collected and done a
// pixel an invocation.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "passes/group_order.glsl"
#include "passes/resolved.glsl"

const int kInvocations = PELLUCID_DIFFUSE_GROUP * PELLUCID_DIFFUSE_GROUP;
// COARSE: without the fine filter, whose share the material's table gives to the pixel and level 2.
#ifdef COARSE
const int kRing = 0, kTexelsX = PELLUCID_DIFFUSE_COARSE_TEXELS_X;
#else
const int kRing = 2, kTexelsX = PELLUCID_DIFFUSE_TEXELS_X;
#endif
// Texels of level 2 that a group does, and with a border of one.
const ivec2 kTexels = ivec2(kTexelsX, PELLUCID_DIFFUSE_TEXELS_Y), kWindow = kTexels + 2;
// An invocation does some rows of a column, the outer columns only what their neighbors need.
const int kColumns = 4 * kTexels.x + 2 * kRing, kRows = 4 * kTexels.y * kColumns / kInvocations;

#ifndef COARSE
// Colors after the fine filter's vertical half. Later, of a row of texels with edges, its pixels with a ring: colors and
// materials, then depths.
shared uvec2 vertical[4 * kTexels.y * kColumns];
const int kRowPixels = (4 + 2 * kRing) * kColumns;
#endif
shared uvec4 resolved[kWindow.x * kWindow.y];
shared uvec4 shares[kWindow.x * kWindow.y];
shared float spreads[kWindow.x * kWindow.y]; // inverseSpread of resolved[], in groups with edges
// Columns of edges, row by row of texels: first those around whose pixels all is one plane, though their neighbors are not,
// from the end on the others; their numbers, in 16 bits each; a bit for each row that has any.
shared uint edges[kTexels.x * kTexels.y];
shared uint edgeCounts[kTexels.y];
shared uint edgeRows, anySurface, anyShape; // anyShape: whether a texel has a FineShape

#ifdef GATHER
#include "passes/shared_points.glsl"

// The points around all pixels. Cells are texels of level 2.
const ivec2 kPoints = kTexels + 1;
#endif

#include "passes/planes.glsl"

#ifndef COARSE
// Weights of the fine filter in one direction: of the pixel, of its neighbors and of theirs.
const vec3 kFine = vec3(9.0, 4.0, 1.0) / 19.0, kWideFine = vec3(2.0, 2.0, 1.0) / 8.0;

// `wider`: FineShape's, negative in the other direction.
vec3 fineWeights(float wider) { return mix(kFine, kWideFine, max(wider, 0.0)); }

float weightAt(vec3 weights, int i) { return i == 0 ? weights.x : abs(i) == 1 ? weights.y : weights.z; }

// The same of each channel, `direct` of which goes through unfiltered.
struct FineFilter {
  vec3 own, next, last;
};

FineFilter fineFilter(float wider, vec3 direct) {
  vec3 weights = fineWeights(wider), rest = 1.0 - direct;
  return FineFilter(direct + weights.x * rest, weights.y * rest, weights.z * rest);
}

vec3 fineSum(FineFilter f, vec3 a, vec3 b, vec3 c, vec3 d, vec3 e) {
  return f.own * c + f.next * (b + d) + f.last * (a + e);
}

// Of those along columns, then rows: what is thin along one passes the other unfiltered. `shape`: a texel's shares' z.
FineFilter columnFilter(uint shape, bool shaped) {
  FineShape s = shaped ? unpackShape(shape) : kNoShape;
  return fineFilter(-s.wider, s.wider > 0.0 ? s.thin : vec3(0.0));
}

FineFilter rowFilter(uint shape, bool shaped) {
  FineShape s = shaped ? unpackShape(shape) : kNoShape;
  return fineFilter(s.wider, s.wider > 0.0 ? vec3(0.0) : s.thin);
}
#endif

void store(ivec2 pixel, vec3 color, float alpha) {
  if (tinted(pass.value.w != 0u)) color = sanitize(color * albedoAt(pixel));
  imageStore(destinationImage, pixel, vec4(asStored(color), alpha));
}

// What pixels of edges ask of a texel and is the same for all of them. Shares without the texel's density: that of the
// pixel replaces it, and a plane's is 1.
void prepareForEdges(int index) {
  uvec4 bits = resolved[index];
  Texel t = unpackTexel(bits);
  spreads[index] = inverseSpread(t.slope, texelSize(t.depth, 2u));
  if (isPlane(bits)) return;
  PixelShares s = unpackShares(shares[index].xyz);
  vec3 density = unpackDensity(shares[index].w) * (1.0 / kDensityOne);
  s.coarser /= max(s.coarser + density * (1.0 - s.coarser), vec3(1.0e-6));
  // Less 1 from a half on: halves are too coarse near 1 for what is left of it.
  s.coarser = mix(s.coarser, min(s.coarser - 1.0, vec3(-6.0e-8)), greaterThan(s.coarser, vec3(0.5)));
  uvec3 packed = packShares(s);
  // One by one: others read z and w meanwhile, which a store of a part of a vector may store, too.
  shares[index].x = packed.x;
  shares[index].y = packed.y;
}

// What prepareForEdges did not take from it.
vec3 coarserOfEdge(vec3 coarser) { return mix(coarser, coarser + 1.0, lessThan(coarser, vec3(0.0))); }

#ifndef COARSE
// The fine filter, its vertical half done.
vec3 fineOf(FineFilter f, int at) {
  return fineSum(f, unpackColor(vertical[at - 2]), unpackColor(vertical[at - 1]), unpackColor(vertical[at]),
                 unpackColor(vertical[at + 1]), unpackColor(vertical[at + 2]));
}

// `first`: of the row's pixels and their ring.
void keepRow(ivec2 first) {
  const int kEach = kRowPixels / kInvocations;
  uvec2 colors[kEach];
  uint depths[kEach];
  // All loads at once, so that their latencies overlap.
  [[unroll]] for (int i = 0; i < kEach; ++i) {
    int place = int(gl_LocalInvocationIndex) + i * kInvocations;
    ivec2 pixel = first + ivec2(place % kColumns, place / kColumns), at = withinRect(pixel);
    colors[i] = packColor(sanitize(texelFetch(sourceImage, at, 0).rgb), at == pixel ? materialAt(at) : 0u);
    depths[i] = floatBitsToUint(frontDistance(at));
  }
  [[unroll]] for (int i = 0; i < kEach; ++i) {
    int place = int(gl_LocalInvocationIndex) + i * kInvocations;
    vertical[place] = colors[i];
    vertical[kRowPixels + place].x = depths[i];
  }
}

// The fine filter where all around the pixel is one plane.
vec3 fineOfPlane(int place, uint shape) {
  FineFilter columns = columnFilter(shape, true), rows = rowFilter(shape, true);
  vec3 fine = vec3(0.0);
  for (int y = -2; y <= 2; ++y) {
    int at = place + y * kColumns;
    vec3 weight = y == 0 ? columns.own : abs(y) == 1 ? columns.next : columns.last;
    fine += weight * fineOf(rows, at);
  }
  return fine;
}

// The fine filter of a pixel on a surface of that slope, and what of it lies on the surface. `place`: of the pixel in
// what keepRow kept; `wider`: FineShape's. What is thin is left to planes, as it makes edges no better.
vec4 fineOfEdge(int place, vec2 slope, vec2 size, float wider) {
  uint material = vertical[place].y >> 16;
  float own = uintBitsToFloat(vertical[kRowPixels + place].x);
  vec2 depthStep = slope * size;
  float spread2 = inverseSpread(slope, 2.0 * size);
  vec3 columns = fineWeights(-wider), rows = fineWeights(wider);
  vec4 fine = vec4(0.0);
  for (int y = -2; y <= 2; ++y) {
    float weightY = weightAt(columns, y);
    // A row without a branch, so that latencies overlap.
    [[unroll]] for (int x = -2; x <= 2; ++x) {
      int at = place + y * kColumns + x;
      uvec2 packed = vertical[at];
      float theirs = uintBitsToFloat(vertical[kRowPixels + at].x);
      float along = dot(depthStep, vec2(x, y));
      float w = sameSurface(theirs - own - along, along, spread2, kPixelFalloff);
      bool counts = packed.y >> 16 == material && theirs > 0.0;
      fine += (counts ? w * weightAt(rows, x) * weightY : 0.0) * vec4(unpackColor(packed), 1.0);
    }
  }
  return fine;
}
#endif

// A pixel of an edge, all weights by what lies on its surface. `local`: from the group's first pixel.
void diffuseEdge(ivec2 firstTexel, ivec2 local) {
  ivec2 pixel = 4 * firstTexel + local;
#ifdef COARSE
  uint material = insideRect(pixel) ? materialAt(pixel) : 0u;
  float depth = frontDistance(withinRect(pixel));
#else
  int place = ((local.y & 3) + kRing) * kColumns + local.x + kRing;
  uint material = vertical[place].y >> 16;
  float depth = uintBitsToFloat(vertical[kRowPixels + place].x);
#endif
  if (material == 0u) return;
  vec4 source = texelFetch(sourceImage, pixel, 0);
#if defined(HALF) && !defined(COARSE)
  vec3 own = unpackColor(vertical[place]); // the same, in fewer registers
#else
  vec3 own = sanitize(source.rgb);
#endif
  vec3 color = own;
  if (depth > 0.0) {
    vec2 size = texelSize(depth, 0u), slope = vec2(0.0);
    int center = (local.y / 4 + 1) * kWindow.x + local.x / 4 + 1;
    vec2 from = vec2(local & 3) - 1.5; // the texel's center, pixels
    vec3 splineX = spline(0.25 * from.x), splineY = spline(0.25 * from.y);
    vec3 coarser = vec3(0.0), found = vec3(0.0);
    vec3 coarserShare = vec3(0.0), fineShare = vec3(0.0);
    float weights = 0.0;
    for (int y = -1; y <= 1; ++y) {
      float weightY = y < 0 ? splineY.x : y > 0 ? splineY.z : splineY.y;
      // A row without a branch, so that latencies overlap.
#ifdef GATHER
      // Compilers would unroll over a number that they know, which takes more registers than four groups have.
      for (int x = -1; x <= int(pass.value.y); ++x) {
#else
      [[unroll]] for (int x = -1; x <= 1; ++x) {
#endif
        int index = center + y * kWindow.x + x;
        Texel t = unpackTexel(resolved[index]);
        float along = dot(t.slope, (from - 4.0 * vec2(x, y)) * size);
        float w = sameSurface(depth - t.depth - along, along, spreads[index], kPixelFalloff);
        w *= weightY * (x < 0 ? splineX.x : x > 0 ? splineX.z : splineX.y);
        w = t.mass != 0.0 && t.material == material ? w : 0.0;
        vec3 density = w * (1.0 / kDensityOne) * unpackDensity(shares[index].w);
        coarser += density * t.color;
        found += density;
        w *= min(t.mass, 1.0);
        slope += w * t.slope;
        PixelShares s = unpackShares(shares[index].xyz);
        coarserShare += w * coarserOfEdge(s.coarser);
        fineShare += w * s.fine;
        weights += w;
      }
    }
    float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
    slope *= inverse;
    coarserShare *= inverse;
    fineShare *= (1.0 - coarserShare) * inverse;
    // Shares are weighted with what of their filters was found. The pixel itself counts in the first and the second,
    // so the divisor is 0 only where all of the share is the coarser one's and none of it is there.
    vec3 ownShare = 1.0 - coarserShare - fineShare;
    vec3 sum = ownShare * own + coarserShare * coarser, divisor = ownShare + coarserShare * found;
#ifndef COARSE
    uint shape = shares[center].z;
    vec4 fine = isFull(shares[center]) ? vec4(fineOfPlane(place, shape), 1.0)
                                       : fineOfEdge(place, slope, size, unpackShape(shape).wider);
    sum += fineShare * fine.rgb;
    divisor += fineShare * fine.a;
#endif
    color = mix(own, max(sum, vec3(0.0)) / max(divisor, vec3(1.0e-6)), greaterThan(divisor, vec3(1.0e-6)));
#ifdef GATHER
    if (someLight != 0u) color = withGathered(color, pixel, PELLUCID_DIFFUSE_CELL, depth, material);
#endif
  }
  store(pixel, color, source.a);
}

// Pixels of planes, four of a column. `sources`: of the invocation's column of pixels; `shaped`: whether texels have shapes.
// For all invocations, as it waits for them.
void diffusePlanes(ivec2 firstTexel, vec4 sources[kRows + 2 * kRing], bool shaped) {
  int invocation = int(gl_LocalInvocationIndex), column = invocation % kColumns, firstRow = invocation / kColumns * kRows;
  uvec2 own[kRows]; // colors and alphas
#ifndef COARSE
  // An invocation's rows are those of one texel.
  FineFilter columns = columnFilter(shares[(firstRow / 4 + 1) * kWindow.x + (column - kRing + 4) / 4].z, shaped);
#endif
  [[unroll]] for (int i = 0; i < kRows; ++i) {
    vec4 source = sources[i + kRing];
    own[i] = uvec2(packHalf2x16(source.rg), packHalf2x16(source.ba));
#ifndef COARSE
    vec3 sum = fineSum(columns, sources[i].rgb, sources[i + 1].rgb, source.rgb, sources[i + 3].rgb, sources[i + 4].rgb);
    vertical[(firstRow + i) * kColumns + column] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, 0.0)));
#endif
  }
  if (edgeRows != 0u && invocation < kWindow.x * kWindow.y) prepareForEdges(invocation);
  barrier();

  int x = column - kRing;
  if (x < 0 || x >= 4 * kTexels.x) return;
  vec3 splineX = splineAt(x);
  [[unroll]] for (int block = 0; block < kRows / 4; ++block) {
    int texelRow = firstRow / 4 + block;
    int index = texelRow * kWindow.x + x / 4;
    if (!isPlane(resolved[index + kWindow.x + 1])) continue;
    vec3 coarser[3];
    coarserRows(index + kWindow.x + 1, splineX, coarser);
    uvec3 bits = shares[index + kWindow.x + 1].xyz;
    PixelShares share = unpackShares(bits);
#ifndef COARSE
    FineFilter rows = rowFilter(bits.z, shaped);
#endif
    vec4 result[4];
    [[unroll]] for (int i = 0; i < 4; ++i) {
      vec3 smoothed = coarserAt(coarser, i);
      uvec2 packed = own[4 * block + i];
      vec2 blue = unpackHalf2x16(packed.y);
      vec3 color = vec3(unpackHalf2x16(packed.x), blue.x);
#ifndef COARSE
      color = mix(color, fineOf(rows, (4 * texelRow + i) * kColumns + column), share.fine);
#endif
      color = mix(color, smoothed, share.coarser);
      result[i] = vec4(color, blue.y);
    }
    storeColumn(4 * firstTexel + ivec2(x, 4 * texelRow), result);
  }
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 firstTexel = (ivec2(frame.rect.xy) >> 2) + ivec2(bordersFirst()) * kTexels;
  // All loads before the first barrier, so that a group waits for memory once.
  uvec4 texel = uvec4(0u), texelShares = uvec4(0u);
  ivec2 inWindow = ivec2(invocation % kWindow.x, invocation / kWindow.x);
  if (invocation < kWindow.x * kWindow.y) {
    ivec2 at = firstTexel + inWindow - 1;
    if (contains(levelRect(2u), at)) {
      texel = texelFetch(pyramidImage, resolvedPlace(at), 0);
      texelShares = texelFetch(pyramidImage, sharesPlace(at), 0);
    }
  }
#ifdef GATHER
  // By invocations that hold no texel.
  int point = kInvocations - 1 - invocation;
  bool hasPoint = point < kPoints.x * kPoints.y;
  if (hasPoint) texel = pointBits(firstTexel + ivec2(point % kPoints.x, point / kPoints.x));
#endif
  int column = invocation % kColumns, firstRow = invocation / kColumns * kRows;
  ivec2 first = 4 * firstTexel + ivec2(column - kRing, firstRow);
  vec4 sources[kRows + 2 * kRing];
  [[unroll]] for (int i = 0; i < kRows + 2 * kRing; ++i)
    sources[i] = texelFetch(sourceImage, withinRect(first + ivec2(0, i - kRing)), 0);
#ifdef GATHER
  if (invocation == 0) someLight = 0u;
#endif
  if (invocation < kTexels.y) edgeCounts[invocation] = 0u;
  if (invocation == 0) anySurface = edgeRows = anyShape = 0u;
  barrier();
  if (invocation < kWindow.x * kWindow.y) {
    resolved[invocation] = texel;
    shares[invocation] = texelShares;
    if (texel.y >> 16 != 0u) {
      anySurface = 1u; // whoever writes, writes this
      if (hasShape(texelShares.z)) anyShape = 1u;
      if (!isPlane(texel) && contains(ivec4(0, 0, kTexels), inWindow - 1))
        atomicOr(edgeRows, 1u << (inWindow.y - 1));
    }
  }
#ifdef GATHER
  uint light = hasPoint ? kindsOfLight(texel) : 0u;
  if (light != 0u) atomicOr(someLight, light);
#endif
  barrier();
  if (anySurface != 0u) {
    if (invocation < kTexels.x * kTexels.y) {
      ivec2 local = ivec2(invocation % kTexels.x, invocation / kTexels.x);
      int index = (local.y + 1) * kWindow.x + local.x + 1;
      uvec4 its = resolved[index];
      if (its.y >> 16 != 0u && !isPlane(its)) {
        bool full = isFull(shares[index]);
        uint before = atomicAdd(edgeCounts[local.y], full ? 1u : 0x10000u);
        int place = full ? int(before & 0xFFFFu) : kTexels.x - 1 - int(before >> 16);
        edges[kTexels.x * local.y + place] = uint(local.x);
      }
    }
#ifdef COARSE
    diffusePlanes(firstTexel, sources, false);
#else
    // Twice the code, so that what faces the camera has filters of constants.
    if (anyShape != 0u)
      diffusePlanes(firstTexel, sources, true);
    else
      diffusePlanes(firstTexel, sources, false);
#endif
    // The same rows for all invocations.
    for (uint rows = edgeRows; rows != 0u; rows &= rows - 1u) {
      int row = findLSB(rows), full = int(edgeCounts[row] & 0xFFFFu), count = full + int(edgeCounts[row] >> 16);
#ifndef COARSE
      barrier(); // what was there has been read
      keepRow(4 * firstTexel + ivec2(-kRing, 4 * row - kRing));
      barrier();
#endif
      int edge = invocation >> 4, at = invocation & 15;
      if (edge < count) {
        int place = edge < full ? edge : kTexels.x - 1 - (edge - full);
        int texelX = int(edges[kTexels.x * row + place]);
        diffuseEdge(firstTexel, ivec2(4 * texelX + (at & 3), 4 * row + (at >> 2)));
      }
    }
  }
}
