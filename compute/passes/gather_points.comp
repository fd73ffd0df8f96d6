// Points of the gather: in each cell of 2x2 or 4x4 pixels one gathers what light has gone through a part, from
// records. Neighbors take samples of their own, by thirteen patterns; gather_share.comp shares what they find.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_POINTS_GROUP
#include "passes/bindings.glsl"
#include "passes/points.glsl"
#include "passes/records.glsl"
#include "lib/light.glsl"
#include "lib/surface.glsl"

layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;
layout(set = 0, binding = PELLUCID_BINDING_RECORDS) uniform utexture2D recordsImage;
layout(set = 0, binding = PELLUCID_BINDING_POINTS, rgba32ui) uniform uimage2D pointsImage;
layout(set = 0, binding = PELLUCID_BINDING_GATHER_DISPATCHES) coherent buffer Dispatches { GatherDispatches dispatches; };

#include "lib/gather.glsl"

const float kLastRing = 1.0e12; // squared radius of what lies beyond all samples

struct Gathered {
  vec3 transmitted; // exitance
  vec3 entering;    // irradiance that reaches x as diffusion does
  vec3 displaced;   // share of the diffusion's profile that lies on hidden texels
};

bool directional(LightConstants light) { return kDirectional || light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL; }

// A view-space point in a map: where its record lies, and its depth.
vec3 mapPoint(uint map, vec4 position) {
  return vec3(dot(maps[map].column, position), dot(maps[map].row, position), dot(maps[map].depth, position));
}

// As floats, where far outside stays outside.
bool isInMap(uint map, vec2 at) {
  return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(maps[map].place.zw)));
}

// The record of the light ray through a point of the map; false: the map does not contain the point.
bool fetchRecord(uint map, bool parallel, vec3 point, out uvec4 bits) {
  bits = kNoRecord;
  if (!parallel && !(point.z > 0.0)) return false;
  vec2 at = parallel ? point.xy : point.xy / point.z;
  if (!isInMap(map, at)) return false;
  bits = texelFetch(recordsImage, maps[map].place.xy + ivec2(at), 0);
  return true;
}

// Of the first of the light's maps that contains the position.
bool fetchRecord(LightConstants light, vec3 position, out vec3 point, out uvec4 bits) {
  for (uint map = light.meta.y; map < light.meta.y + light.meta.z; ++map) {
    point = mapPoint(map, vec4(position, 1.0));
    if (fetchRecord(map, directional(light), point, bits)) return true;
  }
  bits = kNoRecord;
  return false;
}

// How far the lit surface is from a point along its light ray: scene units, or a fraction of the way to the light.
float distanceAhead(bool parallel, float depth, float own) { return parallel ? depth - own : 1.0 - depth / own; }

// The rings around an axis through x; t, mm: along it, from x to the lit surface.
struct GatherRings {
  vec3 axis;
  float t, axisCosine; // of the axis with the light's ray
  uint map;            // that contains x
};

// An axis between the light's ray and the normal inwards suits slabs: their rings are around the foot of the
// perpendicular. false: no map contains x, so that no light comes through it.
bool gatherRings(LightConstants light, Surface x, vec3 toLight, float distanceTo, float longest,
                 out GatherRings rings) {
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  float facing = x.hasNormal ? max(-dot(x.normal, toLight), 0.0) : 0.0;
  rings.axis = normalize(toLight - facing * x.normal); // the two are within 90 degrees
  rings.axisCosine = dot(rings.axis, toLight);
  rings.t = 0.0;
  vec3 point;
  uvec4 bits;
  uint end = light.meta.y + light.meta.z;
  for (rings.map = light.meta.y; rings.map < end; ++rings.map) {
    point = mapPoint(rings.map, vec4(x.position, 1.0));
    if (fetchRecord(rings.map, parallel, point, bits)) break;
  }
  if (rings.map == end) return false;
  if (!holdsSurface(bits)) return true;
  float perAhead = parallel ? 1.0 : distanceTo;
  float t = clamp(distanceAhead(parallel, unpackRecord(bits).depth, point.z) * perAhead, 0.0, longest / mm);
  vec3 guess = x.position + t * rings.axis;
  if (fetchRecord(light, guess, point, bits) && holdsSurface(bits)) {
    vec3 y = guess + distanceAhead(parallel, unpackRecord(bits).depth, point.z) *
                         (parallel ? toLight : light.position.xyz - guess);
    t = clamp(dot(y - x.position, rings.axis), 0.0, longest / mm);
  }
  rings.t = t * mm;
  return true;
}

GatherSlab slabOf(uint m, vec4 lengths, float h) {
  float place = gatherPlace(lengths, h);
  int i = 3 * int(place);
  return gatherSlab(GatherEntry(materials[m].gather.entries[i], materials[m].gather.entries[i + 1],
                                materials[m].gather.entries[i + 2]),
                    fract(place));
}

// From x, mm.
vec3 onRing(vec3 center, vec3 across, vec3 along, vec2 offset) { return center + offset.x * across + offset.y * along; }

// Which of the patterns a cell takes. Where points are too far apart to share, all take the middle one.
struct Pattern {
  float within, turn; // [0, 1): place in a ring, turn of the first sample
};
const float kMostWithin = 0.5 + 6.0 / 13.0;

Pattern patternOf(ivec2 cell, uint m, float front) {
  vec2 spacing = float(pass.value.x) * pixelSize(frame.camera, front);
  float vary = clamp(2.0 - dot(spacing, spacing) * materials[m].gather.profile.w, 0.0, 1.0);
  // A cell and the twelve that it shares with have one of thirteen each. A lattice fills the strata, and the turn between a
  // sample and its like. It begins off the axes, along which edges often lie: of eight turns the one that errs least.
  int turn = (cell.x + 5 * cell.y) % 13, within = turn * 5 % 13;
  return Pattern(0.5 + vary * (float(within) - 6.0) / 13.0, vary * (float(turn) / 13.0 + 0.025));
}

// From points of the light's maps.
Gathered gatherLight(uint m, LightConstants light, Surface x, Pattern pattern) {
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0));
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  Incident incident = incidentLight(light, x.position);
  vec4 lengths = materials[m].gather.lengths;
  GatherRings rings;
  if (!gatherRings(light, x, incident.toLight, incident.distanceTo, lengths.z, rings)) return sum;
  vec3 across = normalize(cross(rings.axis, abs(rings.axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(rings.axis, across), profile = materials[m].gather.profile.rgb;
  // Positions and what maps make of them are affine in mm across and along the rings.
  vec3 center = rings.t * rings.axis;
  vec3 point = mapPoint(rings.map, vec4(x.position + center / mm, 1.0));
  vec3 pointAcross = mapPoint(rings.map, vec4(across / mm, 0.0)), pointAlong = mapPoint(rings.map, vec4(along / mm, 0.0));
  vec2 direction = vec2(cos(6.28318531 * pattern.turn), sin(6.28318531 * pattern.turn));
  uint samples = pass.value.w;
  float perSample = 1.0 / float(samples), inner = 0.0;
  [[dont_unroll]] for (uint i = 0u; i < samples; ++i) {
    // mm, from the foot, across and along the ring.
    float spread = gatherSpread(lengths, (float(i) + pattern.within) * perSample);
    vec2 offset = sqrt(gatherSquaredRadius(rings.t, spread)) * direction;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    vec3 at = point + offset.x * pointAcross + offset.y * pointAlong;
    uvec4 bits;
    // A cube's seams are no borders.
    if (!fetchRecord(rings.map, parallel, at, bits) && !kDirectional && light.meta.z > 1u)
      fetchRecord(light, x.position + onRing(center, across, along, offset) / mm, at, bits);
    float from = inner;
    spread = gatherSpread(lengths, float(i + 1u) * perSample);
    inner = i + 1u == samples ? kLastRing : gatherSquaredRadius(rings.t, spread);
    if (!lightEnters(bits)) continue;
    Record record = unpackRecord(bits);
    float ahead = distanceAhead(parallel, record.depth, at.z);
    vec3 s = onRing(center, across, along, offset);
    vec3 toLight = parallel ? incident.toLight * mm : (light.position.xyz - x.position) * mm - s;
    vec3 to = -(s + ahead * toLight); // from the lit point to x
    float squared = dot(to, to);
    float opposite = x.hasNormal ? 0.5 - 0.5 * dot(x.normal, record.normal) : 1.0; // 1 - m
    float through = max(-dot(record.normal, to), 0.0);
    float squaredH = x.hasNormal ? through * max(dot(x.normal, to), 0.0) / max(opposite, 1.0e-4) : through * through;
    float h = sqrt(min(squaredH, squared));
    // The ring, seen as if all of it lay in the lit point's plane across the axis.
    float plane = max(squared - dot(offset, offset), 0.0);
    float near = sqrt(plane + from), far = sqrt(plane + inner);
    float share = record.enters * rings.axisCosine;
    // A point light's is its intensity: per square scene unit at s. At the light itself any finite value will do.
    if (!parallel) share *= mm * mm / max(dot(toLight, toLight), 1.0e-12 * mm * mm);
    float curved = (1.0 - opposite) * min(squaredH / max(squared, 1.0e-12), 1.0);
    sum.transmitted += share * opposite * gatherTransmitted(lengths, slabOf(m, lengths, h), curved, h, near, far);
    if (opposite < 0.99) {
      vec3 reflected = (1.0 - opposite) * gatherReflected(profile, near, far);
      sum.entering += share * reflected;
      sum.displaced += reflected * (rings.axisCosine * record.inverseCosine);
    }
  }
  sum.transmitted *= light.radiance.rgb;
  sum.entering *= light.radiance.rgb;
  return sum;
}

// The first pixel of the cell with a surface that light comes through. Its texels are fetched at once, so that the
// latencies overlap.
bool pixelOf(ivec2 cell, int side, out int index, out uint material, out float front, out vec4 normal) {
  for (index = 0; index < side * side; ++index) {
    ivec2 pixel = pixelInCell(cell, side, index);
    if (!insideRect(pixel)) continue;
    uint value = materialValueAt(pixel);
    front = frontDistance(pixel);
    normal = texelFetch(normalImage, pixel, 0);
    material = materialIndex(value);
    if (material != 0u && (value & frame.marks.x) == 0u && front > 0.0) return true;
  }
  return false;
}

struct Beside {
  ivec2 pixel;
  float front;
  vec4 normal; // as stored
};

Beside besideAt(ivec2 pixel) {
  ivec2 at = withinRect(pixel);
  return Beside(pixel, frontDistance(at), texelFetch(normalImage, at, 0));
}

// Whether the surface goes on there; changes of position, scene units, and of the normal.
bool goesOn(Beside b, Surface x, float reach, out vec3 apart, out vec3 turn) {
  vec3 normal = mat3(frame.viewFromNormal) * decodeNormal(b.normal);
  Surface s = makeSurface(viewRay(frame.camera, b.pixel), b.front, -1.0, normal);
  apart = s.position - x.position;
  turn = s.normal - x.normal;
  return insideRect(b.pixel) && b.front > 0.0 && s.hasNormal && dot(apart, apart) < 9.0 * reach * reach;
}

// Pixels from one to those beside it from which its surface's curvature is known. Neighboring cells look to opposite
// sides, so that what they share is centered.
ivec2 besideSteps(ivec2 cell, float front, float reachMm) {
  vec2 steps = clamp(reachMm / pixelSize(frame.camera, front) + 0.5, vec2(1.0), vec2(1.0e4));
  return ivec2(steps) * (1 - 2 * (cell & 1));
}

// Of the surface around x, 1/mm, positive where convex; 0 where it does not go on.
float meanCurvature(ivec2 pixel, ivec2 steps, Beside across, Beside along, Surface x, float reachMm) {
  float mm = frame.camera.range.w, reach = max(reachMm / mm, 1.0e-30);
  vec3 a, turnA, b, turnB;
  bool known = goesOn(across, x, reach, a, turnA) || goesOn(besideAt(pixel - ivec2(steps.x, 0)), x, reach, a, turnA);
  known = known && (goesOn(along, x, reach, b, turnB) || goesOn(besideAt(pixel - ivec2(0, steps.y)), x, reach, b, turnB));
  if (!known) return 0.0;
  // Trace of the map from steps to turns.
  float area = dot(x.normal, cross(a, b)), least = 0.1 * sqrt(dot(a, a) * dot(b, b));
  return abs(area) > least ? 0.5 * dot(x.normal, cross(turnA, b) + cross(a, turnB)) / (area * mm) : 0.0;
}

// Where surfaces curve more, what comes back more has entered where it is darker, or is gathered: a tenth, the
// least share that a point holds.
const float kMostConvexity = -float(kLeastDisplaced) / float(kMostDisplaced);

// By how much more light comes back, of each channel, from the surface of the cell's point as it is curved.
vec3 convexity(ivec2 cell, int side, Point p, Surface x) {
  vec4 perCurvature = materials[p.material - 1u].gather.convexity;
  ivec2 steps = besideSteps(cell, p.front, perCurvature.w), pixel = pixelInCell(cell, side, p.index);
  Beside across = besideAt(pixel + ivec2(steps.x, 0)), along = besideAt(pixel + ivec2(0, steps.y));
  vec3 more = perCurvature.rgb * meanCurvature(pixel, steps, across, along, x, perCurvature.w);
  return clamp(more, vec3(-kMostConvexity), vec3(kMostConvexity));
}

void gatherLights(Surface x, Pattern pattern, inout Point result) {
  uint m = result.material - 1u;
  vec3 transmitted = vec3(0.0), entering = vec3(0.0), irradiance = vec3(0.0);
  for (uint i = 0u; i < pass.value.y; ++i) {
    Gathered g = gatherLight(m, lights[i], x, pattern);
    transmitted += g.transmitted;
    entering += g.entering;
    // Mean of what is displaced; where nothing is, nothing enters.
    irradiance += g.entering / max(g.displaced, vec3(1.0e-12));
  }
  // Lights light the same surface: the mean of what each displaces, by how strongly it lights that. A weak one that grazes the
  // surface sees little of it, and that little badly.
  vec3 displaced = entering / max(irradiance, vec3(1.0e-12));
  result.added = transmitted * frame.filterAndLimit.rgb * materials[m].inverseReflectance.rgb;
  if (!hasFlag(PELLUCID_FLAG_DIFFUSED)) return;
  result.added += entering;
  result.displaced += displaced;
}

#ifdef DIRECTIONAL
// The summaries around one that a point of the group is in, a bit each.
shared uint summaryPlace;
shared uint summaries[GROUP_SIDE];

// Whether light enters within `reach`, records, or further than summaries say. `corner`: of the summaries.
bool entersWithin(float reach, vec2 at, ivec2 corner) {
  reach = min(reach, 1.0e6);
  ivec2 low = ivec2(floor((at - reach) / float(kSummarySide))) - corner;
  ivec2 high = ivec2(floor((at + reach) / float(kSummarySide))) - corner;
  if (any(lessThan(low, ivec2(0))) || any(greaterThanEqual(high, ivec2(GROUP_SIDE)))) return true;
  uint found = 0u;
  for (int y = low.y; y <= high.y; ++y) found |= summaries[y];
  return (found & ((2u << high.x) - (1u << low.x))) != 0u;
}

// For all of the group at once: whether light enters anywhere that the samples of x may lie, of the only light's map.
// true if they may lie too far away to say. `some`: there is an x.
bool lightEntersNear(bool some, Surface x, uint m) {
  const uint kNowhere = ~0u;
  ivec2 local = ivec2(gl_LocalInvocationID.xy);
  vec3 point = mapPoint(0u, vec4(x.position, 1.0));
  vec4 lengths = materials[m].gather.lengths;
  bool contained = some && isInMap(0u, point.xy);
  ivec2 square = ivec2(point.xy) / kSummarySide;
  if (local.y == 0) summaries[local.x] = 0u;
  if (gl_LocalInvocationIndex == 0u) summaryPlace = kNowhere;
  barrier();
  if (contained) summaryPlace = uint(square.x) | uint(square.y) << 16; // any of them
  barrier();
  bool anywhere = summaryPlace != kNowhere;
  ivec2 corner = ivec2(summaryPlace & 0xFFFFu, summaryPlace >> 16) - (GROUP_SIDE / 2 - 1), at = corner + local;
  bool exists = anywhere && all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at * kSummarySide, maps[0].place.zw));
  if (exists && texelFetch(recordsImage, ivec2(pass.value.z >> 1, 0) + at, 0).x != 0u)
    atomicOr(summaries[local.y], 1u << local.x);
  barrier();
  if (!contained) return false;
  float samples = float(pass.value.w), spread = gatherSpread(lengths, (samples - 1.0 + kMostWithin) / samples);
  vec3 column = maps[0].column.xyz, row = maps[0].row.xyz;
  float perMm = sqrt(max(dot(column, column), dot(row, row))) / frame.camera.range.w;
  // The furthest sample around whatever axis, then around x itself where that is lit.
  float furthest = lengths.z + sqrt(gatherSquaredRadius(lengths.z, spread));
  if (!entersWithin(furthest * perMm, point.xy, corner)) return false;
  uvec4 bits;
  fetchRecord(0u, true, point, bits);
  bool lit = !holdsSurface(bits) || distanceAhead(true, unpackRecord(bits).depth, point.z) <= 0.0;
  return !lit || entersWithin(spread * perMm, point.xy, corner);
}
#endif

// Decides about the dispatches that follow.
void somePointHasLight() {
  // Read first: atomics of all points would queue at the same place. Where the plan does not go by them, both are 0.
  if (dispatches.light.x == dispatches.light.w || atomicMax(dispatches.light.x, dispatches.light.w) != 0u) return;
  atomicMax(dispatches.share.x, dispatches.share.w);
  atomicMin(dispatches.noLight.x, 0u);
}

void main() {
  int side = int(pass.value.x);
  ivec4 cells = cellsOf(frame.rect, side);
  ivec2 cell = cells.xy + ivec2(gl_GlobalInvocationID.xy);
  bool inside = all(lessThan(cell, cells.zw));
  Point result = unpackPoint(kNoPoint);
  vec4 normalTexel;
  bool some = inside && pixelOf(cell, side, result.index, result.material, result.front, normalTexel);
  Surface x;
  if (some) {
    vec3 normal = vec3(0.0);
    if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
    x = makeSurface(viewRay(frame.camera, pixelInCell(cell, side, result.index)), result.front, -1.0, normal);
    result.normal = x.hasNormal ? x.normal : -x.view;
  }
  bool gathers = some;
#ifdef DIRECTIONAL
  if (pass.value.y == 1u) gathers = lightEntersNear(some, x, max(result.material, 1u) - 1u);
#endif
  // Only now: what it holds would take registers from what is waited for above.
  if (some && x.hasNormal && hasFlag(PELLUCID_FLAG_DIFFUSED)) result.displaced = -convexity(cell, side, result, x);
  if (gathers) gatherLights(x, patternOf(cell, result.material - 1u, result.front), result);
  if (some && (pass.value.z & 1u) != 0u) {
    Point before = unpackPoint(imageLoad(pointsImage, cell));
    result.added += before.added;
    result.displaced = max(result.displaced, before.displaced);
  }
  uvec4 bits = some ? packPoint(result) : kNoPoint;
  if (inside) imageStore(pointsImage, cell, bits);
  if (hasLight(bits)) somePointHasLight();
}
