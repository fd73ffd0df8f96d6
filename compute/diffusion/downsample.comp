// Makes the two levels of the pyramid after level pass.value.x. A group makes 8 x 4 texels of the second level and, before them,
// the 18 x 10 of the first that they need. A texel takes the nearest of the surfaces under it and averages what lies on that.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_BLOCK_GROUP
#define GROUP_ROWS (PELLUCID_BLOCK_GROUP / 2)
#include "diffusion/texel.glsl"

const int kInvocations = GROUP_SIDE * GROUP_ROWS;
// Columns and rows of the second level's part, of the part of the first level that it needs, and of the input of that.
const int kSecond = PELLUCID_DOWNSAMPLE_COLUMNS, kSecondRows = PELLUCID_DOWNSAMPLE_ROWS;
const int kFirst = 2 * kSecond + 2, kFirstRows = 2 * kSecondRows + 2, kInput = 2 * kFirst + 2, kInputRows = 2 * kFirstRows + 2;
const int kLoads = (kInput * kInputRows + kInvocations - 1) / kInvocations, kFirsts = (kFirst * kFirstRows + kInvocations - 1) / kInvocations;
// The arrays hold the input and, once that has been used, the first level: their size limits how many groups run at a time.
shared uvec2 colors[kInput * kInputRows]; // and area, material and plane, as packed
shared float depths[kInput * kInputRows];
shared uint anySurface; // in the input

const int kTaps = 16; // texels under a texel

float weight(int i) { return i == 0 || i == 3 ? PELLUCID_DOWNSAMPLE_OUTER : PELLUCID_DOWNSAMPLE_INNER; }

// A plane's largest mean squared distance, over the squared length of a texel's side. Curved surfaces below it gain nothing
// from weights of their own.
const float kPlaneResidual = 0.01;

// Bits that texels of one plane have in common: the material, and that they are planes.
const uint kSamePlane = 0xFF000000u | kPlane;

// Even columns of a row come before the odd ones: reads of every other column meet no bank twice.
int slot(ivec2 at, int width) { return at.y * width + (at.x >> 1) + (at.x & 1) * (width >> 1); }

// A place among the 4 x 4 texels whose first one is in an even column, at `first`.
int tap(int first, int width, int x, int y) { return first + slot(ivec2(x, y), width); }

void keepTexel(int index, uvec4 bits) {
  colors[index] = bits.xy;
  depths[index] = uintBitsToFloat(bits.z);
}

struct Source {
  float area, depth;
  uint material;
};

Source sourceAt(int index) {
  uint bits = colors[index].y;
  return Source(storedArea(bits), depths[index], bits >> 24);
}

// The texel whose surface is taken: the nearest to the camera of the four in the middle or, beyond an edge, the one of the
// others that the filter weights most. -1: none.
int surfaceOf(int first, int stride) {
  int surface = -1;
  float nearest = kNoDepth, most = 0.0;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    Source t = sourceAt(tap(first, stride, 1 + (i & 1), 1 + (i >> 1)));
    bool nearer = t.area != 0.0 && t.depth < nearest;
    nearest = nearer ? t.depth : nearest;
    surface = nearer ? 5 + 4 * (i >> 1) + (i & 1) : surface;
  }
  if (surface >= 0) return surface;
  [[dont_unroll]] for (int i = 0; i < kTaps; ++i) {
    float w = weight(i & 3) * weight(i >> 2) * sourceAt(tap(first, stride, i & 3, i >> 2)).area;
    if (!(w > most)) continue;
    most = w;
    surface = i;
  }
  return surface;
}

// Depth change per texel in one direction, to whichever neighbor of the material is nearer in depth, because the other one
// may lie across an edge.
float depthStep(int first, int stride, Source center, ivec2 at, ivec2 direction) {
  float best = 0.0;
  bool found = false;
  [[unroll]] for (int side = -1; side <= 1; side += 2) {
    ivec2 neighbor = at + side * direction, within = clamp(neighbor, ivec2(0), ivec2(3));
    Source t = sourceAt(tap(first, stride, within.x, within.y));
    float difference = float(side) * (t.depth - center.depth);
    bool counts = neighbor == within && t.area != 0.0 && t.material == center.material;
    bool better = counts && (!found || abs(difference) < abs(best));
    best = better ? difference : best;
    found = found || counts;
  }
  return best;
}

// Texel from 4 x 4 texels that are not one plane.
uvec4 downsampledEdge(uint finer, int first, int stride, vec2 ray) {
  int chosen = surfaceOf(first, stride);
  if (chosen < 0) {
    uint orphans = 0u;
    for (int i = 0; i < 4; ++i)
      orphans = max(orphans, sourceAt(tap(first, stride, 1 + (i & 1), 1 + (i >> 1))).material);
    return uvec4(0u, orphans << 24, 0u, 0u);
  }
  ivec2 nearest = ivec2(chosen & 3, chosen >> 2);
  Source surface = sourceAt(tap(first, stride, nearest.x, nearest.y));
  vec2 size = texelSize(surface.depth, finer);
  vec2 slope = vec2(depthStep(first, stride, surface, nearest, ivec2(1, 0)),
                    depthStep(first, stride, surface, nearest, ivec2(0, 1))) / max(size, vec2(1.0e-30));
  TangentPlane plane = tangentPlane(slope, ray, inverseSpread(slope, ray, 2.0 * size));
  vec3 color = vec3(0.0);
  float area = 0.0, weights = 0.0, off = 0.0;
  vec2 tilt = vec2(0.0), spread = vec2(0.0);
  // A row has no branch, so that the taps' latencies overlap. Taps that do not count are finite, too.
  [[dont_unroll]] for (int i = 0; i < kTaps; i += 4) {
    [[unroll]] for (int x = 0; x < 4; ++x) {
      ivec2 at = ivec2(x, i >> 2);
      int index = tap(first, stride, at.x, at.y);
      Source t = sourceAt(index);
      bool counts = t.area != 0.0 && t.material == surface.material;
      vec2 offset = (vec2(at) - 1.5) * size;
      float difference = t.depth - surface.depth - dot(slope, vec2(at - nearest) * size);
      float w = weight(at.x) * weight(at.y);
      w = counts ? w * tangentPlaneWeight(plane, difference, offset, kDownsampleFalloff) : 0.0;
      color += w * t.area * unpackHalves(colors[index]);
      area += w * t.area;
      // A surface that is seen edge-on says no more about its depth than elsewhere.
      w *= min(t.area, 1.0);
      off += w * difference;
      tilt += w * difference * offset;
      spread += w * offset * offset;
      weights += w;
    }
  }
  // The nearest one counts, so area and weights are positive; spread is 0 only where it is alone.
  float inverse = 1.0 / weights;
  vec2 center = vec2(1.5) - vec2(nearest);
  float depth = surface.depth + dot(slope, center * size) + off * inverse;
  slope += tilt / max(spread, 1.0e-6 * size * size + 1.0e-30);
  return packTexel(Texel(color / area, area, surface.material, depth, slope), 0u);
}

// Texel of the level after `finer` from the 4 x 4 at `first`.
uvec4 downsampled(uint finer, ivec2 texel, int first, int stride) {
  uint bits = colors[first].y, different = 0u;
  float base = depths[first], off = 0.0, square = 0.0;
  vec2 tilt = vec2(0.0);
  vec3 color = vec3(0.0);
  for (int i = 0; i < kTaps; i += 4)
    [[unroll]] for (int x = 0; x < 4; ++x) {
      int y = i >> 2, index = tap(first, stride, x, y);
      uvec2 packed = colors[index];
      float w = weight(x) * weight(y), difference = depths[index] - base;
      different |= packed.y ^ bits;
      color += w * unpackHalves(packed);
      off += w * difference;
      tilt += w * difference * (vec2(x, y) - 1.5);
      square += w * difference * difference;
    }
  // The plane of least squares: its slope is the covariance over the filter's variance.
  vec2 size = texelSize(base, finer), rise = tilt / PELLUCID_DOWNSAMPLE_VARIANCE;
  float residual = square - off * off - dot(tilt, rise);
  vec2 slope = rise / max(size, vec2(1.0e-30)), ray = facingRayAt(pixelOf(finer + 1u, texel));
  bool plane = (different & kSamePlane) == 0u && (bits & kPlane) != 0u &&
               residual * inverseSpread(slope, ray, 2.0 * size) < kPlaneResidual;
  uvec4 result = packTexel(Texel(color, areaOf(finer + 1u, texel, slope), bits >> 24, base + off, slope), kPlane);
  // Empty texels are too rare for a branch of their own.
  if (!plane) result = (bits | different) >> 16 == 0u ? uvec4(0u) : downsampledEdge(finer, first, stride, ray);
  return result;
}

// True where a texel and all around it are full and lie on one plane. `at`: the texel in colors[] and depths[] of `width`
// columns, not in the outermost rows and columns.
bool isFlatAround(uvec4 bits, ivec2 at, int width, uint level, vec2 ray) {
  float depth = uintBitsToFloat(bits.z), most = 0.0;
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  uint different = 0u;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      int index = slot(at + ivec2(x, y), width);
      most = max(most, abs(depths[index] - depth - dot(slope, vec2(x, y) * size)));
      different |= colors[index].y ^ bits.y;
    }
  return isPlane(bits) && (different & kSamePlane) == 0u && most * most < kPlaneOffset / inverseSpread(slope, ray, size);
}

// The i-th place in the part of the first level: the inner ones first, row by row, which are what the group writes.
ivec2 placeInFirst(int i) {
  const int kInner = kFirst - 2, kInnerRows = kFirstRows - 2;
  if (i < kInner * kInnerRows) return ivec2(i % kInner, i / kInner) + 1;
  i -= kInner * kInnerRows; // the outermost rows, then the columns between them
  if (i < 2 * kFirst) return ivec2(i % kFirst, i < kFirst ? 0 : kFirstRows - 1);
  i -= 2 * kFirst;
  return ivec2(i < kInnerRows ? 0 : kFirst - 1, i % kInnerRows + 1);
}

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  uint finer = pass.value.x, columns = pass.value.y, word = finer == 1u ? listedBlock(nearList()) : 0u;
  const ivec2 kPart = ivec2(kSecond, kSecondRows), kPartShift = ivec2(findMSB(kSecond), findMSB(kSecondRows));
  // Levels 2 and 3 are made in blocks, all others everywhere.
  ivec2 own = finer == 1u ? (firstPixel(blockOf(word)) >> 3) + ivec2(0, int(gl_WorkGroupID.y) * kSecondRows)
                          : ((levelRect(finer + 2u).xy >> kPartShift) + ivec2(gl_WorkGroupID.x % columns, gl_WorkGroupID.x / columns)) * kPart;
  ivec2 start = 2 * own - 1, inputStart = 2 * start - 1;
  if (invocation == 0) anySurface = 0u;
  barrier();
  // All loads come before the first use, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    int at = invocation + i * kInvocations;
    loaded[i] = at < kInput * kInputRows ? writtenTexel(finer, inputStart + ivec2(at % kInput, at / kInput), isWhole(word)) : uvec4(0u);
  }
  [[unroll]] for (int i = 0; i < kLoads; ++i) {
    int at = invocation + i * kInvocations;
    if (at >= kInput * kInputRows) continue;
    if (loaded[i].y >> 16 != 0u) anySurface = 1u; // whoever writes, writes this
    keepTexel(slot(ivec2(at % kInput, at / kInput), kInput), loaded[i]);
  }
  barrier();
  bool some = anySurface != 0u; // texels of nothing are nothing
  uvec4 bits[kFirsts];
  [[unroll]] for (int i = 0; i < kFirsts; ++i) { // else bits[] would lie in memory
    int place = invocation + i * kInvocations;
    ivec2 at = placeInFirst(place);
    bool makes = some && place < kFirst * kFirstRows && contains(levelRect(finer + 1u), start + at);
    bits[i] = makes ? downsampled(finer, start + at, 2 * at.y * kInput + at.x, kInput) : uvec4(0u);
  }
  barrier();
  [[unroll]] for (int i = 0; i < kFirsts; ++i)
    if (invocation + i * kInvocations < kFirst * kFirstRows) keepTexel(slot(placeInFirst(invocation + i * kInvocations), kFirst), bits[i]);
  barrier();
  ivec2 at = placeInFirst(invocation); // one of the inner ones
  if (contains(levelRect(finer + 1u), start + at)) {
    if (finer == 1u && isFlatAround(bits[0], at, kFirst, 2u, facingRayAt(pixelOf(2u, start + at)))) bits[0].x |= kFlat;
    writeLevel(finer + 1u, start + at, bits[0]);
  }
  at = ivec2(invocation % kSecond, invocation / kSecond);
  if (at.y < kSecondRows && contains(levelRect(finer + 2u), own + at))
    writeLevel(finer + 2u, own + at, some ? downsampled(finer + 1u, own + at, 2 * at.y * kFirst + at.x, kFirst) : uvec4(0u));
}
