// Lights as KHR_lights_punctual defines them.
#ifndef PELLUCID_LIGHT_GLSL
#define PELLUCID_LIGHT_GLSL

#include "lib/common_case.glsl"
#include "shared/pellucid_shared.h"

struct Incident {
  vec3 irradiance;  // at normal incidence
  vec3 toLight;     // unit, view space
  float distanceTo; // scene units; 0 for a directional light
};

Incident incidentLight(LightConstants light, vec3 x) {
  if (kDirectional || light.meta.x == PELLUCID_SHADER_LIGHT_DIRECTIONAL)
    return Incident(light.radiance.rgb, -light.direction.xyz, 0.0);
  vec3 offset = light.position.xyz - x;
  // The floor keeps a point at the light finite; 1e-12 is far below any squared depth resolution.
  float squared = max(dot(offset, offset), 1.0e-12);
  float distanceTo = sqrt(squared);
  vec3 toLight = offset / distanceTo;
  float ratio = distanceTo * light.position.w;
  float window = clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
  float attenuation = window / squared;
  if (light.meta.x == PELLUCID_SHADER_LIGHT_SPOT) {
    float cone = clamp(dot(-toLight, light.direction.xyz) * light.cone.x + light.cone.y, 0.0, 1.0);
    attenuation *= cone * cone;
  }
  return Incident(light.radiance.rgb * attenuation, toLight, distanceTo);
}

#endif
