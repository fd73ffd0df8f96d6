// Light through one surface point, for any shader stage. Include it after declaring, from whatever bindings
// the shader has: FrameConstants frame, ShadowConstants shadows[], MaterialConstants materials[], and
//   float shadowTexel(uint image, ivec2 texel); // of the image and layer in ShadowConstants::meta.x
// They are names and not parameters because a buffer's array cannot be passed without a copy.
#ifndef PELLUCID_TRANSMISSION_GLSL
#define PELLUCID_TRANSMISSION_GLSL

#include "lib/angle.glsl"
#include "frame/flags.glsl"
#include "lib/light.glsl"
#include "lib/occluder.glsl"
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

// `texel`: of the image, which holds `stored`. Neighbors are read for maps with a slope bias alone.
DrawnDepth drawnDepth(ShadowConstants shadow, ivec2 texel, float stored) {
  if (shadow.offsets.y == 0.0) return drawnDepth(shadow.offsets, stored, vec4(stored), bvec4(false));
  uint image = shadow.meta.x;
  ivec2 first = firstTexel(shadow.occluder), last = first + ivec2(shadow.depth.zw) - 1;
  ivec2 low = max(texel - 1, first), high = min(texel + 1, last);
  vec4 beside = vec4(shadowTexel(image, ivec2(high.x, texel.y)), shadowTexel(image, ivec2(low.x, texel.y)),
                     shadowTexel(image, ivec2(texel.x, high.y)), shadowTexel(image, ivec2(texel.x, low.y)));
  bvec4 holds = bvec4(high.x > texel.x && shadowHolds(shadow.meta, beside.x), low.x < texel.x && shadowHolds(shadow.meta, beside.y),
                      high.y > texel.y && shadowHolds(shadow.meta, beside.z), low.y < texel.y && shadowHolds(shadow.meta, beside.w));
  return drawnDepth(shadow.offsets, stored, beside, holds);
}

struct LightSpace {
  bool inside, holds; // the map contains the point; its texel has a surface
  bool enters;        // there, and nothing but the surface's own medium is known to lie between it and the point
  float thickness;    // scene units along the light ray; negative: the surface is beyond the point
  float tolerance;    // that a point of the stored surface may be off by
};

float receiverCosine(Surface s, Incident incident) { return s.hasNormal ? dot(s.normal, incident.toLight) : 0.0; }

bool lightEntersMedium(ShadowConstants shadow, ShadowReceiver receiver, Incident incident, Surface s, vec3 x) {
  if (hasCasterImage(shadow) && !casterIsMedium(shadowTexel(shadow.occluder.y - 1u, receiver.texel),
                                                uintBitsToFloat(shadow.occluder.z), s.material))
    return false;
  if (!hasExitImage(shadow)) return true;
  float stored = shadowTexel(shadow.occluder.x - 1u, receiver.texel);
  float tolerance = exitTolerance(shadow, incident.distanceTo, receiverCosine(s, incident));
  if (shadow.offsets.w > 0.0) tolerance += shadow.offsets.w * lengthPerDepth(shadow, receiver, x, incident, stored);
  return !shadowHolds(shadow.meta, stored) ||
         !liesBeyondExit(lightThickness(shadow, receiver, x, incident, stored), tolerance);
}

// In the first of the light's maps that contains x, a point on or behind the surface s.
LightSpace lightSpace(LightConstants light, Incident incident, Surface s, vec3 x) {
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver receiver = projectReceiver(shadow, x);
    if (!receiver.inside) continue;
    float stored = shadowTexel(shadow.meta.x, receiver.texel);
    bool holds = shadowHolds(shadow.meta, stored);
    DrawnDepth drawn = drawnDepth(shadow, receiver.texel, stored);
    float tolerance = exitTolerance(shadow, incident.distanceTo, receiverCosine(s, incident)) +
                      drawn.uncertain * lengthPerDepth(shadow, receiver, x, incident, drawn.depth);
    return LightSpace(true, holds, holds && lightEntersMedium(shadow, receiver, incident, s, x),
                      lightThickness(shadow, receiver, x, incident, drawn.depth) + shadow.offsets.z, tolerance);
  }
  return LightSpace(false, false, false, -1.0, 0.0);
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

// docs/design.md says why each source is what it is. `mapped`: whether the light has shadow maps.
Transmitted lightTransmission(LightConstants light, Surface s, bool mapped) {
  Incident incident = incidentLight(light, s.position);
  bool holdsExits = light.meta.w != 0u; // which do not say where light enters
  if (mapped && !holdsExits && !hasFlag(PELLUCID_FLAG_CAMERA_THICKNESS)) {
    LightSpace l = lightSpace(light, incident, s, s.position);
    vec3 arriving = incident.irradiance * hiddenCosine(light, s, incident.toLight);
    return Transmitted(max(l.thickness, 0.0), arriving, l.enters ? 1.0 : 0.0);
  }
  if (s.chord < 0.0) return Transmitted(-1.0, vec3(0.0), 0.0);
  vec3 back = s.position + s.chord * s.view;
  incident = incidentLight(light, back);
  // A slab's thickness along its normal, from the chord along the view ray.
  bool alongNormal = s.hasNormal && !hasFlag(PELLUCID_FLAG_CHORD_THICKNESS);
  float thickness = alongNormal ? s.chord * abs(dot(s.normal, s.view)) : s.chord;
  float visible = 1.0;
  if (mapped) {
    LightSpace l = lightSpace(light, incident, s, back);
    // Light that enters has not come to the face that it leaves by.
    visible = l.enters && l.thickness <= (holdsExits ? -l.tolerance : l.tolerance) ? 1.0 : 0.0;
  }
  return Transmitted(thickness, incident.irradiance * hiddenCosine(light, s, incident.toLight), visible);
}

#endif
