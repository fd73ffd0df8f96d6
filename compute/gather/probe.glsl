// Probes as one pass leaves them for the next. Each stands for a cell of 1, 2 or 4 pixels a side, aligned to the image.
#ifndef PELLUCID_PROBE_GLSL
#define PELLUCID_PROBE_GLSL

#include "frame/blocks.glsl"
#include "lib/packing.glsl"

// 128 bits: the light that a probe adds, what its body returns, and the place of the surface.
//   x, y: `added`, irradiance that the lights bring beyond their diffused one, below 0 where they bring less; the normal
//   z: planar distance without its 8 lowest bits, which hold the material
//   w: `returned`, the part of the diffused irradiance that comes back beyond a half-space's, below 0 where less does, 9 bits a
//      channel; index of the pixel
struct ProbePlace {
  vec3 normal;   // unit; 16 bits hold it to a degree
  float front;   // planar distance
  uint material; // index + 1; 0: nothing there
  int index;     // of its pixel in the cell, rows first
};

const uvec4 kNoProbe = uvec4(0u);

const float kReturnedSteps = 255.0; // of -1..1; 0 is exact

uvec4 withAdded(uvec4 bits, vec3 added) {
  // Below 1e-7, where halves have a bit or two left, counts as nothing, so that bits say which probes have no light.
  added = mix(vec3(0.0), clamp(added, vec3(-kLargestHalf), vec3(kLargestHalf)), greaterThan(abs(added), vec3(1.0e-7)));
  return uvec4(packHalves(added, bits.y >> 16), bits.zw);
}

uvec4 withReturned(uvec4 bits, vec3 returned) {
  vec3 steps = clamp(returned, vec3(-1.0), vec3(1.0)) * kReturnedSteps;
  uvec3 parts = uvec3(ivec3(floor(steps + 0.5))) & 511u;
  return uvec4(bits.xyz, parts.r | parts.g << 9 | parts.b << 18 | (bits.w & 0xF8000000u));
}

uvec4 packPlace(ProbePlace p) {
  return uvec4(0u, packSnorm4x8(vec4(octahedral(p.normal), 0.0, 0.0)) << 16, (floatBitsToUint(p.front) & 0xFFFFFF00u) | p.material,
               uint(p.index) << 27);
}

vec3 addedOf(uvec4 bits) { return unpackHalves(bits.xy); }

vec3 returnedOf(uvec4 bits) {
  int w = int(bits.w);
  return vec3(bitfieldExtract(w, 0, 9), bitfieldExtract(w, 9, 9), bitfieldExtract(w, 18, 9)) / kReturnedSteps;
}

bool hasReturned(uvec4 bits) { return (bits.w & 0x7FFFFFFu) != 0u; }

// True where light is added, or more or less of the diffused light comes back.
bool hasLight(uvec4 bits) { return (bits.x | bits.y & 0xFFFFu) != 0u || hasReturned(bits); }

vec3 normalOf(uvec4 bits) { return fromOctahedral(unpackSnorm4x8(bits.y >> 16).xy); }

ProbePlace unpackPlace(uvec4 bits) {
  return ProbePlace(normalOf(bits), uintBitsToFloat(bits.z & 0xFFFFFF00u), bits.z & 0xFFu, int(bits.w >> 27));
}

// Cells have 1, 2 or 4 pixels a side, so that a shift replaces divisions, which take as long as the rest.
int shiftOf(int side) { return side >> 1; }

ivec2 pixelInCell(ivec2 cell, int side, int index) {
  return side * cell + ivec2(index & (side - 1), index >> shiftOf(side));
}

// Cells [xy, zw) that the rect touches.
ivec4 cellsOf(uvec4 rect, int side) {
  int shift = shiftOf(side);
  return ivec4(ivec2(rect.xy) >> shift, ((ivec2(rect.zw) - 1) >> shift) + 1);
}

// The probe of a cell in an image that a pass wrote from `row` on; none where the cell's pixels have no material. Neither load waits
// for the other, and nothing branches.
uvec4 probeOf(utexture2D image, ivec2 cell, int side, int row) {
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 within = clamp(cell, cells.xy, cells.zw - 1);
  uvec4 bits = texelFetch(image, within + ivec2(0, row), 0);
  return cellHoldsMaterial(side * within) && within == cell ? bits : kNoProbe;
}

#endif
