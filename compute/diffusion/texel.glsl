// Texels of the diffusion pyramid. One of level l covers 2^l x 2^l pixels of the image, not of the rect, and stands
// for one surface. Needs FrameConstants frame in scope.
#ifndef PELLUCID_TEXEL_GLSL
#define PELLUCID_TEXEL_GLSL

#include "lib/camera.glsl"
#include "lib/sanitize.glsl"
#include "shared/pellucid_filters.h"

struct Texel {
  vec3 color;    // mean over the surface's area
  float mass;    // area of surface under the texel's filter over that of one facing the camera; 0: there is none
  uint material; // where there is no surface, not 0: some of its pixels have this material and no depth
  float depth;   // planar, at the texel's center
  vec2 slope;    // change of depth over that of position, facing the camera: tangents, the same at every level
};

// `color`: halves.
uvec2 packHalves(vec3 color, uint upper) {
  return uvec2(packHalf2x16(color.rg), (packHalf2x16(vec2(color.b, 0.0)) & 0xFFFFu) | upper << 16);
}

uvec2 packColor(vec3 color, uint upper) { return packHalves(roundToHalf(color), upper); }

vec3 unpackColor(uvec2 u) { return vec3(unpackHalf2x16(u.x), unpackHalf2x16(u.y).x); }

const float kMostArea = 16.0;

// Areas over those facing the camera, 0 to 16 in 7 bits. The root makes it exact to 1.6 % at 1.
uint packArea(float area) {
  return uint(clamp(32.0 * sqrt(area) + 0.5, area > 0.0 ? 1.0 : 0.0, 127.0)); // anything at all must not round to 0
}

float unpackArea(uint u) { return float(u * u) / 1024.0; }

const float kDensityOne = 128.0;

// The share of a kernel that a surface fills, over what a plane would, of each channel. A plane's is exact.
uint packDensity(vec3 density) { return packUnorm4x8(vec4(density * (kDensityOne / 255.0), 0.0)); }

// Times kDensityOne.
vec3 unpackDensity(uint u) { return vec3(u & 0xFFu, (u >> 8) & 0xFFu, (u >> 16) & 0xFFu); }

// A slope of 1000 is 0.06 degrees from edge-on.
uint packSlope(vec2 slope) { return packHalf2x16(clamp(slope, vec2(-1.0e3), vec2(1.0e3))); }

// A bit of y: all under the texel's filter is one plane.
const uint kPlane = 0x800000u;
// A bit of x, green's sign, in level 2 alone: all around the texel lies on that plane, too.
const uint kFlat = 0x80000000u;

// `plane`: kPlane or 0.
uvec4 packTexel(Texel t, uint plane) {
  uvec2 color = packColor(t.color, packArea(t.mass) | t.material << 8);
  return uvec4(color.x, color.y | plane, floatBitsToUint(t.depth), packSlope(t.slope));
}

float massOf(uint y) { return unpackArea((y >> 16) & 0x7Fu); }

Texel unpackTexel(uvec4 u) {
  return Texel(unpackColor(uvec2(u.x & ~kFlat, u.y)), massOf(u.y), u.y >> 24, uintBitsToFloat(u.z), unpackHalf2x16(u.w));
}

bool hasSurface(uvec4 texel) { return (texel.y & 0x7F0000u) != 0u; }

bool isPlane(uvec4 texel) { return (texel.y & kPlane) != 0u; }

uint materialBits(uvec4 texel) { return texel.y >> 24; }

// Texels [xy, zw) of a level: those that the rect touches and, from level 2 on, a border of one, which keeps what
// the filter carries over the edge. No others are written or read.
ivec4 levelRect(uint level) {
  ivec4 rect = ivec4(frame.rect);
  int l = int(level), border = level > 1u ? 1 : 0;
  return ivec4((rect.xy >> l) - border, ((rect.zw - 1) >> l) + 1 + border);
}

// Scene units that a texel of the level covers in x and y at planar distance p, facing the camera.
vec2 texelSize(float p, uint level) {
  return pixelSize(frame.camera, p) * (exp2(float(level)) / frame.camera.range.w);
}

// 1 / s^2 for sameSurface: s is the longest side of a texel of facing sides `size` on a surface of that slope.
float inverseSpread(vec2 slope, vec2 size) {
  // Sides are positive in front of the eye; the floor keeps their product normal.
  return 1.0 / max((1.0 + dot(slope, slope)) * size.x * size.y, 1.0e-30);
}

// How much less of a kernel reaches what is not on a texel's tangent plane but `off` in depth from it, `along` in depth
// from the texel's center on the plane: with d = along + off, the squared distance differs by d^2 - along^2 =
// off (off + 2 along). The two terms have factors of their own, x and y of `falloff`: the first says how far a kernel
// bridges gaps, the second how it shifts on curved surfaces, which filters of few taps do less than Gaussians.
float sameSurface(float off, float along, float inverseSpread2, vec2 falloff) {
  float rest = clamp(1.0 - off * (falloff.x * off + falloff.y * along) * inverseSpread2, 0.0, 1.4);
  return rest * rest;
}

// Texels around a texel lie on its plane up to this part of the squared length of its side.
const float kPlaneOffset = 0.1;

// Falloffs of downsampling, of the stretch and the coarser levels of upsampling, and of the last pass: those with the least errors on
// the scenes and captures of docs/diffusion.md that let no more light over a gap than the profile does.
const vec2 kDownsampleFalloff = vec2(PELLUCID_DOWNSAMPLE_FALLOFF), kStretchFalloff = vec2(PELLUCID_STRETCH_FALLOFF),
           kUpsampleFalloff = vec2(PELLUCID_UPSAMPLE_FALLOFF), kPixelFalloff = vec2(PELLUCID_PIXEL_FALLOFF);

// The pixel that a texel's center lies at.
vec2 pixelOf(uint level, ivec2 texel) { return (vec2(texel) + 0.5) * exp2(float(level)) - 0.5; }

// Area of a texel's surface over that of one facing the camera: the normal is (-slope, 1 + slope . ray) of a pixel's
// columns, its rows and the depth.
float areaOf(uint level, ivec2 texel, vec2 slope) {
  vec2 pixel = pixelOf(level, texel);
  vec2 ray = frame.facingRay[0].xy + pixel.x * frame.facingRay[0].zw + pixel.y * frame.facingRay[1].xy;
  float facing = 1.0 + dot(slope, ray);
  return min(sqrt(dot(slope, slope) + facing * facing), kMostArea);
}

// Edge-on surfaces show no more area than one that far from it, 87 degrees from facing the camera: the cosine.
const float kLeastCosine = 0.05;

// Area of a pixel with a normal of any length > 0; 0: it has none.
float areaOf(vec2 pixel, vec3 normal) {
  // In the normal's space.
  vec3 ray = frame.normalRay[0].xyz + pixel.x * frame.normalRay[1].xyz + pixel.y * frame.normalRay[2].xyz;
  float squared = dot(normal, normal), along = dot(normal, ray);
  // False for NaN too.
  return squared > 1.0e-8 ? inversesqrt(max(along * along * (1.0 / squared), kLeastCosine * kLeastCosine)) : 0.0;
}

// Texel of level 1 from its four pixels, rows first; depth <= 0: none. The nearest surface and what lies behind it by no more
// than its own slope over a pixel, or within what a surface 83 degrees from facing the camera has. `area`: of the pixels'
// surfaces, 0: as the depths say.
uvec4 quadTexel(uint material[4], float depth[4], vec3 color[4], vec4 area) {
  uint nearestMaterial = 0u, any = 0u;
  float nearest = kNoDepth;
  for (int i = 0; i < 4; ++i) {
    any = max(any, material[i]);
    if (material[i] == 0u || !(depth[i] > 0.0) || depth[i] >= nearest) continue;
    nearest = depth[i];
    nearestMaterial = material[i];
  }
  if (nearestMaterial == 0u) return uvec4(0u, any << 24, 0u, 0u);
  vec2 sides = squaredPixelSize(frame.camera, nearest);
  float side = sqrt(min(sides.x, sides.y));
  vec3 mean = vec3(0.0);
  float sum = 0.0, weights = 0.0, mass = 0.0;
  for (int i = 0; i < 4; ++i) {
    bool counts = depth[i] > 0.0 && material[i] == nearestMaterial && depth[i] - nearest <= side * max(8.0, area[i]);
    // Across an edge depths say nothing of slopes.
    float w = counts ? 1.0 : 0.0, a = w * (area[i] > 0.0 ? area[i] : 1.0);
    mean += a * color[i];
    sum += counts ? depth[i] : 0.0;
    weights += w;
    mass += a;
  }
  // The nearest counts, so weights >= 1; areas are positive.
  return packTexel(Texel(mean / mass, 0.25 * mass, nearestMaterial, sum / weights, vec2(0.0)), 0u);
}

// Texel of level 1 where its pixels are one surface, of that area. `packed`: by packHalves(color, material).
uvec4 wholeQuadTexel(uvec2 packed[4], float depth[4], float area) {
  vec3 color = unpackColor(packed[0]) + unpackColor(packed[1]) + unpackColor(packed[2]) + unpackColor(packed[3]);
  return packTexel(Texel(0.25 * color, area, packed[0].y >> 16, 0.25 * (depth[0] + depth[1] + depth[2] + depth[3]),
                         vec2(0.0)), kPlane);
}

// True where four pixels, packed alike, are one surface.
bool isWholeQuad(uvec2 packed[4], float depth[4]) {
  uint first = packed[0].y, different = (first ^ packed[1].y) | (first ^ packed[2].y) | (first ^ packed[3].y);
  float nearest = min(min(depth[0], depth[1]), min(depth[2], depth[3]));
  float farthest = max(max(depth[0], depth[1]), max(depth[2], depth[3]));
  bool one = nearest > 0.0 && first >> 16 != 0u && different >> 16 == 0u;
  vec2 sides = squaredPixelSize(frame.camera, nearest);
  float span = farthest - nearest;
  return one && span * span < 64.0 * min(sides.x, sides.y);
}

// Area of a whole quad's surface as its depths say.
float areaOfQuad(ivec2 quad, float depth[4]) {
  vec2 rise = 0.5 * vec2(depth[1] - depth[0] + depth[3] - depth[2], depth[2] - depth[0] + depth[3] - depth[1]);
  return areaOf(1u, quad, rise * inversesqrt(max(squaredPixelSize(frame.camera, depth[0]), vec2(1.0e-30))));
}

// First fundamental form of the surface over a texel, reduced to what the kernel needs.
struct Foreshortening {
  float lengthMm; // of a texel along the foreshortened direction, the longest on the surface
  float stretch;  // its square over that of the shortest, minus 1: 0 facing the camera
  vec2 axis;      // unit, in texels: direction of the shortest, in which the kernel is longest
};

Foreshortening foreshortening(ivec2 texel, uint level, float depth, vec2 slope) {
  float scale = exp2(float(level));
  Camera c = frame.camera;
  vec2 pixel = pixelOf(level, texel);
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
