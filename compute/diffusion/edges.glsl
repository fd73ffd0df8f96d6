// Pixels of edges: texels of level 2 that are no plane, or whose neighbors are none. A pixel takes what lies on its surface.

// Fills edges[] and edgeCounts[].
void collectEdges(int invocation) {
  if (invocation >= kTexelsX * kTexelsY) return;
  ivec2 local = ivec2(invocation % kTexelsX, invocation / kTexelsX);
  int index = (local.y + 1) * kWindowX + local.x + 1;
  uvec4 its = upsampled[index];
  if (its.y >> 16 == 0u || isPlane(its)) return;
  bool full = isFull(shares[index]);
  int band = local.y / kBandRows;
  uint before = atomicAdd(edgeCounts[band], full ? 1u : 0x10000u);
  int place = full ? int(before & 0xFFFFu) : kBandTexels - 1 - int(before >> 16);
  edges[kBandTexels * band + place] = uint(local.x | local.y << 8);
}

// Prepares what all pixels of edges ask of a texel alike: its spread, and its shares without its kernel coverage, which the
// pixel's replaces. A plane's coverage is 1.
void prepareForEdges(int index) {
  uvec4 bits = upsampled[index];
  Texel t = unpackTexel(bits);
  spreads[index] = inverseSpread(t.slope, texelSize(t.depth, 2u));
  if (isPlane(bits)) return;
  PixelShares s = unpackShares(shares[index].xyz);
  vec3 coverage = unpackCoverage(shares[index].w) * (1.0 / kCoverageOne);
  s.coarser /= max(s.coarser + coverage * (1.0 - s.coarser), vec3(1.0e-6));
  // From a half on, shares are kept less 1: halves are too coarse near 1 for what is left of it.
  s.coarser = mix(s.coarser, min(s.coarser - 1.0, vec3(-6.0e-8)), greaterThan(s.coarser, vec3(0.5)));
  uvec3 packed = packShares(s);
  // Stores go one by one: a store of a part of a vector may store z and w, too, which others read meanwhile.
  shares[index].x = packed.x;
  shares[index].y = packed.y;
}

// The share as it was before prepareForEdges.
vec3 coarserOfEdge(vec3 coarser) { return mix(coarser, coarser + 1.0, lessThan(coarser, vec3(0.0))); }

// Keeps colors, materials and depths of a band's pixels with their ring, from pixel `first` on.
void keepBand(ivec2 first) {
  const int kEach = kBandPixels / kInvocations;
  uvec2 colors[kEach];
  float depths[kEach];
  // All loads come before the first use, so that their latencies overlap.
  [[unroll]] for (int i = 0; i < kEach; ++i) {
    int place = int(gl_LocalInvocationIndex) + i * kInvocations;
    ivec2 pixel = first + ivec2(place % kColumns, place / kColumns), at = withinRect(pixel);
    colors[i] = packColor(sanitize(texelFetch(sourceImage, at, 0).rgb), at == pixel ? materialAt(at) : 0u);
    depths[i] = frontDistance(at);
  }
  [[unroll]] for (int i = 0; i < kEach; ++i) {
    int place = int(gl_LocalInvocationIndex) + i * kInvocations;
    vertical[place] = colors[i];
    bandDepths[place] = depths[i];
  }
}

// The fine filter of a pixel on a surface of that slope; w: the part of its weight that lies on the surface. `place`: of the
// pixel in what keepBand kept; `wider`: FineShape's. The thin part is left to planes, as it makes edges no better.
vec4 fineOfEdge(int place, vec2 slope, vec2 size, float wider) {
  uint material = vertical[place].y >> 16;
  float own = bandDepths[place];
  vec2 depthStep = slope * size;
  float spread2 = inverseSpread(slope, 2.0 * size);
  vec3 columns = fineWeights(-wider), rows = fineWeights(wider);
  vec4 fine = vec4(0.0);
  for (int y = -2; y <= 2; ++y) {
    float weightY = weightAt(columns, y);
    // A row has no branch, so that latencies overlap.
    [[unroll]] for (int x = -2; x <= 2; ++x) {
      int at = place + y * kColumns + x;
      uvec2 packed = vertical[at];
      float theirs = bandDepths[at];
      float along = dot(depthStep, vec2(x, y));
      float w = tangentPlaneWeight(theirs - own - along, along, spread2, kPixelFalloff);
      bool counts = packed.y >> 16 == material && theirs > 0.0;
      fine += (counts ? w * weightAt(rows, x) * weightY : 0.0) * vec4(unpackHalves(packed), 1.0);
    }
  }
  return fine;
}

// Sums over the texels around a pixel.
struct Around {
  vec3 coarser, found;            // colors of level 2 and coarser ones, and how much of the kernel they fill
  vec3 coarserShare, fineShare;   // mean shares
  vec2 slope;
};

// `from`: the pixel from the center of its texel, pixels; `center`: that texel in upsampled[].
Around aroundPixel(int center, vec2 from, float depth, uint material, vec2 size) {
  Around a = Around(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec2(0.0));
  vec3 splineX = spline(0.25 * from.x), splineY = spline(0.25 * from.y);
  float weights = 0.0;
  // With gathered light, unrolling over a number that compilers know takes more registers than four groups have.
  int reach = kGathers ? int(pass.value.y) : 1;
  for (int y = -1; y <= 1; ++y) {
    float weightY = y < 0 ? splineY.x : y > 0 ? splineY.z : splineY.y;
    // A row has no branch, so that latencies overlap.
    for (int x = -1; x <= reach; ++x) {
      int index = center + y * kWindowX + x;
      Texel t = unpackTexel(upsampled[index]);
      float along = dot(t.slope, (from - 4.0 * vec2(x, y)) * size);
      float w = tangentPlaneWeight(depth - t.depth - along, along, spreads[index], kPixelFalloff);
      w *= weightY * (x < 0 ? splineX.x : x > 0 ? splineX.z : splineX.y);
      w = t.area != 0.0 && t.material == material ? w : 0.0;
      vec3 coverage = w * (1.0 / kCoverageOne) * unpackCoverage(shares[index].w);
      a.coarser += coverage * t.color;
      a.found += coverage;
      w *= min(t.area, 1.0);
      a.slope += w * t.slope;
      PixelShares s = unpackShares(shares[index].xyz);
      a.coarserShare += w * coarserOfEdge(s.coarser);
      a.fineShare += w * s.fine;
      weights += w;
    }
  }
  float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
  a.slope *= inverse;
  // Rounding must not take from the pixel what it does not have.
  a.coarserShare = min(a.coarserShare * inverse, vec3(1.0));
  // Without the fine filter the pixel itself has its share.
  a.fineShare *= kFine ? (1.0 - a.coarserShare) * inverse : vec3(0.0);
  return a;
}

// `local`: the pixel from the group's first one.
void diffuseEdge(ivec2 firstTexel, ivec2 local) {
  ivec2 pixel = 4 * firstTexel + local;
  int place = (local.y % (4 * kBandRows) + kRing) * kColumns + local.x + kRing;
  uint material;
  float depth;
  if (kFine) {
    material = vertical[place].y >> 16;
    depth = bandDepths[place];
  } else {
    material = insideRect(pixel) ? materialAt(pixel) : 0u;
    depth = frontDistance(withinRect(pixel));
  }
  if (material == 0u) return;
  vec4 source = texelFetch(sourceImage, pixel, 0);
  vec3 own = kFine ? unpackHalves(vertical[place]) : sanitize(source.rgb), color = own;
  if (depth > 0.0) {
    vec2 size = texelSize(depth, 0u);
    int center = (local.y / 4 + 1) * kWindowX + local.x / 4 + 1;
    Around a = aroundPixel(center, vec2(local & 3) - 1.5, depth, material, size);
    float wider = unpackShape(shares[center].z).wider;
    // Texels around may ask for more of a filter that counts the pixel more.
    a.fineShare = min(a.fineShare, (1.0 - a.coarserShare) * mostFine(wider));
    // Kernel coverage weights the shares. The pixel itself counts in the first and the second, so the divisor is 0 only where
    // the coarser levels have all of the share and none of it is there.
    vec3 ownShare = 1.0 - a.coarserShare - a.fineShare;
    vec3 sum = ownShare * own + a.coarserShare * a.coarser, divisor = ownShare + a.coarserShare * a.found;
    if (kFine) {
      uint shape = shares[center].z;
      vec4 fine = isFull(shares[center]) ? vec4(fineOfPlane(place, shape), 1.0)
                                         : fineOfEdge(place, a.slope, size, wider);
      sum += a.fineShare * fine.rgb;
      divisor += a.fineShare * fine.a;
    }
    color = mix(own, max(sum, vec3(0.0)) / max(divisor, vec3(1.0e-6)), greaterThan(divisor, vec3(1.0e-6)));
    if (kGathers && someLight != 0u) color = withGathered(color, pixel, PELLUCID_DIFFUSE_CELL, depth, material);
  }
  writeResult(pixel, color, source.a, pass.value.w != 0u);
}

// Follows diffusePlanes, which prepares the texels. For all invocations, as they wait for each other: no invocation has written
// edgeBands since the last barrier before, so that all of them loop alike.
void diffuseEdges(ivec2 firstTexel, int invocation) {
  for (uint bands = edgeBands; bands != 0u; bands &= bands - 1u) {
    int band = findLSB(bands), full = int(edgeCounts[band] & 0xFFFFu), count = full + int(edgeCounts[band] >> 16);
    if (kFine) {
      barrier(); // what was there has been read
      keepBand(4 * firstTexel + ivec2(-kRing, 4 * kBandRows * band - kRing));
      barrier();
    }
    // Sixteen invocations do a texel.
    ivec2 inTexel = ivec2(invocation & 3, invocation >> 2 & 3);
    for (int edge = invocation >> 4; edge < count; edge += kInvocations / 16) {
      int place = edge < full ? edge : kBandTexels - 1 - (edge - full);
      int texel = int(edges[kBandTexels * band + place]);
      diffuseEdge(firstTexel, 4 * ivec2(texel & 255, texel >> 8) + inTexel);
    }
  }
}
