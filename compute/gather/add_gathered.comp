// Adds gathered light to the pixels, which take what the four probes around them have, and the light of lights without
// shadow maps.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_control_flow_attributes : require
#extension GL_GOOGLE_include_directive : require

#define FOUR_PIXELS // their loads overlap
#define TILE_SIDE (2 * PELLUCID_GATHER_GROUP)
#include "frame/tile.glsl"
#include "translucency/lit_surface.glsl"

const int kTile = TILE_SIDE;
const int kThreads = PELLUCID_GATHER_GROUP * PELLUCID_GATHER_GROUP;
#include "gather/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PROBES, rgba32ui) uniform readonly uimage2D probesImage;

const int kMostProbes = (kTile / 2 + 1) * (kTile / 2 + 1); // around all pixels

shared vec4 probePlanes[kMostProbes]; // see tangentPlane
shared uvec4 probes[kMostProbes];     // as probeOf has them
shared uint someLight;                // kSome* of all

ivec2 tileStart() { return (ivec2(frame.rect.xy) / kTile + ivec2(gl_WorkGroupID.xy)) * kTile; }

// Points of a row.
int probeRow(int side) { return (kTile >> shiftOf(side)) + 1; }

ivec2 cellOfProbe(int index, int side) {
  // Divisions by constants.
  int y = side == 2 ? index / (kTile / 2 + 1) : index / (kTile / 4 + 1);
  return (tileStart() >> shiftOf(side)) + ivec2(index - y * probeRow(side), y);
}

// All, as they are. Returns kSome* of the invocation's.
uint loadProbes(int index, int side) {
  int count = probeRow(side) * probeRow(side);
  ivec4 cells = cellsOf(frame.rect, side);
  uint some = 0u;
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    ivec2 cell = cellOfProbe(i, side);
    uvec4 bits = contains(cells, cell) ? imageLoad(probesImage, cell) : kNoProbe;
    probes[i] = bits;
    some |= kindsOfLight(bits);
  }
  return some;
}

// After a barrier and before another.
void unpackProbes(int index, int side) {
  int count = probeRow(side) * probeRow(side);
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    Probe p = unpackProbe(probes[i]);
    probePlanes[i] = tangentPlane(p, pixelInCell(cellOfProbe(i, side), side, p.index), tileStart());
    probes[i] = uvec4(packLight(p.added, p.convexity), p.material);
  }
}

uvec4 probeOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  int side = int(pass.value.x);
  ivec2 place = cell - (tileStart() >> shiftOf(side));
  int at = place.y * probeRow(side) + place.x;
  vec4 plane = probePlanes[at];
  off = (front - plane.x - dot(plane.yz, vec2(pixel - tileStart()))) * plane.w;
  return probes[at];
}

// The light that came through from lights without a map, which come last.
vec3 otherLight(ivec2 pixel, float front, float frontStored, uint m) {
  float back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  Surface s = surfaceAt(pixel, front, frontStored, back, texelFetch(normalImage, pixel, 0));
  vec3 transmitted = vec3(0.0);
  for (uint i = pass.value.w; i < pass.value.y; ++i) {
    Transmitted t = lightTransmission(lights[i], s, false);
    vec3 through = t.arriving * t.visible;
    if (t.thickness >= 0.0) transmitted += through * materialTransmittance(m, t.thickness * frame.camera.range.w);
  }
  return transmitted * materials[m].inverseReflectance.rgb;
}

// `others`: there are lights without a map.
void writePixel(ivec2 pixel, int side, uint value, vec4 source, float frontStored, bool others) {
  uint material = materialIndex(value);
  if (material == 0u) return;
  vec3 result = sanitize(source.rgb);
  float front = (value & frame.marks.x) != 0u ? -1.0 : frontDistanceOf(frontStored);
  if (front > 0.0 && side == 1) {
    uvec4 own = imageLoad(probesImage, pixel);
    result = withLight(result, addedOf(own), convexityOf(own));
  } else if (front > 0.0 && someLight != 0u) {
    result = withGathered(result, pixel, side, front, material);
  }
  if (front > 0.0 && others) result += otherLight(pixel, front, frontStored, material - 1u);
  writeResult(pixel, max(result, vec3(0.0)), source.a, pass.value.z == PELLUCID_WRITE_LAST);
}

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec2 tile = tileStart();
  uint value[kPixels];
  vec4 source[kPixels];
  float front[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = withinRect(tile + pixelInTile(i));
    value[i] = materialValueAt(pixel);
    source[i] = texelFetch(sourceImage, pixel, 0);
    front[i] = texelFetch(frontDepthImage, pixel, 0).x;
  }
  if (index == 0) someLight = 0u;
  barrier();
  uint light = side == 1 ? 0u : loadProbes(index, side); // a point of its own is what each pixel reads then
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (someLight != 0u) unpackProbes(index, side);
  barrier();
  if (pass.value.w == pass.value.y) {
    // Unrolled, so that the arrays stay in registers.
    [[unroll]] for (int i = 0; i < kPixels; ++i) {
      ivec2 pixel = tile + pixelInTile(i);
      if (insideRect(pixel)) writePixel(pixel, side, value[i], source[i], front[i], false);
    }
  } else {
    // The code of other lights once.
    [[dont_unroll]] for (int i = 0; i < kPixels; ++i) {
      ivec2 pixel = tile + pixelInTile(i);
      if (insideRect(pixel))
        writePixel(pixel, side, materialValueAt(pixel), texelFetch(sourceImage, pixel, 0),
                   texelFetch(frontDepthImage, pixel, 0).x, true);
    }
  }
}
