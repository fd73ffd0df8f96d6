// For engines with a multisampled G-buffer: a dispatch before the module's, which makes the frame's images of one sample. Compile it
// with -I compute. Define PELLUCID_NO_BACK_DEPTH or PELLUCID_NO_ALBEDO where there is no such image.
//
// The dispatch keeps the samples of a pixel's most frequent material. The irradiance's alpha becomes the part of the samples with
// any material, and Pellucid's output keeps it. Clear the output to 0, and blend it over specular light with SRC_ALPHA and ONE.
#version 450
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "lib/multisample.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(push_constant) uniform Pass {
  uvec4 rect;                       // x, y, width, height
  uint materialMask, materialShift; // of the frame; mask 0: all bits
};
layout(set = 0, binding = 0) uniform texture2DMS frontDepthSamples;
layout(set = 0, binding = 1) uniform utexture2DMS materialSamples;
layout(set = 0, binding = 2) uniform texture2DMS irradianceSamples;
// The device has shaderStorageImageWriteWithoutFormat. Depths and materials are copied, and have the formats of the samples.
layout(set = 0, binding = 3) uniform writeonly image2D frontDepth;
layout(set = 0, binding = 4) uniform writeonly uimage2D material;
layout(set = 0, binding = 5) uniform writeonly image2D irradiance; // alpha: part of the samples with a material
#ifndef PELLUCID_NO_BACK_DEPTH
layout(set = 0, binding = 6) uniform texture2DMS backDepthSamples;
layout(set = 0, binding = 7) uniform writeonly image2D backDepth;
#endif
#ifndef PELLUCID_NO_ALBEDO
layout(set = 0, binding = 8) uniform texture2DMS albedoSamples;
layout(set = 0, binding = 9) uniform writeonly image2D albedo;
#endif

vec3 meanOf(texture2DMS image, ivec2 pixel, uint samples) {
  vec3 sum = vec3(0.0);
  for (uint left = samples; left != 0u; left &= left - 1u) sum += texelFetch(image, pixel, findLSB(left)).rgb;
  return sum / float(bitCount(samples));
}

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, rect.zw))) return;
  ivec2 pixel = ivec2(rect.xy + gl_GlobalInvocationID.xy);
  int count = min(textureSamples(materialSamples), kMostSamples);
  uint mask = materialMask == 0u ? ~0u : materialMask, materials[kMostSamples];
  for (int i = 0; i < count; ++i) materials[i] = (texelFetch(materialSamples, pixel, i).r & mask) >> materialShift;
  SampleChoice choice = chooseSamples(materials, count);
  imageStore(frontDepth, pixel, texelFetch(frontDepthSamples, pixel, choice.first));
  imageStore(material, pixel, texelFetch(materialSamples, pixel, choice.first));
  imageStore(irradiance, pixel, vec4(meanOf(irradianceSamples, pixel, choice.samples), choice.coverage));
#ifndef PELLUCID_NO_BACK_DEPTH
  imageStore(backDepth, pixel, texelFetch(backDepthSamples, pixel, choice.first));
#endif
#ifndef PELLUCID_NO_ALBEDO
  imageStore(albedo, pixel, vec4(meanOf(albedoSamples, pixel, choice.samples), 1.0));
#endif
}
