// Records of a dispatch's shadow maps, below each other in one image.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_RECORDS_GROUP
#include "passes/bindings.glsl"
#include "passes/records.glsl"
#include "passes/shadow_images.glsl"
#include "lib/shadow.glsl"

// ONE_MAP: there is only one, in the first image, which the compiler makes more of than of a loop with one turn.
#ifdef ONE_MAP
const bool kOneMap = true;
#else
const bool kOneMap = false;
#endif

#ifdef DIRECTIONAL
layout(set = 0, binding = PELLUCID_BINDING_DIRECTIONAL_RECORD_MAPS) uniform RecordMaps {
  RecordMapConstants recordMaps[PELLUCID_RECORD_MAPS];
};
#else
layout(set = 0, binding = PELLUCID_BINDING_RECORD_MAPS) readonly buffer RecordMaps { RecordMapConstants recordMaps[]; };
#endif
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D recordsDestination;

// A surface that the light sees more obliquely counts as if it did not.
const float kLeastCosine = 0.05;

// Where the camera has a surface on the pixel that a point is seen on, at the point or in front of it: what it sees is
// in the irradiance that diffusion spreads. What faces away cannot be seen, however thin the part is.
// `front`: of the pixel.
bool cameraSees(ivec2 pixel, float front, float planar, vec3 normal, float tolerance) {
  return insideRect(pixel) && dot(normal, viewRay(frame.camera, pixel).direction) < 0.0 && front > 0.0 &&
         planar <= front + tolerance;
}

// To be fetched before what need not wait for it.
float frontAround(ivec2 pixel) { return frontDistance(withinRect(pixel)); }

// The surface that a texel of a perspective map stores, as RecordMapConstants says; depth: as records store it.
vec3 entryPoint(RecordMapConstants map, ivec2 texel, float stored, out float depth) {
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
  // 0 or of the other sign only at infinity.
  depth = dividend * divisor > 0.0 ? dividend / divisor : kNoDepth;
  return map.ray.xyz + depth * at.xyz;
}

// One texel's step along an axis of the map from y, towards whichever neighbor is nearer: the other may lie
// across an edge. `stored`: of the neighbors forwards and backwards. `squaredStep`: of a texel across the light.
vec3 entrySlope(RecordMapConstants map, ivec2 texel, vec3 y, ivec2 axis, vec2 stored, float squaredStep) {
  vec3 best = vec3(0.0);
  float least = 3.0e38;
  for (int i = 0; i < 2; ++i) {
    int side = 1 - 2 * i;
    ivec2 neighbor = texel + side * axis;
    if (any(lessThan(neighbor, ivec2(0))) || any(greaterThanEqual(neighbor, ivec2(map.map.xy)))) continue;
    float theirs = i == 0 ? stored.x : stored.y;
    if (!shadowHolds(map.meta, theirs)) continue;
    float depth;
    vec3 toward = float(side) * (entryPoint(map, neighbor, theirs, depth) - y);
    float squared = dot(toward, toward);
    if (squared < least) {
      least = squared;
      best = toward;
    }
    // Less steep than 60 degrees: no edge.
    if (squared < 4.0 * squaredStep) break;
  }
  return best;
}

// Where rays are parallel, how much depth grows along a texel's step beyond what it does on a plane across the light,
// to whichever neighbor is nearer; kNoDepth if there is none. `at`, `texels`: of the step's axis; `plane`: what depth
// grows on a plane; `across`: twice the step times the ray; `grows`: to the neighbors forwards and backwards.
float parallelSlope(int at, int texels, float plane, float squaredStep, float across, float ray2, vec2 grows) {
  vec2 change = vec2(1.0, -1.0) * grows + plane;
  vec2 squared = squaredStep + change * (across + change * ray2);
  bool forward = at + 1 < texels && grows.x < kNoDepth, backward = at > 0 && grows.y < kNoDepth;
  // Less steep than 60 degrees: no edge.
  if (forward && (!backward || squared.x < 4.0 * squaredStep || squared.x <= squared.y)) return change.x;
  return backward ? change.y : kNoDepth;
}

// A record of what is known of its surface; normal: not normalized, 0 where no neighbor says.
uvec4 recordOf(Record r, vec3 normal, vec3 toLight, ivec2 pixel, float front, float planar, float tolerance) {
  float squared = dot(normal, normal);
  r.normal = toLight;
  r.inverseCosine = 1.0;
  if (squared > 0.0) {
    normal *= inversesqrt(squared);
    float cosine = dot(normal, toLight);
    r.normal = cosine < 0.0 ? -normal : normal;
    r.inverseCosine = 1.0 / max(abs(cosine), kLeastCosine);
  }
  if (cameraSees(pixel, front, planar, r.normal, tolerance)) r.enters = 0.0;
  return packRecord(r);
}

const ivec2 kNoPixel = ivec2(-1);

uvec4 parallelRecord(RecordMapConstants map, ivec2 texel, ShadowTexels stored) {
  vec4 beside = stored.beside;
  bvec4 holds = bvec4(shadowHolds(map.meta, beside.x), shadowHolds(map.meta, beside.y), shadowHolds(map.meta, beside.z),
                      shadowHolds(map.meta, beside.w));
  vec4 grows = mix(vec4(2.0 * kNoDepth), (beside - stored.own) * map.ray.w, holds);
  vec2 p = vec2(texel) + 0.5;
  Record r;
  r.depth = stored.own * map.ray.w + (map.origin.w + p.x * map.stepX.w + p.y * map.stepY.w);
  r.enters = 1.0;
  if (!(abs(r.depth) < kNoDepth)) return kNoRecord;
  vec4 q = vec4(p, r.depth, 1.0);
  float w = dot(map.pixelW, q), planar = dot(map.planar, q);
  ivec2 pixel = kNoPixel;
  // Far outside stays outside after the conversion.
  if (abs(w) > 0.0 && planar > 0.0)
    pixel = ivec2(floor(clamp(vec2(dot(map.pixelX, q), dot(map.pixelY, q)) / w, vec2(-1.0e6), vec2(1.0e6))));
  float front = frontAround(pixel);
  float squareX = dot(map.stepX.xyz, map.stepX.xyz), squareY = dot(map.stepY.xyz, map.stepY.xyz);
  float ray2 = map.across[1].w;
  float x = parallelSlope(texel.x, int(map.map.x), map.stepX.w, squareX, map.normal.w, ray2, grows.xy);
  float y = parallelSlope(texel.y, int(map.map.y), map.stepY.w, squareY, map.across[0].w, ray2, grows.zw);
  vec3 normal = vec3(0.0);
  if (x < kNoDepth && y < kNoDepth) normal = map.normal.xyz + x * map.across[0].xyz + y * map.across[1].xyz;
  return recordOf(r, normal, map.toLight.xyz, pixel, front, planar, map.seen.x + map.seen.y);
}

#ifndef DIRECTIONAL
uvec4 perspectiveRecord(RecordMapConstants map, ivec2 texel, ShadowTexels stored) {
  Record r;
  vec3 y = entryPoint(map, texel, stored.own, r.depth);
  if (!(abs(r.depth) < kNoDepth)) return kNoRecord;
  ivec2 pixel;
  if (!projectToPixel(frame.camera, y, pixel)) pixel = kNoPixel;
  float front = frontAround(pixel);
  vec3 toLight = map.ray.xyz - y;
  float distanceTo = length(toLight), scale = r.depth * r.depth;
  toLight /= max(distanceTo, 1.0e-12);
  r.enters = lightShare(lights[map.map.w], toLight, distanceTo);
  float squareX = scale * dot(map.stepX.xyz, map.stepX.xyz), squareY = scale * dot(map.stepY.xyz, map.stepY.xyz);
  vec3 normal = cross(entrySlope(map, texel, y, ivec2(1, 0), stored.beside.xy, squareX),
                      entrySlope(map, texel, y, ivec2(0, 1), stored.beside.zw, squareY));
  return recordOf(r, normal, toLight, pixel, front, y.z * frame.camera.range.x, abs(r.depth) * map.seen.x + map.seen.y);
}
#endif

uvec4 recordOf(RecordMapConstants map, ivec2 texel) {
  ShadowTexels stored = shadowTexels(kOneMap ? 0u : map.meta.x, texel, ivec2(map.map.xy) - 1);
  if (!shadowHolds(map.meta, stored.own)) return kNoRecord;
#ifndef DIRECTIONAL
  if (map.meta.z != 0u) return perspectiveRecord(map, texel, stored);
#endif
  return parallelRecord(map, texel, stored);
}

shared uint someEnters;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0u) someEnters = 0u;
  barrier();
  for (uint i = 0u; i < (kOneMap ? 1u : pass.value.x); ++i) {
    ivec4 place = maps[i].place;
    ivec2 own = at - place.xy;
    if (any(lessThan(own, ivec2(0))) || any(greaterThanEqual(own, place.zw))) continue;
    RecordMapConstants map = recordMaps[i];
    // The texel in the middle of those that the record stands for.
    int side = int(map.map.z);
    ivec2 texel = min(own * side + side / 2, ivec2(map.map.xy) - 1);
    uvec4 record = recordOf(map, texel);
    imageStore(recordsDestination, at, record);
    if (lightEnters(record)) someEnters = 1u;
    break;
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u)
    imageStore(recordsDestination, ivec2(pass.value.y, 0) + ivec2(gl_WorkGroupID.xy), uvec4(someEnters));
}
