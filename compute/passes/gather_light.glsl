// A point of the gather and one light: what the light brings, by samples of its records.
#ifndef PELLUCID_GATHER_LIGHT_GLSL
#define PELLUCID_GATHER_LIGHT_GLSL

#include "lib/occluder.glsl"

const float kLastRing = 1.0e12; // squared radius of what lies beyond all samples

// Side of the part of the map that a sample stands for, per radius of its ring: a twelfth of the ring.
const float kSampleSide = 0.5;

bool directional(LightConstants light) { return kDirectional || light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL; }

// A view-space point in a map: where its record lies, and its depth.
vec3 mapPoint(uint map, vec4 position) {
  return vec3(dot(maps[map].column, position), dot(maps[map].row, position), dot(maps[map].depth, position));
}

// As floats, where far outside stays outside.
bool isInMap(uint map, vec2 at) {
  return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(maps[map].place.zw)));
}

uvec4 recordAt(uint map, ivec2 record, int level) {
  ivec2 size = ivec2(pass.value.z & 0xFFFFu, pass.value.z >> 16 & 0x7FFFu);
  return texelFetch(recordsImage, recordPlace(maps[map].place.xy + record, level, size), 0);
}

// The record of the light ray through a point of the map, of a level or, where that has several surfaces, of the first;
// false: the map does not contain the point. `off`: from the point to the middle of what the record stands for, records.
bool fetchRecord(uint map, bool parallel, vec3 point, int level, out uvec4 bits, out vec2 off) {
  bits = kNoRecord;
  off = vec2(0.0);
  if (!parallel && !(point.z > 0.0)) return false;
  vec2 at = parallel ? point.xy : point.xy / point.z;
  if (!isInMap(map, at)) return false;
  bits = recordAt(map, ivec2(at), level);
  if (bits == kSeveralSurfaces) {
    level = 0;
    bits = recordAt(map, ivec2(at), 0);
  }
  off = (vec2(ivec2(at) >> level) + 0.5) * float(1 << level) - at;
  return true;
}

// Reads the first of the light's maps that contains the position.
bool fetchRecord(LightConstants light, vec3 position, int level, out uint map, out vec3 point, out uvec4 bits,
                 out vec2 off) {
  for (map = light.meta.y; map < light.meta.y + light.meta.z; ++map) {
    point = mapPoint(map, vec4(position, 1.0));
    if (fetchRecord(map, directional(light), point, level, bits, off)) return true;
  }
  bits = kNoRecord;
  return false;
}

// How far the lit surface is from a point along its light ray: scene units, or a fraction of the way to the light.
float distanceAhead(bool parallel, float depth, float own) { return parallel ? depth - own : 1.0 - depth / own; }

// The rings around an axis through x; lengths in mm.
struct GatherRings {
  vec3 axis;
  float t, axisCosine; // along the axis from x to the lit surface; of the axis with the light's ray
  float recordSide;    // of the first level
  float ahead;         // along the light's ray from x to the lit surface
  float tolerance;     // that a receiver's own exit may be off by
  float shadowed;      // 1: x lies beyond the exit of its own ray, with air before it, 0: it does not
  uint map;            // that contains x
};

const float kSteepestOwn = 4.0; // slope of the surface at x within a record, as of 76 degrees

// An axis between the light's ray and the normal inwards suits slabs: their rings are around the foot of the
// perpendicular. false: no map contains x, so that no light comes through it.
bool gatherRings(LightConstants light, Surface x, vec3 toLight, float distanceTo, float longest,
                 out GatherRings rings) {
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  float facing = x.hasNormal ? max(-dot(x.normal, toLight), 0.0) : 0.0;
  rings.axis = normalize(toLight - facing * x.normal); // the two are within 90 degrees
  rings.axisCosine = dot(rings.axis, toLight);
  rings.t = rings.ahead = rings.shadowed = 0.0;
  vec3 point;
  vec2 off;
  uvec4 bits;
  if (!fetchRecord(light, x.position, 0, rings.map, point, bits, off)) return false;
  rings.recordSide = length(maps[rings.map].stepX.xyz) * mm * (parallel ? 1.0 : point.z);
  // The slope of the surface within a record, and one record for its curvature.
  rings.tolerance = rings.recordSide * (2.0 + min(slopeOf(x.hasNormal ? dot(x.normal, toLight) : 0.0), kSteepestOwn));
  if (!holdsSurface(bits)) return true;
  float perAhead = parallel ? 1.0 : distanceTo;
  Record own = unpackRecord(bits);
  rings.ahead = distanceAhead(parallel, own.depth, point.z) * perAhead * mm;
  if (own.exit < kNoExit) rings.shadowed = clamp((rings.ahead - own.exit * mm) / rings.tolerance - 1.0, 0.0, 1.0);
  float t = clamp(rings.ahead, 0.0, longest) / mm;
  vec3 guess = x.position + t * rings.axis;
  uint map;
  if (fetchRecord(light, guess, 0, map, point, bits, off) && holdsSurface(bits)) {
    vec3 y = guess + distanceAhead(parallel, unpackRecord(bits).depth, point.z) *
                         (parallel ? toLight : light.position.xyz - guess);
    t = clamp(dot(y - x.position, rings.axis), 0.0, longest / mm);
  }
  rings.t = t * mm;
  return true;
}

// The part of the light that gets to x itself, as its map says: none where the lit surface lies further ahead than a record's
// side makes of the surface's slope. Continuous, as the map is coarse.
float arrivesAt(GatherRings rings, float cosine) {
  float own = rings.recordSide * (1.0 + min(slopeOf(cosine), kSteepestOwn));
  return clamp(2.0 - rings.ahead / max(own, 1.0e-12), 0.0, 1.0);
}

GatherSlab slabOf(uint m, vec4 lengths, float h) {
  float place = gatherPlace(lengths, h);
  int i = 3 * int(place);
  return gatherSlab(GatherEntry(materials[m].gather.entries[i], materials[m].gather.entries[i + 1],
                                materials[m].gather.entries[i + 2]),
                    fract(place));
}

// The part of the light that enters at a record and reaches x through the medium: none where x lies beyond the record's exit,
// with air between. Exits differ by the slope of the body's far side; only where x's own ray has air, too, is that no excuse.
// `to`: from the lit point to x.
float staysInside(GatherRings rings, Record record, vec3 to, vec3 toLight) {
  if (record.exit >= kNoExit) return 1.0;
  float along = -dot(to, toLight), aside = sqrt(max(dot(to, to) - along * along, 0.0));
  const float kSteepest = 2.0; // of far sides, as of 63 degrees
  float beyond = along - record.exit * frame.camera.range.w - kSteepest * (1.0 - rings.shadowed) * aside;
  return clamp(2.0 - beyond / max(rings.tolerance, 1.0e-12), 0.0, 1.0);
}

// From x, mm.
vec3 onRing(vec3 center, vec3 across, vec3 along, vec2 offset) { return center + offset.x * across + offset.y * along; }

// A cell takes one of thirteen patterns. Points that are too far apart to share all take the middle one.
struct Pattern {
  float within, turn; // [0, 1): place in a ring, turn of the first sample
};

Pattern patternOf(ivec2 cell, uint m, float front) {
  vec2 spacing = float(pass.value.x) * pixelSize(frame.camera, front);
  float vary = clamp(2.0 - dot(spacing, spacing) * materials[m].gather.profile.w, 0.0, 1.0);
  // A cell and the twelve that it shares with have one of thirteen each. A lattice fills the strata, and the turn between a
  // sample and its like. It begins off the axes, along which edges often lie: of eight turns the one that errs least.
  int turn = (cell.x + 5 * cell.y) % 13, within = turn * 5 % 13;
  return Pattern(0.5 + vary * (float(within) - 6.0) / 13.0, vary * (float(turn) / 13.0 + 0.025));
}

// Sums over samples, of a light of radiance 1; docs/gather.md derives them. hidden, seen: from the camera.
struct Gathered {
  vec3 through;  // exitance of all that enters opposite to x
  vec3 entering; // diffused irradiance of what enters hidden and faces the way x does
  vec3 hidden;   // part of the diffusion's profile that lies there
  vec3 opposite; // diffused irradiance of what enters seen and faces x, which comes `through` instead
  vec3 seenLight, seen; // diffused irradiance of what enters seen, and its part of the profile
};

// Adds a sample. `to`: from the lit point to x; `near`, `far`: distances of its ring from x; flux: per area across the axis.
void addSample(inout Gathered sum, Surface x, uint m, vec4 lengths, Record record, vec3 to, float near, float far,
               float flux, float axisCosine) {
  float squared = dot(to, to);
  float opposite = x.hasNormal ? 0.5 - 0.5 * dot(x.normal, record.normal) : 1.0; // 1 - m
  float through = max(-dot(record.normal, to), 0.0);
  float squaredH = x.hasNormal ? through * max(dot(x.normal, to), 0.0) / max(opposite, 1.0e-4) : through * through;
  float h = sqrt(min(squaredH, squared));
  float curved = (1.0 - opposite) * min(squaredH / max(squared, 1.0e-12), 1.0);
  vec3 comes = opposite * gatherTransmitted(lengths, slabOf(m, lengths, h), curved, h, near, far);
  bool diffuses = hasFlag(PELLUCID_FLAG_DIFFUSED);
  sum.through += flux * (diffuses ? record.hidden + record.seen : record.hidden) * comes;
  if (!diffuses) return;
  vec3 reflected = gatherReflected(materials[m].gather.profile.rgb, near, far);
  float area = axisCosine / record.cosine;
  vec3 alike = (1.0 - opposite) * reflected;
  sum.entering += flux * record.hidden * alike;
  sum.hidden += area * record.hidden * alike;
  sum.opposite += flux * record.seen * opposite * reflected;
  sum.seenLight += flux * record.seen * alike;
  sum.seen += area * record.seen * alike;
}

Gathered gatherSamples(uint m, LightConstants light, Surface x, Pattern pattern, Incident incident, GatherRings rings) {
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  vec4 lengths = materials[m].gather.lengths;
  vec3 across = normalize(cross(rings.axis, abs(rings.axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(rings.axis, across);
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
    float radius = sqrt(gatherSquaredRadius(rings.t, spread));
    vec2 offset = radius * direction;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    int level = clamp(int(log2(max(kSampleSide * radius / rings.recordSide, 1.0))), 0, kLastRecordLevel);
    vec3 at = point + offset.x * pointAcross + offset.y * pointAlong;
    uvec4 bits;
    vec2 off;
    uint map = rings.map;
    // A cube's seams are no borders.
    if (!fetchRecord(map, parallel, at, level, bits, off) && !kDirectional && light.meta.z > 1u)
      fetchRecord(light, x.position + onRing(center, across, along, offset) / mm, level, map, at, bits, off);
    float from = inner;
    spread = gatherSpread(lengths, float(i + 1u) * perSample);
    inner = i + 1u == samples ? kLastRing : gatherSquaredRadius(rings.t, spread);
    if (!lightEnters(bits)) continue;
    Record record = unpackRecord(bits);
    if (record.material != 0u && record.material != m + 1u) continue;
    vec3 s = onRing(center, across, along, offset);
    vec3 toLight = parallel ? incident.toLight * mm : (light.position.xyz - x.position) * mm - s;
    float ahead = distanceAhead(parallel, record.depth, at.z);
    // The record's plane goes on to the sample's own ray.
    vec3 middle = (off.x * maps[map].stepX.xyz + off.y * maps[map].stepY.xyz) * mm * (parallel ? 1.0 : record.depth);
    float towards = dot(record.normal, toLight), most = 2.0 * length(middle) * inversesqrt(max(dot(toLight, toLight), 1.0e-12));
    ahead += clamp(dot(record.normal, middle) / max(towards, 1.0e-6 * mm), -most, most);
    vec3 to = -(s + ahead * toLight); // from the lit point to x
    // The ring, seen as if all of it lay in the lit point's plane across the axis.
    float plane = max(dot(to, to) - dot(offset, offset), 0.0);
    float flux = rings.axisCosine;
    // A point light's is its intensity: per square scene unit at s. At the light itself any finite value will do.
    if (!parallel) flux *= mm * mm / max(dot(toLight, toLight), 1.0e-12 * mm * mm);
    float inside = staysInside(rings, record, to, parallel ? incident.toLight : normalize(toLight));
    record.hidden *= inside;
    record.seen *= inside;
    addSample(sum, x, m, lengths, record, to, sqrt(plane + from), sqrt(plane + inner), flux, rings.axisCosine);
  }
  return sum;
}

// A light of radiance 1 brings this to x beyond its diffused irradiance, as irradiance that albedo = rho turns into exitance.
// The diffusion is normalized over what the camera sees: what enters hidden from it displaces its part of what the light
// itself brings to x and to its surroundings. `loss`: see thinLoss.
vec3 gatherLight(uint m, LightConstants light, Surface x, Pattern pattern, vec3 loss) {
  Incident incident = incidentLight(light, x.position);
  GatherRings rings;
  if (!gatherRings(light, x, incident.toLight, incident.distanceTo, materials[m].gather.lengths.z, rings)) return vec3(0.0);
  Gathered g = gatherSamples(m, light, x, pattern, incident, rings);
  vec3 through = g.through * frame.filterAndLimit.rgb * materials[m].inverseReflectance.rgb;
  if (!hasFlag(PELLUCID_FLAG_DIFFUSED)) return through;
  float cosine = x.hasNormal ? max(dot(x.normal, incident.toLight), 0.0) : 0.0;
  // The light's cone and range are left out: the sums have them.
  float falloff = directional(light) ? 1.0 : 1.0 / max(incident.distanceTo * incident.distanceTo, 1.0e-12);
  float own = falloff * cosine * arrivesAt(rings, cosine);
  vec3 hidden = min(g.hidden, vec3(1.0)), seen = g.seenLight / max(g.seen, vec3(1.0e-12)), around = 0.5 * (own + seen);
  // Diffused light is no more than what lies around, and a dark point has next to none of its own to lose.
  vec3 opposite = min(g.opposite, through + own);
  vec3 lost = min(seen, vec3(2.0 * own)) * lightShare(light, incident.toLight, incident.distanceTo);
  return through + g.entering - opposite - hidden * around - (1.0 - hidden) * loss * lost;
}

#endif
