// The gather over one light's shadow maps; included by translucency.comp after its bindings.
#ifndef PELLUCID_PASS_GATHER_GLSL
#define PELLUCID_PASS_GATHER_GLSL

#include "lib/gather.glsl"

// -T'(r), 1/mm.
vec3 transmittanceSlope(uint m, float r) {
  vec4 red = materials[m].transmittance[0], green = materials[m].transmittance[1], blue = materials[m].transmittance[2];
  vec3 c = materials[m].transmittance4.rgb;
  vec3 slope = materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_EXP2
                   ? vec3(transmittanceExp2Slope(red, r), transmittanceExp2Slope(green, r),
                          transmittanceExp2Slope(blue, r))
                   : vec3(transmittanceSinhExpSlope(red, c.r, r), transmittanceSinhExpSlope(green, c.g, r),
                          transmittanceSinhExpSlope(blue, c.b, r));
  return max(slope, vec3(0.0)) * frame.filterAndLimit.rgb;
}

// True where the camera sees the point: what it sees is in the irradiance that diffusion spreads.
bool cameraSees(vec3 y, float tolerance) {
  float p = y.z * frame.camera.range.x;
  ivec2 pixel;
  if (!projectToPixel(frame.camera, y, pixel) || !insideRect(pixel) || materialAt(pixel) == 0u) return false;
  float front = frontDistance(pixel);
  return front > 0.0 && p <= front + tolerance;
}

struct MapPoint {
  bool holds;
  vec3 position;
};

// Where the light ray through x meets the map's surface.
MapPoint mapPoint(ShadowConstants shadow, LightConstants light, vec3 x) {
  ShadowReceiver receiver = projectReceiver(shadow, x);
  if (!receiver.inside) return MapPoint(false, x);
  float stored = shadowTexel(shadow.meta.x, receiver.texel);
  Incident incident = incidentLight(light, x);
  float thickness = lightThickness(shadow, receiver, x, incident, stored);
  return MapPoint(shadowHolds(shadow, stored), x + thickness * incident.toLight);
}

// The plane across the light ray in which samples are drawn.
struct GatherPlane {
  vec3 across, along; // along the map's rows and columns
  float t;            // mm from the point to the map's surface
  float texel;        // scene units
};

GatherPlane gatherPlane(ShadowConstants shadow, ShadowReceiver receiver, LightConstants light, vec3 x, float slowest) {
  Incident incident = incidentLight(light, x);
  float stored = shadowTexel(shadow.meta.x, receiver.texel);
  float t = shadowHolds(shadow, stored)
                ? max(lightThickness(shadow, receiver, x, incident, stored), 0.0) * frame.camera.range.w : 0.0;
  vec3 row = vec3(shadow.clipFromView[0].x, shadow.clipFromView[1].x, shadow.clipFromView[2].x);
  vec3 across = normalize(row - dot(row, incident.toLight) * incident.toLight);
  // Beyond a few lengths the density from the slab would fall below float's range; nothing comes
  // through there but from nearer texels, which the densities from 0 find.
  return GatherPlane(across, cross(incident.toLight, across), min(t, 8.0 / slowest),
                     2.0 * receiver.clip.w / (length(row) * shadow.depth.z));
}

// The samples whose light ray meets the light's map number `map` and none before it.
vec3 gatherMap(uint m, LightConstants light, uint map, Surface s, GatherPlane plane, uint samples) {
  float mm = frame.camera.range.w;
  vec2 rates = materials[m].gatherRates.xy;
  ShadowConstants shadow = shadows[light.meta.y + map];
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < samples; ++i) {
    vec2 offset = gatherOffset(i, samples, plane.t, rates);
    vec3 x = s.position + (offset.x * plane.across + offset.y * plane.along) / mm;
    MapPoint y = mapPoint(shadow, light, x);
    bool isFirst = y.holds;
    for (uint before = 0u; before < map && isFirst; ++before)
      isFirst = !projectReceiver(shadows[light.meta.y + before], x).inside;
    if (!isFirst || cameraSees(y.position, plane.texel + shadow.depth.y)) continue;
    vec3 toY = y.position - s.position;
    float r = length(toY) * mm;
    // 1 - m, m = 1/2 + 1/2 N_x.N_y: an entry facing the same way as the exit gives nothing.
    float weight = 1.0;
    if (s.hasNormal) {
      MapPoint right = mapPoint(shadow, light, x + plane.across * plane.texel);
      MapPoint below = mapPoint(shadow, light, x + plane.along * plane.texel);
      vec3 normal = cross(right.position - y.position, below.position - y.position);
      normal *= sign(dot(normal, incidentLight(light, s.position).toLight)); // it faces the light
      float size = length(normal);
      if (right.holds && below.holds && size > 0.0) weight = 0.5 - 0.5 * dot(s.normal, normal) / size;
    }
    float rho = length(offset);
    vec3 kernel = transmittanceSlope(m, r) / (kTwoPi * max(r, 1.0e-4));
    sum += incidentLight(light, x).irradiance * kernel * (weight / gatherMixture(rho, plane.t, rates));
  }
  return sum;
}

// Transmitted exitance at the surface from `samples` points of the light's maps, spread about the first that
// contains it. A cube's seams are no borders.
vec3 gatherLight(uint m, LightConstants light, Surface s, uint samples) {
  GatherPlane plane;
  bool inside = false;
  for (uint map = 0u; map < light.meta.z && !inside; ++map) {
    ShadowConstants shadow = shadows[light.meta.y + map];
    ShadowReceiver receiver = projectReceiver(shadow, s.position);
    inside = receiver.inside;
    if (inside) plane = gatherPlane(shadow, receiver, light, s.position, materials[m].gatherRates.x);
  }
  vec3 sum = vec3(0.0);
  if (!inside) return sum;
  for (uint map = 0u; map < light.meta.z; ++map) sum += gatherMap(m, light, map, s, plane, samples);
  return sum / float(samples);
}

#endif
