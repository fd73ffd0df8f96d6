// The entry point of a texel of a shadow map.
#define MORE_SHADOW_IMAGES
#include "frame/shadow_images.glsl"
#include "frame/normal_image.glsl"
#include "lib/occluder.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

// Slope towards the camera up to which a pixel's own slope excuses a point behind its depth: 63 degrees. Steeper limbs enter
// light that their few pixels do not all show: without this end a sphere of 8 mm is off by a third more.
const float kSteepestSeen = 2.0;

// True where a point does not lie behind the surface that its pixel shows: the light that enters there is in the irradiance
// that diffusion spreads. A surface that faces away cannot be seen, however thin the part is. `front`: of the pixel;
// `uncertain`: along the normal.
bool cameraSees(ivec2 pixel, float front, float planar, vec3 normal, float tolerance, float uncertain) {
  vec3 ray = viewRay(frame.camera, pixel).direction;
  float facing = dot(normal, ray), slope = slopeOf(facing * inversesqrt(dot(ray, ray)));
  if (slope >= kSteepestSeen) slope = 0.0;
  vec2 squared = squaredPixelSize(frame.camera, front);
  // Up to half a pixel's diagonal lies between the point and the pixel's center.
  tolerance += 0.70710678 * sqrt(max(squared.x, squared.y)) * slope;
  return insideRect(pixel) && facing < 0.0 && front > 0.0 &&
         planar <= front + tolerance + uncertain / max(-facing, kLeastCosine);
}

// Front of a pixel that has a material; others show nothing, whatever depth they hold, as their light is not diffused.
float frontAround(ivec2 pixel) {
  ivec2 at = withinRect(pixel);
  float front = frontDistance(at);
  return materialAt(at) != 0u ? front : -1.0;
}

// Unit outward normal of what a pixel shows, from the normal image or the depths around; 0: none.
vec3 shownNormal(ivec2 pixel, float front) {
  if (hasFlag(PELLUCID_FLAG_NORMAL)) {
    vec3 normal = mat3(frame.viewFromNormal) * normalAt(withinRect(pixel));
    float squared = dot(normal, normal);
    return squared > 1.0e-8 && squared < 1.0e8 ? normal * inversesqrt(squared) : vec3(0.0); // false for NaN
  }
  vec4 beside = vec4(frontAround(pixel + ivec2(1, 0)), frontAround(pixel - ivec2(1, 0)), frontAround(pixel + ivec2(0, 1)),
                     frontAround(pixel - ivec2(0, 1)));
  return normalOfDepths(frame.camera, pixel, front, beside);
}

// The surface that a texel of a perspective map stores, as EntryMapConstants says; depth: as entry points store it.
vec3 surfacePoint(EntryMapConstants map, ivec2 texel, float stored, out float depth) {
  vec2 p = vec2(texel) + 0.5;
  vec4 at = map.origin + p.x * map.stepX + p.y * map.stepY;
  float divisor = at.w;
  float dividend = stored;
  if (map.meta.y == PELLUCID_SHADER_DEPTH_DEVICE) {
    dividend = map.ray.w;
    divisor = stored - at.w;
  } else if (map.meta.y == PELLUCID_SHADER_DEPTH_DISTANCE) {
    divisor = length(at.xyz);
  }
  // The product is 0 or negative only at infinity.
  depth = dividend * divisor > 0.0 ? dividend / divisor : kNoDepth;
  return map.ray.xyz + depth * at.xyz;
}

// One texel's step along an axis of the map from y, towards whichever neighbor is nearer, because the other may lie across an
// edge. `stored`: of the neighbors forwards and backwards; `squaredStep`: of a texel across the light.
vec3 entrySlope(EntryMapConstants map, ivec2 texel, vec3 y, ivec2 axis, vec2 stored, float squaredStep) {
  vec3 best = vec3(0.0);
  float least = 3.0e38;
  for (int i = 0; i < 2; ++i) {
    int side = 1 - 2 * i;
    ivec2 neighbor = texel + side * axis;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThanEqual(neighbor, ivec2(map.map.xy)))) continue;
    float theirs = i == 0 ? stored.x : stored.y;
    if (!shadowHolds(map.meta, theirs)) continue;
    float depth;
    vec3 toward = float(side) * (surfacePoint(map, neighbor, theirs, depth) - y);
    float squared = dot(toward, toward);
    if (squared < least) {
      least = squared;
      best = toward;
    }
    // A step less steep than 60 degrees is no edge.
    if (squared < 4.0 * squaredStep) break;
  }
  return best;
}

// For parallel rays: how much more depth grows along a texel's step than on a plane across the light, to whichever neighbor is
// nearer; kNoDepth: there is none. `at`, `texels`: of the step's axis; `plane`: what depth grows on a plane; `across`: twice the
// step times the ray; `grows`: to the neighbors forwards and backwards.
float parallelSlope(int at, int texels, float plane, float squaredStep, float across, float ray2, vec2 grows) {
  vec2 change = vec2(1.0, -1.0) * grows + plane;
  vec2 squared = squaredStep + change * (across + change * ray2);
  bool forward = at + 1 < texels && grows.x < kNoDepth, backward = at > 0 && grows.y < kNoDepth;
  // A step less steep than 60 degrees is no edge.
  if (forward && (!backward || squared.x < 4.0 * squaredStep || squared.x <= squared.y)) return change.x;
  return backward ? change.y : kNoDepth;
}

// A texel's caster: what lies behind the stored surface, and the surface's material.
struct Behind {
  float exit; // see EntryPoint
  uint material;
  bool opaque; // no light enters
};

// `texel`: of the image.
Behind behind(EntryMapConstants map, ivec2 texel) {
  Behind b = Behind(kNoExit, 0u, false);
  if (map.occluder.y != 0u) {
    float index = shadowTexel(map.occluder.y - 1u, texel) * uintBitsToFloat(map.occluder.z);
    // NaN counts as opaque.
    b.material = index >= 0.5 && index < 255.5 ? uint(index + 0.5) : 0u;
    b.opaque = b.material == 0u;
  }
  return b;
}

// The entry of a surface at y that part `share` of the light enters. `normal`: of the map, not normalized, 0 where no neighbor
// says. `pixel`, `front`, `planar`: where the camera sees y, what it shows there, and y's planar distance. `tolerance`: half a
// texel, scene units; `uncertain`: scene units along the light that the surface may be off by.
uvec4 entryOf(float depth, vec3 y, float share, vec3 normal, vec3 toLight, ivec2 pixel, float front, float planar,
              float tolerance, float uncertain, Behind b) {
  if (b.opaque) share = 0.0;
  EntryPoint r = EntryPoint(depth, toLight, share, 0.0, 1.0, b.exit, b.material);
  float squared = dot(normal, normal);
  if (squared > 0.0) {
    normal *= inversesqrt(squared);
    float cosine = dot(normal, toLight);
    r.normal = cosine < 0.0 ? -normal : normal;
    r.cosine = abs(cosine);
  }
  bool shown = false;
  if (insideRect(pixel) && front > 0.0) {
    vec3 own = shownNormal(pixel, front);
    ViewRay ray = viewRay(frame.camera, pixel);
    float cosine = dot(own, toLight), above = dot(own, y - ray.origin - front * ray.direction);
    shown = dot(own, own) > 0.0 && abs(above) <= tolerance + uncertain * abs(cosine);
    if (shown) {
      r.normal = own;
      r.cosine = max(cosine, 0.0);
    }
  }
  if (shown || cameraSees(pixel, front, planar, r.normal, tolerance, uncertain * dot(r.normal, toLight))) {
    r.seen = share;
    r.hidden = 0.0;
  }
  return packEntry(r);
}

const ivec2 kNoPixel = ivec2(-1);

bvec4 neighborsHold(EntryMapConstants map, vec4 beside) {
  return bvec4(shadowHolds(map.meta, beside.x), shadowHolds(map.meta, beside.y), shadowHolds(map.meta, beside.z),
               shadowHolds(map.meta, beside.w));
}

// The step of depth along an axis that two neighboring steps agree best on: a bias jumps between triangles, and within one
// all steps are alike. beside, beyond: one and two texels ahead, and behind.
float agreedStep(float own, vec2 beside, vec2 beyond, bvec2 holds, bvec2 holdsBeyond) {
  vec4 steps = vec4(beside.y - beyond.y, own - beside.y, beside.x - own, beyond.x - beside.x);
  bvec4 known = bvec4(holds.y && holdsBeyond.y, holds.y, holds.x, holds.x && holdsBeyond.x);
  float least = 3.0e38, agreed = known.y ? steps.y : known.z ? steps.z : 0.0;
  for (int i = 0; i < 3; ++i) {
    float apart = abs(steps[i] - steps[i + 1]);
    if (!known[i] || !known[i + 1] || apart >= least) continue;
    least = apart;
    agreed = 0.5 * (steps[i] + steps[i + 1]);
  }
  return agreed;
}

float agreedStep(EntryMapConstants map, ivec2 texel, ivec2 axis, float own, vec2 beside, bvec2 holds) {
  ivec2 ahead = texel + 2 * axis, behind = texel - 2 * axis, first = firstTexel(map.occluder), last = ivec2(map.map.xy) - 1;
  vec2 beyond = vec2(shadowTexel(map.meta.x, first + min(ahead, last)), shadowTexel(map.meta.x, first + max(behind, ivec2(0))));
  bvec2 holdsBeyond = bvec2(all(lessThanEqual(ahead, last)) && shadowHolds(map.meta, beyond.x),
                            all(greaterThanEqual(behind, ivec2(0))) && shadowHolds(map.meta, beyond.y));
  return agreedStep(own, beside, beyond, holds, holdsBeyond);
}

// Depths that were drawn into a texel and its neighbors, without the map's biases. `uncertain`: how far its own depth may be off.
// The neighbors of the tile's border are within it: the border itself takes the place of others, and does not count.
ShadowTexels drawnTexels(EntryMapConstants map, ivec2 texel, ShadowTexels stored, out float uncertain) {
  ivec2 last = ivec2(map.map.xy) - 1;
  bvec4 within = bvec4(texel.x < last.x, texel.x > 0, texel.y < last.y, texel.y > 0);
  bvec4 stores = neighborsHold(map, stored.beside), holds = bvec4(uvec4(stores) & uvec4(within));
  DrawnDepth drawn = drawnDepth(map.offsets, stored.own, stored.beside, holds);
  uncertain = drawn.uncertain;
  vec4 steps = stored.beside - stored.own;
  if (map.offsets.y != 0.0) {
    float own = withoutPit(map.offsets, stored.own, stored.beside, holds);
    float x = agreedStep(map, texel, ivec2(1, 0), own, stored.beside.xy, holds.xy);
    float y = agreedStep(map, texel, ivec2(0, 1), own, stored.beside.zw, holds.zw);
    steps = vec4(x, -x, y, -y);
    drawn.depth = own - map.offsets.x - map.offsets.y * max(abs(x), abs(y));
  }
  return ShadowTexels(drawn.depth, mix(stored.beside, drawn.depth + steps, stores));
}

// stored: as drawn; `uncertain`: see drawnTexels.
uvec4 parallelEntry(EntryMapConstants map, ivec2 texel, ShadowTexels stored, float uncertain) {
  vec4 beside = stored.beside;
  bvec4 holds = neighborsHold(map, beside);
  vec4 grows = mix(vec4(2.0 * kNoDepth), (beside - stored.own) * map.ray.w, holds);
  vec2 p = vec2(texel) + 0.5;
  float depth = stored.own * map.ray.w + (map.origin.w + p.x * map.stepX.w + p.y * map.stepY.w) + map.offsets.z;
  if (!(abs(depth) < kNoDepth)) return kNoEntry;
  vec4 q = vec4(p, depth, 1.0);
  float w = dot(map.pixelW, q), planar = dot(map.planar, q);
  ivec2 pixel = kNoPixel;
  // Far outside stays outside after the conversion.
  if (abs(w) > 0.0 && planar > 0.0)
    pixel = ivec2(floor(clamp(vec2(dot(map.pixelX, q), dot(map.pixelY, q)) / w, vec2(-1.0e6), vec2(1.0e6))));
  float front = frontAround(pixel);
  float squareX = dot(map.stepX.xyz, map.stepX.xyz), squareY = dot(map.stepY.xyz, map.stepY.xyz);
  float ray2 = map.across[1].w;
  float slopeX = parallelSlope(texel.x, int(map.map.x), map.stepX.w, squareX, map.normal.w, ray2, grows.xy);
  float slopeY = parallelSlope(texel.y, int(map.map.y), map.stepY.w, squareY, map.across[0].w, ray2, grows.zw);
  vec3 normal = vec3(0.0);
  if (slopeX < kNoDepth && slopeY < kNoDepth)
    normal = map.normal.xyz + slopeX * map.across[0].xyz + slopeY * map.across[1].xyz;
  ivec2 inImage = texel + firstTexel(map.occluder);
  Behind b = behind(map, inImage);
  if (map.occluder.x != 0u) {
    float exit = shadowTexel(map.occluder.x - 1u, inImage);
    // Depths of entry points grow towards the light.
    if (shadowHolds(map.meta, exit)) b.exit = max((stored.own - exit) * map.ray.w + map.offsets.z, 0.0);
  }
  vec3 y = map.origin.xyz + p.x * map.stepX.xyz + p.y * map.stepY.xyz + depth * map.ray.xyz;
  return entryOf(depth, y, 1.0, normal, map.toLight.xyz, pixel, front, planar, map.seen.x, uncertain * abs(map.ray.w), b);
}

// `stored`, `uncertain`: as parallelEntry takes them.
uvec4 perspectiveEntry(EntryMapConstants map, ivec2 texel, ShadowTexels stored, float uncertain) {
  float depth, beside;
  vec3 y = surfacePoint(map, texel, stored.own, depth);
  if (!(abs(depth) < kNoDepth)) return kNoEntry;
  float scale = depth * depth;
  float squareX = scale * dot(map.stepX.xyz, map.stepX.xyz), squareY = scale * dot(map.stepY.xyz, map.stepY.xyz);
  vec3 normal = cross(entrySlope(map, texel, y, ivec2(1, 0), stored.beside.xy, squareX),
                      entrySlope(map, texel, y, ivec2(0, 1), stored.beside.zw, squareY));
  if (uncertain > 0.0) uncertain = min(distance(surfacePoint(map, texel, stored.own + uncertain, beside), y), kNoDepth);
  if (map.offsets.z > 0.0) {
    // Not beyond the light.
    float part = max(1.0 - map.offsets.z / max(distance(y, map.ray.xyz), 1.0e-12), 1.0e-3);
    y = map.ray.xyz + part * (y - map.ray.xyz);
    depth *= part;
  }
  ivec2 pixel;
  if (!projectToPixel(frame.camera, y, pixel)) pixel = kNoPixel;
  float front = frontAround(pixel);
  vec3 toLight = map.ray.xyz - y;
  float distanceTo = length(toLight);
  toLight /= max(distanceTo, 1.0e-12);
  float share = shareOfLight(lights[map.map.w], toLight, distanceTo);
  float tolerance = abs(depth) * map.seen.x;
  ivec2 inImage = texel + firstTexel(map.occluder);
  Behind b = behind(map, inImage);
  if (map.occluder.x != 0u) {
    float exit = shadowTexel(map.occluder.x - 1u, inImage), exitDepth;
    vec3 e = surfacePoint(map, texel, exit, exitDepth);
    if (shadowHolds(map.meta, exit) && abs(exitDepth) < kNoDepth) b.exit = distance(e, y);
  }
  return entryOf(depth, y, share, normal, toLight, pixel, front, y.z * frame.camera.range.x, tolerance, uncertain, b);
}

// `texel`: of the map's tile.
uvec4 entryOf(EntryMapConstants map, ivec2 texel) {
  ivec2 first = firstTexel(map.occluder);
  ShadowTexels stored = shadowTexels(map.meta.x, texel + first, first, first + ivec2(map.map.xy) - 1);
  if (!shadowHolds(map.meta, stored.own)) return kNoEntry;
  float uncertain = 0.0;
  if (any(notEqual(map.offsets.xyw, vec3(0.0)))) stored = drawnTexels(map, texel, stored, uncertain);
  if (map.meta.z != 0u) return perspectiveEntry(map, texel, stored, uncertain);
  return parallelEntry(map, texel, stored, uncertain);
}
