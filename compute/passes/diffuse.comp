// The pixels' own share of the profile plus the resolved pyramid. An invocation does 2 x 2 pixels, which lie in one
// texel of level 2.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_DIFFUSE_GROUP
#include "passes/pyramid.glsl"

const int kPixels = 2 * PELLUCID_DIFFUSE_GROUP + 2; // the group's and a border of one
const int kTexels = PELLUCID_DIFFUSE_GROUP / 2 + 3; // of level 2 under the group, wherever it starts, and around it
const uint kNoSurface = 0x8000u;               // a material without front depth
shared uvec2 colors[kPixels * kPixels];       // and material, kNoSurface or 0
shared float depths[kPixels * kPixels];
shared uvec4 resolved[kTexels * kTexels];
shared vec4 planes[kTexels * kTexels];        // depth, slope, inverseSpread of level 2

struct Pixel {
  vec4 color;
  float depth;
  uint material;
};

// All at once, so that the latencies overlap.
Pixel fetchPixel(ivec2 pixel) {
  ivec2 at = clamp(pixel, ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1);
  Pixel p;
  p.material = materialAt(at);
  p.color = texelFetch(sourceImage, at, 0);
  p.depth = frontDistance(at);
  p.color.rgb = sanitize(p.color.rgb);
  if (at != pixel) p.material = 0u;
  return p;
}

int indexOf(ivec2 local) { return (local.y + 1) * kPixels + local.x + 1; }

void store(ivec2 local, Pixel p) {
  uint blue = packHalf2x16(vec2(p.color.b, 0.0)) & 0xFFFFu;
  uint surface = p.material == 0u ? 0u : p.depth > 0.0 ? p.material : kNoSurface;
  colors[indexOf(local)] = uvec2(packHalf2x16(p.color.rg), blue | surface << 16);
  depths[indexOf(local)] = p.depth;
}

// The border pixels that an invocation loads besides its own: one along the sides and, four of them, a corner.
ivec2 sidePixel(int invocation) {
  const int side = 2 * PELLUCID_DIFFUSE_GROUP;
  int at = invocation % side;
  switch (invocation / side) {
    case 0: return ivec2(at, -1);
    case 1: return ivec2(at, side);
    case 2: return ivec2(-1, at);
    default: return ivec2(side, at);
  }
}

ivec2 cornerPixel(int corner) { return ivec2(corner & 1, corner >> 1) * (2 * PELLUCID_DIFFUSE_GROUP + 1) - 1; }

// The quadratic B-spline at `texel` (-1, 0, 1) for the left and the right of two pixels, which are at `from` and a
// quarter of a texel after it.
vec2 spline(float from, int texel) {
  vec2 at = vec2(from, from + 0.25) - float(texel);
  vec2 outside = 1.5 - abs(at);
  return texel == 0 ? 0.75 - at * at : 0.5 * outside * outside;
}

// 1 2 1 about pixel `at` of the two middle ones of four.
float binomial121(int i, int at) { return i == at + 1 ? 0.5 : i == at || i == at + 2 ? 0.25 : 0.0; }

void main() {
  // Groups start at even pixels, so that pairs lie in one texel.
  ivec2 group = (ivec2(frame.rect.xy) & ~1) + ivec2(gl_WorkGroupID.xy) * (2 * PELLUCID_DIFFUSE_GROUP);
  ivec2 local = 2 * ivec2(gl_LocalInvocationID.xy);
  int invocation = int(gl_LocalInvocationIndex);
  // Texels first and at once: their latency passes while the pixels are loaded.
  ivec2 firstTexel = (group >> 2) - 1;
  ivec4 texelRect = levelRect(2u);
  ivec2 atTexel = firstTexel + ivec2(invocation % kTexels, invocation / kTexels);
  bool inside = invocation < kTexels * kTexels && insideLevel(texelRect, atTexel);
  ivec2 reachable = clamp(atTexel, texelRect.xy, texelRect.zw - 1);
  uvec4 texelBits = levelTexel(2u, reachable), resolvedBits = texelFetch(resolvedImage, inAtlas(2u, reachable), 0);
  for (int i = 0; i < 4; ++i) {
    ivec2 at = local + ivec2(i & 1, i >> 1);
    store(at, fetchPixel(group + at));
  }
  if (invocation < 8 * PELLUCID_DIFFUSE_GROUP) store(sidePixel(invocation), fetchPixel(group + sidePixel(invocation)));
  if (invocation < 4) store(cornerPixel(invocation), fetchPixel(group + cornerPixel(invocation)));
  if (invocation < kTexels * kTexels) {
    Texel t = unpackTexel(texelBits);
    resolved[invocation] = inside ? resolvedBits : uvec4(0u);
    planes[invocation] = vec4(t.depth, t.slope, inverseSpread(t.slope, texelSize(t.depth, 2u)));
  }
  barrier();

  ivec2 texel = (group + local) >> 2, place = ((group + local) >> 1) & 1;
  int centerTexel = (texel.y - firstTexel.y) * kTexels + texel.x - firstTexel.x;
  vec2 from = 0.5 * vec2(place) - 0.375;

  // Pixels to do, by the surface they lie on: all at once where the four lie on one.
  uint pending = 0u;
  for (int i = 0; i < 4; ++i) {
    ivec2 at = local + ivec2(i & 1, i >> 1), pixel = group + at;
    uint surface = colors[indexOf(at)].y >> 16;
    if (surface != 0u && surface != kNoSurface) pending |= 1u << i;
    if (surface != kNoSurface) continue;
    // No scale to diffuse over.
    vec4 source = texelFetch(sourceImage, pixel, 0);
    writeResult(pixel, sanitize(source.rgb), source.a, pass.value.w != 0u);
  }
  while (pending != 0u) {
    int anchor = findLSB(pending);
    ivec2 atAnchor = ivec2(anchor & 1, anchor >> 1);
    uint material = colors[indexOf(local + atAnchor)].y >> 16;
    float depth = depths[indexOf(local + atAnchor)];
    vec2 size = texelSize(depth, 0u);

    vec4 coarser[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    float entry = 0.0, weights = 0.0;
    vec2 slope = vec2(0.0);
    vec2 fromCenter = vec2(atAnchor + 2 * place) - 1.5; // of the texel, pixels
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        int index = centerTexel + y * kTexels + x;
        Resolved r = unpackResolved(resolved[index]);
        vec4 plane = planes[index];
        float expected = plane.x + dot(plane.yz, (fromCenter - 4.0 * vec2(x, y)) * size);
        float w = r.material == material ? r.density * sameSurface(depth - expected, plane.w) : 0.0;
        vec2 weightX = spline(from.x, x), weightY = w * spline(from.y, y);
        vec4 color = vec4(r.color, 1.0);
        for (int i = 0; i < 4; ++i) coarser[i] += weightX[i & 1] * weightY[i >> 1] * color;
        w = (weightX.x + weightX.y) * (weightY.x + weightY.y);
        entry += w * r.pixelEntry;
        slope += w * plane.yz;
        weights += w;
      }
    float inverse = weights > 0.0 ? 1.0 / weights : 0.0;
    slope *= inverse;

    // The surface's part of the 4 x 4 pixels around.
    vec2 depthStep = slope * size;
    float spread2 = inverseSpread(slope, 2.0 * size);
    vec4 fine[4] = vec4[4](vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0));
    uint here = 1u << anchor;
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x) {
        int index = indexOf(local + ivec2(x, y) - 1);
        uvec2 packed = colors[index];
        float expected = depth + dot(depthStep, vec2(ivec2(x, y) - 1 - atAnchor));
        float w = packed.y >> 16 == material ? sameSurface(depths[index] - expected, spread2) : 0.0;
        vec4 color = w * vec4(unpackColor(packed), 1.0);
        for (int i = 0; i < 4; ++i) fine[i] += binomial121(x, i & 1) * binomial121(y, i >> 1) * color;
        if (x > 0 && x < 3 && y > 0 && y < 3 && w > 0.5) here |= 1u << (x - 1 + 2 * (y - 1));
      }
    here &= pending;
    pending &= ~here;

    vec3 coarserShare = vec3(0.0), binomialShare = vec3(0.0);
    if (weights > 0.0) {
      uint m = material - 1u, i = min(uint(entry * inverse), uint(PELLUCID_SHARE_ENTRIES - 2));
      float part = entry * inverse - float(i);
      coarserShare = mix(kernels[m].pixelShare[2u * i].rgb, kernels[m].pixelShare[2u * i + 2u].rgb, part);
      binomialShare = mix(kernels[m].pixelShare[2u * i + 1u].rgb, kernels[m].pixelShare[2u * i + 3u].rgb, part);
    }
    // Shares are weighted with the densities that were found, 4 for all four pixels. The pixel itself is there, so
    // the divisor is 0 only where all of the share is the coarser one's.
    vec3 theirs = coarserShare * (0.25 * weights);
    coarserShare = theirs / max(1.0 - coarserShare + theirs, vec3(1.0e-6));
    for (int i = 0; i < 4; ++i) {
      if ((here & 1u << i) == 0u) continue;
      ivec2 pixel = group + local + ivec2(i & 1, i >> 1);
      vec4 source = texelFetch(sourceImage, pixel, 0);
      vec3 color = sanitize(source.rgb);
      // The pixel counts in its binomial, so the divisor is 0 only where the anchor's surface has no slope to go by.
      color = mix(color, fine[i].rgb / max(fine[i].a, 1.0e-6), binomialShare * min(4.0 * fine[i].a, 1.0));
      color = mix(color, coarser[i].rgb / max(coarser[i].a, 1.0e-6), coarserShare);
      writeResult(pixel, color, source.a, pass.value.w != 0u);
    }
  }
}
