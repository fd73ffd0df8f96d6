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

#include "frame/flags.glsl"
#include "lib/angle.glsl"
#include "frame/light_tables.glsl"
#include "lib/surface.glsl"
#include "lib/thickness.glsl"
#include "lib/transmittance.glsl"
#include "lib/occluder.glsl"
#include "lib/shadow.glsl"

// material: index + 1, as materialIndex has it and not 0. Frames without thin walls read nothing.
bool isThinWalled(uint material) { return hasFlag(PELLUCID_FLAG_THIN_WALLS) && materials[material - 1u].meta.z != 0u; }

// ---- The four texels of a light's shadow map around a point: how far the light that they store would go through the medium, and
// which of them let light come there

// `texel`: of the image, which holds `stored`. Neighbors are read for maps with a slope bias alone.
DrawnDepth drawnDepth(ShadowConstants shadow, ivec2 texel, float stored) {
  if (shadow.offsets.y == 0.0) return drawnDepth(shadow.offsets, stored, vec4(stored), bvec4(false));
  uint image = shadow.meta.x;
  ivec2 first = firstTexel(shadow.occluder), last = first + ivec2(shadow.depth.zw) - 1;
  ivec2 low = max(texel - 1, first), high = min(texel + 1, last);
  vec4 beside = shadowTexels(image, texel, first, last).beside;
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

const float kEverywhere = 3.0e38;

float receiverCosine(Surface s, Incident incident) { return s.hasNormal ? dot(s.normal, incident.toLight) : 0.0; }

// True of each texel where light enters the receiver's medium and has not left the medium before the receiver.
bvec4 entersMedium(ShadowConstants shadow, ShadowReceiver receiver, ShadowFootprint footprint, Incident incident, Surface s,
                   vec3 x, float tolerance) {
  vec4 caster = vec4(0.0), exits = vec4(0.0);
  if (hasCasterImage(shadow)) caster = shadowQuad(shadow.occluder.y - 1u, footprint.low, footprint.high);
  if (hasExitImage(shadow)) exits = shadowQuad(shadow.occluder.x - 1u, footprint.low, footprint.high);
  bvec4 enters = bvec4(true);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if (hasCasterImage(shadow)) enters[i] = casterIsMedium(caster[i], uintBitsToFloat(shadow.occluder.z), s.material);
    if (!hasExitImage(shadow) || !enters[i] || !shadowHolds(shadow.meta, exits[i])) continue;
    float step = shadow.offsets.w > 0.0 ? shadow.offsets.w * lengthPerDepth(shadow, receiver, x, incident, exits[i]) : 0.0;
    enters[i] = !liesBeyondExit(lightThickness(shadow, receiver, x, incident, exits[i]), tolerance + step);
  }
  return enters;
}

// `farthest`: texels further ahead count as if no light entered there.
LightTexels lightTexels(ShadowConstants shadow, ShadowReceiver receiver, Incident incident, Surface s, vec3 x, float cosine,
                        float farthest) {
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
  LightTexels l = LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), texelSideAt(shadow, incident.distanceTo), 0.0);
  bvec4 counts = bvec4(false);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    if (!shadowHolds(shadow.meta, stored[i])) continue;
    l.held[i] = footprint.weight[i];
    l.thickness[i] = lightThickness(shadow, receiver, x, incident, stored[i] + drawn.depth) + shadow.offsets.z;
    counts[i] = l.thickness[i] < farthest;
    if (drawn.uncertain > 0.0)
      l.uncertain = max(l.uncertain, drawn.uncertain * lengthPerDepth(shadow, receiver, x, incident, stored[i]));
  }
  if (!any(counts)) return l;
  bvec4 enters = entersMedium(shadow, receiver, footprint, incident, s, x, depthTolerance(l.side, cosine));
  l.entering = l.held * vec4(enters) * vec4(counts);
  return l;
}

// x: a point on or behind the surface s; cosine: between its normal and the light; 0: not known.
LightTexels lightTexels(LightConstants light, Incident incident, Surface s, vec3 x, float cosine, float farthest) {
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver receiver = projectReceiver(shadow, x);
    if (receiver.inside) return lightTexels(shadow, receiver, incident, s, x, cosine, farthest);
  }
  return LightTexels(vec4(0.0), vec4(0.0), vec4(0.0), 0.0, 0.0);
}

// Unit normal of the front or back depths, towards the eye; 0: not known.
vec3 facetAt(ivec2 pixel, uint material, bool back) {
  vec4 beside = vec4(distanceOf(pixel + ivec2(1, 0), material, back), distanceOf(pixel - ivec2(1, 0), material, back),
                     distanceOf(pixel + ivec2(0, 1), material, back), distanceOf(pixel - ivec2(0, 1), material, back));
  return normalOfDepths(frame.camera, pixel, distanceOf(pixel, material, back), beside);
}

// Beyond this cosine a face that turns away from the light is not the one that a map stores, whose texels would have to
// reach around 30 degrees of curvature.
const float kLeastTurnedCosine = 0.5;

// The least value of texels that count.
float leastEntering(LightTexels l, vec4 values) {
  vec4 counted = mix(vec4(3.0e38), values, greaterThan(l.entering, vec4(0.0)));
  return min(min(counted.x, counted.y), min(counted.z, counted.w));
}

// True where a texel may store the receiver itself. Depths of pixels are read only where they may decide, here and below.
bool mayStoreReceiver(LightTexels l) { return leastEntering(l, l.thickness) < 2.0 * (kMostTexels * l.side + l.uncertain); }

// Weights of texels that do not store the receiver itself: there, light lies on it or is blocked, but does not come through.
// `cosine`: between the normal of the front depths and the light; 0: not known.
vec4 throughWeights(LightTexels l, float cosine) {
  float tolerance = (depthTolerance(l.side, cosine) + l.uncertain) * clamp(1.0 + cosine / kLeastTurnedCosine, 0.0, 1.0);
  return tolerance > 0.0 ? l.entering * clamp(l.thickness / tolerance - 1.0, 0.0, 1.0) : l.entering;
}

// Part of the texels that let light come to a hidden face, whose map holds it or the face that light leaves by. It fades over
// one tolerance.
float litPart(LightTexels l, ivec2 pixel, uint material, vec3 toLight, bool holdsExits) {
  float tolerance = kMostTexels * l.side;
  if (leastEntering(l, abs(l.thickness)) <= 2.0 * (tolerance + l.uncertain))
    tolerance = depthTolerance(l.side, dot(facetAt(pixel, material, true), toLight));
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
  // 0 < sum <= total: the least thickness has a weight above 0. rate > 0: no material's T takes more than 1000 mm to halve.
  float sum = dot(weight, exp2(rate * min(least - thickness, 0.0)));
  return least - log2(sum / total) / rate;
}

// ---- Light through solids

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

// ---- Light through a sheet without thickness, from the face that is not seen

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
