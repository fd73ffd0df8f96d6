// Gathered light of a group's pixels, which take what the four points around them have. Needs kPointPixels: how many
// pixels there are, from a multiple of 4 in the image on; and kLeastSide: of the cells, pixels.
#ifndef PELLUCID_GATHERED_GLSL
#define PELLUCID_GATHERED_GLSL

#include "passes/points.glsl"

layout(set = 0, binding = PELLUCID_BINDING_POINTS, rgba32ui) uniform readonly uimage2D pointsImage;

// The points around all pixels.
const int kMostPoints = (kPointPixels.x / kLeastSide + 1) * (kPointPixels.y / kLeastSide + 1);

shared vec4 pointPlanes[kMostPoints]; // see tangentPlane
shared uvec4 points[kMostPoints];     // unpacked: light; w: material, 0: nothing there
shared uint someLight;                // kSome* of what loadPoints returned

const uint kSomeLight = 1u, kSomeDisplaced = 2u;

// A pixel that is a quarter of its side off a point's tangent plane is not of its surface. Measured: half and a
// tenth err more on heads.
const float kPerPixelOff = 4.0;

// Planar distance of a point's tangent plane: x: in the first pixel, y, z: its steps, per pixel. w: quarters of
// a pixel off the plane, per distance along the view ray.
vec4 tangentPlane(Point p, ivec2 pixel, ivec2 first) {
  Camera c = frame.camera;
  vec2 sideX = c.rayX.zw + p.front * c.rayX.xy, sideY = c.rayY.zw + p.front * c.rayY.xy;
  // Facing the camera; planes seen edge-on would have no slope.
  float facing = min(dot(p.normal, viewRay(c, pixel).direction), -0.1);
  vec2 steps = -vec2(dot(p.normal.xy, sideX), dot(p.normal.xy, sideY)) / facing;
  // Pixels have a size in front of the eye.
  float perSide = inversesqrt(max(dot(sideX, sideX), 1.0e-30));
  return vec4(p.front - dot(steps, vec2(pixel - first)), steps, -facing * kPerPixelOff * perSide);
}

// Points of a row.
int pointRow(int side) { return (kPointPixels.x >> shiftOf(side)) + 1; }

int pointCount(int side) { return pointRow(side) * ((kPointPixels.y >> shiftOf(side)) + 1); }

ivec2 cellOfPoint(int index, int side, ivec2 first) {
  // Divisions by constants.
  int y = side == 2 ? index / (kPointPixels.x / 2 + 1) : index / (kPointPixels.x / 4 + 1);
  return (first >> shiftOf(side)) + ivec2(index - y * pointRow(side), y);
}

// All, as they are, from the pixel `first` on, by invocations index, index + stride, ... Returns kSome* of them.
uint loadPoints(int index, int stride, int side, ivec2 first) {
  int count = pointCount(side);
  ivec4 cells = cellsOf(frame.rect, side);
  uint some = 0u;
  [[dont_unroll]] for (int i = index; i < count; i += stride) {
    ivec2 cell = cellOfPoint(i, side, first);
    bool inside = all(lessThan(cell, cells.zw)) && all(greaterThanEqual(cell, cells.xy));
    uvec4 bits = inside ? imageLoad(pointsImage, cell) : kNoPoint;
    points[i] = bits;
    some |= (hasLight(bits) ? kSomeLight : 0u) | (displaces(bits) ? kSomeDisplaced : 0u);
  }
  return some;
}

// After a barrier and before another.
void unpackPoints(int index, int stride, int side, ivec2 first) {
  int count = pointCount(side);
  [[dont_unroll]] for (int i = index; i < count; i += stride) {
    Point p = unpackPoint(points[i]);
    pointPlanes[i] = tangentPlane(p, pixelInCell(cellOfPoint(i, side, first), side, p.index), first);
    points[i] = uvec4(packLight(p.added, p.displaced), p.material);
  }
}

// What the diffused irradiance D becomes.
vec3 withLight(vec3 diffused, vec3 added, vec3 displaced) {
  return min(diffused - diffused * displaced + added, vec3(kLargestHalf));
}

// Of points as they are: linear between one and the next of its row.
vec3 addedBetween(int at, float fraction) { return mix(addedOf(points[at]), addedOf(points[at + 1]), fraction); }

vec3 displacedBetween(int at, float fraction) {
  return mix(displacedOf(points[at]), displacedOf(points[at + 1]), fraction);
}

// Of four pixels below each other, the column of a cell of 4 x 4 pixels: that of the first one at `local`, and steps. The
// cell and those around are one surface, so that points need no test. They are as they were loaded.
int planePoint(ivec2 local) { return (local.y >> 2) * pointRow(4) + (local.x >> 2); }

void addedOfPlane(ivec2 local, out vec3 first, out vec3 step) {
  int at = planePoint(local);
  float across = 0.25 * float(local.x & 3);
  first = addedBetween(at, across);
  step = 0.25 * (addedBetween(at + pointRow(4), across) - first);
}

void displacedOfPlane(ivec2 local, out vec3 first, out vec3 step) {
  int at = planePoint(local);
  float across = 0.25 * float(local.x & 3);
  first = displacedBetween(at, across);
  step = 0.25 * (displacedBetween(at + pointRow(4), across) - first);
}

// D with what is linear between the four points around the pixel `local`, as far as they are of its material and it
// lies on their planes.
vec3 withGathered(vec3 diffused, ivec2 local, int side, float front, uint material) {
  float total = 0.0, perSide = side == 2 ? 0.5 : 0.25;
  vec3 added = vec3(0.0), displaced = vec3(0.0);
  vec2 fraction = vec2(local & (side - 1)) * perSide;
  int shift = shiftOf(side), row = pointRow(side), first = (local.y >> shift) * row + (local.x >> shift);
  [[dont_unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 linear = mix(1.0 - fraction, fraction, vec2(corner));
    int at = first + corner.y * row + corner.x;
    uvec4 point = points[at];
    if (point.w != material) continue;
    vec4 plane = pointPlanes[at];
    float off = (front - plane.x - dot(plane.yz, vec2(local))) * plane.w;
    // The floors leave a pixel without a like neighbor the most alike.
    float weight = (exp2(-off * off) + 1.0e-4) * (linear.x * linear.y + 1.0e-4);
    addLight(point.xyz, weight, added, displaced);
    total += weight;
  }
  // The cell's own point is of its material, unless the cell has several.
  return total > 0.0 ? withLight(diffused, added / total, displaced / total) : diffused;
}

#endif
