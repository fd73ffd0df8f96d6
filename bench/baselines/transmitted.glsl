// Inputs of the passes of others that add transmitted light to the irradiance: all lights with a shadow
// map, whose texels are 32-bit floats and read unfiltered, as no device has to filter these.
#ifndef PELLUCID_BASELINE_TRANSMITTED_GLSL
#define PELLUCID_BASELINE_TRANSMITTED_GLSL

#include "frame.glsl"
#include "frame/gbuffer_decode.glsl"

// The source is the irradiance; pass.value.x: lights.
layout(set = 0, binding = 6) readonly buffer Lights { LightConstants lights[]; };
layout(set = 0, binding = 7) readonly buffer Shadows { ShadowConstants shadows[]; };
layout(set = 0, binding = 8) uniform texture2D normalImage; // view space
layout(set = 0, binding = 9) uniform texture2D shadowImage0;
layout(set = 0, binding = 10) uniform texture2D shadowImage1;
layout(set = 0, binding = 11) uniform texture2D shadowImage2;
layout(set = 0, binding = 12) uniform texture2D shadowImage3;

float shadowTexel(uint image, ivec2 texel) {
  switch (image) {
    case 0u: return texelFetch(shadowImage0, texel, 0).x;
    case 1u: return texelFetch(shadowImage1, texel, 0).x;
    case 2u: return texelFetch(shadowImage2, texel, 0).x;
    default: return texelFetch(shadowImage3, texel, 0).x;
  }
}

#include "lib/light.glsl"
#include "lib/shadow.glsl"

// View space, scene units.
struct Receiver {
  vec3 position, normal;
};

// False where the stencil test of the rasterizing originals is.
bool readReceiver(ivec2 pixel, out Receiver receiver) {
  receiver = Receiver(vec3(0.0), vec3(0.0));
  if (isSkipped(pixel)) return false;
  ViewRay ray = viewRay(frame.camera, pixel);
  vec3 normal = texelFetch(normalImage, pixel, 0).xyz;
  // A normal of no length stays one; a pixel without depth lies at the eye, where no map sees it.
  receiver = Receiver(ray.origin + max(planarAt(pixel), 0.0) * ray.direction,
                      normal * inversesqrt(max(dot(normal, normal), 1.0e-8)));
  return true;
}

// mm along the light's ray from the first of its maps that contains the point to the point, below 0 where it is nearer to
// the light than the map's surface; false where no map says so.
bool thicknessAt(LightConstants light, Incident incident, vec3 position, out float thickness) {
  thickness = 0.0;
  for (uint i = 0u; i < light.meta.z; ++i) {
    ShadowConstants shadow = shadows[light.meta.y + i];
    ShadowReceiver r = projectReceiver(shadow, position);
    if (r.beyond > 0.0) continue;
    float stored = shadowTexel(shadow.meta.x, r.texel);
    if (!shadowHolds(shadow.meta, stored)) return false;
    thickness = lightThickness(storedRay(shadow, r, position, incident), stored) * frame.camera.range.w;
    return true;
  }
  return false;
}

#endif
