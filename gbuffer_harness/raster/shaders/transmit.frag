#version 450
// The back-face pass when it also computes the light that comes through: camera-space thickness,
// transmittance and lighting of the nearest back face, so that the frame needs no dispatch for them (Whelan
// 2009, 6.2.4). What an engine does with compute/lib in a shader of its own.
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require
#include "draw.glsl"
#include "frame/gbuffer_decode.glsl"
#include "lib/surface.glsl"
#include "shared/pellucid_shared.h"

layout(location = 1) in vec2 uv;
layout(location = 8) in float alpha;

layout(location = 0) out vec4 outTransmitted; // rgb: transmitted / rho, to be added to the irradiance

// The bindings of the module's fused dispatch, after the five of draw.glsl (kOwnBindings of draw.cpp).
#define PLANNED_BINDINGS 5
layout(set = 0, binding = PLANNED_BINDINGS + PELLUCID_BINDING_FRAME) uniform Frame { FrameConstants frame; };
layout(set = 0, binding = PLANNED_BINDINGS + PELLUCID_BINDING_LIGHTS) readonly buffer Lights {
  LightConstants lights[];
};
layout(set = 0, binding = PLANNED_BINDINGS + PELLUCID_BINDING_SHADOWS) readonly buffer Shadows {
  ShadowConstants shadows[];
};
layout(set = 0, binding = PLANNED_BINDINGS + PELLUCID_BINDING_MATERIALS) readonly buffer Materials {
  MaterialConstants materials[];
};
layout(set = 0, binding = PLANNED_BINDINGS + PELLUCID_BINDING_MATERIAL) uniform utexture2D materialImage;
#define SHADOW_BINDING PLANNED_BINDINGS + PELLUCID_BINDING_SHADOW_IMAGES
#include "frame/shadow_images.glsl"
vec2 slope; // of the device depth of the triangle that is drawn, which is affine over pixels

float distanceOf(ivec2 pixel, uint material, bool back) {
  if (!contains(ivec4(frame.rect), pixel + frame.lattice.xy) || decodeMaterial(texelFetch(materialImage, pixel, 0)) != material) return -1.0;
  vec2 steps = vec2(pixel) + 0.5 - gl_FragCoord.xy;
  return planarDistance(frame.camera, back ? gl_FragCoord.z + dot(slope, steps) : texelFetch(earlierDepth, pixel, 0).r);
}

// The pass draws for one light with a direction.
vec3 hiddenIrradianceOf(ivec2 pixel) { return vec3(0.0); }

#define PELLUCID_OWN_INPUTS
#include "translucency/transmission.glsl"

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  ViewRay ray = viewRay(frame.camera, inLattice(pixel));
  slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z)); // before invocations part
  float front = texelFetch(earlierDepth, pixel, 0).r;
  uint material = decodeMaterial(texelFetch(materialImage, pixel, 0));
  bool sameObject = texelFetch(frontObject, pixel, 0).a == draw.addedColor.a;
  if (isHole(uv, alpha) || !sameObject || !isNearer(front, gl_FragCoord.z)) discard;
  if (material == 0u || material > frame.flags.y) discard;

  float through = chord(planarDifference(frame.camera, gl_FragCoord.z, front), ray);
  Surface s = surfaceOf(pixel, ray, planarDistance(frame.camera, front), through, material);
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < draw.ids.w; ++i)
    sum += exitanceOf(lightTransmission(lights[i], s, pixel), material - 1u);
  outTransmitted = vec4(sum * materials[material - 1u].inverseReflectance.rgb, 1.0);
}
