// main() of the pass that adds gathered light to the pixels, which take what the four points around them have.
#ifndef PELLUCID_PASS_GATHER_TILE_GLSL
#define PELLUCID_PASS_GATHER_TILE_GLSL

#include "passes/points.glsl"

layout(set = 0, binding = PELLUCID_BINDING_POINTS, rgba32ui) uniform readonly uimage2D pointsImage;

const int kTile = 2 * PELLUCID_GATHER_GROUP; // an invocation does four pixels, whose loads overlap
// The points around all pixels of a tile, of cells of 2 x 2 pixels.
const int kMostRow = kTile / 2 + 1;
const int kThreads = PELLUCID_GATHER_GROUP * PELLUCID_GATHER_GROUP;

shared vec4 planes[kMostRow * kMostRow]; // see tangentPlane
shared uvec4 points[kMostRow * kMostRow]; // light; w: material, 0: nothing there
shared uint someLight; // 0: no point has any

// A pixel that is a quarter of its side off a point's tangent plane is not of its surface. Measured: half and a
// tenth err more on heads.
const float kPerPixelOff = 4.0;

// Planar distance of a point's tangent plane: x: in the tile's corner, y, z: its steps, per pixel. w: quarters of
// a pixel off the plane, per distance along the view ray.
vec4 tangentPlane(Point p, ivec2 pixel, ivec2 tile) {
  Camera c = frame.camera;
  vec2 sideX = c.rayX.zw + p.front * c.rayX.xy, sideY = c.rayY.zw + p.front * c.rayY.xy;
  // Facing the camera; planes seen edge-on would have no slope.
  float facing = min(dot(p.normal, viewRay(c, pixel).direction), -0.1);
  vec2 steps = -vec2(dot(p.normal.xy, sideX), dot(p.normal.xy, sideY)) / facing;
  // Pixels have a size in front of the eye.
  float perSide = inversesqrt(max(dot(sideX, sideX), 1.0e-30));
  return vec4(p.front - dot(steps, vec2(pixel - tile)), steps, -facing * kPerPixelOff * perSide);
}

void loadPoint(int index, ivec2 cell, int side, ivec2 tile) {
  points[index] = uvec4(0u);
  ivec4 cells = cellsOf(frame.rect, side);
  if (any(greaterThanEqual(cell, cells.zw)) || any(lessThan(cell, cells.xy))) return;
  uvec4 bits = imageLoad(pointsImage, cell);
  if (bits == kNoPoint) return;
  Point p = unpackPoint(bits);
  planes[index] = tangentPlane(p, pixelInCell(cell, side, p.index), tile);
  points[index] = uvec4(packLight(p.added, p.displaced), p.material);
  if (any(notEqual(points[index].xyz, uvec3(0u)))) someLight = 1u;
}

// What D becomes: linear between the four points around the pixel, as far as they are of its material and it lies
// on their planes.
vec3 withGathered(vec3 diffused, ivec2 local, int side, float front, uint material) {
  float total = 0.0, perSide = side == 2 ? 0.5 : 0.25;
  vec3 added = vec3(0.0), displaced = vec3(0.0);
  vec2 fraction = vec2(local & (side - 1)) * perSide;
  int shift = shiftOf(side);
  int row = (kTile >> shift) + 1, first = (local.y >> shift) * row + (local.x >> shift);
  for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 linear = mix(1.0 - fraction, fraction, vec2(corner));
    int at = first + corner.y * row + corner.x;
    uvec4 point = points[at];
    if (point.w != material) continue;
    vec4 plane = planes[at];
    float off = (front - plane.x - dot(plane.yz, vec2(local))) * plane.w;
    // The floors leave a pixel without a like neighbor the most alike.
    float weight = (exp2(-off * off) + 1.0e-4) * (linear.x * linear.y + 1.0e-4);
    addLight(point.xyz, weight, added, displaced);
    total += weight;
  }
  // The cell's own point is of its material, unless the cell has several.
  return total > 0.0 ? diffused + (added - diffused * displaced) / total : diffused;
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
void writePixel(ivec2 pixel, ivec2 local, int side, uint value, vec4 source, float frontStored, bool others) {
  uint material = materialIndex(value);
  if (material == 0u) return;
  vec3 result = sanitize(source.rgb);
  float front = (value & frame.marks.x) != 0u ? -1.0 : frontDistanceOf(frontStored);
  if (front > 0.0 && someLight != 0u) result = withGathered(result, local, side, front, material);
  if (front > 0.0 && others) result += otherLight(pixel, front, frontStored, material - 1u);
  writeResult(pixel, max(result, vec3(0.0)), source.a, pass.value.z == PELLUCID_WRITE_LAST);
}

void main() {
  int side = int(pass.value.x), index = int(gl_LocalInvocationIndex);
  ivec2 tile = (ivec2(frame.rect.xy) / kTile + ivec2(gl_WorkGroupID.xy)) * kTile;
  uint value[4];
  vec4 source[4];
  float front[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    // Within the rect, where the loads need no branch.
    ivec2 pixel = clamp(tile + pixelInTile(i), ivec2(frame.rect.xy), ivec2(frame.rect.zw) - 1);
    value[i] = materialValueAt(pixel);
    source[i] = texelFetch(sourceImage, pixel, 0);
    front[i] = texelFetch(frontDepthImage, pixel, 0).x;
  }
  if (index == 0) someLight = 0u;
  barrier();
  int shift = shiftOf(side), row = (kTile >> shift) + 1;
  for (int i = index; i < row * row; i += kThreads) {
    int y = side == 2 ? i / kMostRow : i / (kTile / 4 + 1);
    loadPoint(i, (tile >> shift) + ivec2(i - y * row, y), side, tile);
  }
  barrier();
  if (pass.value.w == pass.value.y) {
    // Unrolled, so that the arrays stay in registers.
    [[unroll]] for (int i = 0; i < 4; ++i) {
      ivec2 local = pixelInTile(i);
      if (insideRect(tile + local)) writePixel(tile + local, local, side, value[i], source[i], front[i], false);
    }
  } else {
    // The code of other lights once.
    [[dont_unroll]] for (int i = 0; i < 4; ++i) {
      ivec2 local = pixelInTile(i), pixel = tile + local;
      if (insideRect(pixel))
        writePixel(pixel, local, side, materialValueAt(pixel), texelFetch(sourceImage, pixel, 0),
                   texelFetch(frontDepthImage, pixel, 0).x, true);
    }
  }
}

#endif
