// The diffusion profile of a material over the pyramid, KernelConstants, and the foreshortened lengths at which it is looked up.
#ifndef PELLUCID_PROFILE_GLSL
#define PELLUCID_PROFILE_GLSL

#include "diffusion/texel.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

// Place of a length on the surface among a material's shares.
float shareEntry(uint m, float lengthMm) {
  // The floor keeps log2 finite where the camera gives a pixel no size.
  float at = (log2(max(lengthMm, 1.0e-30)) - kernels[m].range.x) * kernels[m].range.y;
  return clamp(at, 0.0, float(PELLUCID_SHARE_ENTRIES - 1));
}

// The coarser levels' share of the energy that `level` and they have, at texels with this entry.
vec3 coarserShare(uint m, uint level, float entry) {
  // In the table, whatever a NaN converts to, here and below.
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2));
  uint first = min(level - 2u, uint(PELLUCID_SHARE_COARSER)) * uint(PELLUCID_SHARE_ENTRIES) + i;
  return mix(kernels[m].share[first].rgb, kernels[m].share[first + 1u].rgb, entry - float(i));
}

// Parts of all energy at pixels with this entry, `element` as in KernelConstants::pixelShare.
vec3 beyondPixel(uint m, uint element, float entry) {
  entry = max(entry, 0.0);
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2)), first = uint(PELLUCID_PIXEL_SHARES) * i + element;
  vec3 next = kernels[m].pixelShare[first + uint(PELLUCID_PIXEL_SHARES)].rgb;
  return mix(kernels[m].pixelShare[first].rgb, next, entry - float(i));
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

// Octaves between the kernel's sides from which on shares ignore them: one more than stretched() of upsample.comp reaches, 1.5.
const float kMostOctaves = 2.5;

// Shares of pixels of a texel of level 2. Octaves between the kernel's sides count by factors of pellucid_filters.h: one octave is 60
// degrees from facing the camera. They fade over the last octave, 69 to 80 degrees.
PixelShares pixelShares(uint m, Foreshortening f) {
  // The stretch is >= 0 but for rounding.
  float longer = 0.5 * log2(1.0 + max(f.stretch, 0.0)), octaves = clamp(kMostOctaves - longer, 0.0, min(longer, 1.0));
  float entry = shareEntry(m, 0.25 * f.lengthMm), perOctave = kernels[m].range.y * octaves; // of a pixel, 1/4 of the texel
  float straight = abs(f.axis.x * f.axis.x - f.axis.y * f.axis.y); // 1: along rows or columns, 0: along a diagonal
  vec3 coarser = beyondPixel(m, 0u, entry - perOctave * (PELLUCID_FORESHORTENED_COARSER - PELLUCID_FORESHORTENED_STRAIGHT * straight));
  vec3 beyond = max(beyondPixel(m, 1u, entry - perOctave * PELLUCID_FORESHORTENED_FINE), coarser);
  // One Gaussian may ask for more than all.
  return PixelShares(1.0 - coarser, min((beyond - coarser) / max(1.0 - coarser, vec3(1.0e-3)), vec3(kMostFine)));
}

#endif
