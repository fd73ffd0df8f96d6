// Light that one light brings to a probe, by samples of its entry points on rings around the probe.
#ifndef PELLUCID_PROBE_LIGHT_GLSL
#define PELLUCID_PROBE_LIGHT_GLSL

#include "gather/entry_level.glsl"
#include "gather/entry_point.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

layout(push_constant) uniform Pass { ProbesPass pass; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_ENTRY_POINTS) uniform utexture2D entriesImage;

// ---- The kernel. Light that enters the lit surface at y with flux F leaves x with exitance F (1 - m) K(r, h) and comes
// back as diffused irradiance F m R(r), r = |x - y| in mm; docs/how-it-works.md derives K.

// A slab of thickness h: log2 of T(h) e^{q h}, and q in powers of 2 per mm. T(h) itself has no bound in its logarithm.
struct GatherSlab {
  vec3 logarithm, decay;
};

// Place of a thickness among the entries, which are at equal steps of h / (h + scale).
float gatherPlace(vec4 lengths, float h) {
  return h / (h + lengths.w) * float(PELLUCID_GATHER_ENTRIES - 1); // scale > 0
}

// Interpolates between an entry of GatherConstants and the next. a, b, c: the logarithm and its step, the decay and its
// step.
GatherSlab gatherSlab(vec4 a, vec4 b, vec4 c, float fraction) {
  return GatherSlab(a.rgb + fraction * vec3(a.w, b.rg), vec3(b.zw, c.x) + fraction * c.yzw);
}

const float kOneOverPi = 0.31830989;

// Integral of K(r, h) over the ring between the distances `near` and `far` from x: T [e^{-q (near - h)} - e^{-q (far - h)}] is
// exact for slabs. Where h grows with r, as on spheres, K falls like T(r). This fall counts to second order before h, and beyond h by
// the part `curved`, 0 to 1. T(r) falls at the rate kappa coth(kappa (r + e)), q / pi on thin bodies and q = kappa on thick ones. A parabola in
// kappa / q between both is within 8 %. The channel that spreads furthest decides this slope, because light of the others comes
// from rings that are small beside it.
vec3 gatherTransmitted(vec4 lengths, GatherSlab slab, float curved, float h, float near, float far) {
  float begins = max(near, h), before = 0.69314718 * (begins - near);
  vec3 q = slab.decay;
  float kappa = 2.0 / 0.69314718 / lengths.z; // of that channel, in powers of 2: at most the least q, above 0
  float part = kappa / min(min(q.r, q.g), q.b), slope = mix(kOneOverPi, 1.0, part * part), decay = mix(1.0, slope, curved);
  vec3 logarithm = slab.logarithm - q * h;
  vec3 begin = exp2(logarithm - q * (decay * (begins - h))), end = exp2(logarithm - q * (decay * (far - h)));
  return (begin - end) / decay + begin * q * (before + 0.5 * before * before * slope * q);
}

// Integral of Burley's profile over the ring, 1 - cdf = e^{-r / d} / 4 + 3/4 e^{-r / 3d}; inverse3d = 0: no profile.
vec3 gatherReflected(vec3 inverse3d, float near, float far) {
  vec3 a = exp(-inverse3d * near), b = exp(-inverse3d * far);
  return 0.25 * (a * a * a - b * b * b) + 0.75 * (a - b);
}

// How much further than the nearest point of the lit surface the share u of the samples lies, at most:
// exponential, of a length that grows with u from the material's shortest to its longest. u < 1.
// Infinite at u = 1, the end of the last ring, which kLastRing replaces.
float gatherSpread(vec4 lengths, float u) { return -log(1.0 - u) * lengths.x * exp2(lengths.y * u); }

// Square of the radius around a foot at distance t where the distance is t + spread.
float gatherSquaredRadius(float t, float spread) { return spread * (spread + 2.0 * t); }

// ---- Rings around the probe, and the entry points that a light has for them

bool directional(LightConstants light) { return light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL; }

// Place of a view-space point's entry in a map, and the point's depth.
vec3 mapPoint(uint map, vec4 position) {
  return vec3(dot(maps[map].column, position), dot(maps[map].row, position), dot(maps[map].depth, position));
}

// The point's place among the map's entry points; outside of any map where the point lies behind a light.
vec2 placeInMap(bool parallel, vec3 point) {
  if (parallel) return point.xy;
  return point.z > 0.0 ? point.xy / point.z : vec2(-1.0);
}

// Floats keep outside what is far outside.
bool isInMap(uint map, vec2 place) {
  return all(greaterThanEqual(place, vec2(0.0))) && all(lessThan(place, vec2(maps[map].place.zw)));
}

// Finds the first of the light's maps that contains the position, or the nearest one beside a seam between maps, see kSeam. false:
// none does. Then `point` is moved into the map's border.
bool findMap(LightConstants light, vec3 position, out uint map, out vec3 point) {
  bool parallel = directional(light), found = false;
  float least = light.meta.z > 1u ? kSeam : -1.0;
  map = light.meta.y;
  point = vec3(0.0);
  for (uint i = light.meta.y; i < light.meta.y + light.meta.z; ++i) {
    vec3 there = mapPoint(i, vec4(position, 1.0));
    vec2 place = placeInMap(parallel, there), size = vec2(maps[i].place.zw);
    bool inside = isInMap(i, place);
    float beyond = beyondMap(place, size);
    if (!inside && !(beyond <= least)) continue;
    if (!inside) there.xy = clamp(place, vec2(0.25), size - 0.25) * (parallel ? 1.0 : there.z);
    found = true;
    map = i;
    point = there;
    least = beyond;
    if (inside) break;
  }
  return found;
}

// Side of a map's entry points of level 0 at a probe, scene units. Behind a light it is negative, and only less than another.
float entrySide(LightConstants light, uint map, vec3 position) {
  return length(maps[map].stepX.xyz) * (directional(light) ? 1.0 : dot(maps[map].depth, vec4(position, 1.0)));
}

// Level that a probe reads of a map.
int levelOf(LightConstants light, uint map, vec3 position) {
  return entryLevel(entrySide(light, map, position), cellSide(position.z * frame.camera.range.x, pass.spacing));
}

uvec4 entryAt(uint map, vec2 place, int level) {
  ivec2 size = ivec2(pass.entries & 0xFFFFu, pass.entries >> 16 & 0x7FFFu);
  return texelFetch(entriesImage, entryPlace(maps[map].place.xy, level, size) + (ivec2(place) >> level), 0);
}

// How far the lit surface is from a point along its light ray: scene units, or a fraction of the way to the light.
float distanceAhead(bool parallel, float depth, float own) { return parallel ? depth - own : 1.0 - depth / own; }

// The rings around an axis through x; lengths in mm.
struct GatherRings {
  vec3 axis;
  float t, axisCosine; // along the axis from x to the lit surface; of the axis with the light's ray
  float entrySide;     // of the map's entry points of the level
  float perFacet;      // 1 / the reach of the facet at x, two pixels, facing the camera
  float ahead;         // along the light's ray from x to what the light meets
  float nearest;       // likewise, to where it enters a medium beside x
  float tolerance;     // how far a receiver's own exit may be off
  float behindExit;    // along the light's ray from where x's own ray has left the medium to x; 0: it has not
  float shadowed;      // 1: that ray has left the medium before x, for air or an opaque body in it, 0: it has not
  uint map;            // contains x
  int level;           // that the probe reads of this map
};

// Level that the probe of the rings reads of any map.
int levelOf(GatherRings rings, LightConstants light, uint map, vec3 position) {
  return map == rings.map ? rings.level : levelOf(light, map, position);
}

// The nearest entry point that is not opaque in place of a given opaque one, because single texels of hair hide the surface around
// them. An opaque entry point among opaque entry points stays.
uvec4 besideHair(uint map, vec2 place, int level, uvec4 bits) {
  const int kPlaces = 12; // 4 beside, 4 at the corners, 4 two away
  vec2 size = vec2(maps[map].place.zw);
  [[dont_unroll]] for (int i = 0; i < kPlaces && isOpaque(bits); ++i) {
    int side = 1 - (i & 2);
    ivec2 away = (i & 1) == 0 ? ivec2(side, 0) : ivec2(0, side);
    if (i >= 8) away *= 2;
    else if (i >= 4) away = ivec2(side, 2 * (i & 1) - 1);
    uvec4 beside = entryAt(map, clamp(place + vec2(away << level), vec2(0.25), size - 0.25), level);
    if (holdsSurface(beside) && !isOpaque(beside)) bits = beside;
  }
  return bits;
}

const float kSteepestOwn = 4.89897949; // largest slope of the surface at x within an entry point: that of kLeastCosine, 78 degrees

// An axis between the light's ray and the inward normal suits slabs, whose rings lie around the foot of the perpendicular.
// false: no map contains x, so that no light comes through it.
bool gatherRings(LightConstants light, Surface x, vec3 toLight, float distanceTo, float longest,
                 out GatherRings rings) {
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  float facing = max(-dot(x.normal, toLight), 0.0);
  rings.axis = normalize(toLight - facing * x.normal); // the two are within 90 degrees
  rings.axisCosine = dot(rings.axis, toLight);
  rings.perFacet = 0.5 / max(pixelSize(frame.camera, x.position.z * frame.camera.range.x).x, 1.0e-30);
  rings.t = rings.ahead = rings.nearest = rings.behindExit = rings.shadowed = 0.0;
  vec3 point;
  if (!findMap(light, x.position, rings.map, point)) return false;
  rings.level = levelOf(light, rings.map, x.position);
  rings.entrySide = entrySide(light, rings.map, x.position) * mm * float(1 << rings.level);
  vec2 place = placeInMap(parallel, point);
  uvec4 bits = entryAt(rings.map, place, rings.level);
  // The slope of the surface counts within an entry point, and a further one stands for curvature and for steps beside hair.
  rings.tolerance = max(rings.entrySide * (2.0 + min(slopeOf(dot(x.normal, toLight)), kSteepestOwn)), 1.0e-12);
  if (!holdsSurface(bits)) return true;
  float perAhead = parallel ? 1.0 : distanceTo;
  EntryPoint own = unpackEntry(bits);
  rings.ahead = distanceAhead(parallel, own.depth, point.z) * perAhead * mm;
  if (own.exit < kNoExit) rings.behindExit = max(rings.ahead - own.exit * mm, 0.0);
  rings.shadowed = clamp(rings.behindExit / rings.tolerance - 1.0, 0.0, 1.0);
  rings.nearest = rings.ahead;
  if (isOpaque(bits))
    rings.nearest = distanceAhead(parallel, unpackEntry(besideHair(rings.map, place, rings.level, bits)).depth, point.z) * perAhead * mm;
  float t = clamp(rings.nearest, 0.0, longest) / mm;
  vec3 guess = x.position + t * rings.axis;
  uint map;
  bool inside = findMap(light, guess, map, point);
  bits = inside ? entryAt(map, placeInMap(parallel, point), levelOf(rings, light, map, x.position)) : kNoEntry;
  if (holdsSurface(bits) && !isOpaque(bits)) {
    vec3 y = guess + distanceAhead(parallel, unpackEntry(bits).depth, point.z) *
                         (parallel ? toLight : light.position.xyz - guess);
    t = clamp(dot(y - x.position, rings.axis), 0.0, longest / mm);
  }
  rings.t = t * mm;
  return true;
}

// The part of the light that gets to x itself, as its map says: none where the lit surface lies further ahead than the
// surface's slope makes it over an entry point. The part is continuous, because the map is coarse.
float arrivesAt(GatherRings rings, float cosine) {
  float own = rings.entrySide * (1.0 + min(slopeOf(cosine), kSteepestOwn));
  return clamp(2.0 - rings.ahead / max(own, 1.0e-12), 0.0, 1.0);
}

// ---- Samples

const float kLastRing = 1.0e12; // squared radius of what lies beyond all samples

// Largest distances looked for, 2 / kappa each, beyond which a lit surface brings nothing to an unlit point: T is below 1e-5.
const float kFarthestLit = 6.0;

GatherSlab slabOf(uint m, vec4 lengths, float h) {
  float place = gatherPlace(lengths, h);
  // Whatever a NaN converts to, the entry is one of the material's.
  uint i = 3u * min(uint(place), uint(PELLUCID_GATHER_ENTRIES - 1));
  return gatherSlab(materials[m].gather.entries[i], materials[m].gather.entries[i + 1u], materials[m].gather.entries[i + 2u],
                    fract(place));
}

// 1 where the straight path from x to a lit point lies in the body at the part `f` of its length, and 0 where the map's exit lies
// before that place: air or an opaque body is there. `to`: from the lit point to x.
float insideAt(GatherRings rings, LightConstants light, Surface x, uint map, vec3 to, float f) {
  float mm = frame.camera.range.w;
  vec3 on = x.position - f / mm * to, point = mapPoint(map, vec4(on, 1.0));
  vec2 place = placeInMap(directional(light), point);
  uvec4 bits = isInMap(map, place) ? entryAt(map, place, levelOf(rings, light, map, x.position)) : kNoEntry;
  if (!lightEnters(bits)) return 1.0;
  EntryPoint entry = unpackEntry(bits); // without an exit, kNoExit is beyond all
  float perAhead = directional(light) ? 1.0 : distance(light.position.xyz, on);
  float beyond = (distanceAhead(directional(light), entry.depth, point.z) * perAhead - entry.exit) * mm;
  return 1.0 - clamp(beyond / rings.tolerance, 0.0, 1.0);
}

// The part of an entry point's light that reaches x through the medium. The straight path must stay in the body if x lies beyond the
// entry point's exit, or beyond the exit of x's own light ray.
float staysInside(GatherRings rings, LightConstants light, Surface x, uint map, EntryPoint entry, vec3 to, vec3 toLight) {
  float stays = 1.0;
  if (entry.exit < kNoExit) {
    float beyond = clamp((-dot(to, toLight) - entry.exit * frame.camera.range.w) / rings.tolerance - 1.0, 0.0, 1.0);
    float excused = 1.0 - rings.shadowed;
    if (beyond > 0.0 && excused > 0.0) excused *= insideAt(rings, light, x, map, to, 0.5);
    stays -= beyond * (1.0 - excused);
  }
  if (rings.shadowed > 0.0 && stays > 0.0) {
    // A path that begins before the depth, along the axis, at which x's own ray has left the body does not cross the gap behind it.
    float behind = rings.behindExit * rings.axisCosine, along = max(-dot(to, rings.axis), 1.0e-12);
    float crosses = rings.shadowed * clamp((along - behind) / rings.tolerance, 0.0, 1.0);
    // A path that crosses the gap has behind < along. insideAt then looks at a place less than half way from x to the lit point.
    if (crosses > 0.0) stays *= 1.0 - crosses * (1.0 - insideAt(rings, light, x, map, to, 0.5 * behind / along));
  }
  return stays;
}

// Largest slope across the light at which an entry point's plane goes on: kSteepestSeen of texel_entry.glsl.
const float kSteepestPlane = 2.0;

// A sample's place from x, mm.
vec3 onRing(vec3 center, vec3 across, vec3 along, vec2 offset) { return center + offset.x * across + offset.y * along; }

// Multipliers of the lattice of patterns, in cells and in turns: of all pairs those whose patterns fill the strata best in diamonds of
// lesser reach, half diamonds and rows, by the sum of squares of the Fourier series up to order 4.
const int kCellStep = 4, kTurnStep = 5;

// A cell takes one of the patterns. Probes that are too far apart to share all take the middle one, unless they are averaged with an
// earlier frame's: then other samples in each frame even out.
struct Pattern {
  float within, turn; // [0, 1): place in a ring, turn of the first sample
};

Pattern patternOf(ivec2 cell, uint m, float front) {
  vec2 spacing = float(pass.spacing) * pixelSize(frame.camera, front);
  bool averages = frame.motion.z > 0.0;
  float vary = averages ? 1.0 : clamp(2.0 - dot(spacing, spacing) * materials[m].gather.profile.w, 0.0, 1.0);
  // A cell and those that it shares with have one pattern each. A lattice fills the strata, and the turn between a sample and its like.
  // Turns begin half a step off the axes, along which edges often lie.
  int turn = kCellStep * (cell.x + PELLUCID_PATTERNS_A_ROW * cell.y + frame.lattice.z) % PELLUCID_PATTERNS;
  int within = kTurnStep * turn % PELLUCID_PATTERNS;
  const float kPerPattern = 1.0 / float(PELLUCID_PATTERNS);
  return Pattern(0.5 + vary * (kPerPattern * (float(within) + 0.5) - 0.5), vary * kPerPattern * (float(turn) + 0.5));
}

// Sums over samples, of a light of radiance 1; docs/how-it-works.md derives them. hidden, seen: from the camera.
struct Gathered {
  vec3 through;  // exitance of all that enters opposite to x
  vec3 entering; // diffused irradiance of what enters hidden and faces the way x does
  vec3 hidden;   // part of the diffusion's profile that lies there
  vec3 opposite; // diffused irradiance of what enters seen and faces x, which comes `through` instead
  vec3 seenLight, seen; // diffused irradiance of what enters seen, and its part of the profile
};

// Adds a sample. `to`: from the lit point to x; `near`, `far`: distances of its ring from x; `flux`: per area across the axis.
void addSample(inout Gathered sum, GatherRings rings, Surface x, uint m, vec4 lengths, EntryPoint entry, vec3 to, float near, float far,
               float flux) {
  float squared = dot(to, to);
  float turned = 0.5 - 0.5 * dot(x.normal, entry.normal); // 1 - m
  // No light comes through a surface that turns less than a quarter within the reach of a facet: both points lie on one face.
  float opposite = turned * mix(min(sqrt(squared) * rings.perFacet, 1.0), 1.0, min(2.0 * turned, 1.0));
  float through = max(-dot(entry.normal, to), 0.0), squaredH = through * max(dot(x.normal, to), 0.0) / max(turned, 1.0e-4);
  float h = sqrt(min(squaredH, squared));
  float curved = (1.0 - turned) * min(squaredH / max(squared, 1.0e-12), 1.0);
  vec3 comes = opposite * gatherTransmitted(lengths, slabOf(m, lengths, h), curved, h, near, far);
  sum.through += flux * (entry.hidden + entry.seen) * comes;
  vec3 reflected = gatherReflected(materials[m].gather.profile.rgb, near, far);
  // A grazed texel stands for more than five times its area: the light beyond that lies further away and does not count here.
  float area = rings.axisCosine / max(entry.cosine, kLeastCosine), here = min(entry.cosine / kLeastCosine, 1.0) * flux;
  vec3 alike = (1.0 - opposite) * reflected;
  sum.entering += here * entry.hidden * alike;
  sum.hidden += area * entry.hidden * alike;
  sum.opposite += flux * entry.seen * opposite * reflected;
  sum.seenLight += here * entry.seen * alike;
  sum.seen += area * entry.seen * alike;
}

Gathered gatherSamples(uint m, LightConstants light, Surface x, Pattern pattern, vec3 lightRay, GatherRings rings) {
  Gathered sum = Gathered(vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
  float mm = frame.camera.range.w;
  bool parallel = directional(light);
  vec4 lengths = materials[m].gather.lengths;
  // Any direction will do, if it is not next to the axis.
  vec3 across = normalize(cross(rings.axis, abs(rings.axis.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0)));
  vec3 along = cross(rings.axis, across);
  // Positions and what maps make of them are affine in mm across and along the rings.
  vec3 center = rings.t * rings.axis;
  vec3 point = mapPoint(rings.map, vec4(x.position + center / mm, 1.0));
  vec3 pointAcross = mapPoint(rings.map, vec4(across / mm, 0.0)), pointAlong = mapPoint(rings.map, vec4(along / mm, 0.0));
  vec2 direction = vec2(cos(6.28318531 * pattern.turn), sin(6.28318531 * pattern.turn));
  uint samples = pass.samples;
  float perSample = 1.0 / float(samples), inner = 0.0;
  [[dont_unroll]] for (uint i = 0u; i < samples; ++i) {
    // Lengths are mm from the foot, across and along the ring.
    float spread = gatherSpread(lengths, (float(i) + pattern.within) * perSample);
    vec2 offset = sqrt(gatherSquaredRadius(rings.t, spread)) * direction;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    vec3 at = point + offset.x * pointAcross + offset.y * pointAlong;
    vec3 s = onRing(center, across, along, offset);
    uint map = rings.map;
    bool inside = isInMap(map, placeInMap(parallel, at));
    // A cube's seams are no borders.
    if (!inside && light.meta.z > 1u) inside = findMap(light, x.position + s / mm, map, at);
    vec2 place = placeInMap(parallel, at);
    int level = inside ? levelOf(rings, light, map, x.position) : 0;
    uvec4 bits = inside ? entryAt(map, place, level) : kNoEntry;
    float from = inner;
    spread = gatherSpread(lengths, float(i + 1u) * perSample);
    inner = i + 1u == samples ? kLastRing : gatherSquaredRadius(rings.t, spread);
    if (!lightEnters(bits)) continue;
    EntryPoint entry = unpackEntry(bits);
    if (entry.material != 0u && entry.material != m + 1u) continue;
    vec3 toLight = parallel ? lightRay * mm : (light.position.xyz - x.position) * mm - s;
    float ahead = distanceAhead(parallel, entry.depth, at.z);
    // The entry point's plane goes on to the sample's own ray, if the plane faces the light: a shown normal may turn away.
    vec2 off = (vec2(ivec2(place) >> level) + 0.5) * float(1 << level) - place; // in entry points of level 0
    vec3 middle = (off.x * maps[map].stepX.xyz + off.y * maps[map].stepY.xyz) * mm * (parallel ? 1.0 : entry.depth);
    float towards = dot(entry.normal, toLight), most = kSteepestPlane / float(1 << level) * length(middle) * inversesqrt(max(dot(toLight, toLight), 1.0e-12));
    if (towards > 0.0) ahead += clamp(dot(entry.normal, middle) / max(towards, 1.0e-6 * mm), -most, most);
    vec3 to = -(s + ahead * toLight);
    // The ring counts as if all of it lay in the lit point's plane across the axis.
    float plane = max(dot(to, to) - dot(offset, offset), 0.0);
    float flux = rings.axisCosine;
    // A point light's flux is its intensity per square scene unit at s. At the light itself any finite value will do.
    if (!parallel) flux *= mm * mm / max(dot(toLight, toLight), 1.0e-12 * mm * mm);
    float stays = staysInside(rings, light, x, map, entry, to, parallel ? lightRay : normalize(toLight));
    entry.hidden *= stays;
    entry.seen *= stays;
    // The camera sees x, and the map does not tell x from what lies closer than an entry point's side on the same face.
    float shown = dot(x.normal, entry.normal) > 0.0 ? max(1.0 - length(to) / max(rings.entrySide, 1.0e-12), 0.0) : 0.0;
    entry.seen += shown * entry.hidden;
    entry.hidden -= shown * entry.hidden;
    addSample(sum, rings, x, m, lengths, entry, to, sqrt(plane + from), sqrt(plane + inner), flux);
  }
  return sum;
}

// Factors of the diffused irradiance and of what comes through.
struct BodyFactors {
  vec3 returned, through;
};

// Irradiance that a light of radiance 1 brings to x beyond its diffused irradiance, for albedo = rho to turn into exitance.
// The diffusion is normalized over what the camera sees: what enters hidden displaces its part of what the light itself brings
// to x and to the surroundings. `body`: see bodyAt.
vec3 gatherLight(uint m, LightConstants light, Surface x, Pattern pattern, BodyFactors body) {
  Incident incident = lightAt(light, x.position);
  GatherRings rings;
  if (!gatherRings(light, x, incident.toLight, incident.distanceTo, materials[m].gather.lengths.z, rings)) return vec3(0.0);
  float cosine = max(dot(x.normal, incident.toLight), 0.0);
  // The sums have the light's cone and range.
  float falloff = directional(light) ? 1.0 : 1.0 / max(incident.distanceTo * incident.distanceTo, 1.0e-12);
  float own = falloff * cosine * arrivesAt(rings, cosine);
  if (own == 0.0 && rings.nearest > kFarthestLit * materials[m].gather.lengths.z) return vec3(0.0);
  Gathered g = gatherSamples(m, light, x, pattern, incident.toLight, rings);
  vec3 through = g.through * frame.filterAndLimit.rgb * materials[m].inverseReflectance.rgb * body.through;
  vec3 hidden = min(g.hidden, vec3(1.0)), seen = g.seenLight / max(g.seen, vec3(1.0e-12)), around = 0.5 * (own + seen);
  // Diffused light is no more than what lies around.
  vec3 opposite = min(g.opposite, through + own);
  return through - opposite + body.returned * (g.entering - hidden * around);
}

#endif
