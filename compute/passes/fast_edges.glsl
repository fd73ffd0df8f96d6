// Edges by the profile itself over distances in space, as where they are summed best (passes/diffuse_edges.comp) but with less to
// do for each pixel: sources are the pixels of 3 x 3 quads around a pixel's own, quads of 3 x 3 texels of level 2, 4 x 4 pixels of
// 5 x 5 texels of level 3, and beyond that texels of the pyramid. What is near is not filtered, as light would count in two of
// them. Of the including pass: places[], colors[] and depths[] of kSources, in shared memory, and kernels[].
#ifndef PELLUCID_FAST_EDGES_GLSL
#define PELLUCID_FAST_EDGES_GLSL

#include "passes/normal_image.glsl"
#include "passes/clusters.glsl"
#include "passes/profile.glsl"
#include "passes/surfaces.glsl"

// As far as windows of level 2 have what is next to them: errors are the same with any less.
const float kMostOff = 16.0;
#include "passes/by_quads.glsl"

// After a level's own texel those of so many coarser ones to each side are summed, in squares.
const int kTile = PELLUCID_EDGES_GROUP, kInvocations = kTile * kTile, kTexels = kTile / 4;
const int kRing = 4, kSide = kTile + 2 * kRing, kQuadSide = kSide / 2; // of pixels and their quads
const int kAround = 2, kWindow = 2 * (2 * kAround + 1), kSecondSide = kWindow + 2;
const int kSecond = kSecondSide * kSecondSide, kCoarser = kWindow * kWindow; // of level 2 and of each from 3 on
const int kLastSummed = PELLUCID_LAST_LEVEL - 1;

shared uint edges[PELLUCID_FAST_EDGES_TILES]; // of tiles, a bit for each texel
shared uint edgeTiles;                        // a bit for each tile that has any
shared uint marks[kSide];                     // of rows, a bit for each texel, then pixel, then quad that has more to sum
shared uint rough, tileLast;                  // a bit for each texel that is not summed by quads; coarsest level

// A surface: its center and its area, mm, and its light.
struct Surfel {
  vec3 center;
  float area; // 0 unless of the material that is asked for
  vec3 color;
};

// Areas have the material in their last bits and keep 1e-4.
const uint kMaterialBits = 0xFFu;

uint withMaterial(float area, uint material) {
  return (floatBitsToUint(area) & ~kMaterialBits) | (area > 0.0 ? material : 0u);
}

uint materialOfSurfel(int i) { return places[i].w & kMaterialBits; }

Surfel surfelAt(int i, uint material) {
  uvec4 place = places[i];
  return Surfel(uintBitsToFloat(place.xyz), (place.w & kMaterialBits) == material ? uintBitsToFloat(place.w) : 0.0,
                unpackColor(colors[i]));
}

// Sums of surfaces times their areas.
struct Together {
  vec3 center, color;
  float area;
};

const Together kNothing = Together(vec3(0.0), vec3(0.0), 0.0);

void addPart(inout Together t, Surfel part) {
  t.center += part.area * part.center;
  t.color += part.area * part.color;
  t.area += part.area;
}

void keep(int i, Together t, uint material) {
  float inverse = t.area > 0.0 ? 1.0 / t.area : 0.0;
  places[i] = uvec4(floatBitsToUint(inverse * t.center), withMaterial(t.area, material));
  colors[i] = packColor(inverse * t.color, 0u);
}

// The direction in which a pixel's surface is longer than wide, of length 1: two halves of it in depths[], the third beside the
// color.
vec3 axisOf(int i) { return vec3(unpackHalf2x16(floatBitsToUint(depths[i])), unpackHalf2x16(colors[i].y >> 16).x); }

// From how many times as long as wide on pixels near by are taken in segments.
const float kLongPixel = 4.0;

void keepPixel(int i, ivec2 at, float depth, uint material, vec3 normal, vec3 color) {
  float facing = pixelArea(depth);
  vec3 tilted = tilt(vec2(at), normal), center = pointAt(vec2(at), depth);
  float steep = length(tilted.xy), rise = steep * sqrt(facing) / frame.camera.range.w;
  vec2 toward = steep > 0.0 ? tilted.xy / steep : vec2(1.0, 0.0);
  vec3 axis = pointAt(vec2(at) + toward, depth + rise) - center;
  if (material != 0u && tilted.z > kLongPixel) atomicOr(marks[i / kSide], 1u << i % kSide);
  axis *= inversesqrt(max(dot(axis, axis), 1.0e-30));
  places[i] = uvec4(floatBitsToUint(center), withMaterial(facing * tilted.z, material));
  depths[i] = uintBitsToFloat(packHalf2x16(axis.xy));
  colors[i] = packColor(color, packHalf2x16(vec2(axis.z, 0.0)));
}

void loadPixels(ivec2 firstPixel) {
  const int kLoads = (kSources + kInvocations - 1) / kInvocations;
  float depth[kLoads];
  uint material[kLoads];
  vec3 normal[kLoads], color[kLoads];
  // All before the first is used, so that their latencies overlap.
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    int i = int(gl_LocalInvocationIndex) + j * kInvocations;
    ivec2 pixel = firstPixel - kRing + ivec2(i % kSide, i / kSide), at = withinRect(pixel);
    depth[j] = frontDistance(at);
    material[j] = at == pixel ? materialAt(at) : 0u;
    normal[j] = normalAt(at);
    color[j] = texelFetch(sourceImage, at, 0).rgb;
  }
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    int i = int(gl_LocalInvocationIndex) + j * kInvocations;
    if (i >= kSources) continue;
    ivec2 at = withinRect(firstPixel - kRing + ivec2(i % kSide, i / kSide));
    keepPixel(i, at, depth[j], depth[j] > 0.0 ? material[j] : 0u, normal[j], sanitize(color[j]));
  }
}

// First texel of a level's window.
ivec2 firstOf(uint level, ivec2 firstPixel) {
  return 2 * ((firstPixel >> int(level + 1u)) - kAround);
}

uvec4 texelOf(uint level, ivec2 texel) {
  return contains(levelRect(level), texel) ? texelFetch(pyramidImage, inAtlas(level, texel), 0) : uvec4(0u);
}

Surfel surfelOf(uint level, ivec2 texel, uvec4 bits) {
  Texel t = unpackTexel(bits);
  float side = exp2(float(level));
  return Surfel(pointAt(pixelOf(level, texel), t.depth), t.mass * pixelArea(t.depth) * side * side, t.color);
}

// How far behind the nearest of four texels others are the same surface, sides.
const float kReachBehind = 32.0;

// From how many sides of the finer level on what lies under a texel is two parts, the nearer and the farther half of it.
const float kDeep = 3.0;

// Beside a texel of level 2, in depths[], its second part: the distance in roots of the first one's area, its area over that, and
// its color, in halves, which the reach and the range of texels' areas keep finite.
void keepSecond(int i, Together first, Together second) {
  vec3 offset = (second.center / second.area - first.center / first.area) * inversesqrt(first.area);
  vec3 color = roundToHalf(second.color / second.area);
  depths[4 * i] = uintBitsToFloat(packHalf2x16(offset.xy));
  depths[4 * i + 1] = uintBitsToFloat(packHalf2x16(vec2(offset.z, second.area / first.area)));
  depths[4 * i + 2] = uintBitsToFloat(packHalf2x16(color.rg));
  depths[4 * i + 3] = uintBitsToFloat(packHalf2x16(vec2(color.b, 0.0)));
}

Surfel secondAt(int i, uint material) {
  Surfel first = surfelAt(i, material);
  vec2 bits[4];
  [[unroll]] for (int j = 0; j < 4; ++j) bits[j] = unpackHalf2x16(floatBitsToUint(depths[4 * i + j]));
  return Surfel(first.center + sqrt(first.area) * vec3(bits[0], bits[1].x), first.area * bits[1].y, vec3(bits[2], bits[3].x));
}

// What lies under a texel, from the four of the finer level. Returns whether there is a second part, of level 2 alone.
bool keepFour(int i, uint level, ivec2 texel, uvec4 bits[4]) {
  uint material = 0u;
  float nearest = kNoDepth;
  [[unroll]] for (int j = 0; j < 4; ++j)
    if (hasSurface(bits[j]) && uintBitsToFloat(bits[j].z) < nearest) {
      nearest = uintBitsToFloat(bits[j].z);
      material = materialBits(bits[j]);
    }
  vec2 sides = texelSize(nearest, level - 1u);
  float side = sqrt(sides.x * sides.y), farthest = nearest;
  bool counts[4];
  [[unroll]] for (int j = 0; j < 4; ++j) {
    float depth = uintBitsToFloat(bits[j].z);
    counts[j] = hasSurface(bits[j]) && materialBits(bits[j]) == material && depth < nearest + kReachBehind * side;
    farthest = counts[j] ? max(farthest, depth) : farthest;
  }
  bool two = level == 2u && farthest - nearest > kDeep * side;
  float limit = two ? 0.5 * (nearest + farthest) : kNoDepth;
  Together first = kNothing, second = kNothing;
  [[unroll]] for (int j = 0; j < 4; ++j) {
    if (!counts[j]) continue;
    Surfel part = surfelOf(level - 1u, 2 * texel + ivec2(j & 1, j >> 1), bits[j]);
    if (uintBitsToFloat(bits[j].z) < limit)
      addPart(first, part);
    else
      addPart(second, part);
  }
  keep(i, first, material);
  two = two && first.area > 0.0 && second.area > 0.0;
  if (two) keepSecond(i, first, second);
  return two;
}

// Of all levels, one after the other. `made`: the coarsest level that is in the image; one more is made of it.
void loadLevels(ivec2 firstPixel, uint made, uint last) {
  for (int i = int(gl_LocalInvocationIndex); i < kSecond; i += kInvocations) {
    ivec2 texel = firstOf(2u, firstPixel) + ivec2(i % kSecondSide, i / kSecondSide);
    uvec4 bits[4];
    [[unroll]] for (int j = 0; j < 4; ++j) bits[j] = texelOf(1u, 2 * texel + ivec2(j & 1, j >> 1));
    if (keepFour(i, 2u, texel, bits)) atomicOr(marks[i / kSecondSide], 1u << i % kSecondSide);
  }
  for (int i = int(gl_LocalInvocationIndex); i < (int(last) - 2) * kCoarser; i += kInvocations) {
    uint level = 3u + uint(i / kCoarser);
    int inWindow = i % kCoarser;
    ivec2 texel = firstOf(level, firstPixel) + ivec2(inWindow % kWindow, inWindow / kWindow);
    if (level <= made) {
      uvec4 bits = texelOf(level, texel);
      Surfel s = surfelOf(level, texel, bits);
      places[kSecond + i] =
          uvec4(floatBitsToUint(s.center), withMaterial(s.area, materialBits(bits)));
      colors[kSecond + i] = uvec2(bits.x & ~kFlat, bits.y);
    } else {
      uvec4 bits[4];
      [[unroll]] for (int j = 0; j < 4; ++j)
        bits[j] = level == made + 1u ? texelOf(made, 2 * texel + ivec2(j & 1, j >> 1)) : uvec4(0u);
      keepFour(kSecond + i, level, texel, bits);
    }
  }
}

// A material's profile, up to a factor.
struct Falloff {
  uint material; // 0: nothing is diffused
  vec3 rate;     // of Burley's, log2(e) / (3 d), 1/mm; x < 0: it has another
};

Falloff falloffOf(uint material) {
  Falloff f = Falloff(material, vec3(0.0));
  if (material != 0u) {
    vec4 burley = kernels[material - 1u].burley;
    f.rate = burley.a > 0.0 ? burley.rgb : vec3(-1.0);
  }
  return f;
}

Kernel tableOf(Falloff f) {
  return Kernel(f.material - 1u, floatBitsToInt(kernels[f.material - 1u].reach.y));
}

// At a squared distance, times an area.
vec3 falloffAt(Falloff f, float squared, float area) {
  if (f.rate.x < 0.0) return area * profileAt(tableOf(f), squared).value;
  // Christensen & Burley 2015, eq. 3 times 8 pi d.
  float inverse = inversesqrt(squared);
  vec3 far = exp2(-squared * inverse * f.rate);
  return area * inverse * (far * far * far + far);
}

// Which of `width` in a row, from the first one's place on, are marked.
uint marked(ivec2 first, int width) { return marks[first.y] >> first.x & (1u << width) - 1u; }

// Which of a row lie in the 3 x 3 around a place: its column, and how many rows before it the row lies.
uint around(ivec2 middle) { return abs(middle.y) > 1 ? 0u : 7u << (middle.x - 1); }

// Of those marked the others; `middle`: from the first one's column on.
uint markedOutside(ivec2 first, int width, ivec2 middle) { return marked(first, width) & ~around(middle); }

// Part of the energy within a distance, over the same factor.
vec3 enclosedBy(Falloff f, float r) {
  if (f.rate.x < 0.0) return enclosed(tableOf(f), r * r);
  vec3 far = exp2(-r * f.rate);
  return (1.0 - 0.25 * far * far * far - 0.75 * far) * (8.0 / 3.0 * 3.14159265 * 1.44269504) / f.rate;
}

void add(inout Sums sums, vec3 color, vec3 weight) {
  sums.color += weight * color;
  sums.weight += weight;
}

// At a squared distance, where 1/r is its mean over a surface to second order: of an area longer than the square `facing` that
// faces the camera, `along2`: the square of the part of the distance in that direction.
float meanOf(float squared, float facing, float area, float along2) {
  float longer2 = max(area * area / facing - facing, 0.0), part = along2 / squared;
  return max(squared - facing * (1.0 / 12.0) + longer2 * (1.0 / 12.0 - 0.25 * part), 0.5 * squared);
}

// `squared`: of the distance at which 1/r is meant.
void addAt(inout Sums sums, Surfel surfel, bool counts, Falloff f, float squared) {
  add(sums, surfel.color, falloffAt(f, squared, counts ? surfel.area : 0.0));
}

// Without a branch, so that sources' latencies overlap. `facing`: area of a square that faces the camera. What is larger is
// longer, next to along the view.
void addSurfel(inout Sums sums, Surfel surfel, bool counts, Falloff f, vec3 center, float facing) {
  vec3 offset = surfel.center - center;
  float squared = max(dot(offset, offset), 1.0e-30);
  addAt(sums, surfel, counts, f, meanOf(squared, facing, surfel.area, offset.z * offset.z));
}

void addSurfel(inout Sums sums, int i, bool counts, Falloff f, vec3 center, float facing) {
  addSurfel(sums, surfelAt(i, f.material), counts, f, center, facing);
}

vec3 ofLong(Falloff f, float area, vec3 axis, vec3 offset, float facing) {
  float width = sqrt(facing), halfLength = 0.5 * area / width;
  vec3 weight = vec3(0.0);
  const float parts = 2.0;
  float part = area / parts;
  [[unroll]] for (float i = 0.5; i < parts; i += 1.0) {
    float at = halfLength * (2.0 * i / parts - 1.0);
    weight += falloffAt(f, meanSquare(offset + at * axis, vec4(axis, halfLength / parts), facing), part);
  }
  return weight;
}

// The pixel's own, of that color, and those under the 3 x 3 quads around it. `local`: from the tile's first.
void addPixels(inout Sums sums, ivec2 local, Falloff f, vec3 center, float facing, vec3 color) {
  ivec2 corner = (local & ~1) + kRing - 2;
  int own = (local.y + kRing) * kSide + local.x + kRing, first = corner.y * kSide + corner.x;
  Surfel mine = surfelAt(own, f.material);
  // The disc over which 1/r has the same integral.
  float ratio = max(mine.area / facing, 1.0);
  float radius = sqrt(facing) * (ratio * asinh(1.0 / ratio) + asinh(ratio)) * (1.0 / 3.14159265);
  add(sums, color, enclosedBy(f, radius)); // not as kept, in halves: narrow kernels return the input
  // Half of a row without a branch, so that latencies overlap; more takes too many registers. Long ones after that.
  [[dont_unroll]] for (int run = 0; run < 12; ++run) {
    int x = 3 * (run & 1), y = run >> 1;
    uint skipped = (marks[corner.y + y] >> corner.x | (y == 2 + (local.y & 1) ? 4u << (local.x & 1) : 0u)) >> x;
    [[unroll]] for (int j = 0; j < 3; ++j) {
      int i = first + y * kSide + x + j;
      Surfel surfel = surfelAt(i, f.material);
      vec3 offset = surfel.center - center;
      float squared = max(dot(offset, offset), 1.0e-30), along = dot(axisOf(i), offset);
      float mean = meanOf(squared, facing, surfel.area, along * along);
      addAt(sums, surfel, (skipped & 1u << j) == 0u, f, mean);
    }
  }
  for (int y = 0; y < 6; ++y)
    for (uint left = marked(corner + ivec2(0, y), 6); left != 0u; left &= left - 1u) {
      int i = first + y * kSide + findLSB(left);
      Surfel surfel = surfelAt(i, f.material);
      if (i != own) add(sums, surfel.color, ofLong(f, surfel.area, axisOf(i), surfel.center - center, facing));
    }
}

// Quads of the pixels that are kept, in their place; the second of two surfaces after all first ones.
void makeQuads() {
  int i = int(gl_LocalInvocationIndex);
  bool makes = i < kQuadSide * kQuadSide;
  Together first = kNothing, second = kNothing;
  uint material = 0u, other = 0u;
  if (makes) {
    int start = i / kQuadSide * 2 * kSide + i % kQuadSide * 2;
    float nearest = kNoDepth, farthest = 0.0;
    [[unroll]] for (int j = 0; j < 4; ++j) {
      int at = start + (j >> 1) * kSide + (j & 1);
      uint its = materialOfSurfel(at);
      float z = uintBitsToFloat(places[at].z);
      if (its != 0u && z < nearest) nearest = z, material = its;
      farthest = its != 0u ? max(farthest, z) : farthest;
    }
    // Two are of two materials or farther apart than a quad is wide. Of three materials one is lost.
    other = material;
    [[unroll]] for (int j = 0; j < 4; ++j) {
      uint its = materialOfSurfel(start + (j >> 1) * kSide + (j & 1));
      if (its != 0u && its != material) other = its;
    }
    float apart = farthest - nearest, limit = 0.5 * (nearest + farthest);
    if (apart * apart < 4.0 * pixelArea(nearest / frame.camera.range.w)) limit = kNoDepth;
    [[unroll]] for (int j = 0; j < 4; ++j) {
      int at = start + (j >> 1) * kSide + (j & 1);
      uint its = materialOfSurfel(at);
      Surfel part = surfelAt(at, its);
      if (its == 0u) continue;
      if (other == material ? part.center.z < limit : its == material)
        addPart(first, part);
      else if (its == other)
        addPart(second, part);
    }
  }
  if (i < kQuadSide) marks[i] = 0u;
  barrier();
  if (makes) {
    keep(i, first, material);
    if (second.area > 0.0) {
      keep(kQuadSide * kQuadSide + i, second, other);
      atomicOr(marks[i / kQuadSide], 1u << i % kQuadSide);
    }
  }
  barrier();
}

// Of 2 n x 2 n, in rows of `width`, those that are not of the n x n from n / 2 + odd on, in 3 n runs of n: the place of a run's
// first one and how many lie there; the others lie n farther.
ivec2 runOutside(int n, int run, ivec2 odd, int width) {
  ivec2 first = n / 2 + odd;
  int row = run >> 1;
  bool isWhole = run < 2 * n;
  row = !isWhole ? run - 2 * n + first.y : row < first.y ? row : row + n;
  return ivec2(row * width + (isWhole ? n * (run & 1) : 0), isWhole ? n : first.x);
}

int placeIn(ivec2 run, int n, int j) { return run.x + (j < run.y ? j : j + n); }

void addQuads(inout Sums sums, ivec2 local, Falloff f, vec3 center, float facing) {
  ivec2 quad = local >> 1, first = 2 * (quad >> 1), odd = quad & 1;
  int start = first.y * kQuadSide + first.x;
  for (int i = 0; i < 9; ++i) {
    ivec2 run = runOutside(3, i, odd, kQuadSide);
    [[unroll]] for (int j = 0; j < 3; ++j)
      addSurfel(sums, start + placeIn(run, 3, j), true, f, center, 4.0 * facing);
  }
  for (int y = 0; y < 6; ++y) {
    uint second = markedOutside(first + ivec2(0, y), 6, ivec2(2 + odd.x, y - 2 - odd.y));
    for (; second != 0u; second &= second - 1u)
      addSurfel(sums, kQuadSide * (kQuadSide + first.y + y) + first.x + findLSB(second), true, f, center, 4.0 * facing);
  }
}

// What is around a pixel at levels up to `last`, every `step`th run of sources from number `from` on, 1 or 4.
void addLevels(inout Sums sums, ivec2 firstPixel, ivec2 pixel, uint last, Falloff f, vec3 center, float facing, int from, int step) {
  const int kRun = kWindow / 2;
  ivec2 first = 2 * ((pixel >> 3) - kAround) - firstOf(2u, firstPixel), own = 2 * kAround + ((pixel >> 2) & 1);
  int start = first.y * kSecondSide + first.x;
  for (int run = from; run < 2 * kWindow; run += step) {
    int x = kRun * (run & 1), y = run >> 1;
    uint skipped = around(ivec2(own.x, y - own.y)) >> x;
    [[unroll]] for (int j = 0; j < kRun; ++j)
      addSurfel(sums, start + y * kSecondSide + x + j, (skipped & 1u << j) == 0u, f, center, 16.0 * facing);
  }
  for (int y = from; y < kWindow; y += step) {
    uint second = markedOutside(first + ivec2(0, y), kWindow, ivec2(own.x, y - own.y));
    for (; second != 0u; second &= second - 1u) {
      int i = start + y * kSecondSide + findLSB(second);
      addSurfel(sums, secondAt(i, f.material), true, f, center, 16.0 * facing);
    }
  }
  // A window of these levels is one texel's that is at least as large as the tile.
  for (uint level = 3u; level <= last; ++level) {
    float side2 = facing * exp2(float(2u * level));
    ivec2 odd = (pixel >> int(level)) & 1;
    start = kSecond + int(level - 3u) * kCoarser;
    for (int i = from; i < 3 * kRun; i += step) {
      ivec2 run = runOutside(kRun, i, odd, kWindow);
      [[unroll]] for (int j = 0; j < kRun; ++j)
        addSurfel(sums, start + placeIn(run, kRun, j), true, f, center, side2);
    }
  }
}

// The coarsest level whose window holds most of the radius.
uint lastLevel(uint material, float facing) {
  float level = ceil(log2(max(0.2 * kernels[material - 1u].reach.x * inversesqrt(facing), 1.0)));
  return uint(clamp(level, 2.0, float(min(pass.value.x - 1u, uint(kLastSummed)))));
}

// Pixels of a tile's edges; a bit for each of its texels says which are. `made`: see loadLevels.
void diffuseTile(ivec2 firstPixel, uint edgeTexels, uint made, bool isLast) {
  int invocation = int(gl_LocalInvocationIndex);
  barrier(); // what was there has been read
  if (invocation == 0) rough = 0u, tileLast = 2u;
  if (invocation < kSide) marks[invocation] = 0u;
  // 16 invocations to a texel, so that those without one are whole subgroups.
  for (int before = invocation / 16; before > 0; --before) edgeTexels &= edgeTexels - 1u;
  bool isEdge = edgeTexels != 0u;
  int texel = max(findLSB(edgeTexels), 0), inTexel = invocation % 16;
  ivec2 local = 4 * ivec2(texel % kTexels, texel / kTexels) + ivec2(inTexel % 4, inTexel / 4), pixel = firstPixel + local;
  ivec2 at = withinRect(pixel);
  float depth = frontDistance(at), facing = max(pixelArea(depth), 1.0e-30);
  uint material = materialOf(pixel, depth), last = 2u, ofPixel = 2u;
  vec3 center = pointAt(vec2(at), depth), ofQuad = center;
  places[invocation] = uvec4(floatBitsToUint(center), material);
  barrier();
  bool diffuses = isEdge && material != 0u && kernels[max(material, 1u) - 1u].reach.x > 0.0;
  Falloff f = falloffOf(diffuses ? material : 0u);
  if (isEdge) {
    vec3 quads[4];
    quadsOf(invocation - inTexel, quads);
    vec4 parts = ofQuads(local & 3);
    vec3 off = parts.x * quads[0] + parts.y * quads[1] + parts.z * quads[2] + parts.w * quads[3] - center;
    ofQuad = quadAt(quads, local & 3);
    if (places[invocation - inTexel].w != material || !(dot(off, off) < kMostOff * facing)) atomicOr(rough, 1u << texel);
    if (diffuses) {
      last = lastLevel(material, max(pixelArea(quads[0].z / frame.camera.range.w), 1.0e-30));
      ofPixel = lastLevel(material, facing);
      atomicMax(tileLast, max(last, ofPixel));
    }
  }
  barrier();
  bool byQuads = (rough >> texel & 1u) == 0u;
  if (!byQuads) last = ofPixel;
  loadLevels(firstPixel, made, tileLast);
  barrier();
  Sums sums = Sums(vec3(0.0), vec3(0.0));
  if (diffuses)
    addLevels(sums, firstPixel, pixel, last, f, byQuads ? ofQuad : center, facing, byQuads ? (local.x & 1) + 2 * (local.y & 1) : 0,
              byQuads ? 4 : 1);
  barrier();
  if (invocation < kSide) marks[invocation] = 0u;
  exchange(sums, invocation, byQuads);
  loadPixels(firstPixel);
  barrier();
  vec4 color = texelFetch(sourceImage, at, 0);
  vec3 own = sanitize(color.rgb);
  if (diffuses) addPixels(sums, local, f, center, facing, own);
  barrier();
  makeQuads();
  if (diffuses) addQuads(sums, local, f, center, facing);
  if (isEdge && insideRect(pixel) && materialAt(pixel) != 0u) {
    // Of what is found, the pixel itself has a weight. Those that diffuse nothing keep their color.
    vec3 result = diffuses ? sums.color / max(sums.weight, vec3(1.0e-20)) : own;
    writeResult(pixel, result, color.a, isLast);
  }
}

#endif
