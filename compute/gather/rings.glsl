// The rings of samples around a probe, and the entry points that a light has for them.
#include "lib/occluder.glsl"

bool directional(LightConstants light) { return light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL; }

// Place of a view-space point's entry in a map, and the point's depth.
vec3 mapPoint(uint map, vec4 position) {
  return vec3(dot(maps[map].column, position), dot(maps[map].row, position), dot(maps[map].depth, position));
}

// Floats keep outside what is far outside.
bool isInMap(uint map, vec2 at) {
  return all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(maps[map].place.zw)));
}

uvec4 entryAt(uint map, ivec2 entry, int level) {
  ivec2 size = ivec2(pass.value.z & 0xFFFFu, pass.value.z >> 16 & 0x7FFFu);
  return texelFetch(entriesImage, entryPlace(maps[map].place.xy + entry, level, size), 0);
}

// Fetches the entry of a point of the map from a level or, where that has several surfaces, from the first. false: the map
// does not contain the point. `off`: from the point to the middle of what the entry stands for, in entry points.
bool fetchEntry(uint map, bool parallel, vec3 point, int level, out uvec4 bits, out vec2 off) {
  bits = kNoEntry;
  off = vec2(0.0);
  if (!parallel && !(point.z > 0.0)) return false;
  vec2 at = parallel ? point.xy : point.xy / point.z;
  if (!isInMap(map, at)) return false;
  bits = entryAt(map, ivec2(at), level);
  if (bits == kSeveralSurfaces) {
    level = 0;
    bits = entryAt(map, ivec2(at), 0);
  }
  off = (vec2(ivec2(at) >> level) + 0.5) * float(1 << level) - at;
  return true;
}

// Fetches from the first of the light's maps that contains the position.
bool fetchEntry(LightConstants light, vec3 position, int level, out uint map, out vec3 point, out uvec4 bits,
                out vec2 off) {
  for (map = light.meta.y; map < light.meta.y + light.meta.z; ++map) {
    point = mapPoint(map, vec4(position, 1.0));
    if (fetchEntry(map, directional(light), point, level, bits, off)) return true;
  }
  bits = kNoEntry;
  return false;
}

// How far the lit surface is from a point along its light ray: scene units, or a fraction of the way to the light.
float distanceAhead(bool parallel, float depth, float own) { return parallel ? depth - own : 1.0 - depth / own; }

// The rings around an axis through x; lengths in mm.
struct GatherRings {
  vec3 axis;
  float t, axisCosine; // along the axis from x to the lit surface; of the axis with the light's ray
  float entrySide;     // side of an entry point of the first level
  float ahead;         // along the light's ray from x to the lit surface
  float tolerance;     // how far a receiver's own exit may be off
  float shadowed;      // 1: x lies beyond the exit of its own ray, with air before it, 0: it does not
  uint map;            // contains x
};

const float kSteepestOwn = 4.0; // largest slope of the surface at x within an entry point: 76 degrees

// An axis between the light's ray and the inward normal suits slabs, whose rings lie around the foot of the perpendicular.
// false: no map contains x, so that no light comes through it.
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
  if (!fetchEntry(light, x.position, 0, rings.map, point, bits, off)) return false;
  rings.entrySide = length(maps[rings.map].stepX.xyz) * mm * (parallel ? 1.0 : point.z);
  // The slope of the surface counts within an entry point, and one entry point stands for its curvature.
  rings.tolerance = rings.entrySide * (2.0 + min(slopeOf(x.hasNormal ? dot(x.normal, toLight) : 0.0), kSteepestOwn));
  if (!holdsSurface(bits)) return true;
  float perAhead = parallel ? 1.0 : distanceTo;
  EntryPoint own = unpackEntry(bits);
  rings.ahead = distanceAhead(parallel, own.depth, point.z) * perAhead * mm;
  if (own.exit < kNoExit) rings.shadowed = clamp((rings.ahead - own.exit * mm) / rings.tolerance - 1.0, 0.0, 1.0);
  float t = clamp(rings.ahead, 0.0, longest) / mm;
  vec3 guess = x.position + t * rings.axis;
  uint map;
  if (fetchEntry(light, guess, 0, map, point, bits, off) && holdsSurface(bits)) {
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
