// Thickness, transmittance, occlusion and the addition to irradiance, fused. PHYSICS: the exitance
// T(d) E_back is added as T(d)/rho E_back, so that albedo times the diffused sum is T E_back.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "passes/bindings.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(set = 0, binding = PELLUCID_BINDING_SHADOWS) uniform Shadows { ShadowConstants shadows[PELLUCID_DISPATCH_SHADOWS]; };
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

#include "lib/transmission.glsl"

Surface surfaceAt(ivec2 pixel, float front, float frontStored, float backStored, vec4 normalTexel) {
  ViewRay ray = viewRay(frame.camera, pixel);
  float along = -1.0;
  if (hasFlag(PELLUCID_FLAG_CHORD) && hasFlag(PELLUCID_FLAG_BACK_DEPTH)) {
    bool backViewZ = hasFlag(PELLUCID_FLAG_BACK_VIEW_Z);
    float back = backViewZ ? planarDistanceViewZ(backStored) : planarDistance(frame.camera, backStored);
    bool device = !backViewZ && !hasFlag(PELLUCID_FLAG_FRONT_VIEW_Z);
    float difference = device ? planarDifference(frame.camera, backStored, frontStored) : back - front;
    if (back > 0.0) along = chord(difference, ray);
  }
  vec3 normal = vec3(0.0);
  if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
  return makeSurface(ray, front, along, normal);
}

#ifdef GATHER
#include "passes/gather_tile.glsl"
#else
void main() {
  ivec2 pixel = invocationPixel();
  if (!insideRect(pixel)) return;
  // All at once and whatever the flags say (a stand-in is bound where an image is missing), so that their
  // latencies overlap: the pass waits for memory more than it computes.
  uint value = materialValueAt(pixel);
  vec4 source = texelFetch(sourceImage, pixel, 0);
  float frontStored = texelFetch(frontDepthImage, pixel, 0).x;
  float backStored = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  vec4 normalTexel = texelFetch(normalImage, pixel, 0);
  uint material = materialIndex(value);
  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there.
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  if (material == 0u) {
    if (starts) imageStore(destinationImage, pixel, vec4(0.0));
    return;
  }
  uint m = material - 1u;

  if (starts) source = vec4(0.0);
  // Marked pixels keep their irradiance.
  bool marked = (value & frame.marks.x) != 0u;
  vec3 irradiance = sanitize(source.rgb);
  float front = marked ? -1.0 : frontDistanceOf(frontStored);
  vec3 arriving = vec3(0.0), visible = vec3(0.0), transmitted = vec3(0.0);
  vec3 thickness = vec3(-1.0);
  if (front > 0.0) {
    Surface s = surfaceAt(pixel, front, frontStored, backStored, normalTexel);
    float mm = frame.camera.range.w;
    if (s.chord >= 0.0) thickness.r = s.chord * mm;
    for (uint i = 0u; i < pass.value.y; ++i) {
      LightConstants light = lights[i];
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
#endif
