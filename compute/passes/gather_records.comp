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

uvec4 recordOf(RecordMapConstants map, ivec2 texel) {
  float stored[5] = shadowTexels(map.meta.x, texel, ivec2(map.map.xy) - 1);
  if (!shadowHolds(map.meta, stored[0])) return kNoRecord;
  Record r;
  vec3 y = entryPoint(map, texel, stored[0], r.depth);
  if (!(abs(r.depth) < kNoDepth)) return kNoRecord;
  vec3 toLight = map.ray.xyz - y;
  float distanceTo = length(toLight), scale = 1.0;
  if (perspective(map)) {
    toLight /= max(distanceTo, 1.0e-12);
    scale = r.depth * r.depth;
  } else {
    toLight = -lights[map.map.w].direction.xyz;
  }
  float squareX = scale * dot(map.stepX.xyz, map.stepX.xyz), squareY = scale * dot(map.stepY.xyz, map.stepY.xyz);
  vec3 normal = cross(entrySlope(map, texel, y, ivec2(1, 0), vec2(stored[1], stored[2]), squareX),
                      entrySlope(map, texel, y, ivec2(0, 1), vec2(stored[3], stored[4]), squareY));
  float size = length(normal), cosine = dot(normal, toLight);
  r.normal = size > 0.0 ? normal * ((cosine < 0.0 ? -1.0 : 1.0) / size) : toLight;
  r.inverseCosine = size > 0.0 ? 1.0 / max(abs(cosine) / size, kLeastCosine) : 1.0;
  r.enters = lightShare(lights[map.map.w], toLight, distanceTo);
  float tolerance = kSeenTolerance * sqrt(sqrt(squareX * squareY)) + map.bias.x;
  if (cameraSees(y, r.normal, tolerance)) r.enters = 0.0;
  return packRecord(r);
}

void main() {
  ivec2 at = ivec2(gl_GlobalInvocationID.xy);
  for (uint i = 0u; i < pass.value.x; ++i) {
    ivec4 place = maps[i].place;
    ivec2 own = at - place.xy;
    if (any(lessThan(own, ivec2(0))) || any(greaterThanEqual(own, place.zw))) continue;
    RecordMapConstants map = recordMaps[i];
    // The texel in the middle of those that the record stands for.
    int side = int(map.map.z);
    ivec2 texel = min(own * side + side / 2, ivec2(map.map.xy) - 1);
    imageStore(recordsDestination, at, recordOf(map, texel));
    return;
  }
}
