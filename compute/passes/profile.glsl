// The profile over the surfaces of pixels and clusters, by distances in space. Needs kernels[].
#ifndef PELLUCID_PASSES_PROFILE_GLSL
#define PELLUCID_PASSES_PROFILE_GLSL

// A pixel's material, and what its taps take from it.
struct Kernel {
  uint m;
  int first; // bits of the first entry's squared distance
};

Kernel kernelOf(uint material) {
  Kernel k = Kernel(max(material, 1u) - 1u, 0);
  if (material != 0u) k.first = floatBitsToInt(kernels[k.m].reach.y);
  return k;
}

const int kLastEntry = PELLUCID_DISTANCE_ENTRIES - 1;

// Of an area over the squared distance. Nearer than that the second order says too much.
const float kMostRelative = 0.8;

// Of the profile at a squared distance. What the table's nearest entry is off by, 2 % and more, would show where few clusters
// light a pixel: the first order of it is taken out, which leaves .05 %.
struct Profile {
  vec3 value, curved, fall; // R, (r R)'' / r, -d ln R / d ln r^2
};

Profile profileAt(Kernel k, float squared) {
  int i = (floatBitsToInt(squared) - k.first + (1 << (PELLUCID_DISTANCE_SHIFT - 1))) >> PELLUCID_DISTANCE_SHIFT;
  i = clamp(i, 0, kLastEntry);
  uvec4 entry = kernels[k.m].distance[i];
  // As floats from 2^23 on, since conversions of integers take several times as long as what they would save.
  uvec3 falls = uvec3(entry.w, entry.w >> 10, entry.w >> 20) & 1023u;
  vec3 fall = (uintBitsToFloat(0x4B000000u | falls) - 8388608.0) * (float(PELLUCID_MOST_FALL) / 1023.0);
  // Entries are positive; before the first one R does not change. Half of what entries are apart, less than 1 over the most
  // that R falls.
  float beyond = clamp(squared / intBitsToFloat(k.first + (i << PELLUCID_DISTANCE_SHIFT)) - 1.0, -0.031, 0.031);
  return Profile(uintBitsToFloat(entry.xyz) * (1.0 - fall * beyond), uintBitsToFloat(entry.xyz << 16), fall);
}

// Twelve times the second moments of a flat surface: of a rectangle, squares of its sides, mm^2.
struct Extent {
  float radial; // in the direction to its center
  float both;   // along it and across
};

// The squared distance at which 1/r is its mean over a surface with its center at the squared distance `squared`, to second
// order.
float meanSquare(float squared, Extent extent) {
  return max(squared - (3.0 * extent.radial - extent.both) * (1.0 / 12.0), max(0.25 * squared, 1.0e-30));
}

// The profile's mean over a surface. `squared`: its meanSquare() and `at` the profile there. With R = g / r, that makes up for
// 1/r and, to second order, for the slope of g; left is its curvature, radial / 24 times g'' / r.
vec3 meanOf(Profile at, float squared, Extent extent) {
  return at.value + min(extent.radial, kMostRelative * squared) * (1.0 / 24.0) * at.curved;
}

// Part of the energy within a squared distance. Before the first entry it is like the area.
vec3 enclosed(Kernel k, float squared) {
  float at = float(floatBitsToInt(squared) - k.first) * exp2(-float(PELLUCID_DISTANCE_SHIFT));
  at = clamp(at, 0.0, float(kLastEntry) - 1.0e-3);
  uint i = uint(at);
  vec3 part = mix(kernels[k.m].enclosed[i].rgb, kernels[k.m].enclosed[i + 1u].rgb, fract(at));
  return part * min(squared / intBitsToFloat(k.first), 1.0);
}

// What a pixel has of its own between its center and two of its surface's sides. `x`: from the center to one of them, `y`: half
// of it, mm. In polar coordinates 1/pi times the integral of enclosed() over the angle; with the distance h of the side and
// h sinh u along it the angle's differential is du / cosh u, and what is integrated as good as constant where the profile is
// like 1/r.
vec3 toSides(Kernel k, vec3 x, vec3 y) {
  const int kSteps = 4;
  float length2 = max(dot(y, y), 1.0e-30), along = dot(x, y) * inversesqrt(length2);
  float height2 = max(dot(x, x) - along * along, 1.0e-4 * length2), perHeight = inversesqrt(height2);
  float begin = asinh((along - sqrt(length2)) * perHeight), end = asinh((along + sqrt(length2)) * perHeight);
  float u = end - begin;
  vec3 sum = vec3(0.0);
  for (int i = 0; i < kSteps; ++i) {
    float e = exp(begin + u * ((float(i) + 0.5) / float(kSteps))), cosh2 = 0.5 * (e + 1.0 / e);
    sum += enclosed(k, height2 * cosh2 * cosh2) / cosh2;
  }
  return sum * (u / (float(kSteps) * 3.14159265));
}

// All of it; `x` and `y`: halves of its sides.
vec3 ownPart(Kernel k, vec3 x, vec3 y) { return toSides(k, x, y) + toSides(k, y, x); }

// The same of a segment of a pixel's surface: along its axis exactly, and across it to second order.
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

uint axisBits(vec3 axis) {
  vec3 v = axis.z < 0.0 ? -axis : axis;
  vec2 p = v.xy / max(abs(v.x) + abs(v.y) + v.z, 1.0e-30);
  uvec2 q = uvec2((0.5 + 0.5 * vec2(p.x + p.y, p.x - p.y)) * kAxisMost + 0.5);
  return q.x | q.y << 7;
}

float withAxis(float area, uint bits) {
  return uintBitsToFloat((floatBitsToUint(area) & ~kAxisBits) | (bits & kAxisBits));
}

float placeArea(vec4 place) { return uintBitsToFloat(floatBitsToUint(place.w) & ~kAxisBits); }

// Of a length from 0.57 to 1.
vec3 placeAxis(vec4 place) {
  uint bits = floatBitsToUint(place.w);
  vec2 q = vec2(bits & 0x7Fu, bits >> 7 & 0x7Fu) * (1.0 / kAxisMost) - 0.5;
  vec2 p = vec2(q.x + q.y, q.x - q.y);
  return vec3(p, 1.0 - abs(p.x) - abs(p.y));
}

// From how many times as long as wide on a pixel's surface is taken in segments, and in how many at most.
const float kLong = 2.0, kMostParts = 4.0;

// A pixel's surface, which is as wide as one that faces the camera.
Extent extentOf(vec4 place, vec3 offset, float facing) {
  float area = placeArea(place), length2 = area * area / facing;
  vec3 axis = placeAxis(place);
  float along = dot(axis, offset), part = min(along * along / max(dot(offset, offset) * dot(axis, axis), 1.0e-30), 1.0);
  return Extent(mix(facing, length2, part), length2 + facing);
}

// The profile's mean over a pixel's surface, or a quarter of it, times its area, `facing`: that of one facing the camera.
vec3 ofPixel(Kernel k, vec4 place, vec3 offset, float facing) {
  float squared = dot(offset, offset), area = placeArea(place);
  // From three pixels and its length on the second order is enough.
  bool far = squared > 9.0 * facing + area * area / facing;
  if (far || area < kLong * facing) {
    Extent extent = extentOf(place, offset, facing);
    float mean = meanSquare(squared, extent);
    return area * meanOf(profileAt(k, mean), mean, extent);
  }
  vec3 axis = normalize(placeAxis(place)), weight = vec3(0.0);
  float width = sqrt(facing), halfLength = 0.5 * area / width;
  // As long as wide, each.
  float parts = clamp(floor(2.0 * halfLength / width + 0.5), 1.0, kMostParts), part = area / parts;
  for (float i = 0.5; i < parts; i += 1.0) {
    float at = halfLength * (2.0 * i / parts - 1.0);
    float mean = meanSquare(offset + at * axis, vec4(axis, halfLength / parts), facing);
    weight += part * meanOf(profileAt(k, mean), mean, Extent(part, 2.0 * part));
  }
  return weight;
}

// The same of one near the pixel, where the profile falls too steeply for that: of its quarters. `x`, `y`: the sides of its
// surface.
vec3 ofNeighbor(Kernel k, vec4 place, vec3 offset, float facing, vec3 x, vec3 y) {
  vec4 quarter = vec4(place.xyz, withAxis(0.25 * placeArea(place), floatBitsToUint(place.w)));
  vec3 weight = vec3(0.0);
  for (int i = 0; i < 4; ++i) {
    vec2 to = 0.5 * vec2(i & 1, i >> 1) - 0.25;
    weight += ofPixel(k, quarter, offset + to.x * x + to.y * y, 0.25 * facing);
  }
  return weight;
}

#endif
