// Blends the pixels' own shares of the profile with a fine filter of their neighbors and with the upsampled pyramid, and adds the
// light of the probes. A group does 32 x 16 pixels. Texels of level 2 that lie on a plane have their 4 x 4 pixels filtered without
// a look at depths. The rest, edges, are collected and done a pixel an invocation: a pixel takes what lies on its surface.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#define GROUP_ROWS (PELLUCID_BLOCK_GROUP / 2)
#include "diffusion/texel.glsl"
#include "frame/lists.glsl"
#include "gather/probe.glsl"

layout(push_constant) uniform Pass { DiffusePass pass; };
layout(set = 0, binding = PELLUCID_BINDING_FILTERED_PROBES) uniform utexture2D filteredProbesImage;

const int kInvocations = GROUP_SIDE * GROUP_ROWS, kPixelsX = PELLUCID_DIFFUSE_COLUMNS, kPixelsY = PELLUCID_DIFFUSE_ROWS;
const int kTexelsX = kPixelsX / 4, kTexelsY = kPixelsY / 4; // of level 2
// Texels with one around, pixels with two.
const int kWindowX = kTexelsX + 2, kWindowY = kTexelsY + 2, kRing = 2;
const int kColumns = kPixelsX + 2 * kRing, kRows = kPixelsY + 2 * kRing;
const int kLoads = (kColumns * kRows + kInvocations - 1) / kInvocations;

shared uvec2 colors[kColumns * kRows];   // and alphas, as halves
// Vertical sums of the fine filter, from the group's first row of pixels on. Afterwards, where there are edges, bits of the depth and
// the material, from the ring's first row on.
shared uvec2 surfaces[kColumns * kRows];
shared uvec4 upsampled[kWindowX * kWindowY], shares[kWindowX * kWindowY];
shared float spreads[kWindowX * kWindowY]; // inverseSpread of upsampled[]
shared uint edges[kTexelsX * kTexelsY];    // columns and, from bit 8 on, rows of texels
shared uint edgeCount;

// The invocation's i-th pixel of the group, counted from the ring's first one.
ivec2 loaded(int i) {
  int at = int(gl_LocalInvocationIndex) + i * kInvocations;
  return ivec2(at % kColumns, at / kColumns);
}

float depthAt(int place) { return uintBitsToFloat(surfaces[place].x); }

// The quadratic B-spline at -1, 0 and 1 for a point at most half a texel from 0. It spreads level 2 by a variance of 1/4.
vec3 spline(float at) {
  return vec3(0.5 * (0.5 - at) * (0.5 - at), 0.75 - at * at, 0.5 * (0.5 + at) * (0.5 + at));
}

float fineWeight(int i) { return i == 0 ? PELLUCID_FINE_OWN : abs(i) == 1 ? PELLUCID_FINE_NEXT : PELLUCID_FINE_LAST; }

// ---- Light of the probes

// The diffused irradiance with the light that probes found.
vec3 withLight(vec3 diffused, vec3 added, vec3 returned) { return sanitize(diffused + diffused * returned + added); }

// Adds light to a column of four pixels, linear between the probes around each. All around is one surface, so that probes need no
// test. `side`: pixels of a cell.
void addProbesToPlane(ivec2 top, int side, inout vec3 column[4]) {
  float perSide = 1.0 / float(side), across = perSide * float(top.x & (side - 1));
  vec3 added, addedStep, returned, returnedStep;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    int row = i & (side - 1);
    if (row == 0) { // a cell begins
      ivec2 cell = ((top + ivec2(0, i)) >> shiftOf(side)) + ivec2(0, frame.lattice.w);
      uvec4 a = texelFetch(filteredProbesImage, cell, 0), b = texelFetch(filteredProbesImage, cell + ivec2(1, 0), 0);
      uvec4 c = texelFetch(filteredProbesImage, cell + ivec2(0, 1), 0), d = texelFetch(filteredProbesImage, cell + ivec2(1, 1), 0);
      added = mix(addedOf(a), addedOf(b), across);
      addedStep = perSide * (mix(addedOf(c), addedOf(d), across) - added);
      returned = mix(returnedOf(a), returnedOf(b), across);
      returnedStep = perSide * (mix(returnedOf(c), returnedOf(d), across) - returned);
    }
    column[i] = withLight(column[i], added + float(row) * addedStep, returned + float(row) * returnedStep);
  }
}

// A pixel that is half of its side off a probe's tangent plane is not of the probe's surface: the plane crosses another pixel.
const float kHalvesPerPixel = 2.0;

// Halves of a pixel from a probe's tangent plane to a surface at `front` in a pixel.
float offPlane(ProbePlace p, ivec2 probePixel, ivec2 pixel, float front) {
  Camera c = frame.camera;
  vec2 sideX = c.rayX.zw + p.front * c.rayX.xy, sideY = c.rayY.zw + p.front * c.rayY.xy;
  // The limit gives planes that are seen edge-on a slope, that of the largest area.
  float facing = min(dot(p.normal, viewRay(c, probePixel).direction), -1.0 / kMostArea);
  vec2 steps = -vec2(dot(p.normal.xy, sideX), dot(p.normal.xy, sideY)) / facing;
  // Pixels have a size in front of the eye.
  float perSide = inversesqrt(max(dot(sideX, sideX), 1.0e-30));
  return (front - p.front - dot(steps, vec2(pixel - probePixel))) * -facing * kHalvesPerPixel * perSide;
}

// Adds what is linear between the four probes around the pixel, as far as they are of its material and it lies on their planes.
vec3 withProbes(vec3 diffused, ivec2 pixel, int side, float front, uint material) {
  float total = 0.0;
  vec3 added = vec3(0.0), returned = vec3(0.0);
  vec2 fraction = vec2(pixel & (side - 1)) / float(side);
  uvec4 probes[4];
  [[unroll]] for (int i = 0; i < 4; ++i) probes[i] = probeOf(filteredProbesImage, (pixel >> shiftOf(side)) + ivec2(i & 1, i >> 1), side, frame.lattice.w);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1), cell = (pixel >> shiftOf(side)) + corner;
    vec2 linear = mix(1.0 - fraction, fraction, vec2(corner));
    ProbePlace p = unpackPlace(probes[i]);
    if (p.material != material) continue;
    float off = offPlane(p, pixelInCell(cell, side, p.index), pixel, front);
    // The floors keep the sum above 0: where no probe is of this surface, all four count by nearness.
    float weight = (exp2(-off * off) + 1.0e-4) * (linear.x * linear.y + 1.0e-4);
    added += weight * addedOf(probes[i]);
    returned += weight * returnedOf(probes[i]);
    total += weight;
  }
  // The cell's own probe is of its material, unless the cell has several.
  return total > 0.0 ? withLight(diffused, added / total, returned / total) : diffused;
}

// ---- Planes

// Puts vertical sums of the fine filter, which is separable, into surfaces[]: an invocation sums four pixels of a column.
void sumColumns() {
  for (int at = int(gl_LocalInvocationIndex); at < kColumns * kTexelsY; at += kInvocations) {
    int place = at % kColumns + 4 * (at / kColumns) * kColumns;
    vec3 rows[8];
    [[unroll]] for (int y = 0; y < 8; ++y) rows[y] = unpackHalves(colors[place + y * kColumns]);
    [[unroll]] for (int i = 0; i < 4; ++i) {
      vec3 sum = PELLUCID_FINE_OWN * rows[i + 2] + PELLUCID_FINE_NEXT * (rows[i + 1] + rows[i + 3]) +
                 PELLUCID_FINE_LAST * (rows[i] + rows[i + 4]);
      surfaces[place + i * kColumns] = packHalves(roundToHalf(sum), 0u);
    }
  }
}

// Diffuses the invocation's column of four pixels, which is part of a plane. `texel`: in the window.
void diffusePlane(ivec2 first, ivec2 local, int texel) {
  vec3 result[4], fine[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    int place = (local.y + i) * kColumns + local.x + kRing;
    result[i] = unpackHalves(colors[place + kRing * kColumns]);
    fine[i] = PELLUCID_FINE_OWN * unpackHalves(surfaces[place]) +
              PELLUCID_FINE_NEXT * (unpackHalves(surfaces[place - 1]) + unpackHalves(surfaces[place + 1])) +
              PELLUCID_FINE_LAST * (unpackHalves(surfaces[place - 2]) + unpackHalves(surfaces[place + 2]));
  }
  vec3 across = spline(0.25 * (float(local.x & 3) - 1.5)), level2[3]; // at the column, in three rows of texels
  [[unroll]] for (int y = 0; y < 3; ++y) {
    int row = texel + (y - 1) * kWindowX;
    level2[y] = across.x * unpackHalves(upsampled[row - 1].xy) + across.y * unpackHalves(upsampled[row].xy) +
                across.z * unpackHalves(upsampled[row + 1].xy);
  }
  PixelShares share = unpackShares(shares[texel].xyz);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    vec3 along = spline(0.25 * (float(i) - 1.5));
    vec3 coarser = along.x * level2[0] + along.y * level2[1] + along.z * level2[2];
    result[i] = share.rest * mix(result[i], fine[i], share.fine) + (1.0 - share.rest) * coarser; // mix may round
  }
  if (pass.spacing != 0u) addProbesToPlane(first + local, int(pass.spacing), result);
  // All pixels share a branch, so that the latencies of their loads overlap.
  bool last = pass.last != 0u;
  ivec2 top = first + local;
  vec4 written[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    int place = (local.y + i + kRing) * kColumns + local.x + kRing;
    written[i] = vec4(sanitize(result[i]), unpackHalf2x16(colors[place].y).y);
  }
  if (hasFlag(PELLUCID_FLAG_WIDE_OUTPUT)) // keeps what halves round
    [[unroll]] for (int i = 0; i < 4; ++i) written[i].a = texelFetch(sourceImage, inImage(top + ivec2(0, i)), 0).a;
  if (tinted(last))
    [[unroll]] for (int i = 0; i < 4; ++i) written[i].rgb = sanitize(written[i].rgb * albedoAt(inImage(top + ivec2(0, i))));
  if (adds(last))
    [[unroll]] for (int i = 0; i < 4; ++i) written[i] = onHeld(inImage(top + ivec2(0, i)), written[i].rgb);
  [[unroll]] for (int i = 0; i < 4; ++i) imageStore(destinationImage, inImage(top + ivec2(0, i)), vec4(asStored(written[i].rgb, last), written[i].a));
}

// ---- Edges: texels of level 2 that are no plane, or whose neighbors are none

// Sums over the texels around a pixel.
struct Around {
  vec3 coarser, found;  // colors of level 2 and coarser ones, and how much of the kernel they fill
  vec3 share, fine;     // mean shares: of level 2 and coarser ones, and of the rest the fine filter's
  vec2 slope;
};

// `from`: the pixel from the center of its texel, pixels; `center`: that texel in the window.
Around aroundPixel(int center, vec2 from, float depth, uint material, vec2 size, vec2 ray) {
  Around a = Around(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0));
  vec3 splineX = spline(0.25 * from.x), splineY = spline(0.25 * from.y);
  float weights = 0.0;
  [[dont_unroll]] for (int i = 0; i < 9; ++i) {
    ivec2 at = ivec2(i % 3, i / 3) - 1;
    int index = center + at.y * kWindowX + at.x;
    Texel t = unpackTexel(upsampled[index]);
    vec2 x = (from - 4.0 * vec2(at)) * size;
    float w = tangentPlaneWeight(tangentPlane(t.slope, ray, spreads[index]), depth - t.depth - dot(t.slope, x), x, kPixelFalloff);
    w *= (at.y < 0 ? splineY.x : at.y > 0 ? splineY.z : splineY.y) * (at.x < 0 ? splineX.x : at.x > 0 ? splineX.z : splineX.y);
    w = t.area != 0.0 && t.material == material ? w : 0.0;
    vec3 coverage = w * (1.0 / kCoverageOne) * unpackCoverage(shares[index].w);
    a.coarser += coverage * t.color;
    a.found += coverage;
    w *= min(t.area, 1.0);
    a.slope += w * t.slope;
    PixelShares s = unpackShares(shares[index].xyz);
    a.share += w * (1.0 - s.rest); // exactly 0 without diffusion
    a.fine += w * s.fine;
    weights += w;
  }
  float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
  a.slope *= inverse;
  a.share *= inverse;
  a.fine *= inverse;
  return a;
}

// The fine filter of a pixel on a surface of that slope; w: the part of its weight that lies on the surface. `place`: of the pixel
// in colors[].
vec4 fineOfEdge(int place, vec2 slope, vec2 size, vec2 ray) {
  uint material = surfaces[place].y;
  float own = depthAt(place);
  TangentPlane plane = tangentPlane(slope, ray, inverseSpread(slope, ray, 2.0 * size));
  vec4 fine = vec4(0.0);
  [[dont_unroll]] for (int y = -2; y <= 2; ++y)
    // A row has no branch, so that latencies overlap.
    [[unroll]] for (int x = -2; x <= 2; ++x) {
      int at = place + y * kColumns + x;
      vec2 step = vec2(x, y) * size;
      float theirs = depthAt(at);
      float w = tangentPlaneWeight(plane, theirs - own - dot(slope, step), step, kPixelFalloff) * fineWeight(x) * fineWeight(y);
      bool counts = surfaces[at].y == material && theirs > 0.0;
      fine += (counts ? w : 0.0) * vec4(unpackHalves(colors[at]), 1.0);
    }
  return fine;
}

void diffuseEdge(ivec2 first, ivec2 local) {
  ivec2 pixel = first + local;
  int place = (local.y + kRing) * kColumns + local.x + kRing;
  uint material = surfaces[place].y;
  if (material == 0u) return;
  float depth = depthAt(place);
  vec3 own = unpackHalves(colors[place]), color = own;
  if (depth > 0.0) {
    vec2 size = texelSize(depth, 0u), ray = facingRayAt(vec2(pixel));
    Around a = aroundPixel((local.y / 4 + 1) * kWindowX + local.x / 4 + 1, vec2(local & 3) - 1.5, depth, material, size, ray);
    vec4 fine = fineOfEdge(place, a.slope, size, ray);
    // Kernel coverage weights the shares. The pixel itself counts in the first and the second, so the divisor is 0 only where
    // the coarser levels have all of the share and none of it is there.
    vec3 rest = 1.0 - a.share, fineShare = rest * a.fine, ownShare = rest - fineShare;
    vec3 sum = ownShare * own + fineShare * fine.rgb + a.share * a.coarser;
    vec3 divisor = ownShare + fineShare * fine.a + a.share * a.found;
    color = mix(own, max(sum, vec3(0.0)) / max(divisor, vec3(1.0e-6)), greaterThan(divisor, vec3(1.0e-6)));
    if (pass.spacing != 0u) color = withProbes(color, pixel, int(pass.spacing), depth, material);
  }
  writeResult(inImage(pixel), color, texelFetch(sourceImage, inImage(pixel), 0).a, pass.last != 0u);
}

// Keeps materials and depths of the group's pixels with their ring.
void keepEdges(ivec2 first) {
  uint materials[kLoads];
  float fronts[kLoads];
  // All loads come before the first use, so that their latencies overlap.
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 pixel = first + loaded(i) - kRing, at = withinRect(pixel);
    materials[i] = at == pixel ? materialAt(inImage(at)) : 0u;
    fronts[i] = frontDistance(inImage(at));
  }
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    ivec2 at = loaded(i);
    if (at.y >= kRows) continue;
    surfaces[at.y * kColumns + at.x] = uvec2(floatBitsToUint(fronts[i]), materials[i]);
  }
}

// Diffuses the pixels from `first` on, for all invocations, as they wait for each other.
void diffuse(ivec2 first) {
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 inWindow = ivec2(invocation % kWindowX, invocation / kWindowX), texel = (first >> 2) + inWindow - 1;
  uvec4 bits = uvec4(0u), texelShares = uvec4(0u);
  ivec4 touched = touchedTexels(2u);
  if (inWindow.y < kWindowY && contains(levelRect(2u), texel)) {
    bits = texelFetch(pyramidImage, upsampledPlace(texel), 0);
    texelShares = texelFetch(pyramidImage, sharesPlace(texel), 0);
  }
  vec4 sources[kLoads];
  [[unroll]] for (int i = 0; i < kLoads; ++i) sources[i] = texelFetch(sourceImage, inImage(withinRect(first + loaded(i) - kRing)), 0);
  if (invocation == 0) edgeCount = 0u;
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    vec3 color = roundToHalf(sanitize(sources[i].rgb));
    if (loaded(i).y < kRows)
      colors[loaded(i).y * kColumns + loaded(i).x] = uvec2(packHalf2x16(color.rg), packHalf2x16(vec2(color.b, sources[i].a)));
  }
  barrier();
  if (inWindow.y < kWindowY) {
    upsampled[invocation] = bits;
    shares[invocation] = texelShares;
    spreads[invocation] = inverseSpread(unpackHalf2x16(bits.w), facingRayAt(pixelOf(2u, texel)), texelSize(uintBitsToFloat(bits.z), 2u));
    ivec2 inside = inWindow - 1;
    if (contains(ivec4(0, 0, kTexelsX, kTexelsY), inside) && contains(touched, (first >> 2) + inside) && bits.y >> 16 != 0u && !isPlane(bits))
      edges[atomicAdd(edgeCount, 1u)] = uint(inside.x | inside.y << 8);
  }
  sumColumns();
  barrier();
  uint count = edgeCount;
  ivec2 column = ivec2(invocation % kPixelsX, invocation / kPixelsX * 4);
  int center = (column.y / 4 + 1) * kWindowX + column.x / 4 + 1;
  if (isPlane(upsampled[center]) && contains(touched, (first + column) >> 2)) diffusePlane(first, column, center);
  barrier(); // keepEdges writes over the sums
  if (count != 0u) keepEdges(first);
  barrier();
  // Sixteen invocations do a texel.
  ivec2 inTexel = ivec2(invocation & 3, invocation >> 2 & 3);
  for (uint edge = uint(invocation) >> 4; edge < count; edge += uint(kInvocations) / 16u)
    diffuseEdge(first, 4 * ivec2(edges[edge] & 255u, edges[edge] >> 8) + inTexel);
}

// Empties the lists: a recording may run more than once. This pass is the last that goes by them, and its command has been read.
void emptyLists() {
  uint invocation = gl_LocalInvocationIndex, words = counterWords() + lists.maps.x * uint(PELLUCID_ENTRY_GROUP_WORDS);
  if (invocation < uint(PELLUCID_LISTS)) {
    lists.commands[invocation].ran.x = lists.commands[invocation].groups.x;
    lists.commands[invocation].groups.x = 0u;
  }
  for (uint i = counterWords() + invocation; i < words; i += uint(kInvocations)) listWords[i] = 0u;
}

void main() {
  if (goesByLists() && gl_WorkGroupID.xy == uvec2(0u)) emptyLists();
  ivec2 first;
  if (materialPart(ivec2(kPixelsX, kPixelsY), first)) diffuse(first);
}
