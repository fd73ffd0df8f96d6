// Texels of a level from texels of the finer one in shared memory. A texel takes the nearest of the surfaces under it and averages
// what lies on that. A pass defines HELD_TEXELS, the texels that it holds at a time, before it includes this file.
#ifndef PELLUCID_DOWNSAMPLE_GLSL
#define PELLUCID_DOWNSAMPLE_GLSL

#include "diffusion/texel.glsl"
#include "lib/surface.glsl"

#ifndef HELD_TEXELS
#define HELD_TEXELS 1
#endif
shared uvec2 colors[HELD_TEXELS]; // and area, material and plane, as packed
shared float depths[HELD_TEXELS];
shared uint anySurface; // in what was loaded

const int kTaps = 16; // texels under a texel

float weight(int i) { return i == 0 || i == 3 ? PELLUCID_DOWNSAMPLE_OUTER : PELLUCID_DOWNSAMPLE_INNER; }

// A plane's largest mean squared distance, over a texel's squared side: that of kNearPlane. Curved surfaces below it gain nothing
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

void keepLoaded(int index, uvec4 bits) {
  if (bits.y >> 16 != 0u) anySurface = 1u; // whoever writes, writes this
  keepTexel(index, bits);
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

// Change of depth per texel from `center` to its neighbor at a step; kFarthest: none of its material is held.
float stepTo(int first, int stride, Source center, ivec2 at, ivec2 step) {
  ivec2 neighbor = at + step, within = clamp(neighbor, ivec2(0), ivec2(3));
  Source t = sourceAt(tap(first, stride, within.x, within.y));
  bool counts = neighbor == within && t.area != 0.0 && t.material == center.material;
  return counts ? float(step.x + step.y) * (t.depth - center.depth) : kFarthest;
}

float stepAlong(int first, int stride, Source center, ivec2 at, ivec2 axis) {
  return nearerStep(stepTo(first, stride, center, at, axis), stepTo(first, stride, center, at, -axis));
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
  vec2 slope = vec2(stepAlong(first, stride, surface, nearest, ivec2(1, 0)),
                    stepAlong(first, stride, surface, nearest, ivec2(0, 1))) / max(size, vec2(1.0e-30));
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
  [[dont_unroll]] for (int i = 0; i < kTaps; i += 4)
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

#endif
