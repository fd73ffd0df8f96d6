// A light at a point, with its own falloff. PELLUCID_OWN_INPUTS as in translucency/transmission.glsl.
#ifndef PELLUCID_LIGHT_TABLES_GLSL
#define PELLUCID_LIGHT_TABLES_GLSL

#ifndef PELLUCID_OWN_INPUTS
#include "frame/frame.glsl"
#endif
#include "lib/light.glsl"

// False in pipelines of contexts whose frames have no tables.
layout(constant_id = PELLUCID_CONSTANT_LIGHT_TABLES) const bool kLightTables = false;

float lightTableEntry(uint table, uint entry) {
  uint index = table * PELLUCID_LIGHT_ENTRIES + entry;
  return unpackHalf2x16(frame.lightTables[index / 8u][(index / 2u) % 4u])[index % 2u];
}

// at: 0..1, from the first entry to the last.
float lightTableAt(uint table, float at) {
  float place = at * float(PELLUCID_LIGHT_ENTRIES - 1);
  uint entry = min(uint(place), uint(PELLUCID_LIGHT_ENTRIES - 2)); // in the table, whatever a NaN converts to
  return mix(lightTableEntry(table, entry), lightTableEntry(table, entry + 1u), place - float(entry));
}

float lightTablesShare(LightConstants light, vec3 toLight, float distanceTo) {
  uint both = uint(light.radiance.w), angle = both / (PELLUCID_LIGHT_TABLES + 1u), away = both % (PELLUCID_LIGHT_TABLES + 1u);
  float share = 1.0;
  if (angle > 0u) share = lightTableAt(angle - 1u, acos(clamp(-dot(toLight, light.direction.xyz), -1.0, 1.0)) / 3.14159265);
  float ratio = distanceTo * light.direction.w;
  if (away > 0u) share *= ratio < 1.0 ? lightTableAt(away - 1u, ratio) : 0.0;
  return share;
}

// lightShare and incidentLight of a light that may have tables.
float shareOfLight(LightConstants light, vec3 toLight, float distanceTo) {
  float share = lightShare(light, toLight, distanceTo);
  if (kLightTables) share *= lightTablesShare(light, toLight, distanceTo);
  return share;
}

Incident lightAt(LightConstants light, vec3 x) {
  Incident incident = incidentLight(light, x);
  if (kLightTables) incident.irradiance *= lightTablesShare(light, incident.toLight, incident.distanceTo);
  return incident;
}

#endif
