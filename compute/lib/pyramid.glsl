// Texels of the diffusion pyramid. One of level l covers 2^l x 2^l pixels of the image, not of the rect, and stands
// for one surface. Needs FrameConstants frame in scope.
#ifndef PELLUCID_PYRAMID_LIB_GLSL
#define PELLUCID_PYRAMID_LIB_GLSL

#include "lib/camera.glsl"
#include "lib/sanitize.glsl"

struct Texel {
  vec3 color;
  float coverage; // share of the texel's filter that its surface fills; 0: the texel holds no surface
  uint material;  // where there is no surface, not 0: some of its pixels have this material and no depth
  float depth;    // planar, at the texel's center
  vec2 slope;     // change of depth over that of position, facing the camera: tangents, the same at every level
};

// Of halves.
uvec2 packHalves(vec3 color, uint upper) {
  return uvec2(packHalf2x16(color.rg), (packHalf2x16(vec2(color.b, 0.0)) & 0xFFFFu) | upper << 16);
}

uvec2 packColor(vec3 color, uint upper) { return packHalves(roundToHalf(color), upper); }

vec3 unpackColor(uvec2 u) { return vec3(unpackHalf2x16(u.x), unpackHalf2x16(u.y).x); }

// A slope of 1000 is 0.06 degrees from edge-on.
uint packSlope(vec2 slope) { return packHalf2x16(clamp(slope, vec2(-1.0e3), vec2(1.0e3))); }

// Bits of a coverage of 1. In level 2, one more says that all around lies on the texel's plane, too.
const uint kFullCoverage = 254u, kFlatCoverage = 255u;

uvec4 packTexel(Texel t) {
  // Anything there at all must not round to nothing.
  float full = float(kFullCoverage);
  uint coverage = uint(clamp(ceil(t.coverage * full - 0.5), t.coverage > 0.0 ? 1.0 : 0.0, full));
  return uvec4(packColor(t.color, coverage | t.material << 8), floatBitsToUint(t.depth), packSlope(t.slope));
}

Texel unpackTexel(uvec4 u) {
  float coverage = min(float((u.y >> 16) & 0xFFu) / float(kFullCoverage), 1.0);
  return Texel(unpackColor(u.xy), coverage, u.y >> 24, uintBitsToFloat(u.z),
               unpackHalf2x16(u.w));
}

uint coverageBits(uvec4 texel) { return (texel.y >> 16) & 0xFFu; }

uint materialBits(uvec4 texel) { return texel.y >> 24; }

// Texels [xy, zw) of a level: those that the rect touches and, from level 2 on, a border of one, which keeps what
// the filter carries over the edge. No others are written or read.
ivec4 levelRect(uint level) {
  ivec4 rect = ivec4(frame.rect);
  int l = int(level), border = level > 1u ? 1 : 0;
  return ivec4((rect.xy >> l) - border, ((rect.zw - 1) >> l) + 1 + border);
}

bool insideLevel(ivec4 rect, ivec2 texel) {
  return all(greaterThanEqual(texel, rect.xy)) && all(lessThan(texel, rect.zw));
}

// Scene units that a texel of the level covers in x and y at planar distance p, facing the camera.
vec2 texelSize(float p, uint level) {
  return pixelSize(frame.camera, p) * (exp2(float(level)) / frame.camera.range.w);
}

// 1 / s^2 for sameSurface: s is the longest side of a texel of facing sides `size` on a surface of that slope.
float inverseSpread(vec2 slope, vec2 size) {
  float cosine2 = 1.0 / (1.0 + dot(slope, slope));
  // Sides are positive in front of the eye; the floor keeps their product normal.
  return cosine2 * cosine2 / max(size.x * size.y, 1.0e-30);
}

// Whether what is `off` in depth from a texel's tangent plane belongs to its surface: 1 on the plane, 0 beyond
// 1.6 texels, near e^{-(off/s)^2}, so that what lies as far behind as the kernel is wide does not count.
float sameSurface(float off, float inverseSpread2) {
  float rest = clamp(1.0 - 0.4 * off * off * inverseSpread2, 0.0, 1.0);
  return rest * rest;
}

// Texel of level 1 from its four pixels, rows first; depth <= 0: none. One surface if they lie on one plane, else
// the nearest one.
uvec4 quadTexel(uint material[4], float depth[4], vec3 color[4]) {
  float nearest = kNoDepth;
  uint nearestMaterial = 0u, any = 0u;
  bool one = true;
  for (int i = 0; i < 4; ++i) {
    any = max(any, material[i]);
    bool some = material[i] != 0u && depth[i] > 0.0;
    one = one && some && material[i] == material[0];
    if (!some || depth[i] >= nearest) continue;
    nearest = depth[i];
    nearestMaterial = material[i];
  }
  if (nearestMaterial == 0u) return uvec4(0u, any << 24, 0u, 0u);
  vec2 sides = squaredPixelSize(frame.camera, nearest);
  float side = sqrt(min(sides.x, sides.y));
  // A plane up to 76 degrees from facing the camera; steeper pairs count as an edge.
  float farthest = max(max(depth[0], depth[1]), max(depth[2], depth[3]));
  bool plane = one && abs(depth[0] - depth[1] - depth[2] + depth[3]) < side && farthest - nearest < 8.0 * side;
  float reach = plane ? 8.0 * side : 1.5 * side;
  vec3 mean = vec3(0.0);
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    bool counts = depth[i] > 0.0 && material[i] == nearestMaterial && depth[i] - nearest <= reach;
    float w = counts ? 1.0 : 0.0;
    mean += w * color[i];
    sum += counts ? depth[i] : 0.0;
    weights += w;
  }
  // The nearest counts, so weights >= 1.
  float inverse = 1.0 / weights;
  return packTexel(Texel(mean * inverse, 0.25 * weights, nearestMaterial, sum * inverse, vec2(0.0)));
}

// First fundamental form of the surface over a texel, reduced to what the kernel needs.
struct Foreshortening {
  float lengthMm; // of a texel along the foreshortened direction, the longest on the surface
  float stretch;  // its square over that of the shortest, minus 1: 0 facing the camera
  vec2 axis;      // unit, in texels: direction of the shortest, in which the kernel is longest
};

Foreshortening foreshortening(vec2 texel, uint level, float depth, vec2 slope) {
  float scale = exp2(float(level));
  vec2 pixel = (texel + 0.5) * scale - 0.5;
  Camera c = frame.camera;
  vec2 direction = c.rayBase.xy + pixel.x * c.rayX.xy + pixel.y * c.rayY.xy;
  vec2 facingX = (c.rayX.xy * depth + c.rayX.zw) * scale, facingY = (c.rayY.xy * depth + c.rayY.zw) * scale;
  float dx = slope.x * length(facingX), dy = slope.y * length(facingY);
  vec3 x = vec3(facingX + direction * dx, dx), y = vec3(facingY + direction * dy, dy);
  float a = dot(x, x), b = dot(x, y), d = dot(y, y);
  float middle = 0.5 * (a + d), difference = 0.5 * (a - d), root = sqrt(difference * difference + b * b);
  // Eigenvector of the smaller eigenvalue, from whichever row does not cancel.
  vec2 axis = difference > 0.0 ? vec2(b, -(difference + root)) : vec2(difference - root, b);
  float norm = dot(axis, axis);
  axis = norm > 0.0 ? axis * inversesqrt(norm) : vec2(1.0, 0.0);
  float least = max(middle - root, 1.0e-6 * middle);
  // middle > 0 in front of the eye; the floor is for cameras without a pixel size.
  return Foreshortening(sqrt(middle + root) * c.range.w, (middle + root) / max(least, 1.0e-30) - 1.0, axis);
}

#endif
