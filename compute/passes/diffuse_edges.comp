// Pixels of edges by the profile itself over distances in space: pixels around them one by one, others as texels of the
// pyramid, coarser with their distance (Barnes and Hut 1986, on a grid). A group loads what its pixels need of one level
// after the other.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_EDGES_GROUP
#include "passes/normal_image.glsl"
#include "passes/resolved.glsl"

#ifdef GATHER
#include "passes/shared_points.glsl"
#endif

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

// A level sums what is under texels of the next coarser one so far to each side, where the finer level does not.
const int kAround = 2, kWindow = 2 * (2 * kAround + 1);
// Edge-on surfaces show no more area than one so far from it.
const float kLeastCosine = 0.05;
// Pixels of a tile, its texels of level 2, and pixels with all around them that are summed one by one: the largest window.
const int kPixels = PELLUCID_EDGES_GROUP, kTexels = kPixels / 4, kSide = kPixels + 4 * kAround;
const int kInvocations = kPixels * kPixels;

// Of a level, what stands for the surface in its texels: center, mm, and area, mm^2, of pixels with an axis; color and
// material. All that a group holds decides how many run at a time.
shared vec4 places[kSide * kSide];
shared uvec2 colors[kSide * kSide];
shared uint edges[PELLUCID_EDGES_TILES]; // of tiles, a bit for each texel
shared uint coarsest;

// Window of a level around a tile.
struct Window {
  ivec2 first, size;
};

Window windowOf(uint level, ivec2 firstPixel) {
  ivec2 first = 2 * ((firstPixel >> int(level + 1u)) - kAround);
  return Window(first, 2 * (((firstPixel + kPixels - 1) >> int(level + 1u)) + kAround + 1) - first);
}

// A point of the view ray, mm; z: planar distance.
vec3 pointAt(vec2 pixel, float p) {
  vec4 ray = frame.camera.rayBase + pixel.x * frame.camera.rayX + pixel.y * frame.camera.rayY;
  return vec3(ray.zw + p * ray.xy, p) * frame.camera.range.w;
}

// Facing the camera, mm^2.
float pixelArea(float p) {
  vec2 size = pixelSize(frame.camera, p);
  return size.x * size.y;
}

// Of a surface with that normal: xy: slope, as of texels; z: area over that of one facing the camera.
vec3 tilt(vec2 pixel, vec3 normal) {
  vec3 n = mat3(frame.viewFromNormal) * normal;
  float squared = dot(n, n);
  if (!(squared > 1.0e-8)) return vec3(0.0, 0.0, 1.0); // it has none
  n *= inversesqrt(squared);
  vec4 ray = frame.camera.rayBase + pixel.x * frame.camera.rayX + pixel.y * frame.camera.rayY;
  vec2 column = frame.camera.rayX.xy + frame.camera.rayX.zw, row = frame.camera.rayY.xy + frame.camera.rayY.zw;
  float inverse = 1.0 / max(-dot(n, vec3(ray.xy, frame.camera.range.x)), kLeastCosine);
  return vec3(dot(n.xy, column) * inversesqrt(max(dot(column, column), 1.0e-30)),
              dot(n.xy, row) * inversesqrt(max(dot(row, row), 1.0e-30)), 1.0) * inverse;
}

// A pixel's material, and what its taps take from it.
struct Kernel {
  uint m;
  vec4 reach;
  int first; // bits of the first entry's squared distance
};

const int kLastEntry = PELLUCID_DISTANCE_ENTRIES - 1;

// Of the profile's curvature over an area, how much counts. That of texels, whose light comes from around them, too: with
// all of it checkers err less, but smooth light more.
const float kPixelCurvature = 1.0, kTexelCurvature = 0.5;

// Of an area over the squared distance. Nearer than that the second order says too much.
const float kMostRelative = 0.8;

// The profile's mean over a square of that area, mm^2, times the area. `squared`: the squared distance > 0, mm^2, at which 1/r
// is its mean there. With R = g / r, that makes up for 1/r and, to second order, for the slope of g; its curvature adds
// area / (24 r^2) times r^2 laplace(R) - R + g' = r g''.
vec3 profileAt(Kernel k, float squared, float area, float curvature) {
  // The nearest entry is off by 2 %, or more where hardly anything is left, but by turns above and below: sums of hundreds
  // err by 1e-4 of themselves.
  int entry = (floatBitsToInt(squared) - k.first + (1 << (PELLUCID_DISTANCE_SHIFT - 1))) >> PELLUCID_DISTANCE_SHIFT;
  uvec3 bits = kernels[k.m].distance[clamp(entry, 0, kLastEntry)].xyz;
  float curved = min(area, kMostRelative * squared) * curvature * (1.0 / 24.0);
  return area * (uintBitsToFloat(bits) + curved * uintBitsToFloat(bits << 16));
}

// Part of the energy within a squared distance. Before the first entry it is like the area.
vec3 enclosed(Kernel k, float squared) {
  float at = float(floatBitsToInt(squared) - k.first) * exp2(-float(PELLUCID_DISTANCE_SHIFT));
  at = clamp(at, 0.0, float(kLastEntry) - 1.0e-3);
  uint i = uint(at);
  return mix(kernels[k.m].enclosed[i].rgb, kernels[k.m].enclosed[i + 1u].rgb, fract(at)) * min(squared / k.reach.y, 1.0);
}

// What a pixel has of its own, its surface `area` times as large as one facing the camera: of a disc whose mean of 1/r,
// which the profile is like near 0, is that of a rectangle so long.
vec3 ownPart(Kernel k, float facing, float area) {
  float radius = (area * asinh(1.0 / area) + asinh(area)) * (1.0 / 3.14159265);
  return enclosed(k, max(radius * radius * facing, 1.0e-30));
}

// The squared distance at which 1/r is its mean over a square of that area, to second order.
float meanSquare(float squared, float area) { return max(squared - area * (1.0 / 12.0), max(0.25 * squared, 1.0e-30)); }

// The same over a pixel's surface: a segment of the axis along which it is longer, exactly, and across it to second order.
// `offset`: of its center, `axis`: unit and half of the length, `facing`: the square of its width.
float meanSquare(vec3 offset, vec4 axis, float facing) {
  float squared = max(dot(offset, offset), 1.0e-30), along = min(abs(dot(offset, axis.xyz)), sqrt(squared));
  float across = squared - along * along, width = facing * (1.0 / 12.0);
  across = max(across + width * (1.0 - 3.0 * across / squared), 0.03 * facing);
  float begin = along - axis.w, end = along + axis.w;
  // across > 0, so both are positive, the first less than the second.
  float mean = log((end + sqrt(end * end + across)) / (begin + sqrt(begin * begin + across)));
  float distance = 2.0 * axis.w / max(mean, 1.0e-6);
  return distance * distance;
}

// The direction in which a pixel's surface is longer, of either sign, in the last bits of its area: octahedral, to a
// degree, which moves the end of the longest by a fifth of a pixel. The area keeps .1 %.
const uint kAxisBits = 0x3FFFu;
const float kAxisMost = 127.0;

float withAxis(float area, vec3 axis) {
  vec3 v = axis.z < 0.0 ? -axis : axis;
  vec2 p = v.xy / max(abs(v.x) + abs(v.y) + v.z, 1.0e-30);
  uvec2 q = uvec2((0.5 + 0.5 * vec2(p.x + p.y, p.x - p.y)) * kAxisMost + 0.5);
  return uintBitsToFloat((floatBitsToUint(area) & ~kAxisBits) | q.x | q.y << 7);
}

float placeArea(vec4 place) { return uintBitsToFloat(floatBitsToUint(place.w) & ~kAxisBits); }

vec3 placeAxis(vec4 place) {
  uint bits = floatBitsToUint(place.w);
  vec2 q = vec2(bits & 0x7Fu, bits >> 7 & 0x7Fu) * (1.0 / kAxisMost) - 0.5;
  vec2 p = vec2(q.x + q.y, q.x - q.y);
  return normalize(vec3(p, 1.0 - abs(p.x) - abs(p.y))); // of a length of 0.57 at least
}

// In how many segments at most a pixel's surface is taken.
const float kMostParts = 4.0;

// The profile's mean over a pixel's surface times its area, `facing`: that of one facing the camera.
vec3 ofPixel(Kernel k, vec4 place, vec3 offset, float facing) {
  float squared = dot(offset, offset), area = placeArea(place);
  // From three pixels and its length on it does not matter that it is longer than wide.
  bool far = squared > 9.0 * facing + area * area / facing;
  if (far || area < 1.5 * facing) return profileAt(k, meanSquare(squared, area), area, kPixelCurvature);
  vec3 axis = placeAxis(place);
  float width = sqrt(facing), halfLength = 0.5 * area / width;
  // As long as wide, each.
  float parts = clamp(floor(2.0 * halfLength / width + 0.5), 1.0, kMostParts);
  vec3 weight = vec3(0.0);
  for (float part = 0.5; part < parts; part += 1.0) {
    float at = halfLength * (2.0 * part / parts - 1.0);
    vec4 segment = vec4(axis, halfLength / parts);
    weight += profileAt(k, meanSquare(offset + at * axis, segment, facing), area / parts, kPixelCurvature);
  }
  return weight;
}

struct Sums {
  vec3 color, weight;
};

void add(inout Sums sums, uvec2 color, vec3 weight) {
  sums.color += weight * unpackColor(color);
  sums.weight += weight;
}

int ownPlace(ivec2 local) { return (local.y + 2 * kAround) * kSide + local.x + 2 * kAround; }

void loadPixels(ivec2 firstPixel) {
  Window window = windowOf(0u, firstPixel);
  for (int i = int(gl_LocalInvocationIndex); i < kSide * window.size.y; i += kInvocations) {
    ivec2 pixel = window.first + ivec2(i % kSide, i / kSide), at = withinRect(pixel);
    float depth = frontDistance(at), facing = pixelArea(depth);
    uint material = at == pixel && depth > 0.0 ? materialAt(at) : 0u;
    vec3 tilted = tilt(vec2(at), normalAt(at));
    float steep = length(tilted.xy), rise = steep * sqrt(facing) / frame.camera.range.w;
    vec2 toward = steep > 0.0 ? tilted.xy / steep : vec2(1.0, 0.0);
    vec3 center = pointAt(vec2(at), depth), axis = pointAt(vec2(at) + toward, depth + rise) - center;
    places[i] = vec4(center, withAxis(facing * tilted.z, axis));
    colors[i] = packColor(sanitize(texelFetch(sourceImage, at, 0).rgb), material);
  }
}

void loadTexels(uint level, ivec2 firstPixel) {
  Window window = windowOf(level, firstPixel);
  ivec4 rect = levelRect(level);
  for (int i = int(gl_LocalInvocationIndex); i < kSide * window.size.y; i += kInvocations) {
    ivec2 at = ivec2(i % kSide, i / kSide), texel = window.first + at;
    if (at.x >= window.size.x) continue;
    uvec4 bits = contains(rect, texel) ? texelFetch(pyramidImage, inAtlas(level, texel), 0) : uvec4(0u);
    Texel t = unpackTexel(bits);
    places[i] = vec4(pointAt(pixelOf(level, texel), t.depth), t.mass * pixelArea(t.depth) * exp2(2.0 * float(level)));
    colors[i] = packColor(t.color, t.mass > 0.0 ? t.material : 0u);
  }
}

// `local`: the pixel, from the tile's first; `facing`: area of one that faces the camera.
void addPixels(inout Sums sums, ivec2 local, Kernel k, vec3 center, float facing) {
  int own = ownPlace(local), first = (local.y & ~1) * kSide + (local.x & ~1);
  for (int y = 0; y < kWindow; ++y)
    [[unroll]] for (int x = 0; x < kWindow; ++x) {
      int i = first + y * kSide + x;
      vec4 place = places[i];
      uvec2 color = colors[i];
      bool counts = color.y >> 16 == k.m + 1u && i != own;
      vec3 weight = ofPixel(k, place, place.xyz - center, facing);
      add(sums, color, counts ? weight : vec3(0.0));
    }
}

void addTexel(inout Sums sums, int i, Kernel k, vec3 center) {
  vec4 place = places[i];
  uvec2 color = colors[i];
  vec3 offset = place.xyz - center;
  float area = color.y >> 16 == k.m + 1u ? place.w : 0.0;
  add(sums, color, profileAt(k, meanSquare(dot(offset, offset), area), area, kTexelCurvature));
}

void addTexels(inout Sums sums, uint level, ivec2 firstPixel, ivec2 local, Kernel k, vec3 center) {
  ivec2 origin = windowOf(level, firstPixel).first, texel = (firstPixel + local) >> int(level), odd = texel & 1;
  ivec2 parent = 2 * ((texel >> 1) - kAround) - origin;
  int first = parent.y * kSide + parent.x;
  // Rows and columns beside what the finer level does: two and three of them, or three and two. Rows at once, so that their
  // latencies overlap.
  for (int i = 0; i <= 2 * kAround; ++i) {
    int y = i < kAround ? i : i > kAround ? i + 2 * kAround + 1 : odd.y == 0 ? 3 * kAround + 1 : kAround;
    [[unroll]] for (int x = 0; x < kWindow; ++x) addTexel(sums, first + y * kSide + x, k, center);
  }
  for (int i = 0; i <= 2 * kAround; ++i) {
    int y = kAround + odd.y + i;
    [[unroll]] for (int j = 0; j <= 2 * kAround; ++j) {
      int x = j < kAround ? j : j > kAround ? j + 2 * kAround + 1 : odd.x == 0 ? 3 * kAround + 1 : kAround;
      addTexel(sums, first + y * kSide + x, k, center);
    }
  }
}

// Pixels of a tile's edges; a bit for each of its texels says which are.
void diffuseTile(ivec2 firstPixel, uint edgeTexels) {
  int invocation = int(gl_LocalInvocationIndex);
  if (invocation == 0) coarsest = 0u;
  loadPixels(firstPixel);
  barrier();
  // 16 invocations to a texel, so that those without one are whole subgroups.
  for (int before = invocation / 16; before > 0; --before) edgeTexels &= edgeTexels - 1u;
  bool isEdge = edgeTexels != 0u;
  int texel = max(findLSB(edgeTexels), 0), inTexel = invocation % 16;
  ivec2 local = 4 * ivec2(texel % kTexels, texel / kTexels) + ivec2(inTexel % 4, inTexel / 4), pixel = firstPixel + local;
  int own = ownPlace(local);
  uint material = colors[own].y >> 16;
  Kernel k = Kernel(max(material, 1u) - 1u, vec4(0.0), 0);
  if (material != 0u) k.reach = kernels[k.m].reach;
  k.first = floatBitsToInt(k.reach.y);
  bool diffuses = isEdge && k.reach.x > 0.0;
  vec3 center = places[own].xyz;
  Sums sums = Sums(vec3(0.0), vec3(0.0));
  uint last = 0u; // of the pixel's levels
  if (diffuses) {
    float facing = max(pixelArea(center.z / frame.camera.range.w), 1.0e-30);
    // The coarsest level whose window holds most of the radius.
    float level = ceil(log2(max(0.8 * k.reach.x * inversesqrt(facing) / float(2 * kAround), 1.0)));
    last = uint(clamp(level, 1.0, float(pass.value.x)));
    atomicMax(coarsest, last);
    add(sums, colors[own], ownPart(k, facing, max(placeArea(places[own]) / facing, 1.0)));
    addPixels(sums, local, k, center, facing);
  }
  barrier();
  uint levels = coarsest;
  for (uint level = 1u; level <= levels; ++level) {
    loadTexels(level, firstPixel);
    barrier();
    if (level <= last) addTexels(sums, level, firstPixel, local, k, center);
    barrier();
  }
  if (isEdge && insideRect(pixel) && materialAt(pixel) != 0u) {
    vec4 color = texelFetch(sourceImage, pixel, 0);
    // Of what is found, the pixel itself has a weight. Those that diffuse nothing keep their color.
    color.rgb = diffuses ? sums.color / max(sums.weight, vec3(1.0e-20)) : sanitize(color.rgb);
#ifdef GATHER
    if (material != 0u)
      color.rgb = withGathered(color.rgb, pixel, PELLUCID_DIFFUSE_CELL, center.z / frame.camera.range.w, material);
#endif
    writeResult(pixel, color.rgb, color.a, pass.value.w != 0u);
  }
}

// The first pixel of a group's tiles, which lie far from each other so that all groups have as much to do.
ivec2 tileOf(uint i) {
  uvec2 tile = uvec2(gl_WorkGroupID.x, gl_WorkGroupID.y + i * gl_NumWorkGroups.y);
  return 4 * (ivec2(frame.rect.xy) >> 2) + kPixels * ivec2(tile);
}

void main() {
  uint invocation = gl_LocalInvocationIndex;
  if (invocation < uint(PELLUCID_EDGES_TILES)) edges[invocation] = 0u;
  barrier();
  uint tile = invocation / uint(kTexels * kTexels), inTile = invocation % uint(kTexels * kTexels);
  if (tile < uint(PELLUCID_EDGES_TILES)) {
    ivec2 texel = (tileOf(tile) >> 2) + ivec2(inTile % uint(kTexels), inTile / uint(kTexels));
    if (contains(levelRect(2u), texel) && isSummed(texelFetch(pyramidImage, sharesPlace(texel), 0)))
      atomicOr(edges[tile], 1u << inTile);
  }
  barrier();
  for (uint i = 0u; i < uint(PELLUCID_EDGES_TILES); ++i)
    if (edges[i] != 0u) diffuseTile(tileOf(i), edges[i]);
}
