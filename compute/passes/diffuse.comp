// The pixels' own shares of the profile plus the resolved pyramid's. Where a texel of level 2 lies on one plane with all
// around it, its 4 x 4 pixels are filtered without looking at their depths; the rest, edges, are collected and done a
// pixel an invocation.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "passes/resolved.glsl"
#ifdef NORMALS
#include "passes/normal_image.glsl"
#endif

const int kInvocations = PELLUCID_DIFFUSE_GROUP * PELLUCID_DIFFUSE_GROUP;
// NORMALS: pixels at edges count by the area of their surface.
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
shared uvec2 vertical[4 * kTexels.y * kColumns];   // colors after the fine filter's vertical half
#endif
shared uvec4 resolved[kWindow.x * kWindow.y];
shared uvec4 shares[kWindow.x * kWindow.y];
shared uint edges[kTexels.x * kTexels.y];
shared uint edgeCount, anySurface;

#ifdef GATHER
#include "passes/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_SHARED_POINTS) uniform utexture2D pointsImage;

// The points around all pixels. Cells are texels of level 2.
const ivec2 kPoints = kTexels + 1;

shared uint someLight; // kSome* of them

uvec4 pointBits(ivec2 cell) {
  return contains(cellsOf(frame.rect, PELLUCID_DIFFUSE_CELL), cell) ? texelFetch(pointsImage, cell, 0) : kNoPoint;
}

uvec4 pointOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  Point p = unpackPoint(pointBits(cell));
  vec4 plane = tangentPlane(p, pixelInCell(cell, PELLUCID_DIFFUSE_CELL, p.index), pixel);
  off = (front - plane.x) * plane.w;
  return uvec4(packLight(p.added, p.displaced), p.material);
}
#endif

// The quadratic B-spline at -1, 0 and 1 for a point at most half a texel from 0.
vec3 spline(float at) {
  return vec3(0.5 * (0.5 - at) * (0.5 - at), 0.75 - at * at, 0.5 * (0.5 + at) * (0.5 + at));
}

// The fine filter, 1 4 9 4 1 in each direction.
float fineWeight(int i) { return i == 0 ? 9.0 / 19.0 : abs(i) == 1 ? 4.0 / 19.0 : 1.0 / 19.0; }

vec3 fineSum(vec3 a, vec3 b, vec3 c, vec3 d, vec3 e) {
  return fineWeight(0) * c + fineWeight(1) * (b + d) + fineWeight(2) * (a + e);
}

#ifdef GATHER
// Four pixels below each other, a column of a cell, with what is linear between the four points around it. The cell and
// those around are one surface, so that points need no test.
void addLightOfPlane(ivec2 pixel, inout vec4 colors[4]) {
  ivec2 cell = pixel >> 2;
  float across = 0.25 * float(pixel.x & 3);
  uvec4 a = texelFetch(pointsImage, cell, 0), b = texelFetch(pointsImage, cell + ivec2(1, 0), 0);
  uvec4 c = texelFetch(pointsImage, cell + ivec2(0, 1), 0), d = texelFetch(pointsImage, cell + ivec2(1, 1), 0);
  vec3 added = mix(addedOf(a), addedOf(b), across), displaced = vec3(0.0);
  vec3 addedStep = 0.25 * (mix(addedOf(c), addedOf(d), across) - added), displacedStep = vec3(0.0);
  if ((someLight & kSomeDisplaced) != 0u) {
    displaced = mix(displacedOf(a), displacedOf(b), across);
    displacedStep = 0.25 * (mix(displacedOf(c), displacedOf(d), across) - displaced);
  }
  [[unroll]] for (int i = 0; i < 4; ++i)
    colors[i].rgb = withLight(colors[i].rgb, added + float(i) * addedStep, displaced + float(i) * displacedStep);
}
#endif

void store(ivec2 pixel, vec3 color, float alpha) {
  if (tinted(pass.value.w != 0u)) color = sanitize(color * albedoAt(pixel));
  imageStore(destinationImage, pixel, vec4(asStored(color), alpha));
}

#ifndef COARSE
// The fine filter, its vertical half done.
vec3 fineOf(int at) {
  return fineSum(unpackColor(vertical[at - 2]), unpackColor(vertical[at - 1]), unpackColor(vertical[at]),
                 unpackColor(vertical[at + 1]), unpackColor(vertical[at + 2]));
}

// The fine filter of a pixel on a surface of that slope, and what of it lies on the surface.
vec4 fineOfEdge(ivec2 pixel, uint material, float depth, vec2 slope, vec2 size) {
  vec2 depthStep = slope * size;
#ifdef NORMALS
  float area = areaOf(vec2(pixel), normalAt(pixel));
#endif
  float spread2 = inverseSpread(slope, 2.0 * size);
  vec4 fine = vec4(0.0);
  for (int y = -2; y <= 2; ++y) {
    // A row's loads at once, so that their latencies overlap.
    [[unroll]] for (int x = -2; x <= 2; ++x) {
      ivec2 offset = ivec2(x, y), at = withinRect(pixel + offset);
      uint theirs = materialAt(at);
      float theirDepth = frontDistance(at);
      vec3 theirColor = sanitize(texelFetch(sourceImage, at, 0).rgb);
      float along = dot(depthStep, vec2(offset));
      float w = sameSurface(theirDepth - depth - along, along, spread2, kPixelFalloff);
#ifdef NORMALS
      float theirArea = areaOf(vec2(at), normalAt(at));
      if (area > 0.0 && theirArea > 0.0) w *= theirArea / area;
#endif
      bool counts = at == pixel + offset && theirs == material && theirDepth > 0.0;
      fine += (counts ? w * fineWeight(x) * fineWeight(y) : 0.0) * vec4(theirColor, 1.0);
    }
  }
  return fine;
}
#endif

// A pixel of an edge, all weights by what lies on its surface. `local`: from the group's first pixel.
void diffuseEdge(ivec2 firstTexel, ivec2 local) {
  ivec2 pixel = 4 * firstTexel + local;
  uint material = insideRect(pixel) ? materialAt(pixel) : 0u;
  if (material == 0u) return;
  vec4 source = texelFetch(sourceImage, pixel, 0);
  vec3 color = sanitize(source.rgb);
  float depth = frontDistance(pixel);
  if (depth > 0.0) {
    vec2 size = texelSize(depth, 0u), slope = vec2(0.0);
    int center = (local.y / 4 + 1) * kWindow.x + local.x / 4 + 1;
    vec2 from = vec2(local & 3) - 1.5; // the texel's center, pixels
    vec3 splineX = spline(0.25 * from.x), splineY = spline(0.25 * from.y);
    vec3 coarser = vec3(0.0), found = vec3(0.0);
    PixelShares share = PixelShares(vec3(0.0), vec3(0.0));
    float weights = 0.0;
    for (int i = 0; i < 9; ++i) {
      ivec2 offset = ivec2(i % 3, i / 3) - 1;
      int index = center + offset.y * kWindow.x + offset.x;
      Texel t = unpackTexel(resolved[index]);
      if (t.mass == 0.0 || t.material != material) continue;
      float along = dot(t.slope, (from - 4.0 * vec2(offset)) * size);
      float spread2 = inverseSpread(t.slope, texelSize(t.depth, 2u));
      float w = sameSurface(depth - t.depth - along, along, spread2, kPixelFalloff);
      w *= (offset.x < 0 ? splineX.x : offset.x > 0 ? splineX.z : splineX.y) *
           (offset.y < 0 ? splineY.x : offset.y > 0 ? splineY.z : splineY.y);
      vec3 density = unpackDensity(shares[index].w) * (1.0 / kDensityOne);
      coarser += w * density * t.color;
      found += w * density;
      w *= min(t.mass, 1.0);
      slope += w * t.slope;
      PixelShares s = unpackShares(shares[index].xyz);
      // Without the texel's density: that of the pixel replaces it.
      share.coarser += w * s.coarser / max(s.coarser + density * (1.0 - s.coarser), vec3(1.0e-6));
      share.fine += w * s.fine;
      weights += w;
    }
    float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
    slope *= inverse;
    share.coarser *= inverse;
    vec3 fineShare = (1.0 - share.coarser) * share.fine * inverse;
    vec4 fine = vec4(0.0);
#ifndef COARSE
    // All pixels around are one plane where the texel is, though its neighbors are not.
    bool full = shares[center].w >> 24 != 0u;
    int at = local.y * kColumns + local.x + kRing;
    fine = full ? vec4(fineOf(at), 1.0) : fineOfEdge(pixel, material, depth, slope, size);
#endif
    // Shares are weighted with what of their filters was found. The pixel itself counts in the first and the second,
    // so the divisor is 0 only where all of the share is the coarser one's and none of it is there.
    vec3 own = 1.0 - share.coarser - fineShare;
    vec3 sum = own * color + fineShare * fine.rgb + share.coarser * coarser;
    vec3 divisor = own + fineShare * fine.a + share.coarser * found;
    color = mix(color, max(sum, vec3(0.0)) / max(divisor, vec3(1.0e-6)), greaterThan(divisor, vec3(1.0e-6)));
#ifdef GATHER
    if (someLight != 0u) color = withGathered(color, pixel, PELLUCID_DIFFUSE_CELL, depth, material);
#endif
  }
  store(pixel, color, source.a);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  // The rect's borders are edges, which take longest: first and last rows come in the middle, not at the end, where
  // nothing else would run beside them.
  uvec2 group = uvec2(gl_WorkGroupID.x, (gl_WorkGroupID.y + gl_NumWorkGroups.y / 2u) % gl_NumWorkGroups.y);
  ivec2 firstTexel = (ivec2(frame.rect.xy) >> 2) + ivec2(group) * kTexels;
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
  vec4 sources[kRows + 2 * kRing];
  [[unroll]] for (int i = 0; i < kRows + 2 * kRing; ++i)
    sources[i] = texelFetch(sourceImage, withinRect(first + ivec2(0, i - kRing)), 0);
#ifdef GATHER
  if (invocation == 0) someLight = 0u;
#endif
  if (invocation == 0) edgeCount = anySurface = 0u;
  barrier();
  if (invocation < kWindow.x * kWindow.y) {
    resolved[invocation] = texel;
    shares[invocation] = texelShares;
    if (texel.y >> 16 != 0u) anySurface = 1u; // whoever writes, writes this
  }
#ifdef GATHER
  uint light = hasPoint ? kindsOfLight(texel) : 0u;
  if (light != 0u) atomicOr(someLight, light);
#endif
  barrier();
  if (anySurface != 0u) {
    if (invocation < kTexels.x * kTexels.y) {
      ivec2 local = ivec2(invocation % kTexels.x, invocation / kTexels.x);
      uvec4 its = resolved[(local.y + 1) * kWindow.x + local.x + 1];
      if (its.y >> 16 != 0u && !isPlane(its)) edges[atomicAdd(edgeCount, 1u)] = uint(invocation);
    }
    uvec2 own[kRows]; // colors and alphas
    [[unroll]] for (int i = 0; i < kRows; ++i) {
      vec4 source = sources[i + kRing];
      own[i] = uvec2(packHalf2x16(source.rg), packHalf2x16(source.ba));
#ifndef COARSE
      vec3 sum = fineSum(sources[i].rgb, sources[i + 1].rgb, source.rgb, sources[i + 3].rgb, sources[i + 4].rgb);
      vertical[(firstRow + i) * kColumns + column] = uvec2(packHalf2x16(sum.rg), packHalf2x16(vec2(sum.b, 0.0)));
#endif
    }
    barrier();

    int x = column - kRing;
    if (x >= 0 && x < 4 * kTexels.x) {
      vec3 splineX = spline(0.25 * (float(x & 3) - 1.5));
      [[unroll]] for (int block = 0; block < kRows / 4; ++block) {
        int texelRow = firstRow / 4 + block;
        int index = texelRow * kWindow.x + x / 4;
        if (!isPlane(resolved[index + kWindow.x + 1])) continue;
        vec3 coarser[3];
        [[unroll]] for (int y = 0; y < 3; ++y) {
          int row = index + y * kWindow.x;
          coarser[y] = splineX.x * unpackColor(resolved[row].xy) + splineX.y * unpackColor(resolved[row + 1].xy) +
                       splineX.z * unpackColor(resolved[row + 2].xy);
        }
        PixelShares share = unpackShares(shares[index + kWindow.x + 1].xyz);
        vec4 result[4];
        [[unroll]] for (int i = 0; i < 4; ++i) {
          vec3 splineY = spline(0.25 * (float(i) - 1.5));
          vec3 smoothed = splineY.x * coarser[0] + splineY.y * coarser[1] + splineY.z * coarser[2];
          uvec2 packed = own[4 * block + i];
          vec2 blue = unpackHalf2x16(packed.y);
          vec3 color = vec3(unpackHalf2x16(packed.x), blue.x);
#ifndef COARSE
          color = mix(color, fineOf((4 * texelRow + i) * kColumns + column), share.fine);
#endif
          color = mix(color, smoothed, share.coarser);
          result[i] = vec4(color, blue.y);
        }
        // One branch for all pixels, as branches cost more than what is in them.
        ivec2 top = 4 * firstTexel + ivec2(x, 4 * texelRow);
#ifdef GATHER
        if (someLight != 0u) addLightOfPlane(top, result);
#endif
        if (tinted(pass.value.w != 0u))
          [[unroll]] for (int i = 0; i < 4; ++i)
            result[i].rgb = sanitize(result[i].rgb * albedoAt(top + ivec2(0, i)));
        [[unroll]] for (int i = 0; i < 4; ++i)
          imageStore(destinationImage, top + ivec2(0, i), vec4(asStored(result[i].rgb), result[i].a));
      }
    }
    for (int i = invocation; i < int(16u * edgeCount); i += kInvocations) {
      int edge = int(edges[i >> 4]), at = i & 15;
      diffuseEdge(firstTexel, 4 * ivec2(edge % kTexels.x, edge / kTexels.x) + ivec2(at & 3, at >> 2));
    }
  }
}
