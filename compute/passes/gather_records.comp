// Records of a dispatch's shadow maps, below each other in one image.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_RECORDS_GROUP
#include "passes/bindings.glsl"
#include "passes/records.glsl"
#include "passes/shadow_images.glsl"
#include "lib/shadow.glsl"

layout(set = 0, binding = PELLUCID_BINDING_RECORD_MAPS) readonly buffer RecordMaps { RecordMapConstants recordMaps[]; };
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D recordsDestination;

// The camera may miss a texel's point by the slope of the surface within the texel and the pixel.
const float kSeenTolerance = 0.5; // texels
// A surface that the light sees more obliquely counts as if it did not.
const float kLeastCosine = 0.05;

// Where the camera has a surface at y or in front of it: what it sees is in the irradiance that diffusion
// spreads. What faces away cannot be seen, however thin the part is.
bool cameraSees(vec3 y, vec3 normal, float tolerance) {
  ivec2 pixel;
  if (!projectToPixel(frame.camera, y, pixel) || !insideRect(pixel)) return false;
  if (dot(normal, viewRay(frame.camera, pixel).direction) >= 0.0) return false;
  float front = frontDistance(pixel);
  return front > 0.0 && y.z * frame.camera.range.x <= front + tolerance;
}

bool perspective(RecordMapConstants map) { return !kDirectional && map.meta.z != 0u; }

// The surface that a texel stores, as RecordMapConstants says; depth: as records store it.
vec3 entryPoint(RecordMapConstants map, ivec2 texel, float stored, out float depth) {
  vec2 p = vec2(texel) + 0.5;
  vec4 at = map.origin + p.x * map.stepX + p.y * map.stepY;
  if (!perspective(map)) {
    depth = stored * map.ray.w + at.w;
    return at.xyz + depth * map.ray.xyz;
  }
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

// Where rays are parallel, steps along an axis of the map are `along` and a multiple of the ray: which, of whichever
// neighbor is nearer, kNoDepth if there is none. `at`, `texels`: of the axis. along.w: of depth, see RecordMapConstants.
float parallelSlope(RecordMapConstants map, int at, int texels, vec4 along, float own, vec2 stored) {
  vec2 change = vec2(1.0, -1.0) * (stored - own) * map.ray.w + along.w;
  float least = dot(along.xyz, along.xyz), across = 2.0 * dot(along.xyz, map.ray.xyz);
  vec2 squared = least + change * (across + change * dot(map.ray.xyz, map.ray.xyz));
  bool forward = at + 1 < texels && shadowHolds(map.meta, stored.x);
  bool backward = at > 0 && shadowHolds(map.meta, stored.y);
  // Less steep than 60 degrees: no edge.
  if (forward && (!backward || squared.x < 4.0 * least || squared.x <= squared.y)) return change.x;
  return backward ? change.y : kNoDepth;
}

// Not normalized; 0: no neighbor says. `stored`: as of shadowTexels.
vec3 entryNormal(RecordMapConstants map, ivec2 texel, vec3 y, float stored[5], float squareX, float squareY) {
  vec2 besideX = vec2(stored[1], stored[2]), besideY = vec2(stored[3], stored[4]);
  if (perspective(map))
    return cross(entrySlope(map, texel, y, ivec2(1, 0), besideX, squareX),
                 entrySlope(map, texel, y, ivec2(0, 1), besideY, squareY));
  vec3 stepX = map.stepX.xyz, stepY = map.stepY.xyz, ray = map.ray.xyz;
  float x = parallelSlope(map, texel.x, int(map.map.x), map.stepX, stored[0], besideX);
  float yy = parallelSlope(map, texel.y, int(map.map.y), map.stepY, stored[0], besideY);
  if (x >= kNoDepth || yy >= kNoDepth) return vec3(0.0);
  // (stepX + x ray) x (stepY + y ray)
  return cross(stepX, stepY) + yy * cross(stepX, ray) + x * cross(ray, stepY);
}

uvec4 recordOf(RecordMapConstants map, ivec2 texel) {
  float stored[5] = shadowTexels(map.meta.x, texel, ivec2(map.map.xy) - 1);
  if (!shadowHolds(map.meta, stored[0])) return kNoRecord;
  Record r;
  vec3 y = entryPoint(map, texel, stored[0], r.depth);
  if (!(abs(r.depth) < kNoDepth)) return kNoRecord;
  LightConstants light = lights[map.map.w];
  vec3 toLight = -light.direction.xyz;
  float distanceTo = 0.0, scale = 1.0;
  if (perspective(map)) {
    toLight = map.ray.xyz - y;
    distanceTo = length(toLight);
    toLight /= max(distanceTo, 1.0e-12);
    scale = r.depth * r.depth;
  }
  float squareX = scale * dot(map.stepX.xyz, map.stepX.xyz), squareY = scale * dot(map.stepY.xyz, map.stepY.xyz);
  vec3 normal = entryNormal(map, texel, y, stored, squareX, squareY);
  float squared = dot(normal, normal);
  if (squared > 0.0) {
    normal *= inversesqrt(squared);
    float cosine = dot(normal, toLight);
    r.normal = cosine < 0.0 ? -normal : normal;
    r.inverseCosine = 1.0 / max(abs(cosine), kLeastCosine);
  } else {
    r.normal = toLight;
    r.inverseCosine = 1.0;
  }
  r.enters = lightShare(light, toLight, distanceTo);
  float tolerance = kSeenTolerance * sqrt(sqrt(squareX * squareY)) + map.bias.x;
  if (cameraSees(y, r.normal, tolerance)) r.enters = 0.0;
  return packRecord(r);
}

shared uint someEnters;

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  if (gl_LocalInvocationIndex == 0u) someEnters = 0u;
  barrier();
  for (uint i = 0u; i < pass.value.x; ++i) {
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
