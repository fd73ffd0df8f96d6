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

// Transmitted exitance at the surface from `samples` points of the light's first map that contains it.
vec3 gatherLight(uint m, LightConstants light, Surface s, uint samples) {
  float mm = frame.camera.range.w;
  vec3 sum = vec3(0.0);
  for (uint map = 0u; map < light.meta.z; ++map) {
    ShadowConstants shadow = shadows[light.meta.y + map];
    ShadowReceiver receiver = projectReceiver(shadow, s.position);
    if (!receiver.inside) continue;
    Incident incident = incidentLight(light, s.position);
    float stored = shadowTexel(shadow.meta.x, receiver.texel);
    float t = shadowHolds(shadow, stored)
                  ? max(lightThickness(shadow, receiver, s.position, incident, stored), 0.0) * mm : 0.0;
    vec2 rates = materials[m].gatherRates.xy;
    // Beyond a few lengths the density from the slab would fall below float's range; nothing comes
    // through there but from nearer texels, which the densities from 0 find.
    t = min(t, 8.0 / rates.x);

    vec3 row = vec3(shadow.clipFromView[0].x, shadow.clipFromView[1].x, shadow.clipFromView[2].x);
    vec3 across = normalize(row - dot(row, incident.toLight) * incident.toLight);
    vec3 along = cross(incident.toLight, across);
    float texel = 2.0 * receiver.clip.w / (length(row) * shadow.depth.z);
    for (uint i = 0u; i < samples; ++i) {
      vec2 offset = gatherOffset(i, samples, t, rates);
      vec3 x = s.position + (offset.x * across + offset.y * along) / mm;
      MapPoint y = mapPoint(shadow, light, x);
      if (!y.holds || cameraSees(y.position, texel + shadow.depth.y)) continue;
      vec3 toY = y.position - s.position;
      float r = length(toY) * mm;
      // 1 - m, m = 1/2 + 1/2 N_x.N_y: an entry facing the same way as the exit gives nothing.
      float weight = 1.0;
      if (s.hasNormal) {
        MapPoint right = mapPoint(shadow, light, x + across * texel);
        MapPoint below = mapPoint(shadow, light, x + along * texel);
        vec3 normal = cross(right.position - y.position, below.position - y.position);
        normal *= sign(dot(normal, incident.toLight)); // it faces the light
        float size = length(normal);
        if (right.holds && below.holds && size > 0.0) weight = 0.5 - 0.5 * dot(s.normal, normal) / size;
      }
      float rho = length(offset);
      vec3 kernel = transmittanceSlope(m, r) / (kTwoPi * max(r, 1.0e-4));
      sum += incidentLight(light, x).irradiance * kernel * (weight / gatherMixture(rho, t, rates));
    }
    return sum / float(samples);
  }
  return sum;
}

#endif
