// One axis of one Gaussian of d'Eon and Luebke 2007 (GPU Gems 3, ch. 14), in screen space as Jimenez et al.
// 2009 ("Screen-space perceptual rendering of human skin"): each blurs the one before, and the vertical passes
// add up. kernel[i]: rgb: weight of Gaussian i; w: standard deviation (mm) from Gaussian i - 1 to i.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

layout(set = 0, binding = 6, rgba16f) uniform image2D sumImage;

// At multiples of the standard deviation; GPU Gems 3, listing 14-3.
const float kTaps[7] = float[](0.006, 0.061, 0.242, 0.383, 0.242, 0.061, 0.006);

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isSkipped(pixel)) return;
  ivec2 axis = ivec2(pass.value.xy);
  vec4 gaussian = kernel[pass.value.z];
  float mm = frame.camera.range.w;
  float gradient = 0.5 * abs(distanceAt(pixel + axis) - distanceAt(pixel - axis)) * mm;
  // Stretch of Jimenez et al. 2009, eq. 1: alpha / (d + beta |grad d|), with alpha / d made exact for any
  // camera by the pixel's size, and beta such that a 45 degree slope gets its true length.
  const float kBeta = 0.41421356;
  float size = dot(pixelSize(frame.camera, distanceAt(pixel)), vec2(axis)) + kBeta * gradient;
  vec2 spread = vec2(axis) * (gaussian.w / size);
  vec3 blurred = vec3(0.0);
  for (int i = 0; i < 7; ++i) blurred += kTaps[i] * colorAt(vec2(pixel) + 0.5 + float(i - 3) * spread);
  blurred /= 1.001; // the sum of the taps as printed
  imageStore(destinationImage, pixel, vec4(blurred, 1.0));
  if (axis.y == 1) {
    vec3 before = pass.value.z > 0u ? imageLoad(sumImage, pixel).rgb : vec3(0.0);
    imageStore(sumImage, pixel, vec4(before + gaussian.rgb * blurred, 1.0));
  }
}
