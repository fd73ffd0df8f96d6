// Light through one surface point: one thickness for each light. Engines include this file in shaders of any stage.
//
// A shader that binds its inputs its own way defines PELLUCID_OWN_INPUTS and declares, before it includes this file,
// FrameConstants frame, ShadowConstants shadows[] and MaterialConstants materials[] (names, as a buffer's array cannot be passed
// without a copy), and the functions
//   vec4 shadowTexels(uint image, ivec2 a, ivec2 b, ivec2 c, ivec2 d); // four texels of the image and layer that
//                                                                      // ShadowConstants::meta.x names
//   float distanceOf(ivec2 pixel, uint material, bool back); // planar distance of the front or back depth of a pixel that has
//                                                            // the material (index + 1); <= 0 of others
//   vec3 hiddenIrradianceOf(ivec2 pixel); // what the image of that name holds, in a frame that has one
// The shader requires GL_EXT_control_flow_attributes. Frames with light tables need specialization constant
// PELLUCID_CONSTANT_LIGHT_TABLES (5) as true.
#ifndef PELLUCID_TRANSMISSION_GLSL
#define PELLUCID_TRANSMISSION_GLSL

#include "frame/light_tables.glsl"
#include "lib/camera.glsl"
#include "lib/shadow.glsl"
#include "lib/surface.glsl"

#ifdef PELLUCID_OWN_INPUTS
bool hasFlag(uint flag) { return (frame.flags.x & flag) != 0u; }
ivec2 inLattice(ivec2 at) { return at + frame.lattice.xy; } // where frame.rect and frame.camera count from
bool mayUse(uint use) { return true; }
#else
#include "frame/frame.glsl"
#include "frame/shadow_images.glsl"
layout(set = 0, binding = PELLUCID_BINDING_SHADOWS) uniform Shadows { ShadowConstants shadows[PELLUCID_DISPATCH_SHADOWS]; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_HIDDEN_IRRADIANCE) uniform texture2D hiddenIrradianceImage;

// False of options that no frame of the context has.
layout(constant_id = PELLUCID_CONSTANT_USES) const uint kUses = 0xFFFFFFFFu;
bool mayUse(uint use) { return (kUses & use) != 0u; }

vec3 hiddenIrradianceOf(ivec2 pixel) { return sanitize(texelFetch(hiddenIrradianceImage, pixel, 0).rgb); }
#endif

#define FACET_LOOP [[dont_unroll]]
#include "frame/facet.glsl"

// material: index + 1, as materialIndex has it and not 0. Frames without thin walls read nothing.
bool isThinWalled(uint material) {
  return mayUse(PELLUCID_SHADER_USE_THIN_WALLS) && hasFlag(PELLUCID_FLAG_THIN_WALLS) && materials[material - 1u].meta.z != 0u;
}

// ---- T(d): fraction of the flux entering one face of a slab that leaves the other. d in mm, >= 0.

// a1 e^{-k1 d} + a2 e^{-k2 d}
float transmittanceExp2(vec4 p, float d) {
  const float kLog2E = 1.44269504;
  float e = kLog2E * d; // once for all channels
  return p.x * exp2(-p.y * e) + p.z * exp2(-p.w * e);
}

// a / sinh(kappa d + z) + b e^{-c d}; z > 0 by construction. Written with e^{-y} so that a thick slab
// gives 0 and not 1/inf: 1/sinh y = 2 e^{-y} / (1 - e^{-2y}).
float transmittanceSinhExp(vec4 p, float c, float d) {
  float y = max(p.y * d + p.z, 1.0e-6);
  float e = exp(-y);
  // 1 - e^2 loses its bits where y is small; its series there is off by 2/15 y^4 < 1e-6.
  float denominator = y < 0.05 ? 2.0 * y * (1.0 - y * (1.0 - y * (2.0 / 3.0 - y / 3.0))) : 1.0 - e * e;
  return p.x * 2.0 * e / denominator + p.w * exp(-c * d);
}

// One term w e^{-d^2 / (2 v)} of d'Eon & Luebke 2007: R(sqrt(r^2 + d^2)) of a Gaussian sum,
// integrated over the plane.
vec3 transmittanceGaussian(vec3 weight, vec3 falloff, float d) {
  return weight * exp(-d * d * falloff);
}

vec3 materialTransmittance(uint m, float d) {
  vec3 t = vec3(0.0);
  if (materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_EXP2) {
    t = vec3(transmittanceExp2(materials[m].transmittance[0], d), transmittanceExp2(materials[m].transmittance[1], d),
             transmittanceExp2(materials[m].transmittance[2], d));
  } else if (!mayUse(PELLUCID_SHADER_USE_THESIS) || materials[m].meta.x == PELLUCID_SHADER_TRANSMITTANCE_SINH_EXP) {
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

// ---- The four texels of a light's shadow map around a point: how far the light that they store would go through the medium, and
// which of them let light come there

// Texels of a footprint.
vec4 shadowTexels(uint image, ShadowFootprint f) {
  return shadowTexels(image, f.low, ivec2(f.high.x, f.low.y), ivec2(f.low.x, f.high.y), f.high);
}

// 1 of each texel where light enters the receiver's medium and has not left the medium before the receiver, 0 of others.
// `material`: the receiver's; `tolerance`: of its own exit.
vec4 entersMedium(ShadowConstants shadow, ShadowFootprint footprint, StoredRay ray, uint material, float tolerance) {
  vec4 enters = vec4(1.0);
  // One loop, as every read has a copy of the switch over images.
  [[dont_unroll]] for (int i = 0; i < 2; ++i) {
    uint image = i == 0 ? shadow.occluder.x : shadow.occluder.y; // + 1; 0: none
    if (image == 0u) continue;
    vec4 texels = shadowTexels(image - 1u, footprint);
    [[unroll]] for (int k = 0; k < 4; ++k) {
      bool left = i == 0 && shadowHolds(shadow.meta, texels[k]) &&
                  liesBeyondExit(lightThickness(ray, texels[k]), tolerance + shadow.offsets.w * lengthPerDepth(ray, texels[k]));
      bool other = i == 1 && !casterIsMedium(texels[k], uintBitsToFloat(shadow.occluder.z), material);
      if (left || other) enters[k] = 0.0;
    }
  }
  return enters;
}

// `texel`: of the image, which holds `stored`. Neighbors are read for maps with a slope bias alone.
DrawnDepth drawnDepth(ShadowConstants shadow, ivec2 texel, float stored) {
  if (shadow.offsets.y == 0.0) return drawnDepth(shadow.offsets, stored, vec4(stored), bvec4(false));
  ivec2 first = firstTexel(shadow.occluder), last = first + ivec2(shadow.depth.zw) - 1;
  ivec4 at = besideTexel(texel, first, last);
  vec4 beside = shadowTexels(shadow.meta.x, ivec2(at.x, texel.y), ivec2(at.y, texel.y), ivec2(texel.x, at.z), ivec2(texel.x, at.w));
  bvec4 within = notEqual(at, texel.xxyy), holds;
  for (int i = 0; i < 4; ++i) holds[i] = within[i] && shadowHolds(shadow.meta, beside[i]);
  return drawnDepth(shadow.offsets, stored, beside, holds);
}

// The four texels around a point in the first of the light's maps that contains it, or beside a seam between maps.
struct LightTexels {
  vec4 weight;    // bilinear, of texels that have a surface where light enters the medium asked for; 0 of others
  vec4 thickness; // scene units along the light ray; negative: the surface is beyond the point
  float side;      // of a texel, scene units
  float uncertain; // scene units that the thickness may be off by, besides what depthTolerance says
};

// `material`: index + 1 of the medium, in which x lies; 0: all surfaces count. `farthest`: texels further ahead have no weight;
// kFarthest: texels tell what holds light back, and not where light enters.
LightTexels lightTexels(ShadowConstants shadow, ShadowReceiver receiver, Incident incident, uint material, vec3 x, float cosine,
                        float farthest) {
  ShadowFootprint footprint = footprintOf(shadow, receiver);
  StoredRay ray = storedRay(shadow, receiver, x, incident);
  vec4 texels = shadowTexels(shadow.meta.x, footprint);
  vec2 row = footprint.part.y < 0.5 ? texels.xy : texels.zw;
  float nearest = footprint.part.x < 0.5 ? row.x : row.y;
  // All texels were moved as far as the nearest one, or by the constant alone where that has no surface.
  DrawnDepth drawn = DrawnDepth(-shadow.offsets.x, 0.5 * shadow.offsets.w);
  if (shadowHolds(shadow.meta, nearest)) {
    drawn = drawnDepth(shadow, receiver.texel, nearest);
    drawn.depth -= nearest;
  }
  LightTexels l = LightTexels(vec4(0.0), vec4(0.0), texelSideAt(shadow, incident.distanceTo), 0.0);
  [[unroll]] for (int i = 0; i < 4; ++i) {
    float stored = texels[i];
    if (!shadowHolds(shadow.meta, stored)) continue;
    l.thickness[i] = lightThickness(ray, stored + drawn.depth) + shadow.offsets.z;
    // A clamped texel holds light back, but nobody knows the thickness before it.
    bool unknown = farthest < kFarthest && isClamped(shadow.meta, shadow.offsets, stored);
    if (l.thickness[i] < farthest && !unknown) l.weight[i] = footprint.weight[i];
    l.uncertain = max(l.uncertain, drawn.uncertain * lengthPerDepth(ray, stored));
  }
  if (material != 0u && l.weight != vec4(0.0)) l.weight *= entersMedium(shadow, footprint, ray, material, depthTolerance(l.side, cosine));
  return l;
}

// x: a point on or behind a surface; cosine: between its normal and the light; 0: not known.
LightTexels lightTexels(LightConstants light, Incident incident, uint material, vec3 x, float cosine, float farthest) {
  uint found = light.meta.z;
  float least = light.meta.z > 1u ? kSeam : 0.0;
  for (uint i = 0u; i < light.meta.z; ++i) {
    float beyond = projectReceiver(shadows[light.meta.y + i], x).beyond;
    if (!(beyond <= least)) continue;
    found = i;
    least = beyond;
    if (beyond <= 0.0) break;
  }
  if (found == light.meta.z) return LightTexels(vec4(0.0), vec4(0.0), 0.0, 0.0);
  ShadowConstants shadow = shadows[light.meta.y + found];
  return lightTexels(shadow, projectReceiver(shadow, x), incident, material, x, cosine, farthest);
}

// The surface of a pixel, whose normal follows from the depths around. `planar`: distance of the front; `chord`: as Surface has
// it; `material`: index + 1.
Surface surfaceOf(ivec2 pixel, ViewRay ray, float planar, float chord, uint material) {
  vec3 view = normalize(ray.direction), normal = facetAt(pixel, material, planar, false);
  if (normal == vec3(0.0)) normal = -view;
  return Surface(ray.origin + planar * ray.direction, normal, view, chord, material);
}

// Beyond this cosine a face that turns away from the light is not the one that a map stores, whose texels would have to
// reach around 30 degrees of curvature.
const float kLeastTurnedCosine = 0.5;

// Weights of texels that do not store the receiver itself: there, light lies on it or is blocked, but does not come through.
// `cosine`: between the normal of the front depths and the light; 0: not known.
vec4 throughWeights(LightTexels l, float cosine) {
  float tolerance = (depthTolerance(l.side, cosine) + l.uncertain) * clamp(1.0 + cosine / kLeastTurnedCosine, 0.0, 1.0);
  return tolerance > 0.0 ? l.weight * clamp(l.thickness / tolerance - 1.0, 0.0, 1.0) : l.weight;
}

// Part of the texels that let light come to a hidden face, whose map holds it or the face that light leaves by. It fades over
// one tolerance. `cosine`: between the normal of the back depths and the light; 0: not known.
float litPart(LightTexels l, float cosine, bool holdsExits) {
  float tolerance = max(depthTolerance(l.side, cosine) + l.uncertain, 1.0e-30);
  return dot(l.weight, clamp((holdsExits ? 0.0 : 2.0) - l.thickness / tolerance, 0.0, 1.0));
}

// Mean of thicknesses as an exponential has it that halves at the same depth as T. Scene units; 0 without weights.
float meanThickness(vec4 weight, vec4 thickness, uint m) {
  float total = dot(weight, vec4(1.0));
  if (total <= 0.0) return 0.0;
  float rate = materials[m].inverseReflectance.w * frame.camera.range.w;
  thickness = max(thickness, 0.0);
  vec4 counted = mix(vec4(kFarthest), thickness, greaterThan(weight, vec4(0.0)));
  float least = min(min(counted.x, counted.y), min(counted.z, counted.w));
  // 0 < sum <= total: the least thickness has a weight above 0. rate > 0: no material's T takes more than 1000 mm to halve.
  float sum = dot(weight, exp2(rate * min(least - thickness, 0.0)));
  // sum / total and log2 are rounded, but no mean is below the least.
  return max(least - log2(sum / total) / rate, least);
}

// ---- Light through solids

struct Transmitted {
  float thickness; // scene units; -1: no light comes through
  vec3 arriving;   // irradiance of the hidden face before occlusion
  float visible;   // part that no shadow map holds back
  float opposite;  // factor of how far both faces are opposite: 1 slab, 0 rim
  vec3 front;      // irradiance of the visible face, of which a thin body returns less than a half-space does; 0: returns all
};

const Transmitted kNothingTransmitted = Transmitted(-1.0, vec3(0.0), 0.0, 1.0, vec3(0.0));

// Least part that a body is taken to return, so that a thin pixel beside a probe of a thick one is no dot.
const float kLeastKept = 0.25;

// Exitance of material m, besides what the irradiance image has. Most pixels face some lights; T is the expensive part.
vec3 exitanceOf(Transmitted t, uint m) {
  vec3 entering = t.arriving * (t.visible * t.opposite), any = max(entering, t.front);
  if (!(isWithin(t.thickness, 0.0, kMostFloat) && max(any.r, max(any.g, any.b)) > 0.0)) return vec3(0.0);
  vec3 through = materialTransmittance(m, t.thickness * frame.camera.range.w), exitance = entering * through, kept;
  bool bodies = hasFlag(PELLUCID_FLAG_BODIES) && !isThinWalled(m + 1u);
  if (!bodies && t.front == vec3(0.0)) return exitance;
  for (int c = 0; c < 3; ++c) kept[c] = keptReflectance(materials[m].gather.reflectance[c], through[c]);
  // Probes scale all irradiance by what a thin body returns of the light on it. This light is not returned: it came through.
  if (bodies) return exitance / max(kept, vec3(kLeastKept));
  return exitance - (1.0 - kept) * t.front / materials[m].inverseReflectance.rgb;
}

// ---- Factors that stand for the cosine of the light on the hidden face, which the camera does not see. x is the cosine
// between the view ray and the direction to the light. See PellucidAngleModel.

// Whelan 2009, 4.4. The clamp keeps rounding from leaving the domain of acos.
float angleInverseCosine(float x) {
  const float kTwoOverPi = 0.63661977;
  return clamp(1.0 - kTwoOverPi * acos(clamp(x, -1.0, 1.0)), 0.0, 1.0);
}

// A polynomial of the angle between eye and light: Whelan 2009, eqs. 4.4 and 4.5. The outer clamp matters: the
// quadratic is negative from 96 to 123 degrees.
float anglePolynomial(vec4 c, float x) {
  float angle = 3.14159265 - acos(clamp(x, -1.0, 1.0));
  return x > 0.0 ? clamp(c.x + angle * (c.y + angle * (c.z + angle * c.w)), 0.0, 1.0) : 0.0;
}

uint angleModel() { return mayUse(PELLUCID_SHADER_USE_THESIS) ? frame.flags.w : PELLUCID_SHADER_ANGLE_NORMAL; }

float hiddenCosine(LightConstants light, Surface s, vec3 toLight) {
  uint model = angleModel();
  if (model == PELLUCID_SHADER_ANGLE_NORMAL) return max(-dot(s.normal, toLight), 0.0);
  vec3 view = hasFlag(PELLUCID_FLAG_CONSTANT_VIEW) ? vec3(0.0, 0.0, frame.camera.range.x) : s.view;
  float x = dot(view, toLight) * light.cone.z + light.cone.w; // from the minimum dot on, if the model has one
  if (model == PELLUCID_SHADER_ANGLE_INVERSE_COSINE) return angleInverseCosine(x);
  if (model == PELLUCID_SHADER_ANGLE_POLYNOMIAL) return anglePolynomial(frame.anglePolynomial, x);
  return clamp(x, 0.0, 1.0);
}

// ---- Light through a sheet without thickness, from the face that is not seen

// A plane's own texels lie within the tolerance down to a cosine of .045. Light that grazes more brings less than 5 %.
const float kMostWallTexels = 32.0;
const float kDiagonal = 1.41421356; // to the farthest of four texels
// Normals may turn a face to the light that geometry turns away. Its light fades over 6 degrees: facets of a round body of 30 sides
// turn as far from its normals.
const float kTurnedCosine = 0.1;

// Part of the light that no other surface holds back. A texel that stores the sheet itself, what lies behind it, or nothing
// lets light by. `l`: around the sheet; `facing`: cosine between the sheet's geometry and the light.
float unblockedPart(LightConstants light, LightTexels l, float facing) {
  if (light.meta.z == 0u) return 1.0;
  if (l.side <= 0.0) return 0.0; // no map contains the point
  float tolerance = l.side * min(1.0 + kDiagonal * slopeOf(facing), kMostWallTexels) + l.uncertain;
  return 1.0 - dot(l.weight, clamp(l.thickness / tolerance - 1.0, 0.0, 1.0));
}

// ---- The face that a pixel hides: where the light of all that has no map of front faces enters

// False of bodies through which no light comes, whatever their back: most are thick.
bool isThin(Surface s) {
  float least = 0.5 * s.chord * abs(dot(s.normal, s.view)) * frame.camera.range.w;
  return s.chord >= 0.0 && least <= materials[s.material - 1u].transmittance4.w;
}

// The pixel's chord, unless it is shorter than all chords beside: a silhouette that crosses one pixel is no thin part.
float chordBeside(Surface s, ivec2 pixel) {
  float least = kFarthest;
  [[dont_unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 beside = pixelBeside(pixel, i);
    float front = distanceOf(beside, s.material, false), back = distanceOf(beside, s.material, true);
    if (front > 0.0 && back > front) least = min(least, back - front);
  }
  // Rays meet the plane of depths at less than 90 degrees.
  return least < kFarthest ? max(s.chord, least / max(abs(s.view.z), 1.0e-3)) : s.chord;
}

struct HiddenFace {
  vec3 position, normal; // outward
  float thickness;       // of the body, scene units
  float opposite;        // factor of how far both faces are opposite: 1 slab, 0 rim
};

HiddenFace hiddenFace(Surface s, ivec2 pixel) {
  // A stored thickness is that of a slab.
  if (hasFlag(PELLUCID_FLAG_BACK_THICKNESS)) return HiddenFace(s.position - s.chord * s.normal, -s.normal, s.chord, 1.0);
  float own = distanceOf(pixel, s.material, true);
  vec3 facet = own > 0.0 ? facetAt(pixel, s.material, own, true) : vec3(0.0);
  vec3 front = s.normal, back = facet == vec3(0.0) ? -front : -facet;
  float thickness = 0.5 * chordBeside(s, pixel) * (abs(dot(front, s.view)) + abs(dot(back, s.view)));
  // A rim has all of the medium behind it. Depths do not tell the normal of a face that is seen at less than some 20 degrees.
  const float kPerCosine = 3.0; // 1 / sin(20 degrees)
  float seen = min(kPerCosine * min(abs(dot(front, s.view)), abs(dot(back, s.view))), 1.0);
  return HiddenFace(s.position + s.chord * s.view, back, thickness, seen * (0.5 - 0.5 * dot(front, back)));
}

// ---- Light from all around. A thin body sends on what comes from behind, and returns less of what lies on it than a half-space
// does; docs/integration.md says why both count

// Irradiance of a face, in the units of the irradiance image. `normal`: unit, view space.
vec3 ambientIrradiance(vec3 normal) {
  vec4 n = vec4(normal, 1.0);
  return max(vec3(dot(n, frame.ambient[0] * n), dot(n, frame.ambient[1] * n), dot(n, frame.ambient[2] * n)), vec3(0.0));
}

// Irradiance of the face that the pixel hides; `back`: its normal.
vec3 hiddenIrradiance(ivec2 pixel, vec3 back) {
  return hasFlag(PELLUCID_FLAG_HIDDEN_IRRADIANCE) ? hiddenIrradianceOf(pixel) : ambientIrradiance(back);
}

bool isAmbient(LightConstants light) {
  return mayUse(PELLUCID_SHADER_USE_AMBIENT) && light.meta.x == PELLUCID_SHADER_LIGHT_AMBIENT;
}

Transmitted ambientTransmission(Surface s, ivec2 pixel, HiddenFace face) {
  vec3 visible = hasFlag(PELLUCID_FLAG_BODIES) ? vec3(0.0) : ambientIrradiance(s.normal);
  return Transmitted(face.thickness, hiddenIrradiance(pixel, face.normal), 1.0, face.opposite, face.opposite * visible);
}

// ---- Light through any surface

// docs/how-it-works.md, "Light without a map of front faces", says when each source is used. `pixel`: of the surface.
Transmitted lightTransmission(LightConstants light, Surface s, ivec2 pixel) {
  bool wall = isThinWalled(s.material), ambient = isAmbient(light), mapped = light.meta.z != 0u;
  // A sheet's T is the same at any thickness, and its reflectance is its own.
  if (ambient && wall) return Transmitted(0.0, hiddenIrradiance(pixel, -s.normal), 1.0, 1.0, vec3(0.0));
  // Exit depths do not say where light enters: it enters the hidden face, which they may hide from the light.
  bool holdsExits = light.meta.w != 0u, hidden = !wall && (!mapped || holdsExits || hasFlag(PELLUCID_FLAG_CAMERA_THICKNESS));
  HiddenFace face = HiddenFace(s.position, s.normal, -1.0, 1.0);
  if (hidden) {
    if (!isThin(s)) return kNothingTransmitted;
    face = hiddenFace(s, pixel);
    if (ambient) return ambientTransmission(s, pixel, face);
    if (hasFlag(PELLUCID_FLAG_CHORD_THICKNESS)) face.thickness = s.chord;
  }
  Incident incident = lightAt(light, face.position);
  bool byNormal = hidden && angleModel() == PELLUCID_SHADER_ANGLE_NORMAL;
  float facing = dot(face.normal, incident.toLight);
  float cosine = byNormal ? max(facing, 0.0) : hiddenCosine(light, s, incident.toLight);
  Transmitted t = Transmitted(face.thickness, incident.irradiance * cosine, 1.0, byNormal ? face.opposite : 1.0, vec3(0.0));
  // Most pixels face some lights, whose maps need no reading.
  if (t.arriving * t.opposite == vec3(0.0) || (hidden && !mapped)) return t;
  // Below kFarthest, also of materials that light crosses at any thickness: clamped texels are then told apart.
  float farthest = hidden || wall ? kFarthest : min(materials[s.material - 1u].transmittance4.w / frame.camera.range.w, kNoDepth);
  LightTexels l = lightTexels(light, incident, wall ? 0u : s.material, face.position, hidden ? 0.0 : facing, farthest);
  if (wall) {
    t.thickness = 0.0; // not by a choice of 0 or -1, which compilers make -0: isWithin refuses that
    t.visible = clamp(1.0 - facing / kTurnedCosine, 0.0, 1.0) * unblockedPart(light, l, facing);
  } else if (hidden) {
    t.visible = litPart(l, facing, holdsExits);
  } else {
    vec4 weight = throughWeights(l, facing);
    t.thickness = meanThickness(weight, l.thickness, s.material - 1u);
    t.visible = dot(weight, vec4(1.0));
  }
  return t;
}

#endif
