// Lights as KHR_lights_punctual defines them.
#ifndef PELLUCID_LIGHT_GLSL
#define PELLUCID_LIGHT_GLSL

#include "shared/pellucid_shared.h"

struct Incident {
  vec3 irradiance;  // at normal incidence
  vec3 toLight;     // unit, view space
  float distanceTo; // scene units; 0 for a directional light
};

// The part of the light that goes the way to a point: 1 inside the range and the cone. toLight: unit.
float lightShare(LightConstants light, vec3 toLight, float distanceTo) {
  if (light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL) return 1.0;
  float ratio = distanceTo * light.position.w;
  float share = clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
  if (light.meta.x == PELLUCID_SHADER_LIGHT_SPOT) {
    float cone = clamp(dot(-toLight, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
    share *= cone * cone;
  }
  return share;
}

Incident incidentLight(LightConstants light, vec3 x) {
  if (light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL)
    return Incident(light.radiance.rgb, -light.direction.xyz, 0.0);
  vec3 offset = light.position.xyz - x;
  // The floor keeps a point at the light finite: 1e-6 scene units, which are 1 mm if a unit is 1 km.
  float squared = max(dot(offset, offset), 1.0e-12);
  float distanceTo = sqrt(squared);
  vec3 toLight = offset / distanceTo;
  float attenuation = lightShare(light, toLight, distanceTo) / squared;
  // Below the largest float, so that a transmittance of 0 makes 0 of it.
  return Incident(min(light.radiance.rgb * attenuation, vec3(1.0e30)), toLight, distanceTo);
}

#endif
