// Light through one surface point, for any shader stage. Include it after declaring, from whatever bindings
// the shader has: FrameConstants frame, ShadowConstants shadows[], MaterialConstants materials[], and
//   ShadowTexels shadowTexels(uint image, ivec2 texel, ivec2 first, ivec2 last); // of the image and layer in
//   ShadowConstants::meta.x, as frame/shadow_images.glsl has it
//   vec4 shadowQuad(uint image, ivec2 low, ivec2 high); // as frame/shadow_images.glsl has it
//   float distanceOf(ivec2 pixel, uint material, bool back); // planar distance of the front or back depth of a pixel that has
//   the material (index + 1); <= 0 of others
// The shader requires GL_EXT_control_flow_attributes.
// They are names and not parameters because a buffer's array cannot be passed without a copy.
#ifndef PELLUCID_TRANSMISSION_GLSL
#define PELLUCID_TRANSMISSION_GLSL

#include "lib/angle.glsl"
#include "frame/flags.glsl"
#include "frame/thin_walls.glsl"
#include "frame/light_tables.glsl"
#include "lib/surface.glsl"
#include "lib/thickness.glsl"
#include "lib/transmittance.glsl"
#include "translucency/light_texels.glsl"

vec3 materialTransmittance(uint m, float d) {
  vec3 t = vec3(0.0);
  if (materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_EXP2) {
    t = vec3(transmittanceExp2(materials[m].transmittance[0], d), transmittanceExp2(materials[m].transmittance[1], d),
             transmittanceExp2(materials[m].transmittance[2], d));
  } else if (materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_SINH_EXP) {
    vec3 c = materials[m].transmittance4.rgb;
    t = vec3(transmittanceSinhExp(materials[m].transmittance[0], c.r, d),
             transmittanceSinhExp(materials[m].transmittance[1], c.g, d),
             transmittanceSinhExp(materials[m].transmittance[2], c.b, d));
  } else if (materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_LINEAR) {
    t = 1.0 - d * vec3(materials[m].transmittance[0].x, materials[m].transmittance[1].x, materials[m].transmittance[2].x);
  } else {
    for (uint i = 0u; i < materials[m].meta.y; ++i)
      t += transmittanceGaussian(materials[m].gaussianWeight[i].rgb, materials[m].gaussianFalloff[i].rgb, d);
  }
  return d <= frame.filterAndLimit.w ? clamp(t, vec3(0.0), vec3(1.0)) * frame.filterAndLimit.rgb : vec3(0.0);
}

struct Transmitted {
  float thickness; // scene units; -1: no light comes through
  vec3 arriving;   // irradiance of the hidden face before occlusion
  float visible;
};

// Exitance of what arrives at material m's hidden face. Most pixels face some lights; T is the expensive part.
vec3 exitanceOf(Transmitted t, uint m) {
  vec3 entering = t.arriving * t.visible;
  if (!(t.thickness >= 0.0 && max(entering.r, max(entering.g, entering.b)) > 0.0)) return vec3(0.0); // false for NaN
  return entering * materialTransmittance(m, t.thickness * frame.camera.range.w);
}

float hiddenCosine(LightConstants light, Surface s, vec3 toLight) {
  uint model = frame.flags.w;
  if (model == PELLUCID_SHADER_ANGLE_NORMAL && s.hasNormal) return max(-dot(s.normal, toLight), 0.0);
  vec3 view = hasFlag(PELLUCID_FLAG_CONSTANT_VIEW) ? vec3(0.0, 0.0, frame.camera.range.x) : s.view;
  float x = dot(view, toLight) * light.cone.z + light.cone.w; // from the minimum dot on, if the model has one
  if (model == PELLUCID_SHADER_ANGLE_INVERSE_COSINE) return angleInverseCosine(x);
  if (model == PELLUCID_SHADER_ANGLE_POLYNOMIAL) return anglePolynomial(frame.anglePolynomial, x);
  return clamp(x, 0.0, 1.0);
}

// Light along the chord, of a light without shadow maps.
Transmitted chordTransmission(LightConstants light, Surface s) {
  if (s.chord < 0.0) return Transmitted(-1.0, vec3(0.0), 0.0);
  Incident incident = lightAt(light, s.position + s.chord * s.view);
  // A slab's thickness along its normal, from the chord along the view ray.
  bool alongNormal = s.hasNormal && !hasFlag(PELLUCID_FLAG_CHORD_THICKNESS);
  float thickness = alongNormal ? s.chord * abs(dot(s.normal, s.view)) : s.chord;
  return Transmitted(thickness, incident.irradiance * hiddenCosine(light, s, incident.toLight), 1.0);
}

#include "translucency/wall_transmission.glsl"

// docs/integration.md says why each source is what it is. `pixel`: of the surface.
Transmitted lightTransmission(LightConstants light, Surface s, ivec2 pixel) {
  bool wall = isThinWalled(s.material);
  bool holdsExits = light.meta.w != 0u; // which do not say where light enters
  if (!wall && (light.meta.z == 0u || holdsExits || hasFlag(PELLUCID_FLAG_CAMERA_THICKNESS))) {
    Transmitted t = chordTransmission(light, s);
    if (light.meta.z == 0u || t.thickness < 0.0) return t;
    vec3 back = s.position + s.chord * s.view;
    Incident incident = lightAt(light, back);
    LightTexels l = lightTexels(light, incident, s, back, 0.0, kEverywhere);
    t.visible = litPart(l, pixel, s.material, incident.toLight, holdsExits);
    return t;
  }
  Incident incident = lightAt(light, s.position);
  float cosine = hiddenCosine(light, s, incident.toLight);
  vec3 arriving = incident.irradiance * cosine;
  // Most pixels face some lights, whose maps need no reading.
  if (arriving == vec3(0.0) && !(wall && takesDepthsNormal(s))) return Transmitted(-1.0, arriving, 0.0);
  // Media do not count where the receiver has none.
  float farthest = wall ? -kEverywhere : materials[s.material - 1u].transmittance4.w / frame.camera.range.w;
  LightTexels l = lightTexels(light, incident, s, s.position, receiverCosine(s, incident), farthest);
  bool byDepths = wall || mayStoreReceiver(l);
  vec3 facet = byDepths ? facetAt(pixel, s.material, false) : vec3(0.0);
  if (wall) return wallTransmission(light, incident, s, l, facet, cosine);
  vec4 weight = byDepths ? throughWeights(l, dot(facet, incident.toLight)) : l.entering;
  return Transmitted(meanThickness(weight, l.thickness, s.material - 1u), arriving, dot(weight, vec4(1.0)));
}

#endif
