// main() of the pass that adds gathered light to the pixels, which take what the four points around them have.
#ifndef PELLUCID_PASS_GATHER_TILE_GLSL
#define PELLUCID_PASS_GATHER_TILE_GLSL

const int kTile = TILE_SIDE;
const int kThreads = PELLUCID_GATHER_GROUP * PELLUCID_GATHER_GROUP;
#include "passes/gathered.glsl"

layout(set = 0, binding = PELLUCID_BINDING_POINTS, rgba32ui) uniform readonly uimage2D pointsImage;

const int kMostPoints = (kTile / 2 + 1) * (kTile / 2 + 1); // around all pixels

shared vec4 pointPlanes[kMostPoints]; // see tangentPlane
shared uvec4 points[kMostPoints];     // as pointOf has them
shared uint someLight;                // kSome* of all

ivec2 tileStart() { return (ivec2(frame.rect.xy) / kTile + ivec2(gl_WorkGroupID.xy)) * kTile; }

// Points of a row.
int pointRow(int side) { return (kTile >> shiftOf(side)) + 1; }

ivec2 cellOfPoint(int index, int side) {
  // Divisions by constants.
  int y = side == 2 ? index / (kTile / 2 + 1) : index / (kTile / 4 + 1);
  return (tileStart() >> shiftOf(side)) + ivec2(index - y * pointRow(side), y);
}

// All, as they are. Returns kSome* of the invocation's.
uint loadPoints(int index, int side) {
  int count = pointRow(side) * pointRow(side);
  ivec4 cells = cellsOf(frame.rect, side);
  uint some = 0u;
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    ivec2 cell = cellOfPoint(i, side);
    uvec4 bits = contains(cells, cell) ? imageLoad(pointsImage, cell) : kNoPoint;
    points[i] = bits;
    some |= kindsOfLight(bits);
  }
  return some;
}

// After a barrier and before another.
void unpackPoints(int index, int side) {
  int count = pointRow(side) * pointRow(side);
  [[dont_unroll]] for (int i = index; i < count; i += kThreads) {
    Point p = unpackPoint(points[i]);
    pointPlanes[i] = tangentPlane(p, pixelInCell(cellOfPoint(i, side), side, p.index), tileStart());
    points[i] = uvec4(packLight(p.added, p.convexity), p.material);
  }
}

uvec4 pointOf(ivec2 cell, ivec2 pixel, float front, out float off) {
  int side = int(pass.value.x);
  ivec2 place = cell - (tileStart() >> shiftOf(side));
  int at = place.y * pointRow(side) + place.x;
  vec4 plane = pointPlanes[at];
  off = (front - plane.x - dot(plane.yz, vec2(pixel - tileStart()))) * plane.w;
  return points[at];
}

// What came through of the lights without a map, which come last.
vec3 otherLight(ivec2 pixel, float front, float frontStored, uint m) {
  float back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  Surface s = surfaceAt(pixel, front, frontStored, back, texelFetch(normalImage, pixel, 0));
  vec3 transmitted = vec3(0.0);
  for (uint i = pass.value.w; i < pass.value.y; ++i) {
    Transmitted t = lightTransmission(lights[i], s);
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
    uvec4 own = imageLoad(pointsImage, pixel);
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
  uint light = side == 1 ? 0u : loadPoints(index, side); // a point of its own is what each pixel reads then
  if (light != 0u) atomicOr(someLight, light);
  barrier();
  if (someLight != 0u) unpackPoints(index, side);
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

#endif
