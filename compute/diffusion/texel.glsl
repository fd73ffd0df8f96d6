// Texels of the pyramid of mip levels that the diffusion works on. A texel of level l covers 2^l x 2^l pixels of the image, not
// of the rect, and stands for one surface.
#ifndef PELLUCID_TEXEL_GLSL
#define PELLUCID_TEXEL_GLSL

#include "frame/blocks.glsl"
#include "lib/packing.glsl"
#include "shared/pellucid_filters.h"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage; // levels that the pass reads
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D levelsDestination;

struct Texel {
  vec3 color;    // mean over the surface's area
  float area;    // projected-area weight of the surface under the filter; 0: there is none
  uint material; // where there is no surface, not 0: some of its pixels have this material and no depth
  float depth;   // planar, at the texel's center
  vec2 slope;    // change of depth over that of position, facing the camera: tangents, the same at every level
};

uvec2 packColor(vec3 color, uint upper) { return packHalves(roundToHalf(color), upper); }

const float kMostArea = 16.0; // the largest that packArea's 7 bits hold

// Projected-area weights, 0 to 15.75, take 7 bits: roots in steps of 1/32, which are 3.1 % of the weight at most near 1.
uint packArea(float area) {
  return uint(clamp(32.0 * sqrt(area) + 0.5, area > 0.0 ? 1.0 : 0.0, 127.0)); // anything at all must not round to 0
}

float unpackArea(uint u) { return float(u * u) / 1024.0; }

// Kernel coverage of each channel. A plane's, 1, is exact.
const float kCoverageOne = 128.0;
uint packCoverage(vec3 coverage) { return packUnorm4x8(vec4(coverage * (kCoverageOne / 255.0), 0.0)); }
// The result is the coverage times kCoverageOne.
vec3 unpackCoverage(uint u) { return vec3(u & 0xFFu, (u >> 8) & 0xFFu, (u >> 16) & 0xFFu); }

// A slope of 1000 is 0.06 degrees from edge-on.
uint packSlope(vec2 slope) { return packHalf2x16(clamp(slope, vec2(-1.0e3), vec2(1.0e3))); }

// A bit of y says that all under the texel's filter is one plane.
const uint kPlane = 0x800000u;
// A bit of x, green's sign, says in level 2 alone that all around the texel lies on that plane, too.
const uint kFlat = 0x80000000u;

// `plane`: kPlane or 0.
uvec4 packTexel(Texel t, uint plane) {
  uvec2 color = packColor(t.color, packArea(t.area) | t.material << 8);
  return uvec4(color.x, color.y | plane, floatBitsToUint(t.depth), packSlope(t.slope));
}

float storedArea(uint y) { return unpackArea((y >> 16) & 0x7Fu); }

Texel unpackTexel(uvec4 u) {
  return Texel(unpackHalves(uvec2(u.x & ~kFlat, u.y)), storedArea(u.y), u.y >> 24, uintBitsToFloat(u.z), unpackHalf2x16(u.w));
}

bool hasSurface(uvec4 texel) { return (texel.y & 0x7F0000u) != 0u; }
bool isPlane(uvec4 texel) { return (texel.y & kPlane) != 0u; }
uint materialBits(uvec4 texel) { return texel.y >> 24; }

// Texels [xy, zw) of a level that the rect touches.
ivec4 touchedTexels(uint level) {
  ivec4 rect = ivec4(frame.rect);
  int l = int(level);
  return ivec4(rect.xy >> l, ((rect.zw - 1) >> l) + 1);
}

// From level 2 on a border of one texel keeps what the filter carries over the rect's edge. No other texels are written or read.
ivec4 levelRect(uint level) { return touchedTexels(level) + (level > 1u ? ivec4(-1, -1, 1, 1) : ivec4(0)); }

ivec2 inAtlas(uint level, ivec2 texel) { return frame.level[level].xy + texel; }

void writeLevel(uint level, ivec2 texel, uvec4 value) { imageStore(levelsDestination, inAtlas(level, texel), value); }

// A texel of level 1, which pyramidImage holds; nothing where none was written, as cells hold no material. `whole`: isWhole of the
// group's block.
uvec4 writtenQuad(ivec2 quad, bool whole) {
  if (!contains(levelRect(1u), quad)) return uvec4(0u);
  if (!whole && !cellHoldsMaterial(quad << 1)) return uvec4(0u);
  return texelFetch(pyramidImage, inAtlas(1u, quad), 0);
}

// A texel of level 2 or 3, which pyramidImage holds; nothing where none was written, as no block beside holds material.
uvec4 writtenTexel(uint level, ivec2 texel) {
  if (!contains(levelRect(level), texel)) return uvec4(0u);
  if (!isNearMaterial(texel << level)) return uvec4(0u);
  return texelFetch(pyramidImage, inAtlas(level, texel), 0);
}

// Scene units that a texel of the level covers in x and y at planar distance p, facing the camera.
vec2 texelSize(float p, uint level) {
  return pixelSize(frame.camera, p) * (exp2(float(level)) / frame.camera.range.w);
}

// Along pixels' columns and rows: what the view ray of a pixel is off from facing, per depth. 0 in the middle of a symmetric camera.
vec2 facingRayAt(vec2 pixel) {
  return frame.facingRay[0].xy + pixel.x * frame.facingRay[0].zw + pixel.y * frame.facingRay[1].xy;
}

// The pixel that a texel's center lies at.
vec2 pixelOf(uint level, ivec2 texel) { return (vec2(texel) + 0.5) * exp2(float(level)) - 0.5; }

// Unit normal towards the eye, view space. `ray`: of facingRayAt.
vec3 normalOfSlope(vec2 slope, vec2 ray) {
  // The depth's component is 1 along the ray, so that the length is not 0.
  return normalize(vec3(slope.x * frame.axes.xy + slope.y * frame.axes.zw, -(1.0 + dot(slope, ray)) * frame.camera.range.x));
}

// A surface's tangent plane, as a view ray meets it. For a step x at one depth, the plane's point lies dot(x, along) / sqrt(ray2)
// along the ray.
struct TangentPlane {
  vec2 along;
  float ray2;     // squared length of the ray per depth, 1 in the middle of a symmetric camera
  float inverse2; // 1 / s^2, s the longest side of a texel on the plane
};

// 1 / s^2 of a texel of facing sides `size`. `ray`: of facingRayAt.
float inverseSpread(vec2 slope, vec2 ray, vec2 size) {
  // The larger eigenvalue of the first fundamental form of unit steps at one depth.
  float facing = 1.0 + dot(slope, ray), middle = facing + 0.5 * dot(slope, slope) * (1.0 + dot(ray, ray));
  float squaredArea = dot(slope, slope) + facing * facing;
  float longest2 = middle + sqrt(max(middle * middle - squaredArea, 0.0));
  // Sides are positive in front of the eye; the floor keeps their product normal.
  return 1.0 / max(longest2 * size.x * size.y, 1.0e-30);
}

TangentPlane tangentPlane(vec2 slope, vec2 ray, float inverse2) {
  float ray2 = 1.0 + dot(ray, ray);
  return TangentPlane(ray2 * slope + ray, ray2, inverse2);
}

// Weight of what lies `off` in depth from a tangent plane whose point there is the step `x` away. With o and a their lengths along
// the ray, the squared distance differs by (a + o)^2 - a^2 = o (o + 2 a). The two terms have factors of their own, x and y of
// `falloff`: the first says how far a kernel bridges gaps, the second how it shifts on curved surfaces, where filters of few
// taps shift less than Gaussians.
const float kMostRoot = 1.4; // of a weight: no tap counts more than twice as much as on the plane
float tangentPlaneWeight(TangentPlane plane, float off, vec2 x, vec2 falloff) {
  float rest = clamp(1.0 - off * (falloff.x * plane.ray2 * off + falloff.y * dot(plane.along, x)) * plane.inverse2, 0.0, kMostRoot);
  return rest * rest;
}

// Texels around lie on a texel's plane up to this part of its squared side: kPixelFalloff then weights them with .9 at least.
const float kPlaneOffset = 0.1;

// Falloffs of downsampling, of the stretch and the coarser levels of upsampling, and of the last pass. They have the least
// errors on the scenes of `./run sweep` of those that let no more light over a gap than the profile does.
const vec2 kDownsampleFalloff = vec2(PELLUCID_DOWNSAMPLE_FALLOFF), kStretchFalloff = vec2(PELLUCID_STRETCH_FALLOFF),
           kUpsampleFalloff = vec2(PELLUCID_UPSAMPLE_FALLOFF), kPixelFalloff = vec2(PELLUCID_PIXEL_FALLOFF);

// Projected-area weight of a texel: the normal is (-slope, 1 + slope . ray) of a pixel's columns, its rows and the depth.
float areaOf(uint level, ivec2 texel, vec2 slope) {
  float facing = 1.0 + dot(slope, facingRayAt(pixelOf(level, texel)));
  return min(sqrt(dot(slope, slope) + facing * facing), kMostArea);
}

// Level 2 after upsampling, with all coarser levels in it, lies in the image of level 1: kPlane says there that all around the
// texel lies on its plane, too. Another texel holds the shares of the pixels under it and in w its kernel coverage, by which
// planes' shares have been weighted.
ivec2 upsampledPlace(ivec2 texel) { return frame.level[0].xy + texel; }
ivec2 sharesPlace(ivec2 texel) { return frame.level[0].zw + texel; }

// Shares of a pixel on the surface of a texel: of all but level 2 and coarser ones, and of that the part of the fine filter. In halves, 1 is exact, and so is next to nothing.
struct PixelShares {
  vec3 rest, fine;
};

// The part of the fine filter at which the pixel itself counts 0, less what 8 bits round: 1 - f + f w^2 = 0, w of its own weight.
const float kMostFine = 1.0 / (1.0 - PELLUCID_FINE_OWN * PELLUCID_FINE_OWN) - 0.003;

uvec3 packShares(PixelShares s) {
  uvec3 fine = uvec3(s.fine * (255.0 / kMostFine) + 0.5);
  return uvec3(packHalves(s.rest, fine.r | fine.g << 8), fine.b);
}

PixelShares unpackShares(uvec3 u) {
  return PixelShares(unpackHalves(u.xy), vec3((u.y >> 16) & 255u, u.y >> 24, u.z & 255u) * (kMostFine / 255.0));
}

#endif
