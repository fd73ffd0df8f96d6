// The entry point of a texel of a shadow map.
#ifndef PELLUCID_TEXEL_ENTRY_GLSL
#define PELLUCID_TEXEL_ENTRY_GLSL

#define MORE_SHADOW_IMAGES
#include "frame/facet.glsl"
#include "frame/shadow_images.glsl"
#include "gather/entry_point.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

// A point of the surface that a map stores.
struct MapPoint {
  vec3 position; // view space
  float depth;   // as entry points store it; kNoDepth: none
};

MapPoint pointOf(EntryMapConstants map, ivec2 texel, float stored) {
  vec2 p = vec2(texel) + 0.5;
  vec4 at = map.origin + p.x * map.stepX + p.y * map.stepY;
  if (map.meta.z == 0u) {
    float depth = stored * map.ray.w + at.w + map.offsets.z;
    return MapPoint(at.xyz + depth * map.ray.xyz, abs(depth) < kNoDepth ? depth : kNoDepth);
  }
  float dividend = stored, divisor = at.w;
  if (map.meta.y == PELLUCID_SHADER_DEPTH_DEVICE) {
    dividend = map.ray.w;
    divisor = stored - at.w;
  } else if (map.meta.y == PELLUCID_SHADER_DEPTH_DISTANCE) {
    divisor = length(at.xyz);
  }
  // The product is 0 or negative only at infinity.
  if (!(dividend * divisor > 0.0)) return MapPoint(map.ray.xyz, kNoDepth);
  float depth = dividend / divisor;
  // Not beyond the light.
  if (map.offsets.z > 0.0) depth *= max(1.0 - map.offsets.z / max(depth * length(at.xyz), 1.0e-12), 1.0e-3);
  return MapPoint(map.ray.xyz + depth * at.xyz, abs(depth) < kNoDepth ? depth : kNoDepth);
}

// ---- What the camera shows, and what that hides

// The surface at the pixel of a point: the front that the camera shows, or the back that the front hides.
struct PixelSurface {
  ivec2 pixel;  // with a surface
  float planar; // of the point
  float depth;  // planar, of a surface with material; -1: none
  vec3 normal;  // unit, outward
  float above;  // how far the point lies before the surface, along its normal
};

// Planar distance of the surface that goes on under a pixel of hair, as alpha hashing and dithering draw it: the pixels to both sides
// have one material. The less steep of the two axes counts. -1: there is no such surface. `beside`: one of the two pixels.
float frontUnderHair(ivec2 pixel, out ivec2 beside, out uint material) {
  float front = -1.0, least = kNoDepth;
  beside = pixel;
  material = 0u;
  [[dont_unroll]] for (int i = 0; i < 2; ++i) {
    ivec2 axis = i == 0 ? ivec2(1, 0) : ivec2(0, 1), next = pixel + axis, last = pixel - axis;
    if (!insideRect(next) || !insideRect(last)) continue;
    uint theirs = materialAt(inImage(next));
    if (theirs == 0u || theirs != materialAt(inImage(last))) continue;
    float a = frontDistance(inImage(next)), b = frontDistance(inImage(last));
    if (!(min(a, b) > 0.0) || !(abs(a - b) < least)) continue;
    least = abs(a - b);
    beside = next;
    material = theirs;
    front = 0.5 * (a + b);
  }
  return front;
}

PixelSurface surfaceUnder(vec3 position, bool hidden) {
  PixelSurface s = PixelSurface(ivec2(0), position.z * frame.camera.range.x, -1.0, vec3(0.0), 0.0);
  ivec2 pixel;
  if (!projectToPixel(frame.camera, position, pixel) || !insideRect(pixel)) return s;
  s.pixel = pixel;
  // A pixel without material shows nothing, whatever depth it holds, as its light is not diffused. The light of skin under single
  // pixels of hair is, as pixels around stand for them.
  uint material = materialAt(inImage(pixel));
  float depth = hidden ? distanceOf(inImage(pixel), material, true) : frontDistance(inImage(pixel));
  ivec2 of = pixel;
  if (!hidden && material == 0u && depth > 0.0) {
    float skin = frontUnderHair(pixel, of, material);
    depth = skin >= depth ? skin : -1.0; // through a gap, what lies behind is seen
  }
  if (material == 0u || !(depth > 0.0)) return s;
  float own = of == pixel ? depth : frontDistance(inImage(of)); // not the mean that stands for hair
  vec3 towardsEye = facetAt(inImage(of), material, own, hidden);
  if (towardsEye == vec3(0.0)) return s;
  s.normal = hidden ? -towardsEye : towardsEye;
  s.depth = depth;
  ViewRay ray = viewRay(frame.camera, pixel);
  s.above = dot(s.normal, position - ray.origin - depth * ray.direction);
  return s;
}

// Slope towards the camera from which a surface is a limb, whose few pixels do not show all of the light that enters: 63 degrees.
// Measured: procedural balls of skin, radius 5 mm.
const float kSteepestSeen = 2.0;

// Cosine up to which a shown normal may turn away from the light that enters there: normals are interpolated, and texels reach
// around 30 degrees of curvature. A face that turns away further is the other face of a thin part.
const float kMostTurned = 0.5;

float slopeToCamera(ivec2 pixel, vec3 normal) {
  vec3 ray = viewRay(frame.camera, pixel).direction;
  return slopeOf(dot(normal, ray) * inversesqrt(dot(ray, ray)));
}

float largerPixelSide(float front) {
  vec2 squared = squaredPixelSize(frame.camera, front);
  return sqrt(max(squared.x, squared.y));
}

// True where a point is of the surface at its pixel: it lies no further off along the normal than the pixel's plane can tell and its
// map leaves open. `tolerance`: half a texel; `uncertain`: along the light; `offset`: along normals; scene units.
bool liesOn(PixelSurface s, vec3 toLight, float tolerance, float uncertain, float offset) {
  float cosine = dot(s.normal, toLight);
  return s.depth > 0.0 && cosine > -kMostTurned &&
         abs(s.above) <= min(tolerance, 0.5 * largerPixelSide(s.depth)) + offset + uncertain * abs(cosine);
}

// True where a point does not lie behind the surface that its pixel shows: the light that enters there is in the irradiance
// that diffusion spreads. A surface that faces away cannot be seen, however thin the part is. `uncertain`: along the normal.
bool cameraSees(PixelSurface s, vec3 normal, float tolerance, float uncertain) {
  if (!(s.depth > 0.0)) return false;
  float facing = dot(normal, viewRay(frame.camera, s.pixel).direction), slope = slopeToCamera(s.pixel, normal);
  // Up to half a pixel's diagonal lies between the point and the pixel's center.
  if (slope < kSteepestSeen) tolerance += 0.70710678 * largerPixelSide(s.depth) * slope;
  return facing < 0.0 && s.planar <= s.depth + tolerance + uncertain / max(-facing, kLeastCosine);
}

// ---- What the map's neighbors say

const float kSquaredEdge = 4.0;  // squared steps across the light; a step less steep than 60 degrees is no edge
const float kSquaredHair = 64.0; // what lies nearer by 8 texels may be hair; folds of the surface lie nearer by less

const int kHairReach = 3; // texels: hair that covers three quarters leaves one of y's surface among four, in the mean

// One texel's step along an axis from y, where both neighbors are hair nearer to the light, as alpha hashing and dithering draw single
// texels. The step follows from texels of y's surface two or three away, or the surface faces the light. `across`: of a texel.
vec3 slopeBetweenHair(EntryMapConstants map, ivec2 texel, MapPoint y, ivec2 axis, vec3 across, float squaredStep, float shift) {
  [[dont_unroll]] for (int i = 2; i < 2 * kHairReach; ++i) {
    int away = (i >> 1) + 1, side = (1 - 2 * (i & 1)) * away;
    ivec2 neighbor = texel + side * axis;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThanEqual(neighbor, ivec2(map.map.xy)))) continue;
    float theirs = shadowTexel(map.meta.x, firstTexel(map.occluder) + neighbor);
    if (!shadowHolds(map.meta, theirs)) continue;
    vec3 toward = (pointOf(map, neighbor, theirs + shift).position - y.position) / float(side);
    if (dot(toward, toward) < kSquaredEdge * squaredStep) return toward;
  }
  return across;
}

// One texel's step along an axis of the map from y. `stored`: of the neighbors forwards and backwards; `across`: a texel's step at the
// depth of y.
vec3 entryStep(EntryMapConstants map, ivec2 texel, MapPoint y, ivec2 axis, vec2 stored, vec3 across, float shift) {
  vec4 steps[2] = vec4[](vec4(0.0), vec4(0.0));
  float squaredStep = dot(across, across);
  int hairs = 0;
  for (int i = 0; i < 2; ++i) {
    int side = 1 - 2 * i;
    ivec2 neighbor = texel + side * axis;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThanEqual(neighbor, ivec2(map.map.xy))) || !shadowHolds(map.meta, stored[i])) continue;
    MapPoint there = pointOf(map, neighbor, stored[i]);
    if (!(abs(there.depth) < kNoDepth)) continue;
    steps[i] = vec4(float(side) * (there.position - y.position), 1.0);
    bool nearer = map.meta.z == 0u ? there.depth > y.depth : there.depth < y.depth;
    hairs += nearer && dot(steps[i].xyz, steps[i].xyz) >= kSquaredHair * squaredStep ? 1 : 0;
  }
  return hairs == 2 ? slopeBetweenHair(map, texel, y, axis, across, squaredStep, shift) : nearerStep(steps[0], steps[1]);
}

// Unit normal towards the light of the surface at y; towards the light itself where no neighbor says. `beside`: without biases;
// `shift`: what that took from the stored depths.
vec3 mapNormal(EntryMapConstants map, ivec2 texel, MapPoint y, vec4 beside, float shift, vec3 toLight) {
  vec3 steps[2];
  // Not unrolled, here and below: a copy of each read of the map is a switch over all images, and small frames wait for code.
  [[dont_unroll]] for (int i = 0; i < 2; ++i) {
    vec3 across = (map.meta.z == 0u ? 1.0 : y.depth) * (i == 0 ? map.stepX.xyz : map.stepY.xyz);
    steps[i] = entryStep(map, texel, y, ivec2(1 - i, i), i == 0 ? beside.xy : beside.zw, across, shift);
  }
  vec3 normal = cross(steps[0], steps[1]);
  float squared = dot(normal, normal);
  if (!(squared > 0.0)) return toLight;
  return normal * (dot(normal, toLight) < 0.0 ? -inversesqrt(squared) : inversesqrt(squared));
}

bvec4 neighborsHold(EntryMapConstants map, vec4 beside) {
  return bvec4(shadowHolds(map.meta, beside.x), shadowHolds(map.meta, beside.y), shadowHolds(map.meta, beside.z),
               shadowHolds(map.meta, beside.w));
}

// Depths that were drawn into a texel and its neighbors, without the map's biases. `uncertain`: how far its own depth may be off.
// The neighbors of the tile's border are within it: the border itself takes the place of others, and does not count.
ShadowTexels drawnTexels(EntryMapConstants map, ivec2 texel, ShadowTexels stored, out float uncertain) {
  bvec4 within = notEqual(besideTexel(texel, ivec2(0), ivec2(map.map.xy) - 1), texel.xxyy);
  bvec4 stores = neighborsHold(map, stored.beside), holds = bvec4(uvec4(stores) & uvec4(within));
  if (map.offsets.y != 0.0) stored.own = withoutPit(map.offsets, stored.own, stored.beside, holds);
  DrawnDepth drawn = drawnDepth(map.offsets, stored.own, stored.beside, holds);
  uncertain = drawn.uncertain;
  return ShadowTexels(drawn.depth, mix(stored.beside, drawn.depth + stored.beside - stored.own, stores));
}

// ---- Biases. A texel's point is where its light ray meets the surface that front or back depths show there

// Least cosine between a surface's normal and the light ray: at 87 degrees, less than 5 % of the light comes in.
const float kLeastAlong = 0.05;

// The larger change of the stored device depth from texel to texel on a plane through a point, which the rasterizer's slope bias
// has multiplied.
float slopeOnPlane(EntryMapConstants map, vec3 position, vec3 normal) {
  bool parallel = map.meta.z == 0u;
  vec3 ray = parallel ? map.ray.xyz : position - map.ray.xyz;
  float along = dot(normal, ray), least = max(kLeastAlong * length(ray), 1.0e-12);
  if (abs(along) < least) along = along < 0.0 ? -least : least;
  vec2 onPlane = vec2(dot(normal, map.stepX.xyz), dot(normal, map.stepY.xyz)) / along, affine = vec2(map.stepX.w, map.stepY.w);
  vec2 steps = abs(parallel ? (onPlane + affine) / map.ray.w : affine + map.ray.w * onPlane); // ray.w is not 0
  return max(steps.x, steps.y);
}

// A bound on time: most texels need one step, and later steps change few.
const int kMostAgain = 3;

// The front at the pixel of a texel's point, and whether the texel stores that front.
struct Told {
  PixelSurface shown;
  bool isShown;
};

// Moves y along its light ray to the surface at its pixel, and takes that surface's normal, if y lies on it within what the map leaves
// open. A bias had the slope of the map, or that of the surface at the pixel, which leads to another pixel. Behind a biased map's front
// may lie the back that the front hides. At limbs the camera knows more than a biased map, and less than another. `asDrawn`: the stored
// depth.
Told moveToSurface(EntryMapConstants map, ivec2 texel, float asDrawn, vec3 toLight, float tolerance, float uncertain, inout MapPoint y,
                   inout vec3 normal) {
  bool parallel = map.meta.z == 0u, slopes = map.offsets.y != 0.0 && map.meta.y == PELLUCID_SHADER_DEPTH_DEVICE;
  bool biased = map.offsets.y != 0.0 || map.offsets.z != 0.0, hidden = false;
  Told told;
  told.isShown = false;
  MapPoint tried = y;
  int again = 0;
  [[dont_unroll]] for (int i = 0; i < 2 * (kMostAgain + 1); ++i) {
    PixelSurface s = surfaceUnder(tried.position, hidden);
    if (i == 0) told.shown = s;
    // An offset along normals is undone by its mean, which is off by as much where the light grazes.
    if (liesOn(s, toLight, tolerance, uncertain, abs(map.offsets.z)) && (biased || slopeToCamera(s.pixel, s.normal) < kSteepestSeen)) {
      normal = s.normal;
      told.isShown = !hidden;
      if (told.isShown) told.shown = s;
      if (!biased) break;
      // Per depth, which is not 0; of parallel light towards the light, else away from it.
      vec3 ray = parallel ? map.ray.xyz : (tried.position - map.ray.xyz) / tried.depth;
      // In grazing light the point moves part of the way. A plane that turns away from the light does not move the point.
      float cosine = dot(s.normal, toLight), step = cosine > 0.0 ? s.above / max(max(cosine, kLeastCosine) * length(ray), 1.0e-12) : 0.0;
      if (parallel) step = -step;
      MapPoint moved = MapPoint(tried.position + step * ray, tried.depth + step);
      y = parallel || moved.depth > 0.0 ? moved : tried; // not behind the light
      break;
    }
    bool goesOn = slopes && s.depth > 0.0 && again < kMostAgain;
    if (goesOn) {
      ++again;
      tried = pointOf(map, texel, asDrawn - map.offsets.x - map.offsets.y * slopeOnPlane(map, tried.position, s.normal));
      goesOn = abs(tried.depth) < kNoDepth;
    }
    if (goesOn) continue;
    if (hidden || !biased || !hasFlag(PELLUCID_FLAG_BACK_DEPTH)) break;
    hidden = true;
    again = 0;
    tried = y;
  }
  return told;
}

// ---- The entry point

// `texel`: of the map's tile.
uvec4 entryOf(EntryMapConstants map, ivec2 texel) {
  ivec2 first = firstTexel(map.occluder), inImage = texel + first;
  ShadowTexels stored = shadowTexels(map.meta.x, inImage, first, first + ivec2(map.map.xy) - 1);
  if (!shadowHolds(map.meta, stored.own)) return kNoEntry;
  float asDrawn = stored.own, uncertain = 0.0;
  if (any(notEqual(map.offsets.xyw, vec3(0.0)))) stored = drawnTexels(map, texel, stored, uncertain);
  MapPoint y = pointOf(map, texel, stored.own);
  if (!(abs(y.depth) < kNoDepth)) return kNoEntry;
  bool parallel = map.meta.z == 0u;
  vec3 toLight = parallel ? map.toLight.xyz : normalize(map.ray.xyz - y.position);
  vec3 normal = mapNormal(map, texel, y, stored.beside, stored.own - asDrawn, toLight);
  float tolerance = map.seen.x * (parallel ? 1.0 : abs(y.depth)); // half a texel
  if (uncertain > 0.0) uncertain = min(distance(pointOf(map, texel, stored.own + uncertain).position, y.position), kNoDepth);

  // The camera's depths know the surface's normal. The map's neighbors miss normals of surfaces that the light grazes, and between
  // triangles that a slope bias moved apart: light would seem to come through between points of one lit surface.
  Told told = moveToSurface(map, texel, asDrawn, toLight, tolerance, uncertain, y, normal);

  bool clamped = isClamped(map.meta, map.offsets, asDrawn), opaque = clamped;
  float share = parallel ? 1.0 : shareOfLight(lights[map.map.w], toLight, distance(map.ray.xyz, y.position));
  uint material = 0u;
  if (map.occluder.y != 0u) {
    float index = shadowTexel(map.occluder.y - 1u, inImage) * uintBitsToFloat(map.occluder.z);
    material = isWithin(index, 0.5, 255.5) ? uint(index + 0.5) : 0u;
    opaque = opaque || material == 0u; // as is NaN
  }
  if (opaque) share = 0.0;
  float exit = kNoExit;
  if (map.occluder.x != 0u) {
    float exitStored = shadowTexel(map.occluder.x - 1u, inImage);
    MapPoint behind = pointOf(map, texel, exitStored);
    if (!clamped && shadowHolds(map.meta, exitStored) && abs(behind.depth) < kNoDepth)
      exit = max(dot(y.position - behind.position, toLight) + map.offsets.z, 0.0); // the exit has no offset
  }
  float cosine = max(dot(normal, toLight), 0.0);
  bool seen = told.isShown || cameraSees(told.shown, normal, tolerance, uncertain * cosine);
  // Without diffusion what the camera sees stays where it is.
  float seenShare = seen && hasFlag(PELLUCID_FLAG_DIFFUSED) ? share : 0.0;
  return packEntry(EntryPoint(y.depth, normal, seen ? 0.0 : share, seenShare, cosine, exit, material, opaque));
}

#endif
