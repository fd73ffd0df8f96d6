// The two levels of the diffusion pyramid after level pass.value.x. A texel takes the nearest of the four surfaces under
// it and averages those of 4 x 4 texels that lie on it by 3 5 5 3 in each direction. A group makes 7 x 7 texels of the
// second level and, before them, the 16 x 16 of the first that they need: one an invocation.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_REDUCE_GROUP
#include "passes/pyramid.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage;

const uint kInvocations = uint(PELLUCID_REDUCE_GROUP * PELLUCID_REDUCE_GROUP);
// Sides of what a tile needs of the level before, and of its input.
const int kFirst = PELLUCID_REDUCE_GROUP, kInput = 2 * kFirst + 2;
const int kLoads = (kInput * kInput + int(kInvocations) - 1) / int(kInvocations);
// The input and, once that has been used, the first level: as many groups run at a time as these fit into a
// processor. Slopes are not needed.
shared uvec2 colors[kInput * kInput]; // and coverage and material, as packed
shared float depths[kInput * kInput];

// 3 5 5 3, variance 1.
float weight(int i) { return i == 0 || i == 3 ? 0.1875 : 0.3125; }

// Texels under a texel, from the push constants: compilers would unroll the loops of edges over a number that they know,
// which takes half as many registers again.
int taps() { return int(pass.value.y); }

// Above it, the weights of texels are within .2 % of those of a plane.
const float kPlaneResidual = 0.002;

// Even columns of a row come before the odd ones: reads of every other column meet no bank twice.
int slot(ivec2 at, int width) { return at.y * width + (at.x >> 1) + (at.x & 1) * (width >> 1); }

// Of the 4 x 4 texels whose first one is in an even column, at `first`.
int tap(int first, int width, int x, int y) { return first + slot(ivec2(x, y), width); }

struct Source {
  float coverage, depth;
  uint material;
};

Source sourceAt(int index) {
  uint bits = colors[index].y;
  return Source(float((bits >> 16) & 0xFFu) / float(kFullCoverage), depths[index], bits >> 24);
}

// Which texel's surface is taken: the nearest to the camera of the four in the middle or, beyond an edge, the one
// of the others that the filter weights most. -1: none.
int surfaceOf(int first, int stride) {
  int surface = -1;
  float nearest = kNoDepth, most = 0.0;
  for (int i = 0; i < 4; ++i) {
    int index = tap(first, stride, 1 + (i & 1), 1 + (i >> 1));
    Source t = sourceAt(index);
    if (t.coverage == 0.0 || t.depth >= nearest) continue;
    nearest = t.depth;
    surface = 5 + 4 * (i >> 1) + (i & 1);
  }
  if (surface >= 0) return surface;
  for (int i = 0; i < taps(); ++i) {
    float w = weight(i & 3) * weight(i >> 2) * sourceAt(tap(first, stride, i & 3, i >> 2)).coverage;
    if (!(w > most)) continue;
    most = w;
    surface = i;
  }
  return surface;
}

// Depth change per texel in one direction, to whichever neighbor of the same material is nearer in depth:
// the other one may lie across an edge.
float depthStep(int first, int stride, Source center, ivec2 at, ivec2 direction) {
  float best = 0.0;
  bool found = false;
  for (int side = -1; side <= 1; side += 2) {
    ivec2 neighbor = at + side * direction;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThan(neighbor, ivec2(3)))) continue;
    Source t = sourceAt(tap(first, stride, neighbor.x, neighbor.y));
    if (t.coverage == 0.0 || t.material != center.material) continue;
    float difference = float(side) * (t.depth - center.depth);
    if (!found || abs(difference) < abs(best)) best = difference;
    found = true;
  }
  return best;
}

// Where the 4 x 4 texels are not one plane.
uvec4 reducedEdge(uint finer, int first, int stride) {
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
  float spread2 = inverseSpread(slope, 2.0 * size);
  vec3 color = vec3(0.0);
  float weights = 0.0, off = 0.0;
  vec2 tilt = vec2(0.0), spread = vec2(0.0);
  for (int i = 0; i < taps(); ++i) {
    ivec2 at = ivec2(i & 3, i >> 2);
    int index = tap(first, stride, at.x, at.y);
    Source t = sourceAt(index);
    if (t.coverage == 0.0 || t.material != surface.material) continue;
    float difference = t.depth - surface.depth - dot(slope, vec2(at - nearest) * size);
    float w = weight(at.x) * weight(at.y) * t.coverage * sameSurface(difference, spread2);
    vec2 offset = (vec2(at) - 1.5) * size;
    color += w * unpackColor(colors[index]);
    off += w * difference;
    tilt += w * difference * offset;
    spread += w * offset * offset;
    weights += w;
  }
  // The nearest one counts, so weights > 0; spread is 0 only where it is alone.
  float inverse = 1.0 / weights;
  vec2 center = vec2(1.5) - vec2(nearest);
  float depth = surface.depth + dot(slope, center * size) + off * inverse;
  slope += tilt / max(spread, 1.0e-6 * size * size + 1.0e-30);
  return packTexel(Texel(color * inverse, weights, surface.material, depth, slope));
}

// From the 4 x 4 texels of level `finer` at `first`.
uvec4 reduced(uint finer, int first, int stride) {
  uint upper = colors[first].y >> 16, different = 0u;
  float base = depths[first], off = 0.0, square = 0.0;
  vec2 tilt = vec2(0.0);
  vec3 color = vec3(0.0);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      int index = tap(first, stride, x, y);
      uvec2 packed = colors[index];
      float w = weight(x) * weight(y), difference = depths[index] - base;
      different |= (packed.y >> 16) ^ upper;
      color += w * unpackColor(packed);
      off += w * difference;
      tilt += w * difference * (vec2(x, y) - 1.5);
      square += w * difference * difference;
    }
  if ((upper | different) == 0u) return uvec4(0u);
  // The plane of least squares, because the filter's variance is 1: its slope is the tilt.
  vec2 size = texelSize(base, finer);
  float residual = square - off * off - dot(tilt, tilt);
  vec2 slope = tilt / max(size, vec2(1.0e-30));
  bool plane = different == 0u && (upper & 0xFFu) == kFullCoverage &&
               residual * inverseSpread(slope, 2.0 * size) < kPlaneResidual;
  if (!plane) return reducedEdge(finer, first, stride);
  return packTexel(Texel(color, 1.0, upper >> 8, base + off, slope));
}

// Above it, something at a texel's neighbor counts 1 % less than on its plane.
const float kPlaneOffset = 0.0125;

// Whether a texel and all around it are full and lie on one plane. `at`: not in the outermost rows and columns.
bool isFlat(uvec4 bits, ivec2 at, uint level) {
  float depth = uintBitsToFloat(bits.z);
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  float most = kPlaneOffset / inverseSpread(slope, size);
  bool plane = coverageBits(bits) == kFullCoverage;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      int index = slot(at + ivec2(x, y), kFirst);
      float off = depths[index] - depth - dot(slope, vec2(x, y) * size);
      plane = plane && colors[index].y >> 16 == bits.y >> 16 && off * off < most;
    }
  return plane;
}

void main() {
  uint finer = pass.value.x;
  int invocation = int(gl_LocalInvocationIndex);
  // The rect's borders are edges, which take longest: first and last rows come in the middle.
  uvec2 group = uvec2(gl_WorkGroupID.x, (gl_WorkGroupID.y + gl_NumWorkGroups.y / 2u) % gl_NumWorkGroups.y);
  ivec4 finerRect = levelRect(finer), rect = levelRect(finer + 1u), lastRect = levelRect(finer + 2u);
  ivec2 own = lastRect.xy + PELLUCID_REDUCE_TILE * ivec2(group), start = 2 * own - 1;
  // All loads before the first is used, so that their latencies overlap.
  uvec4 loaded[kLoads];
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    int i = invocation + j * int(kInvocations);
    ivec2 texel = 2 * start - 1 + ivec2(i % kInput, i / kInput);
    loaded[j] = insideLevel(finerRect, texel) ? texelFetch(pyramidImage, inAtlas(finer, texel), 0) : uvec4(0u);
  }
  [[unroll]] for (int j = 0; j < kLoads; ++j) {
    int i = invocation + j * int(kInvocations);
    int index = slot(ivec2(i % kInput, i / kInput), kInput);
    if (i < kInput * kInput) {
      colors[index] = loaded[j].xy;
      depths[index] = uintBitsToFloat(loaded[j].z);
    }
  }
  barrier();
  ivec2 at = ivec2(gl_LocalInvocationID.xy), texel = start + at;
  bool inside = insideLevel(rect, texel);
  uvec4 bits = inside ? reduced(finer, 2 * at.y * kInput + at.x, kInput) : uvec4(0u);
  barrier();
  int index = slot(at, kFirst);
  colors[index] = bits.xy;
  depths[index] = uintBitsToFloat(bits.z);
  barrier();
  // The outer ones are the groups' beside.
  if (inside && all(greaterThan(at, ivec2(0))) && all(lessThan(at, ivec2(kFirst - 1)))) {
    if (finer == 1u && isFlat(bits, at, finer + 1u)) bits.y += 1u << 16;
    writeLevel(finer + 1u, texel, bits);
  }
  at = ivec2(invocation % PELLUCID_REDUCE_TILE, invocation / PELLUCID_REDUCE_TILE);
  texel = own + at;
  if (at.y < PELLUCID_REDUCE_TILE && insideLevel(lastRect, texel))
    writeLevel(finer + 2u, texel, reduced(finer + 1u, 2 * at.y * kFirst + at.x, kFirst));
}
