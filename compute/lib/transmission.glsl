// Light through one surface point, for any shader stage. Include it after declaring, from whatever bindings
// the shader has: FrameConstants frame, ShadowConstants shadows[], MaterialConstants materials[], and
//   float shadowTexel(uint image, ivec2 texel); // of the image in ShadowConstants::meta.x
// They are names and not parameters because a buffer's array cannot be passed without a copy.
#ifndef PELLUCID_TRANSMISSION_GLSL
#define PELLUCID_TRANSMISSION_GLSL

#include "lib/angle.glsl"
#include "lib/flags.glsl"
#include "lib/light.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"
#include "lib/thickness.glsl"
#include "lib/transmittance.glsl"

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

struct LightSpace {
  bool inside, holds; // the map contains the point; its texel has a surface
  float thickness;    // scene units along the light ray; negative: the surface is beyond the point
  float bias;
};

// The first of the light's maps that contains x.
LightSpace lightSpace(LightConstants light, Incident incident, vec3 x) {
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver receiver = projectReceiver(shadow, x);
    if (!receiver.inside) continue;
    float stored = shadowTexel(shadow.meta.x, receiver.texel);
    return LightSpace(true, shadowHolds(shadow.meta, stored), lightThickness(shadow, receiver, x, incident, stored),
                      shadow.depth.y);
  }
  return LightSpace(false, false, -1.0, 0.0);
}

struct Transmitted {
  float thickness; // scene units; -1: no light comes through
  vec3 arriving;   // irradiance of the hidden face before occlusion
  float visible;
};

float hiddenCosine(LightConstants light, Surface s, vec3 toLight) {
  uint model = frame.flags.w;
  if (model == PELLUCID_SHADER_ANGLE_NORMAL && s.hasNormal) return max(-dot(s.normal, toLight), 0.0);
  vec3 view = hasFlag(PELLUCID_FLAG_CONSTANT_VIEW) ? vec3(0.0, 0.0, frame.camera.range.x) : s.view;
  float x = dot(view, toLight) * light.cone.z + light.cone.w; // from the minimum dot on, if the model has one
  if (model == PELLUCID_SHADER_ANGLE_INVERSE_COSINE) return angleInverseCosine(x);
  if (model == PELLUCID_SHADER_ANGLE_POLYNOMIAL) return anglePolynomial(frame.anglePolynomial, x);
  return clamp(x, 0.0, 1.0);
}

// docs/design.md says why each source is what it is.
Transmitted lightTransmission(LightConstants light, Surface s) {
  Incident incident = incidentLight(light, s.position);
  bool mapped = !kUnmapped && light.meta.z != 0u;
  if (mapped && !hasFlag(PELLUCID_FLAG_CAMERA_THICKNESS)) {
    LightSpace l = lightSpace(light, incident, s.position);
    vec3 arriving = incident.irradiance * hiddenCosine(light, s, incident.toLight);
    return Transmitted(max(l.thickness - l.bias, 0.0), arriving, l.inside && l.holds ? 1.0 : 0.0);
  }
  if (s.chord < 0.0) return Transmitted(-1.0, vec3(0.0), 0.0);
  vec3 back = s.position + s.chord * s.view;
  incident = incidentLight(light, back);
  // A slab's thickness along its normal, from the chord along the view ray.
  bool alongNormal = s.hasNormal && !hasFlag(PELLUCID_FLAG_CHORD_THICKNESS);
  float thickness = alongNormal ? s.chord * abs(dot(s.normal, s.view)) : s.chord;
  float visible = 1.0;
  if (mapped) {
    LightSpace l = lightSpace(light, incident, back);
    visible = l.inside && l.holds && l.thickness <= l.bias ? 1.0 : 0.0;
  }
  return Transmitted(thickness, incident.irradiance * hiddenCosine(light, s, incident.toLight), visible);
}

#endif
