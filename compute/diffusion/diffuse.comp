// Blends the pixels' own shares of the profile with the upsampled pyramid's. Texels of level 2 that are planes have their 4 x 4
// pixels filtered without looking at depths. The rest, edges, are collected and done a pixel an invocation.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "diffusion/upsampled.glsl"
#include "frame/group_order.glsl"
#include "gather/probe_image.glsl"
#include "diffusion/diffuse_group.glsl"
#include "diffusion/pixel_filters.glsl"
#include "diffusion/edges.glsl"
#include "diffusion/planes.glsl"

void main() {
  int invocation = int(gl_LocalInvocationIndex);
  ivec2 firstTexel = (ivec2(frame.rect.xy) >> 2) + ivec2(workGroupBordersFirst(PELLUCID_LIST_DIFFUSE)) * ivec2(kTexelsX, kTexelsY);
  // All loads come before the first barrier, so that a group waits for memory once.
  uvec4 texel = uvec4(0u), texelShares = uvec4(0u);
  ivec2 inWindow = ivec2(invocation % kWindowX, invocation / kWindowX);
  bool hasTexel = inWindow.y < kWindowY;
  if (hasTexel && contains(levelRect(2u), firstTexel + inWindow - 1)) {
    texel = texelFetch(pyramidImage, upsampledPlace(firstTexel + inWindow - 1), 0);
    texelShares = texelFetch(pyramidImage, sharesPlace(firstTexel + inWindow - 1), 0);
  }
  // Cells of probes are texels of level 2. Invocations that hold no texel load them.
  int probe = kInvocations - 1 - invocation;
  bool hasProbe = kGathers && probe < (kTexelsX + 1) * (kTexelsY + 1);
  if (hasProbe) texel = probeBits(firstTexel + ivec2(probe % (kTexelsX + 1), probe / (kTexelsX + 1)));
  ivec2 first = 4 * firstTexel + ivec2(ownColumn() - kRing, ownRow());
  vec4 sources[kRows + 2 * kMostRing];
  [[unroll]] for (int i = 0; i < kRows + 2 * kMostRing; ++i)
    if (kFine || (i >= kMostRing && i < kRows + kMostRing))
      sources[i] = texelFetch(sourceImage, withinRect(first + ivec2(0, i - kMostRing)), 0);
  if (invocation < kTexelsY) edgeCounts[invocation] = 0u;
  if (invocation == 0) anySurface = edgeBands = anyShape = someLight = 0u;
  barrier();
  if (hasTexel) keepTexel(invocation, inWindow, texel, texelShares);
  uint light = hasProbe ? kindsOfLight(texel) : 0u;
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (anySurface != 0u) { // the same for all invocations
    collectEdges(invocation);
    [[unroll]] for (int i = 0; i < kRows + 2 * kMostRing; ++i)
      if (kFine || (i >= kMostRing && i < kRows + kMostRing)) sources[i].rgb = sanitize(sources[i].rgb);
    // The code is there twice, so that what faces the camera has filters of constants.
    if (kFine && anyShape != 0u)
      diffusePlanes(firstTexel, sources, true);
    else
      diffusePlanes(firstTexel, sources, false);
    diffuseEdges(firstTexel, invocation);
  }
}
