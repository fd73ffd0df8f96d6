// Pixels of edges by the profile itself over distances in space: pixels around them one by one, others as clusters, coarser
// with their distance (Barnes and Hut 1986, on a grid). A group loads what its pixels need of one level after the other.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_EDGES_GROUP
#include "passes/normal_image.glsl"
#include "passes/resolved.glsl"
#include "lib/moments.glsl"
#include "passes/clusters.glsl"
#include "passes/surfaces.glsl"

#ifdef GATHER
#include "passes/shared_points.glsl"
#endif

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };
#include "passes/profile.glsl"

// A level sums what is under texels of the next coarser one so far to each side, where the finer level does not.
const int kAround = 2, kRows = 2 * kAround + 1, kWindow = 2 * kRows;
// Pixels of a tile, its texels of level 2, and pixels with all around them that are summed one by one: the largest window.
const int kPixels = PELLUCID_EDGES_GROUP, kTexels = kPixels / 4, kSide = kPixels + 4 * kAround;
const int kInvocations = kPixels * kPixels;
// Of clusters the largest window, of level 1, and what lies in a window of that side.
const int kClusterSide = 2 * (kTexels + 2 * kAround), kClusters = kClusterSide * kClusterSide;

// Pixels, then clusters of a level, then second ones of its texels: center, mm, and area, mm^2, of pixels with an axis; color and
// material. After the places of clusters, in halves, the sides of their surface and along each of them the moments of red, green
// and blue, in roots of the area; the last four in lasts[], which has the slope of pixels. All that a group holds decides how
// many run at a time, and is less than the 16 KB that every device has.
shared uvec4 places[kSide * kSide];
shared uvec2 colors[kSide * kSide];
shared uint lasts[kSide * kSide];
shared uint edges[PELLUCID_EDGES_TILES]; // of tiles, a bit for each texel
shared uint splits[2][kClusterSide]; // of the rows of a level, even or odd, a bit for each texel of two
shared uint coarsest, rough, splitLevels; // rough: a bit for each texel that is not summed by quads

const float kMostOff = 0.25;
#include "passes/by_quads.glsl"

// Window of a level around a tile.
struct Window {
  ivec2 first;
  int rows;
};

Window windowOf(uint level, ivec2 firstPixel) {
  ivec2 first = 2 * ((firstPixel >> int(level + 1u)) - kAround);
  int end = 2 * (((firstPixel.y + kPixels - 1) >> int(level + 1u)) + kAround + 1);
  return Window(first, end - first.y);
}

void add(inout Sums sums, uvec2 color, vec3 weight) {
  sums.color += weight * unpackColor(color);
  sums.weight += weight;
}

vec4 placeAt(int i) { return uintBitsToFloat(places[i]); }

int ownPlace(ivec2 local) { return (local.y + 2 * kAround) * kSide + local.x + 2 * kAround; }

void loadPixels(ivec2 firstPixel) {
  Window window = windowOf(0u, firstPixel);
  for (int i = int(gl_LocalInvocationIndex); i < kSide * window.rows; i += kInvocations) {
    ivec2 pixel = window.first + ivec2(i % kSide, i / kSide), at = withinRect(pixel);
    float depth = frontDistance(at), facing = pixelArea(depth);
    uint material = materialOf(pixel, depth);
    vec3 tilted = tilt(vec2(at), normalAt(at));
    float steep = length(tilted.xy), rise = steep * sqrt(facing) / frame.camera.range.w;
    vec2 toward = steep > 0.0 ? tilted.xy / steep : vec2(1.0, 0.0);
    vec3 center = pointAt(vec2(at), depth), axis = pointAt(vec2(at) + toward, depth + rise) - center;
    places[i] = floatBitsToUint(vec4(center, withAxis(facing * tilted.z, axisBits(axis))));
    lasts[i] = packHalf2x16(tilted.xy);
    colors[i] = packColor(sanitize(texelFetch(sourceImage, at, 0).rgb), material);
  }
}

// Sides of a texel's surface, mm, around `center`, which lies at `pixel`.
void sidesOf(vec2 pixel, vec3 center, vec2 slope, float side, out vec3 x, out vec3 y) {
  float depth = center.z / frame.camera.range.w;
  vec2 rise = slope * texelSize(depth, 0u) * side;
  x = pointAt(pixel + vec2(side, 0.0), depth + rise.x) - center;
  y = pointAt(pixel + vec2(0.0, side), depth + rise.y) - center;
}

// The slope of the pyramid's texel at a cluster of level 2 and coarser, if that is its surface.
vec2 slopeAt(uint level, ivec2 texel, uint material) {
  ivec2 place = level > 2u ? inAtlas(level, texel) : resolvedPlace(texel);
  uvec4 bits = texelFetch(pyramidImage, place, 0);
  return materialBits(bits) == material && hasSurface(bits) ? unpackHalf2x16(bits.w) : vec2(0.0);
}

uvec4 clusterBits(uint level, ivec2 texel) {
  return contains(clusterRect(level), texel) ? texelFetch(pyramidImage, clusterPlace(level, texel), 0) : uvec4(0u);
}

// Of two, the second.
uvec4 secondBits(uint level, ivec2 texel) { return texelFetch(pyramidImage, secondPlace(level, texel), 0); }

// A pixel's surface.
Part partOfPixel(ivec2 pixel, float depth) {
  ivec2 at = withinRect(pixel);
  vec3 tilted = tilt(vec2(at), normalAt(at));
  Part p;
  p.area = pixelArea(depth) * tilted.z;
  p.center = pointAt(vec2(at), depth);
  sidesOf(vec2(at), p.center, tilted.xy, 1.0, p.x, p.y);
  p.color = sanitize(texelFetch(sourceImage, at, 0).rgb);
  p.momentX = p.momentY = vec3(0.0);
  return p;
}

// The same of a cluster. `slope`: of the coarser texel.
Part partOfCluster(uint level, ivec2 texel, Cluster c, vec2 slope) {
  float side = exp2(float(level));
  vec2 pixel = pixelOf(level, texel) + side * c.center;
  Part p;
  p.area = c.mass * pixelArea(c.depth) * side * side;
  p.center = pointAt(pixel, c.depth);
  sidesOf(pixel, p.center, slope, side, p.x, p.y);
  p.color = c.color;
  p.momentX = c.momentX;
  p.momentY = c.momentY;
  return p;
}

void extendByCluster(inout Range range, uvec4 bits) {
  extend(range, isPlane(bits) ? uintBitsToFloat(bits.z) : clusterDepth(bits), hasSurface(bits) ? materialBits(bits) : 0u);
}

// Which of what lies under a texel is summed.
struct Which {
  Split split;
  bool second;
  vec3 point; // from which places are
};

void addPixel(inout PartSums sums, ivec2 pixel, Which w) {
  float depth = frontDistance(withinRect(pixel));
  if (belongs(w.split, w.second, depth, materialOf(pixel, depth))) addPart(sums, partOfPixel(pixel, depth), w.point);
}

void addBits(inout PartSums sums, uint level, ivec2 texel, uvec4 bits, vec2 slope, Which w) {
  Cluster c = isPlane(bits) ? clusterOfTexel(bits) : unpackCluster(bits);
  if (hasSurface(bits) && belongs(w.split, w.second, c.depth, c.material))
    addPart(sums, partOfCluster(level, texel, c, slope), w.point);
}

void keepCluster(int i, Part p, uint upper) {
  float scale = p.area > 0.0 ? inversesqrt(p.area) : 0.0;
  vec3 x = scale * p.x, y = scale * p.y;
  places[i] = floatBitsToUint(vec4(p.center, p.area));
  colors[i] = packColor(p.color, upper);
  places[kClusters + i] =
      uvec4(packHalf2x16(x.xy), packHalf2x16(vec2(x.z, y.x)), packHalf2x16(y.yz), packHalf2x16(p.momentX.xy));
  lasts[i] = packHalf2x16(vec2(p.momentX.z, p.momentY.x));
  lasts[kClusters + i] = packHalf2x16(p.momentY.yz);
}

// Whether a texel's are made of its pixels: of quads and, where it is two surfaces and has no quads, of level 2.
bool isOfPixels(uint level, ivec2 texel) { return level == 1u || (level == 2u && isSplit(clusterBits(2u, texel))); }

Range rangeOf(uint level, ivec2 texel) {
  Range range = kNoRange;
  if (isOfPixels(level, texel)) {
    int side = 1 << int(level);
    for (int i = 0; i < side * side; ++i) {
      ivec2 pixel = side * texel + ivec2(i % side, i / side);
      float depth = frontDistance(withinRect(pixel));
      extend(range, depth, materialOf(pixel, depth));
    }
  } else {
    for (int i = 0; i < 4; ++i) {
      ivec2 child = childOf(texel, i);
      uvec4 bits = clusterBits(level - 1u, child);
      extendByCluster(range, bits);
      if (isSplit(bits)) extendByCluster(range, secondBits(level - 1u, child));
    }
  }
  return range;
}

// How a texel is split, and a depth near it. Of levels with clusters it is known which are not.
Split splitAt(uint level, ivec2 texel, out float near) {
  if (level > 1u && level < pass.value.x) {
    uvec4 bits = clusterBits(level, texel);
    near = clusterDepth(bits);
    if (!isSplit(bits)) return Split(materialBits(bits), 0u, 0.0);
  }
  Range range = rangeOf(level, texel);
  near = range.material != 0u ? range.nearest : 0.0;
  return splitOf(range, level);
}

// A texel's only cluster, the first of two or the second, to keep at `i`. Returns whether there are two. Loops that are not
// unrolled leave registers for two groups at a time.
bool loadCluster(uint level, ivec2 texel, int i, bool second) {
  float near;
  Split split = splitAt(level, texel, near);
  Which w = Which(split, second, pointAt(pixelOf(level, texel), near));
  uint material = second ? split.second : split.first;
  PartSums sums = kNoParts;
  if (isOfPixels(level, texel)) {
    int side = 1 << int(level);
    [[dont_unroll]] for (int j = 0; j < side * side; ++j) addPixel(sums, side * texel + ivec2(j % side, j / side), w);
  } else {
    vec2 slope = second ? vec2(0.0) : slopeAt(level, texel, material);
    [[dont_unroll]] for (int j = 0; j < 8; ++j) {
      ivec2 child = childOf(texel, j >> 1);
      uvec4 bits = clusterBits(level - 1u, child);
      if ((j & 1) != 0) bits = isSplit(bits) ? secondBits(level - 1u, child) : uvec4(0u);
      addBits(sums, level - 1u, child, bits, slope, w);
    }
  }
  keepCluster(i, together(sums, w.point), material);
  return split.second != 0u;
}

// All that are alone or first, which says where there are two, or then the second ones in their places.
void loadClusters(uint level, ivec2 firstPixel, bool second) {
  Window window = windowOf(level, firstPixel);
  int invocation = int(gl_LocalInvocationIndex);
  uint parity = level & 1u;
  if (!second && invocation < kClusterSide) splits[1u - parity][invocation] = 0u; // for the next level
  for (int i = invocation; i < kClusterSide * window.rows; i += kInvocations) {
    ivec2 inWindow = ivec2(i % kClusterSide, i / kClusterSide);
    uint bit = 1u << inWindow.x;
    if (second && (splits[parity][inWindow.y] & bit) == 0u) continue;
    if (loadCluster(level, window.first + inWindow, i, second) && !second) {
      atomicOr(splits[parity][inWindow.y], bit);
      atomicOr(splitLevels, 1u << level);
    }
  }
}

// How far to each side long pixels are summed by quarters, and how many these are in a row; those next to the pixel all are.
const int kNear = 1, kNearRow = 2 * kNear + 1;

// Pixels around the one `local` from the tile's first, `pixel` of the image; `facing`: area of one that faces the camera.
void addPixels(inout Sums sums, ivec2 local, ivec2 pixel, Kernel k, vec3 center, float facing) {
  int first = (local.y & ~1) * kSide + (local.x & ~1);
  ivec2 near = 2 * kAround + (local & 1) - kNear; // the first of those below
  for (int y = 0; y < kWindow; ++y) {
    int skipped = y < near.y || y >= near.y + kNearRow ? 0 : kNearRow;
    for (int j = 0; j < kWindow - skipped; ++j) {
      int i = first + y * kSide + (j < near.x ? j : j + skipped);
      vec4 place = placeAt(i);
      uvec2 color = colors[i];
      vec3 weight = ofPixel(k, place, place.xyz - center, facing);
      add(sums, color, color.y >> 16 == k.m + 1u ? weight : vec3(0.0));
    }
  }
  for (int j = 0; j < kNearRow * kNearRow; ++j) {
    ivec2 to = ivec2(j % kNearRow, j / kNearRow) - kNear;
    int i = ownPlace(local + to);
    vec4 place = placeAt(i);
    uvec2 color = colors[i];
    if (to == ivec2(0) || color.y >> 16 != k.m + 1u) continue;
    vec3 offset = place.xyz - center;
    if (abs(to.x) + abs(to.y) > 1 && placeArea(place) < kLong * facing) {
      add(sums, color, ofPixel(k, place, offset, facing));
      continue;
    }
    vec3 x, y;
    sidesOf(vec2(pixel + to), place.xyz, unpackHalf2x16(lasts[i]), 1.0, x, y);
    add(sums, color, ofNeighbor(k, place, offset, facing, x, y));
  }
}

// Of the squared distance: how long clusters may be, squared, to second order. Longer ones lie beside the pixel.
const float kMostLength2 = 4.0;

void addCluster(inout Sums sums, int i, Kernel k, vec3 center) {
  vec4 place = placeAt(i);
  uvec2 color = colors[i];
  uvec4 bits = places[kClusters + i];
  vec2 two = unpackHalf2x16(bits.y), four = unpackHalf2x16(lasts[i]);
  vec3 x = vec3(unpackHalf2x16(bits.x), two.x), y = vec3(two.y, unpackHalf2x16(bits.z));
  vec3 momentX = vec3(unpackHalf2x16(bits.w), four.x), momentY = vec3(four.y, unpackHalf2x16(lasts[kClusters + i]));
  vec3 offset = place.xyz - center;
  float area = color.y >> 16 == k.m + 1u ? place.w : 0.0, distance2 = max(dot(offset, offset), 1.0e-30);
  vec2 along = vec2(dot(offset, x), dot(offset, y));
  float xx = dot(x, x), yy = dot(y, y), longest = area * max(xx, yy);
  Extent extent = Extent(area * dot(along, along) / distance2, area * (xx + yy));
  // Beside what is long the second order says too little.
  bool isLong = longest > kMostLength2 * distance2;
  vec4 axis = vec4((xx > yy ? x : y) * inversesqrt(max(max(xx, yy), 1.0e-30)), 0.5 * sqrt(longest));
  // The floor keeps what follows finite.
  float squared = max(isLong ? meanSquare(offset, axis, area * min(xx, yy)) : meanSquare(distance2, extent), 1.0e-6 * area);
  Profile profile = profileAt(k, squared);
  vec3 weight = area * meanOf(profile, squared, extent);
  // To first order each channel's light is where its moments say; the profile changes by 2 R' / R of r^2 times how much nearer
  // that is.
  vec3 nearer = (along.x * momentX + along.y * momentY) * (-2.0 * sqrt(area) / squared);
  sums.color += weight * max(1.0 + profile.fall * nearer, vec3(0.0)) * unpackColor(color);
  sums.weight += weight;
}

// Clusters around a texel that are summed for it, in runs of kRows.
struct Around {
  ivec2 first, odd; // the first of the window's kWindow x kWindow
};

Around aroundOf(uint level, ivec2 firstPixel, ivec2 texel) {
  return Around(2 * ((texel >> 1) - kAround) - windowOf(level, firstPixel).first, texel & 1);
}

// Of a run: where its row begins and its middle one lies, and how many columns are left out before those after that.
struct Run {
  ivec2 first;
  int middle, skipped;
};

// Beside the kRows x kRows texels that the finer level does are kAround rows before them and one more after them, or the other
// way round: two runs each. Then what is left and right of them.
Run runOf(Around a, int run) {
  const int kAfter = 3 * kAround + 1;
  bool beside = run < 2 * kRows;
  int row = run >> 1, outer = row < kAround ? row : row > kAround ? row + kRows : a.odd.y == 0 ? kAfter : kAround;
  ivec2 first = a.first + ivec2(beside && (run & 1) != 0 ? kRows : 0, beside ? outer : run - 2 * kRows + kAround + a.odd.y);
  return Run(first, beside || a.odd.x != 0 ? kAround : kAfter, beside ? 0 : kRows);
}

int columnOf(Run r, int j) { return r.first.x + (j < kAround ? j : j > kAround ? j + r.skipped : r.middle); }

// Runs from number `from` on, every `step`th.
void addClusters(inout Sums sums, Around a, Kernel k, vec3 center, int from, int step) {
  for (int i = from; i < 3 * kRows; i += step) {
    Run run = runOf(a, i);
    int first = run.first.y * kClusterSide;
    // At once, so that their latencies overlap.
    [[unroll]] for (int j = 0; j < kRows; ++j) addCluster(sums, first + columnOf(run, j), k, center);
  }
}

// The second of two of those.
void addSeconds(inout Sums sums, uint level, Around a, Kernel k, vec3 center, int from, int step) {
  const int kRuns = 6; // whose clusters have a bit each
  for (int begin = from; begin < 3 * kRows; begin += kRuns * step) {
    uint bits = 0u;
    for (int i = 0; i < kRuns && begin + i * step < 3 * kRows; ++i) {
      Run run = runOf(a, begin + i * step);
      uint row = splits[level & 1u][run.first.y];
      for (int j = 0; j < kRows; ++j) bits |= (row >> columnOf(run, j) & 1u) << (i * kRows + j);
    }
    // As often as some invocation has any, wherever they are.
    for (; bits != 0u; bits &= bits - 1u) {
      int bit = findLSB(bits);
      Run run = runOf(a, begin + bit / kRows * step);
      addCluster(sums, run.first.y * kClusterSide + columnOf(run, bit % kRows), k, center);
    }
  }
}

// The coarsest level whose window holds most of the radius.
uint lastLevel(Kernel k, float facing) {
  float level = ceil(log2(max(0.8 * kernels[k.m].reach.x * inversesqrt(facing) / float(2 * kAround), 1.0)));
  return uint(clamp(level, 1.0, float(pass.value.x)));
}

// Pixels of a tile's edges; a bit for each of its texels says which are.
void diffuseTile(ivec2 firstPixel, uint edgeTexels) {
  int invocation = int(gl_LocalInvocationIndex);
  if (invocation == 0) coarsest = rough = splitLevels = 0u;
  if (invocation < 2 * kClusterSide) splits[invocation / kClusterSide][invocation % kClusterSide] = 0u;
  // 16 invocations to a texel, so that those without one are whole subgroups.
  for (int before = invocation / 16; before > 0; --before) edgeTexels &= edgeTexels - 1u;
  bool isEdge = edgeTexels != 0u;
  int texel = max(findLSB(edgeTexels), 0), inTexel = invocation % 16;
  ivec2 local = 4 * ivec2(texel % kTexels, texel / kTexels) + ivec2(inTexel % 4, inTexel / 4), pixel = firstPixel + local;
  ivec2 at = withinRect(pixel);
  float depth = frontDistance(at);
  uint material = materialOf(pixel, depth);
  vec3 center = pointAt(vec2(at), depth), ofQuad = center;
  places[invocation] = uvec4(floatBitsToUint(center), material);
  barrier();
  Kernel k = kernelOf(material);
  bool diffuses = isEdge && material != 0u && kernels[k.m].reach.x > 0.0;
  uint last = 0u, lastOfTexel = 0u; // of the levels that are summed
  if (diffuses) {
    float facing = max(pixelArea(depth), 1.0e-30);
    last = lastLevel(k, facing);
    atomicMax(coarsest, last);
  }
  if (isEdge) {
    vec3 quads[4];
    quadsOf(invocation - inTexel, quads);
    vec4 parts = ofQuads(local & 3);
    vec3 mean = 0.25 * (quads[0] + quads[1] + quads[2] + quads[3]);
    vec3 off = parts.x * quads[0] + parts.y * quads[1] + parts.z * quads[2] + parts.w * quads[3] - center;
    float facing = max(pixelArea(mean.z / frame.camera.range.w), 1.0e-30);
    ofQuad = quadAt(quads, local & 3);
    bool isSmooth = places[invocation - inTexel].w == material && dot(off, off) < kMostOff * facing;
    if (!isSmooth) atomicOr(rough, 1u << texel);
    lastOfTexel = diffuses && isSmooth ? lastLevel(k, facing) : 0u;
    atomicMax(coarsest, lastOfTexel);
  }
  barrier();
  uint levels = coarsest;
  bool byQuads = (rough >> texel & 1u) == 0u;
  if (byQuads) last = lastOfTexel;
  Sums sums = Sums(vec3(0.0), vec3(0.0));
  // Pixels last, so that only one of the sums is kept while others are made.
  for (uint level = levels; level > 0u; --level) {
    if (level == 1u) exchange(sums, invocation, byQuads);
    bool shares = level > 1u && byQuads;
    Around around = aroundOf(level, firstPixel, pixel >> int(level));
    int from = shares ? (local.x & 1) + 2 * (local.y & 1) : 0, step = shares ? 4 : 1;
    loadClusters(level, firstPixel, false);
    barrier();
    if (level <= last) addClusters(sums, around, k, shares ? ofQuad : center, from, step);
    barrier();
    if ((splitLevels >> level & 1u) == 0u) continue; // of all invocations
    loadClusters(level, firstPixel, true);
    barrier();
    if (level <= last) addSeconds(sums, level, around, k, shares ? ofQuad : center, from, step);
    barrier();
  }
  loadPixels(firstPixel);
  barrier();
  if (diffuses) {
    int own = ownPlace(local);
    vec3 x, y;
    sidesOf(vec2(pixel), center, unpackHalf2x16(lasts[own]), 1.0, x, y);
    add(sums, colors[own], ownPart(k, 0.5 * x, 0.5 * y));
    addPixels(sums, local, pixel, k, center, max(pixelArea(depth), 1.0e-30));
  }
  barrier();
  if (isEdge && insideRect(pixel) && materialAt(pixel) != 0u) {
    vec4 color = texelFetch(sourceImage, pixel, 0);
    // Of what is found, the pixel itself has a weight. Those that diffuse nothing keep their color.
    color.rgb = diffuses ? sums.color / max(sums.weight, vec3(1.0e-20)) : sanitize(color.rgb);
#ifdef GATHER
    if (material != 0u)
      color.rgb = withGathered(color.rgb, pixel, PELLUCID_DIFFUSE_CELL, depth, material);
#endif
    writeResult(pixel, color.rgb, color.a, pass.value.w != 0u);
  }
}

// The first pixel of a group's tiles, which lie far from each other so that all groups have as much to do.
ivec2 tileOf(uint i) {
  uvec2 tile = uvec2(gl_WorkGroupID.x, gl_WorkGroupID.y + i * gl_NumWorkGroups.y);
  return 4 * (ivec2(frame.rect.xy) >> 2) + kPixels * ivec2(tile);
}

void main() {
  if (texelFetch(pyramidImage, summedPlace(), 0).x == 0u) return; // of all invocations
  uint invocation = gl_LocalInvocationIndex;
  if (invocation < uint(PELLUCID_EDGES_TILES)) edges[invocation] = 0u;
  barrier();
  uint tile = invocation / uint(kTexels * kTexels), inTile = invocation % uint(kTexels * kTexels);
  if (tile < uint(PELLUCID_EDGES_TILES)) {
    ivec2 texel = (tileOf(tile) >> 2) + ivec2(inTile % uint(kTexels), inTile / uint(kTexels));
    if (contains(levelRect(2u), texel) && isSummed(texelFetch(pyramidImage, sharesPlace(texel), 0)))
      atomicOr(edges[tile], 1u << inTile);
  }
  barrier();
  for (uint i = 0u; i < uint(PELLUCID_EDGES_TILES); ++i)
    if (edges[i] != 0u) diffuseTile(tileOf(i), edges[i]);
}
