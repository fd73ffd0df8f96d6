// Pixels of planes where edges are summed: two fine filters, of 5 x 5 and of 9 x 9 pixels, and the resolved pyramid.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "passes/group_order.glsl"
#include "passes/resolved.glsl"

const int kInvocations = PELLUCID_DIFFUSE_GROUP * PELLUCID_DIFFUSE_GROUP;
const int kRing = 4; // of the wide filter
// Texels of level 2 that a group does, and with a border of one.
const ivec2 kTexels = ivec2(PELLUCID_DIFFUSE_PLANES_TEXELS_X, PELLUCID_DIFFUSE_TEXELS_Y), kWindow = kTexels + 2;
// An invocation does four rows of a column, the outer columns only what their neighbors need.
const int kColumns = 4 * kTexels.x + 2 * kRing, kRows = 4 * kTexels.y * kColumns / kInvocations;

// Halves of what the filters' vertical halves made: of the wide one red and green, of both blue; of the narrow one.
shared uvec2 wide[4 * kTexels.y * kColumns];
shared uint narrow[4 * kTexels.y * kColumns];
shared uvec4 resolved[kWindow.x * kWindow.y];
shared uvec4 shares[kWindow.x * kWindow.y];
shared uint anySurface;
shared uint anyPartial; // of kernels that the rect cuts

#ifdef GATHER
#include "passes/shared_points.glsl"

// The points around all pixels. Cells are texels of level 2.
const ivec2 kPoints = kTexels + 1;
#endif

// Towards the cubic B-spline, whose fourth texel has next to nothing.
const float kWider = 0.027;

#include "passes/planes.glsl"

// 1 14 44 14 1 and 1 2 5 9 10 9 5 2 1, near Gaussians of .7 and 1.7 pixels.
const float kNarrow[] = {44.0 / 74.0, 14.0 / 74.0, 1.0 / 74.0, 0.0, 0.0};
const float kWide[] = {10.0 / 44.0, 9.0 / 44.0, 5.0 / 44.0, 2.0 / 44.0, 1.0 / 44.0};
const int kNarrowRing = 2;

// What of both filters lies in [first, end) in one direction. x: narrow, y: wide.
vec2 within(int at, uint first, uint end) {
  vec2 sum = vec2(0.0);
  for (int i = -kRing; i <= kRing; ++i)
    if (at + i >= int(first) && at + i < int(end)) sum += vec2(kNarrow[abs(i)], kWide[abs(i)]);
  return sum;
}

void keepVertical(int place, uvec2 pixels[kRows + 2 * kRing], int row) {
  vec3 wideSum = vec3(0.0), narrowSum = vec3(0.0);
  [[unroll]] for (int y = -kRing; y <= kRing; ++y) {
    // Planes have nothing that needs it, but may end at the rect beside what does.
    vec3 color = sanitize(unpackColor(pixels[row + kRing + y]));
    wideSum += kWide[abs(y)] * color;
    if (abs(y) <= kNarrowRing) narrowSum += kNarrow[abs(y)] * color;
  }
  wide[place] = uvec2(packHalf2x16(wideSum.rg), packHalf2x16(vec2(wideSum.b, narrowSum.b)));
  narrow[place] = packHalf2x16(narrowSum.rg);
}

// By how much the parts of two texels' kernels that lie in the rect may differ and still be taken as the same, 3 %.
const float kMostUneven = 4.5;

bool isEvenAround(int texel) {
  vec3 own = unpackDensity(shares[texel].w), most = vec3(0.0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) most = max(most, abs(unpackDensity(shares[texel + y * kWindow.x + x].w) - own));
  return max(most.r, max(most.g, most.b)) < kMostUneven;
}

struct Filtered {
  vec3 narrow, wide;
};

Filtered filtered(int place) {
  Filtered f = Filtered(vec3(0.0), vec3(0.0));
  [[unroll]] for (int x = -kRing; x <= kRing; ++x) {
    uvec2 bits = wide[place + x];
    vec2 blue = unpackHalf2x16(bits.y);
    f.wide += kWide[abs(x)] * vec3(unpackHalf2x16(bits.x), blue.x);
    if (abs(x) <= kNarrowRing) f.narrow += kNarrow[abs(x)] * vec3(unpackHalf2x16(narrow[place + x]), blue.y);
  }
  return f;
}

// Parts of the energy.
struct Parts {
  vec3 own, narrow, wide, coarser;
};

Parts partsOf(uvec3 bits) {
  PixelEnergies e = unpackEnergies(bits);
  return Parts(1.0 - e.narrow, e.narrow - e.wide, e.wide - e.coarser, e.coarser);
}

// A pixel of a plane that ends at the rect: of each filter, what lies in it. `texel`: its own in the window; `place`: in
// wide[].
void diffuseAtBorder(ivec2 pixel, int texel, int place) {
  uint material = insideRect(pixel) ? materialAt(pixel) : 0u;
  if (material == 0u) return;
  float depth = frontDistance(pixel);
  Parts parts = partsOf(shares[texel].xyz);
  Filtered f = filtered(place);
  vec4 source = texelFetch(sourceImage, pixel, 0);
  vec2 inRect = within(pixel.x, frame.rect.x, frame.rect.z) * within(pixel.y, frame.rect.y, frame.rect.w);
  vec3 coarser = vec3(0.0), found = vec3(0.0);
  vec3 splineX = splineAt(pixel.x), splineY = splineAt(pixel.y);
  for (int y = 0; y < 3; ++y)
    for (int x = 0; x < 3; ++x) {
      int index = texel + (y - 1) * kWindow.x + x - 1;
      float weight = x == 0 ? splineX.x : x == 1 ? splineX.y : splineX.z;
      weight *= y == 0 ? splineY.x : y == 1 ? splineY.y : splineY.z;
      vec3 density = weight * unpackDensity(shares[index].w);
      coarser += density * unpackColor(resolved[index].xy);
      found += density;
    }
  // The texel's density, which its parts have in them, is replaced by that of the pixel.
  vec3 part = parts.coarser / max(unpackDensity(shares[texel].w), vec3(1.0));
  vec3 own = sanitize(source.rgb);
  vec3 sum = parts.own * own + parts.narrow * f.narrow + parts.wide * f.wide + part * coarser;
  vec3 divisor = parts.own + parts.narrow * inRect.x + parts.wide * inRect.y + part * found;
  vec3 color = own;
  // Parts of filters may be below 0, but little.
  if (depth > 0.0) color = mix(own, max(sum, vec3(0.0)) / max(divisor, vec3(1.0e-6)), greaterThan(divisor, vec3(0.1)));
#ifdef GATHER
  if (someLight != 0u && depth > 0.0) color = withGathered(color, pixel, PELLUCID_DIFFUSE_CELL, depth, material);
#endif
  writeResult(pixel, color, source.a, pass.value.w != 0u);
}

// Four pixels below each other of texel `texel` of the window; `top`: the first; `place`: of it in wide[].
void diffuseColumn(ivec2 top, int texel, int place, uvec2 own[4], uvec4 alphas) {
  Parts parts = partsOf(shares[texel].xyz);
  vec3 coarser[3];
  coarserRows(texel, splineAt(top.x), coarser);
  vec4 result[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    vec3 smoothed = coarserAt(coarser, i);
    Filtered f = filtered(place + i * kColumns);
    vec3 color = parts.own * unpackColor(own[i]) + parts.narrow * f.narrow + parts.wide * f.wide;
    color += parts.coarser * smoothed;
    result[i] = vec4(max(color, vec3(0.0)), uintBitsToFloat(alphas[i]));
  }
  storeColumn(top, result);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 firstTexel = (ivec2(frame.rect.xy) >> 2) + ivec2(bordersFirst()) * kTexels;
  // All loads before the first barrier, so that a group waits for memory once.
  uvec4 texel = uvec4(0u), texelShares = uvec4(0u);
  if (invocation < kWindow.x * kWindow.y) {
    ivec2 at = firstTexel + ivec2(invocation % kWindow.x, invocation / kWindow.x) - 1;
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
  uvec2 pixels[kRows + 2 * kRing];
  uvec4 alphas = uvec4(0u);
  [[unroll]] for (int i = 0; i < kRows + 2 * kRing; ++i) {
    ivec2 pixel = first + ivec2(0, i - kRing), at = withinRect(pixel);
    vec4 source = texelFetch(sourceImage, at, 0);
    pixels[i] = packHalves(source.rgb, 0u);
    // Beyond the rect there is nothing.
    if (at != pixel) pixels[i] = uvec2(0u);
    if (i >= kRing && i < kRing + kRows) alphas[i - kRing] = floatBitsToUint(source.a);
  }
#ifdef GATHER
  if (invocation == 0) someLight = 0u;
#endif
  if (invocation == 0) anySurface = anyPartial = 0u;
  barrier();
  if (invocation < kWindow.x * kWindow.y) {
    resolved[invocation] = texel;
    shares[invocation] = texelShares;
    // Whoever writes, writes this.
    if (texel.y >> 16 != 0u) anySurface = 1u;
    if (hasSurface(texel) && (texelShares.w & kDensityBits) != kFullDensity) anyPartial = 1u;
  }
#ifdef GATHER
  uint light = hasPoint ? kindsOfLight(texel) : 0u;
  if (light != 0u) atomicOr(someLight, light);
#endif
  barrier();
  if (anySurface == 0u) return; // of all invocations
  [[unroll]] for (int i = 0; i < kRows; ++i) keepVertical((firstRow + i) * kColumns + column, pixels, i);
  barrier();
  int x = column - kRing;
  if (x < 0 || x >= 4 * kTexels.x) return;
  int inWindow = (firstRow / 4 + 1) * kWindow.x + x / 4 + 1;
  if (!hasSurface(resolved[inWindow]) || isSummed(shares[inWindow])) return;
  ivec2 top = 4 * firstTexel + ivec2(x, firstRow);
  int place = firstRow * kColumns + column;
  if (isPlane(resolved[inWindow]) && (anyPartial == 0u || isEvenAround(inWindow))) {
    uvec2 own[4];
    [[unroll]] for (int i = 0; i < 4; ++i) own[i] = pixels[i + kRing];
    diffuseColumn(top, inWindow, place, own, alphas);
  } else {
    for (int i = 0; i < int(pass.value.y); ++i) diffuseAtBorder(top + ivec2(0, i), inWindow, place + i * kColumns);
  }
}
