// Light through a sheet without thickness, from the face that is not seen. transmission.glsl includes it.

// A plane's own texels lie within the tolerance down to a cosine of .045, where it stops to grow.
const float kMostWallTexels = 32.0;
const float kDiagonal = 1.41421356; // to the farthest of four texels
// Normals may turn a face to the light that geometry turns away. Its light fades over this cosine.
const float kTurnedCosine = 0.1;

// Part of the light that no other surface holds back. A texel that stores the sheet itself, what lies behind it, or nothing
// lets light by. `facing`: cosine between the sheet's geometry and the light.
float unblockedPart(LightConstants light, Incident incident, Surface s, float facing) {
  if (light.meta.z == 0u) return 1.0;
  LightTexels l = lightTexels(light, incident, s, s.position, 0.0, -kEverywhere); // media do not count
  if (l.side <= 0.0) return 0.0; // no map contains the point
  float tolerance = l.side * min(1.0 + kDiagonal * slopeOf(facing), kMostWallTexels) + l.uncertain;
  return 1.0 - dot(l.held, clamp(l.thickness / tolerance - 1.0, 0.0, 1.0));
}

Transmitted wallTransmission(LightConstants light, Surface s, ivec2 pixel) {
  Incident incident = incidentLight(light, s.position);
  bool byDepth = frame.flags.w == PELLUCID_SHADER_ANGLE_NORMAL && !s.hasNormal;
  vec3 arriving = incident.irradiance * (byDepth ? 1.0 : hiddenCosine(light, s, incident.toLight));
  if (arriving == vec3(0.0)) return Transmitted(-1.0, arriving, 0.0);
  vec3 facet = facetAt(pixel, s.material, false);
  bool hasFacet = facet != vec3(0.0);
  float facing = hasFacet ? dot(facet, incident.toLight) : receiverCosine(s, incident);
  if (byDepth) arriving *= hasFacet ? max(-facing, 0.0) : hiddenCosine(light, s, incident.toLight);
  if (arriving == vec3(0.0)) return Transmitted(-1.0, arriving, 0.0);
  float behind = clamp(1.0 - facing / kTurnedCosine, 0.0, 1.0);
  return Transmitted(0.0, arriving, behind > 0.0 ? behind * unblockedPart(light, incident, s, facing) : 0.0);
}
