// Light through one surface point, for any shader stage. Include it after declaring, from whatever bindings
// the shader has: FrameConstants frame, ShadowConstants shadows[], MaterialConstants materials[], and
//   float shadowTexel(uint image, ivec2 texel); // of the image and layer in ShadowConstants::meta.x
//   vec4 shadowQuad(uint image, ivec2 low, ivec2 high); // as frame/shadow_images.glsl has it
//   vec3 facetAt(ivec2 pixel, bool back); // unit normal of the front or back depths, towards the eye; 0: not known
// The shader requires GL_EXT_control_flow_attributes.
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

// The four texels around a point in the first of the light's maps that contains it.
struct LightTexels {
  vec4 held;      // bilinear weights of the texels that have a surface; 0 of others
  vec4 entering;  // of those where light enters the point's own medium
  vec4 thickness; // scene units along the light ray; negative: the surface is beyond the point
  float side;      // of a texel, scene units
  float uncertain; // scene units that the thickness may be off by, besides what depthTolerance says
};

float receiverCosine(Surface s, Incident incident) { return s.hasNormal ? dot(s.normal, incident.toLight) : 0.0; }

// Whether light enters the receiver's medium at a texel and has not left it before it is at the receiver. `tolerance`: of a
// receiver on the exit surface.
bool entersMedium(ShadowConstants shadow, ShadowReceiver receiver, ivec2 texel, Incident incident, Surface s, vec3 x,
                  float tolerance) {
  if (hasCasterImage(shadow) &&
      !casterIsMedium(shadowTexel(shadow.occluder.y - 1u, texel), uintBitsToFloat(shadow.occluder.z), s.material))
    return false;
  if (!hasExitImage(shadow)) return true;
  float stored = shadowTexel(shadow.occluder.x - 1u, texel);
  if (!shadowHolds(shadow.meta, stored)) return true;
  if (shadow.offsets.w > 0.0) tolerance += shadow.offsets.w * lengthPerDepth(shadow, receiver, x, incident, stored);
  return !liesBeyondExit(lightThickness(shadow, receiver, x, incident, stored), tolerance);
}

LightTexels lightTexels(ShadowConstants shadow, ShadowReceiver receiver, Incident incident, Surface s, vec3 x, float cosine) {
  ShadowFootprint footprint = footprintOf(shadow, receiver);
  vec4 stored = shadowQuad(shadow.meta.x, footprint.low, footprint.high);
  vec2 row = footprint.part.y < 0.5 ? stored.xy : stored.zw;
  float nearest = footprint.part.x < 0.5 ? row.x : row.y;
  // All texels were moved as far as the nearest one, or by the constant alone where that has no surface.
  DrawnDepth drawn = DrawnDepth(-shadow.offsets.x, 0.5 * shadow.offsets.w);
  if (shadowHolds(shadow.meta, nearest)) {
    drawn = drawnDepth(shadow, receiver.texel, nearest);
    drawn.depth -= nearest;
  }
  float side = texelSideAt(shadow, incident.distanceTo);
  LightTexels l = LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), side, 0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if (!shadowHolds(shadow.meta, stored[i])) continue;
    l.held[i] = footprint.weight[i];
    l.thickness[i] = lightThickness(shadow, receiver, x, incident, stored[i] + drawn.depth) + shadow.offsets.z;
    if (drawn.uncertain > 0.0)
      l.uncertain = max(l.uncertain, drawn.uncertain * lengthPerDepth(shadow, receiver, x, incident, stored[i]));
    ivec2 texel = ivec2((i & 1) != 0 ? footprint.high.x : footprint.low.x, i > 1 ? footprint.high.y : footprint.low.y);
    if (entersMedium(shadow, receiver, texel, incident, s, x, depthTolerance(side, cosine))) l.entering[i] = l.held[i];
  }
  return l;
}

// x: a point on or behind the surface s; cosine: between its normal and the light; 0: not known.
LightTexels lightTexels(LightConstants light, Incident incident, Surface s, vec3 x, float cosine) {
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver receiver = projectReceiver(shadow, x);
    if (receiver.inside) return lightTexels(shadow, receiver, incident, s, x, cosine);
  }
  return LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0);
}

// Beyond this cosine a face that turns away from the light is not the one that a map stores, whose texels would have to
// reach around 30 degrees of curvature.
const float kLeastTurnedCosine = 0.5;

// The least value of texels that count.
float leastEntering(LightTexels l, vec4 values) {
  vec4 counted = mix(vec4(3.0e38), values, greaterThan(l.entering, vec4(0.0)));
  return min(min(counted.x, counted.y), min(counted.z, counted.w));
}

// Weights of texels that do not store the receiver itself: there, light lies on it or is blocked, but does not come through.
// Depths of pixels are read only where they may decide, here and below.
vec4 throughWeights(LightTexels l, ivec2 pixel, vec3 toLight) {
  if (leastEntering(l, l.thickness) >= 2.0 * (kMostTexels * l.side + l.uncertain)) return l.entering;
  float cosine = dot(facetAt(pixel, false), toLight);
  float tolerance = (depthTolerance(l.side, cosine) + l.uncertain) * clamp(1.0 + cosine / kLeastTurnedCosine, 0.0, 1.0);
  return tolerance > 0.0 ? l.entering * clamp(l.thickness / tolerance - 1.0, 0.0, 1.0) : l.entering;
}

// Part of the texels that let light come to a hidden face, whose map holds it or the face that light leaves by. It fades over
// one tolerance.
float litPart(LightTexels l, ivec2 pixel, vec3 toLight, bool holdsExits) {
  float tolerance = kMostTexels * l.side;
  if (leastEntering(l, abs(l.thickness)) <= 2.0 * (tolerance + l.uncertain))
    tolerance = depthTolerance(l.side, dot(facetAt(pixel, true), toLight));
  tolerance = max(tolerance + l.uncertain, 1.0e-30);
  return dot(l.entering, clamp((holdsExits ? 0.0 : 2.0) - l.thickness / tolerance, 0.0, 1.0));
}

// Mean of thicknesses as an exponential has it that halves at the same depth as T. Scene units; 0 without weights.
float meanThickness(vec4 weight, vec4 thickness, uint m) {
  float total = dot(weight, vec4(1.0));
  if (total <= 0.0) return 0.0;
  float rate = materials[m].inverseReflectance.w * frame.camera.range.w;
  thickness = max(thickness, 0.0);
  vec4 counted = mix(vec4(3.0e38), thickness, greaterThan(weight, vec4(0.0)));
  float least = min(min(counted.x, counted.y), min(counted.z, counted.w));
  // 0 < sum <= total: the least thickness has a weight above 0.
  float sum = dot(weight, exp2(rate * min(least - thickness, 0.0)));
  return rate > 0.0 ? least - log2(sum / total) / rate : dot(weight, thickness) / total;
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

// docs/design.md says why each source is what it is. `pixel`: of the surface; `mapped`: whether the light has shadow maps.
Transmitted lightTransmission(LightConstants light, Surface s, ivec2 pixel, bool mapped) {
  Incident incident = incidentLight(light, s.position);
  bool holdsExits = light.meta.w != 0u; // which do not say where light enters
  if (mapped && !holdsExits && !hasFlag(PELLUCID_FLAG_CAMERA_THICKNESS)) {
    vec3 arriving = incident.irradiance * hiddenCosine(light, s, incident.toLight);
    // Most pixels face some lights, whose maps need no reading.
    if (arriving == vec3(0.0)) return Transmitted(-1.0, arriving, 0.0);
    LightTexels l = lightTexels(light, incident, s, s.position, receiverCosine(s, incident));
    vec4 weight = throughWeights(l, pixel, incident.toLight);
    return Transmitted(meanThickness(weight, l.thickness, s.material - 1u), arriving, dot(weight, vec4(1.0)));
  }
  if (s.chord < 0.0) return Transmitted(-1.0, vec3(0.0), 0.0);
  vec3 back = s.position + s.chord * s.view;
  incident = incidentLight(light, back);
  // A slab's thickness along its normal, from the chord along the view ray.
  bool alongNormal = s.hasNormal && !hasFlag(PELLUCID_FLAG_CHORD_THICKNESS);
  float thickness = alongNormal ? s.chord * abs(dot(s.normal, s.view)) : s.chord;
  // The exit depth says where light leaves, which the back depth does already.
  float visible = mapped ? litPart(lightTexels(light, incident, s, back, 0.0), pixel, incident.toLight, holdsExits) : 1.0;
  return Transmitted(thickness, incident.irradiance * hiddenCosine(light, s, incident.toLight), visible);
}

#endif
