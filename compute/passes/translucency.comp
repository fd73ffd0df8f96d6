// Thickness, transmittance, occlusion and the addition to irradiance, fused. PHYSICS: the exitance
// T(d) E_back is added as T(d)/rho E_back, so that albedo times the diffused sum is T E_back.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "lib/angle.glsl"
#include "lib/light.glsl"
#include "lib/shadow.glsl"
#include "lib/thickness.glsl"
#include "lib/transmittance.glsl"
#include "passes/bindings.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) readonly buffer Lights { LightConstants lights[]; };
layout(set = 0, binding = PELLUCID_BINDING_SHADOWS) readonly buffer Shadows { ShadowConstants shadows[]; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;
layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 0) uniform texture2D shadowImage0;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 1) uniform texture2D shadowImage1;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 2) uniform texture2D shadowImage2;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 3) uniform texture2D shadowImage3;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 4) uniform texture2D shadowImage4;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 5) uniform texture2D shadowImage5;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 6) uniform texture2D shadowImage6;
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES + 7) uniform texture2D shadowImage7;

// A switch over constant bindings needs no shaderSampledImageArrayDynamicIndexing.
float shadowTexel(uint image, ivec2 texel) {
  switch (image) {
    case 0u: return texelFetch(shadowImage0, texel, 0).x;
    case 1u: return texelFetch(shadowImage1, texel, 0).x;
    case 2u: return texelFetch(shadowImage2, texel, 0).x;
    case 3u: return texelFetch(shadowImage3, texel, 0).x;
    case 4u: return texelFetch(shadowImage4, texel, 0).x;
    case 5u: return texelFetch(shadowImage5, texel, 0).x;
    case 6u: return texelFetch(shadowImage6, texel, 0).x;
    default: return texelFetch(shadowImage7, texel, 0).x;
  }
}

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

// What one pixel knows of its surface. View space, scene units.
struct Surface {
  vec3 position, normal, view; // view: unit, from the eye
  float chord;                 // along the view ray; -1: unknown
  bool hasNormal;
};

Surface surfaceAt(ivec2 pixel, float front, float frontStored, float backStored, vec4 normalTexel) {
  ViewRay ray = viewRay(frame.camera, pixel);
  Surface s;
  s.position = ray.origin + front * ray.direction;
  s.view = normalize(ray.direction);
  s.chord = -1.0;
  if (hasFlag(PELLUCID_FLAG_BACK_DEPTH)) {
    bool backViewZ = hasFlag(PELLUCID_FLAG_BACK_VIEW_Z);
    float back = backViewZ ? planarDistanceViewZ(backStored) : planarDistance(frame.camera, backStored);
    bool device = !backViewZ && !hasFlag(PELLUCID_FLAG_FRONT_VIEW_Z);
    float difference = device ? planarDifference(frame.camera, backStored, frontStored) : back - front;
    if (back > 0.0) s.chord = chord(difference, ray);
  }
  s.normal = vec3(0.0);
  if (hasFlag(PELLUCID_FLAG_NORMAL))
    s.normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
  float squared = dot(s.normal, s.normal);
  s.hasNormal = squared > 1.0e-8 && squared < 1.0e8; // false for NaN too
  if (s.hasNormal) s.normal *= inversesqrt(squared);
  return s;
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
    return LightSpace(true, shadowHolds(shadow, stored), lightThickness(shadow, receiver, x, incident, stored),
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
  float x = dot(view, toLight);
  if (model == PELLUCID_SHADER_ANGLE_INVERSE_COSINE) return angleInverseCosine(x);
  if (model == PELLUCID_SHADER_ANGLE_POLYNOMIAL) return anglePolynomial(frame.anglePolynomial, x);
  if (model <= PELLUCID_SHADER_ANGLE_COSINE) return clamp(x, 0.0, 1.0);
  return clamp(x * light.cone.z + light.cone.w, 0.0, 1.0); // minimum dot
}

// docs/design.md says why each source is what it is.
Transmitted lightTransmission(LightConstants light, Surface s) {
  Incident incident = incidentLight(light, s.position);
  bool mapped = light.meta.z != 0u;
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

#ifdef GATHER
#include "passes/gather.glsl"
#endif

void main() {
  ivec2 pixel = invocationPixel();
  if (!insideRect(pixel)) return;
  uint value = materialValueAt(pixel);
  uint material = materialIndex(value);
  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there.
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  if (material == 0u) {
    if (starts) imageStore(destinationImage, pixel, vec4(0.0));
    return;
  }
  uint m = material - 1u;

  // All at once and whatever the flags say (a stand-in is bound where an image is missing), so that their
  // latencies overlap: the pass waits for memory more than it computes.
  vec4 source = starts ? vec4(0.0) : texelFetch(sourceImage, pixel, 0);
  // Marked pixels keep their irradiance, and read nothing else.
  bool marked = (value & frame.marks.x) != 0u;
  float frontStored = 0.0, backStored = 0.0;
  vec4 normalTexel = vec4(0.0);
  if (!marked) {
    frontStored = texelFetch(frontDepthImage, pixel, 0).x;
    backStored = texelFetch(backDepthImage, pixel, 0).x;
    normalTexel = texelFetch(normalImage, pixel, 0);
  }
  vec3 irradiance = sanitize(source.rgb);
  float front = marked ? -1.0 : frontDistanceOf(frontStored);
  vec3 arriving = vec3(0.0), visible = vec3(0.0), transmitted = vec3(0.0);
  vec3 thickness = vec3(-1.0);
  if (front > 0.0) {
    Surface s = surfaceAt(pixel, front, frontStored, backStored, normalTexel);
    float mm = frame.camera.range.w;
    if (s.chord >= 0.0) thickness.r = s.chord * mm;
    for (uint i = 0u; i < pass.value.y; ++i) {
      LightConstants light = lights[pass.value.x + i];
#ifdef GATHER
      if (pass.value.w > 0u && light.meta.z != 0u) {
        transmitted += gatherLight(m, light, s, pass.value.w);
        continue;
      }
#endif
      Transmitted t = lightTransmission(light, s);
      vec3 through = t.arriving * t.visible;
      // Most pixels face some lights; T is the expensive part.
      if (t.thickness >= 0.0 && max(through.r, max(through.g, through.b)) > 0.0)
        transmitted += through * materialTransmittance(m, t.thickness * mm);
#ifdef DEBUG_VIEWS
      arriving += t.arriving;
      visible += through;
      if (t.visible > 0.0 && thickness.b < 0.0) thickness.b = t.thickness * mm;
      LightSpace l = lightSpace(light, incidentLight(light, s.position), s.position);
      if (l.inside && l.holds && thickness.g < 0.0) thickness.g = max(l.thickness - l.bias, 0.0) * mm;
#endif
    }
  }
  vec3 result = irradiance + transmitted * materials[m].inverseReflectance.rgb;
#ifdef DEBUG_VIEWS
  uint view = frame.flags.z;
  // The divisors are positive where they are used; nothing arriving shows as 0.
  vec3 some = vec3(greaterThan(arriving, vec3(0.0)));
  if (view == PELLUCID_SHADER_DEBUG_THICKNESS) result = thickness;
  if (view == PELLUCID_SHADER_DEBUG_TRANSMITTANCE) result = some * transmitted / max(visible, vec3(1.0e-30));
  if (view == PELLUCID_SHADER_DEBUG_OCCLUSION) result = some * visible / max(arriving, vec3(1.0e-30));
  imageStore(destinationImage, pixel, vec4(result, source.a));
#else
  writeResult(pixel, result, source.a, pass.value.z == PELLUCID_WRITE_LAST);
#endif
}
