// Light through a sheet without thickness, from the face that is not seen. transmission.glsl includes it.

// A plane's own texels lie within the tolerance down to a cosine of .045, where it stops to grow.
const float kMostWallTexels = 32.0;
const float kDiagonal = 1.41421356; // to the farthest of four texels
// Normals may turn a face to the light that geometry turns away. Its light fades over this cosine.
const float kTurnedCosine = 0.1;

// Without normals the sheet has those of its depths, which other angle models do not know.
bool takesDepthsNormal(Surface s) { return frame.flags.w == PELLUCID_SHADER_ANGLE_NORMAL && !s.hasNormal; }

// Part of the light that no other surface holds back. A texel that stores the sheet itself, what lies behind it, or nothing
// lets light by. `l`: around the sheet; `facing`: cosine between the sheet's geometry and the light.
float unblockedPart(LightConstants light, LightTexels l, float facing) {
  if (light.meta.z == 0u) return 1.0;
  if (l.side <= 0.0) return 0.0; // no map contains the point
  float tolerance = l.side * min(1.0 + kDiagonal * slopeOf(facing), kMostWallTexels) + l.uncertain;
  return 1.0 - dot(l.held, clamp(l.thickness / tolerance - 1.0, 0.0, 1.0));
}

// `facet`: normal of the front depths, 0: not known; `cosine`: of the hidden face without it.
Transmitted wallTransmission(LightConstants light, Incident incident, Surface s, LightTexels l, vec3 facet, float cosine) {
  bool hasFacet = facet != vec3(0.0);
  float facing = hasFacet ? dot(facet, incident.toLight) : receiverCosine(s, incident);
  if (hasFacet && takesDepthsNormal(s)) cosine = max(-facing, 0.0);
  float behind = clamp(1.0 - facing / kTurnedCosine, 0.0, 1.0);
  return Transmitted(0.0, incident.irradiance * cosine, behind * unblockedPart(light, l, facing));
}
