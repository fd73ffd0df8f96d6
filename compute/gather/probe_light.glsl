// Light that one light brings to a probe, by samples of its entry points.
#include "lib/gather.glsl"
#include "gather/rings.glsl"

const float kLastRing = 1.0e12; // squared radius of what lies beyond all samples

// Largest distances looked for, 2 / kappa each, beyond which a lit surface brings nothing to an unlit point: T is below 1e-5.
const float kFarthestLit = 6.0;

// Side of the part of the map that a sample stands for, per radius of its ring: a twelfth of the ring.
const float kSampleSide = 0.5;

GatherSlab slabOf(uint m, vec4 lengths, float h) {
  float place = gatherPlace(lengths, h);
  // Whatever a NaN converts to, the entry is one of the material's.
  uint i = 3u * min(uint(place), uint(PELLUCID_GATHER_ENTRIES - 1));
  return gatherSlab(materials[m].gather.entries[i], materials[m].gather.entries[i + 1u], materials[m].gather.entries[i + 2u],
                    fract(place));
}

// The part of an entry point's light that reaches x through the medium: none where x lies beyond the exit, with air between.
// The slope of the body's far side excuses other exits, unless x's own ray has air, too. `to`: from the lit point to x.
float staysInside(GatherRings rings, EntryPoint entry, vec3 to, vec3 toLight) {
  if (entry.exit >= kNoExit) return 1.0;
  float along = -dot(to, toLight), aside = sqrt(max(dot(to, to) - along * along, 0.0));
  const float kSteepest = 2.0; // slope of far sides: 63 degrees
  float beyond = along - entry.exit * frame.camera.range.w - kSteepest * (1.0 - rings.shadowed) * aside;
  return clamp(2.0 - beyond / max(rings.tolerance, 1.0e-12), 0.0, 1.0);
}

// A sample's place from x, mm.
vec3 onRing(vec3 center, vec3 across, vec3 along, vec2 offset) { return center + offset.x * across + offset.y * along; }

// A cell takes one of 25 patterns. Probes that are too far apart to share all take the middle one.
struct Pattern {
  float within, turn; // [0, 1): place in a ring, turn of the first sample
};

Pattern patternOf(ivec2 cell, uint m, float front) {
  vec2 spacing = float(pass.value.x) * pixelSize(frame.camera, front);
  float vary = clamp(2.0 - dot(spacing, spacing) * materials[m].gather.profile.w, 0.0, 1.0);
  // A cell and the 24 that it shares with have one pattern each. A lattice fills the strata, and the turn between a sample and
  // its like; of five lattices this one leaves fewest dots. Turns begin off the axes, along which edges often lie.
  int turn = (cell.x + 7 * cell.y) % 25, within = turn * 11 % 25;
  return Pattern(0.5 + vary * (float(within) - 12.0) / 25.0, vary * (float(turn) / 25.0 + 0.025));
}

// Sums over samples, of a light of radiance 1; docs/gather.md derives them. hidden, seen: from the camera.
struct Gathered {
  vec3 through;  // exitance of all that enters opposite to x
  vec3 entering; // diffused irradiance of what enters hidden and faces the way x does
  vec3 hidden;   // part of the diffusion's profile that lies there
  vec3 opposite; // diffused irradiance of what enters seen and faces x, which comes `through` instead
  vec3 seenLight, seen; // diffused irradiance of what enters seen, and its part of the profile
};

// Adds a sample. `to`: from the lit point to x; `near`, `far`: distances of its ring from x; `flux`: per area across the axis.
void addSample(inout Gathered sum, Surface x, uint m, vec4 lengths, EntryPoint entry, vec3 to, float near, float far,
               float flux, float axisCosine) {
  float squared = dot(to, to);
  float opposite = x.hasNormal ? 0.5 - 0.5 * dot(x.normal, entry.normal) : 1.0; // 1 - m
  float through = max(-dot(entry.normal, to), 0.0);
  float squaredH = x.hasNormal ? through * max(dot(x.normal, to), 0.0) / max(opposite, 1.0e-4) : through * through;
  float h = sqrt(min(squaredH, squared));
  float curved = (1.0 - opposite) * min(squaredH / max(squared, 1.0e-12), 1.0);
  vec3 comes = opposite * gatherTransmitted(lengths, slabOf(m, lengths, h), curved, h, near, far);
  bool diffuses = hasFlag(PELLUCID_FLAG_DIFFUSED);
  sum.through += flux * (diffuses ? entry.hidden + entry.seen : entry.hidden) * comes;
  if (!diffuses) return;
  vec3 reflected = gatherReflected(materials[m].gather.profile.rgb, near, far);
  // A grazed texel stands for more than five times its area: the light beyond that lies further away and does not count here.
  float area = axisCosine / max(entry.cosine, kLeastCosine), here = min(entry.cosine / kLeastCosine, 1.0) * flux;
  vec3 alike = (1.0 - opposite) * reflected;
  sum.entering += here * entry.hidden * alike;
  sum.hidden += area * entry.hidden * alike;
  sum.opposite += flux * entry.seen * opposite * reflected;
  sum.seenLight += here * entry.seen * alike;
  sum.seen += area * entry.seen * alike;
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
    // Lengths are mm from the foot, across and along the ring.
    float spread = gatherSpread(lengths, (float(i) + pattern.within) * perSample);
    float radius = sqrt(gatherSquaredRadius(rings.t, spread));
    vec2 offset = radius * direction;
    direction = mat2(-0.73736888, 0.67549029, -0.67549029, -0.73736888) * direction; // the golden angle
    int level = clamp(int(log2(max(kSampleSide * radius / rings.entrySide, 1.0))), 0, kLastEntryLevel);
    vec3 at = point + offset.x * pointAcross + offset.y * pointAlong;
    uvec4 bits;
    vec2 off;
    uint map = rings.map;
    // A cube's seams are no borders.
    if (!fetchEntry(map, parallel, at, level, bits, off) && light.meta.z > 1u)
      fetchEntry(light, x.position + onRing(center, across, along, offset) / mm, level, map, at, bits, off);
    float from = inner;
    spread = gatherSpread(lengths, float(i + 1u) * perSample);
    inner = i + 1u == samples ? kLastRing : gatherSquaredRadius(rings.t, spread);
    if (!lightEnters(bits)) continue;
    EntryPoint entry = unpackEntry(bits);
    if (entry.material != 0u && entry.material != m + 1u) continue;
    vec3 s = onRing(center, across, along, offset);
    vec3 toLight = parallel ? incident.toLight * mm : (light.position.xyz - x.position) * mm - s;
    float ahead = distanceAhead(parallel, entry.depth, at.z);
    // The entry point's plane goes on to the sample's own ray, if the plane faces the light: a shown normal may turn away.
    vec3 middle = (off.x * maps[map].stepX.xyz + off.y * maps[map].stepY.xyz) * mm * (parallel ? 1.0 : entry.depth);
    float towards = dot(entry.normal, toLight), most = 2.0 * length(middle) * inversesqrt(max(dot(toLight, toLight), 1.0e-12));
    if (towards > 0.0) ahead += clamp(dot(entry.normal, middle) / max(towards, 1.0e-6 * mm), -most, most);
    vec3 to = -(s + ahead * toLight);
    // The ring counts as if all of it lay in the lit point's plane across the axis.
    float plane = max(dot(to, to) - dot(offset, offset), 0.0);
    float flux = rings.axisCosine;
    // A point light's flux is its intensity per square scene unit at s. At the light itself any finite value will do.
    if (!parallel) flux *= mm * mm / max(dot(toLight, toLight), 1.0e-12 * mm * mm);
    float inside = staysInside(rings, entry, to, parallel ? incident.toLight : normalize(toLight));
    entry.hidden *= inside;
    entry.seen *= inside;
    addSample(sum, x, m, lengths, entry, to, sqrt(plane + from), sqrt(plane + inner), flux, rings.axisCosine);
  }
  return sum;
}

// Irradiance that a light of radiance 1 brings to x beyond its diffused irradiance, for albedo = rho to turn into exitance.
// The diffusion is normalized over what the camera sees: what enters hidden displaces its part of what the light itself brings
// to x and to the surroundings. `loss`: see thinLoss.
vec3 gatherLight(uint m, LightConstants light, Surface x, Pattern pattern, vec3 loss) {
  Incident incident = lightAt(light, x.position);
  GatherRings rings;
  if (!gatherRings(light, x, incident.toLight, incident.distanceTo, materials[m].gather.lengths.z, rings)) return vec3(0.0);
  float cosine = x.hasNormal ? max(dot(x.normal, incident.toLight), 0.0) : 0.0;
  // The sums have the light's cone and range.
  float falloff = directional(light) ? 1.0 : 1.0 / max(incident.distanceTo * incident.distanceTo, 1.0e-12);
  float own = falloff * cosine * arrivesAt(rings, cosine);
  if (own == 0.0 && rings.ahead > kFarthestLit * materials[m].gather.lengths.z) return vec3(0.0);
  Gathered g = gatherSamples(m, light, x, pattern, incident, rings);
  vec3 through = g.through * frame.filterAndLimit.rgb * materials[m].inverseReflectance.rgb;
  if (!hasFlag(PELLUCID_FLAG_DIFFUSED)) return through;
  vec3 hidden = min(g.hidden, vec3(1.0)), seen = g.seenLight / max(g.seen, vec3(1.0e-12)), around = 0.5 * (own + seen);
  // Diffused light is no more than what lies around, and a dark point has next to none of its own to lose.
  vec3 opposite = min(g.opposite, through + own);
  vec3 lost = min(seen, vec3(2.0 * own)) * shareOfLight(light, incident.toLight, incident.distanceTo);
  return through + g.entering - opposite - hidden * around - (1.0 - hidden) * loss * lost;
}
