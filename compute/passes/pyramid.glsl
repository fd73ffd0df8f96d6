// Bindings of the diffusion passes. All levels lie in one image, at FrameConstants::level.
#ifndef PELLUCID_PYRAMID_GLSL
#define PELLUCID_PYRAMID_GLSL

#include "passes/bindings.glsl"
#include "lib/pyramid.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };
layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;
layout(set = 0, binding = PELLUCID_BINDING_RESOLVED) uniform utexture2D resolvedImage;
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D levelsDestination;

ivec2 inAtlas(uint level, ivec2 texel) { return frame.level[level].xy + texel; }

uvec4 levelTexel(uint level, ivec2 texel) { return texelFetch(pyramidImage, inAtlas(level, texel), 0); }

void writeLevel(uint level, ivec2 texel, uvec4 value) { imageStore(levelsDestination, inAtlas(level, texel), value); }

float binomial(int i) { return i == 0 || i == 3 ? 0.125 : 0.375; }

// Place of a length on the surface among a material's shares, see KernelConstants.
float shareEntry(uint m, float lengthMm) {
  // The floor keeps log2 finite where the camera gives a pixel no size.
  float at = (log2(max(lengthMm, 1.0e-30)) - kernels[m].range.x) * kernels[m].range.y;
  return clamp(at, 0.0, float(PELLUCID_SHARE_ENTRIES - 1));
}

// Of level `level` and coarser ones, the share of the coarser ones at texels with this entry.
vec3 coarserShare(uint m, uint level, float entry) {
  uint i = min(uint(entry), uint(PELLUCID_SHARE_ENTRIES - 2));
  uint first = min(level - 2u, uint(PELLUCID_SHARE_COARSER)) * uint(PELLUCID_SHARE_ENTRIES) + i;
  return mix(kernels[m].share[first].rgb, kernels[m].share[first + 1u].rgb, entry - float(i));
}

#endif
