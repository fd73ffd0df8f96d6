// Points of the gather as one pass leaves them for the next. Cells are aligned to the image, not to the rect.
#ifndef PELLUCID_POINTS_GLSL
#define PELLUCID_POINTS_GLSL

struct Point {
  vec3 added;     // irradiance
  vec3 displaced; // share of the diffused irradiance, -1/10..1; below 0: more of it comes back
  vec3 normal;    // unit
  float front;    // planar distance
  uint material;  // index + 1; 0: nothing there
  int index;      // of its pixel in the cell, rows first
};

const uvec4 kNoPoint = uvec4(0u);

// Octahedral map of a unit vector; Cigolle et al. 2014, "oct".
vec2 octahedral(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  vec2 sides = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return n.z < 0.0 ? (1.0 - abs(p.yx)) * sides : p;
}

vec3 fromOctahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0);
  n.xy -= vec2(n.x < 0.0 ? -fold : fold, n.y < 0.0 ? -fold : fold);
  return normalize(n);
}

// Shares of -1/10 to 1 in 9 bits, 0 as 0.
const int kMostDisplaced = 460, kLeastDisplaced = -46;

// A point with other light.
uvec4 replaceLight(uvec4 bits, vec3 added, vec3 displaced) {
  added = min(added, vec3(kLargestHalf));
  float most = float(kMostDisplaced);
  uvec3 shares = uvec3(ivec3(floor(clamp(displaced * most, vec3(kLeastDisplaced), vec3(most)) + 0.5))) & 511u;
  return uvec4(packHalf2x16(added.rg), (packHalf2x16(vec2(added.b, 0.0)) & 0xFFFFu) | (bits.y & 0xFFFF0000u), bits.z,
               shares.r | shares.g << 9 | shares.b << 18 | (bits.w & 0xF8000000u));
}

// 16 bits hold a direction to a degree; the depth leaves its 8 lowest bits to the material.
uvec4 packPoint(Point p) {
  uvec4 bits = uvec4(0u, packSnorm4x8(vec4(octahedral(p.normal), 0.0, 0.0)) << 16,
                     (floatBitsToUint(p.front) & 0xFFFFFF00u) | p.material, uint(p.index) << 27);
  return replaceLight(bits, p.added, p.displaced);
}

vec3 addedOf(uvec4 bits) { return vec3(unpackHalf2x16(bits.x), unpackHalf2x16(bits.y).x); }

vec3 displacedOf(uvec4 bits) {
  uvec3 shares = (bits.www >> uvec3(0u, 9u, 18u)) - uint(kLeastDisplaced) & 511u;
  return vec3(ivec3(shares) + kLeastDisplaced) / float(kMostDisplaced);
}

bool displaces(uvec4 bits) { return (bits.w & 0x7FFFFFFu) != 0u; }

// Whether anything is added or displaced.
bool hasLight(uvec4 bits) { return (bits.x | bits.y & 0xFFFFu) != 0u || displaces(bits); }

vec3 normalOf(uvec4 bits) { return fromOctahedral(unpackSnorm4x8(bits.y >> 16).xy); }

Point unpackPoint(uvec4 bits) {
  return Point(addedOf(bits), displacedOf(bits), normalOf(bits), uintBitsToFloat(bits.z & 0xFFFFFF00u), bits.z & 0xFFu,
               int(bits.w >> 27));
}

// Added and displaced light alone, in halves.
uvec3 packLight(vec3 added, vec3 displaced) {
  return uvec3(packHalf2x16(added.rg), packHalf2x16(vec2(added.b, displaced.r)), packHalf2x16(displaced.gb));
}

void addLight(uvec3 bits, float weight, inout vec3 added, inout vec3 displaced) {
  vec2 middle = unpackHalf2x16(bits.y);
  added += weight * vec3(unpackHalf2x16(bits.x), middle.x);
  displaced += weight * vec3(middle.y, unpackHalf2x16(bits.z));
}

// Cells have 2 or 4 pixels a side: shifts in place of divisions, which take as long as the rest.
int shiftOf(int side) { return side >> 1; }

ivec2 pixelInCell(ivec2 cell, int side, int index) {
  return side * cell + ivec2(index & (side - 1), index >> shiftOf(side));
}

vec3 viewPosition(ivec2 cell, int side, Point p) {
  ViewRay ray = viewRay(frame.camera, pixelInCell(cell, side, p.index));
  return ray.origin + p.front * ray.direction;
}

// Cells [xy, zw) that the rect touches.
ivec4 cellsOf(uvec4 rect, int side) {
  int shift = shiftOf(side);
  return ivec4(ivec2(rect.xy) >> shift, ((ivec2(rect.zw) - 1) >> shift) + 1);
}

#endif
