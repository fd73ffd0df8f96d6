// Levels of the diffusion pyramid: level 2 from the pixels (PIXELS), or two levels from the one before. A texel
// takes the nearest of the four surfaces under it and averages those of 4 x 4 texels that lie on it with the
// binomial 1 3 3 1, whose triple zero at the coarser level's sampling frequency leaves hardly any aliasing.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_REDUCE_GROUP
#include "passes/pyramid.glsl"

#ifdef PIXELS
const int kFiner = 2 * PELLUCID_REDUCE_GROUP + 2; // pairs of pixels, and a border of one
const int kMiddle = 0;
#else
const int kMiddle = PELLUCID_REDUCE_GROUP + 2;    // the level between: half a group of the last level, and a border
const int kFiner = 2 * kMiddle + 2;
#endif
shared uvec4 texels[kFiner * kFiner + kMiddle * kMiddle];

#ifdef PIXELS
// Four pixels as a texel of level 1, without its slope. One surface if they lie on one plane, else the nearest.
uvec4 quadTexel(ivec2 quad, bool copies) {
  uint material[4];
  float depth[4];
  vec4 source[4];
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * quad + ivec2(i & 1, i >> 1);
    material[i] = insideRect(pixel) ? materialAt(pixel) : 0u;
  }
  if ((material[0] | material[1] | material[2] | material[3]) == 0u) return uvec4(0u);
  // The rest at once, so that the latencies overlap.
  for (int i = 0; i < 4; ++i) {
    ivec2 at = clamp(2 * quad + ivec2(i & 1, i >> 1), ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1);
    depth[i] = frontDistance(at);
    source[i] = texelFetch(sourceImage, at, 0);
  }
  for (int i = 0; i < 4; ++i) {
    ivec2 pixel = 2 * quad + ivec2(i & 1, i >> 1);
    bool some = material[i] != 0u;
    if (!some) depth[i] = -1.0;
#ifdef COPY
    // The quads of a border are the groups' beside.
    if (some && copies) imageStore(destinationImage, pixel, source[i]);
#endif
  }
  float nearest = kNoDepth;
  uint nearestMaterial = 0u;
  bool one = true;
  for (int i = 0; i < 4; ++i) {
    one = one && depth[i] > 0.0 && material[i] == material[0];
    if (!(depth[i] > 0.0) || depth[i] >= nearest) continue;
    nearest = depth[i];
    nearestMaterial = material[i];
  }
  if (nearestMaterial == 0u) return uvec4(0u);
  vec2 sides = texelSize(nearest, 0u);
  float side = min(sides.x, sides.y);
  // A plane up to 76 degrees from facing the camera; steeper pairs count as an edge.
  float farthest = max(max(depth[0], depth[1]), max(depth[2], depth[3]));
  bool plane = one && abs(depth[0] - depth[1] - depth[2] + depth[3]) < side && farthest - nearest < 8.0 * side;
  float reach = plane ? 8.0 * side : 1.5 * side;
  vec3 color = vec3(0.0);
  float sum = 0.0, weights = 0.0;
  for (int i = 0; i < 4; ++i) {
    bool counts = depth[i] > 0.0 && material[i] == nearestMaterial && depth[i] - nearest <= reach;
    float w = counts ? 1.0 : 0.0;
    color += w * sanitize(source[i].rgb);
    sum += counts ? depth[i] : 0.0;
    weights += w;
  }
  // The nearest counts, so weights >= 1.
  return packTexel(Texel(color / weights, 0.25 * weights, nearestMaterial, sum / weights, vec2(0.0)));
}
#else
uvec4 finerTexel(uint finer, ivec2 texel) {
  return insideLevel(levelRect(finer), texel) ? levelTexel(finer, texel) : uvec4(0u);
}
#endif

Texel texelAt(int first, int stride, ivec2 at) { return unpackTexel(texels[first + at.y * stride + at.x]); }

// The surface that a texel stands for: the nearest to the camera of the four under it or, beyond an edge, the
// one of the others that the filter weights most.
Texel surfaceOf(int first, int stride, ivec2 corner, out ivec2 at) {
  Texel surface = kNothing;
  at = ivec2(1);
  for (int i = 0; i < 4; ++i) {
    ivec2 candidate = 1 + ivec2(i & 1, i >> 1);
    Texel t = texelAt(first, stride, corner + candidate);
    if (t.coverage == 0.0 || (surface.coverage > 0.0 && t.depth >= surface.depth)) continue;
    surface = t;
    at = candidate;
  }
  if (surface.coverage > 0.0) return surface;
  float most = 0.0;
  for (int i = 0; i < 16; ++i) {
    ivec2 candidate = ivec2(i & 3, i >> 2);
    Texel t = texelAt(first, stride, corner + candidate);
    float w = binomial(candidate.x) * binomial(candidate.y) * t.coverage;
    if (!(w > most)) continue;
    most = w;
    surface = t;
    at = candidate;
  }
  return surface;
}

#ifdef PIXELS
// Depth change per texel in one direction, to whichever neighbor of the same material is nearer in depth:
// the other one may lie across an edge.
float depthStep(Texel center, int stride, ivec2 corner, ivec2 at, ivec2 direction) {
  float best = 0.0;
  bool found = false;
  for (int side = -1; side <= 1; side += 2) {
    ivec2 neighbor = at + side * direction;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThan(neighbor, ivec2(3)))) continue;
    Texel t = texelAt(0, stride, corner + neighbor);
    if (t.coverage == 0.0 || t.material != center.material) continue;
    float difference = float(side) * (t.depth - center.depth);
    if (!found || abs(difference) < abs(best)) best = difference;
    found = true;
  }
  return best;
}
#endif

// From the 4 x 4 texels of level `finer` at `corner` of the array that starts at `first`.
uvec4 reduced(uint finer, int first, int stride, ivec2 corner) {
  ivec2 nearest;
  Texel surface = surfaceOf(first, stride, corner, nearest);
  if (surface.coverage == 0.0) return uvec4(0u);
  vec2 size = texelSize(surface.depth, finer);
#ifdef PIXELS
  surface.slope = vec2(depthStep(surface, stride, corner, nearest, ivec2(1, 0)),
                       depthStep(surface, stride, corner, nearest, ivec2(0, 1))) / max(size, vec2(1.0e-30));
#endif
  float spread2 = inverseSpread(surface.slope, 2.0 * size);
  vec3 color = vec3(0.0);
  float weights = 0.0, off = 0.0;
  vec2 tilt = vec2(0.0), spread = vec2(0.0);
  for (int i = 0; i < 16; ++i) {
    ivec2 at = ivec2(i & 3, i >> 2);
    Texel t = texelAt(first, stride, corner + at);
    if (t.coverage == 0.0 || t.material != surface.material) continue;
    float difference = t.depth - surface.depth - dot(surface.slope, vec2(at - nearest) * size);
    float w = binomial(at.x) * binomial(at.y) * t.coverage * sameSurface(difference, spread2);
    vec2 offset = (vec2(at) - 1.5) * size;
    color += w * t.color;
    off += w * difference;
    tilt += w * difference * offset;
    spread += w * offset * offset;
    weights += w;
  }
  // The nearest one counts, so weights > 0; spread is 0 only where it is alone.
  float inverse = 1.0 / weights;
  vec2 center = vec2(1.5) - vec2(nearest);
  float depth = surface.depth + dot(surface.slope, center * size) + off * inverse;
  vec2 slope = surface.slope + tilt / max(spread, 1.0e-6 * size * size + 1.0e-30);
  return packTexel(Texel(color * inverse, weights, surface.material, depth, slope));
}

void main() {
  uint finer = pass.value.x;
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  int invocation = int(gl_LocalInvocationIndex);
  const int invocations = PELLUCID_REDUCE_GROUP * PELLUCID_REDUCE_GROUP;
#ifdef PIXELS
  ivec4 rect = levelRect(2u);
  ivec2 group = rect.xy + ivec2(gl_WorkGroupID.xy) * PELLUCID_REDUCE_GROUP;
  ivec2 start = 2 * group - 1;
  for (int i = invocation; i < kFiner * kFiner; i += invocations)
{
    ivec2 at = ivec2(i % kFiner, i / kFiner);
    texels[i] = quadTexel(start + at, all(greaterThan(at, ivec2(0))) && all(lessThan(at, ivec2(kFiner - 1))));
  }
  barrier();
  ivec2 texel = group + local;
  if (insideLevel(rect, texel)) writeLevel(2u, texel, reduced(1u, 0, kFiner, 2 * local));
#else
  ivec4 middleRect = levelRect(finer + 1u), rect = levelRect(finer + 2u);
  ivec2 group = rect.xy + ivec2(gl_WorkGroupID.xy) * (PELLUCID_REDUCE_GROUP / 2);
  ivec2 middleStart = 2 * group - 1, start = 2 * middleStart - 1;
  for (int i = invocation; i < kFiner * kFiner; i += invocations)
    texels[i] = finerTexel(finer, start + ivec2(i % kFiner, i / kFiner));
  barrier();
  for (int i = invocation; i < kMiddle * kMiddle; i += invocations) {
    ivec2 at = ivec2(i % kMiddle, i / kMiddle), texel = middleStart + at;
    bool inside = insideLevel(middleRect, texel);
    uvec4 result = inside ? reduced(finer, 0, kFiner, 2 * at) : uvec4(0u);
    texels[kFiner * kFiner + i] = result;
    // Borders belong to the groups beside.
    bool own = all(greaterThan(at, ivec2(0))) && all(lessThan(at, ivec2(kMiddle - 1)));
    if (inside && own) writeLevel(finer + 1u, texel, result);
  }
  barrier();
  ivec2 texel = group + local;
  if (all(lessThan(local, ivec2(PELLUCID_REDUCE_GROUP / 2))) && insideLevel(rect, texel))
    writeLevel(finer + 2u, texel, reduced(finer + 1u, kFiner * kFiner, kMiddle, 2 * local));
#endif
}
