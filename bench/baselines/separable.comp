// One axis of Jimenez et al. 2015, "Separable subsurface scattering", with surface following.
// kernel[i]: rgb: weight; w: offset (mm); the center is first. pass.value.z: taps.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isSkipped(pixel)) return;
  vec2 axis = vec2(pass.value.xy);
  float front = distanceAt(pixel);
  float size = dot(pixelSize(frame.camera, front), axis);
  vec2 middle = vec2(pixel) + 0.5;
  vec3 center = colorAt(middle);
  vec3 sum = kernel[0].rgb * center;
  // The authors' code fades a tap out over 300 * distanceToProjectionWindow * sssWidth in depth, which with
  // the values it ships is four times the filter's half width.
  float reach = 4.0 * abs(kernel[1].w);
  for (uint i = 1u; i < pass.value.z; ++i) {
    vec2 at = middle + axis * (kernel[i].w / size);
    float gap = abs(distanceAt(ivec2(floor(at))) - front) * frame.camera.range.w;
    sum += kernel[i].rgb * mix(colorAt(at), center, clamp(gap / reach, 0.0, 1.0));
  }
  imageStore(destinationImage, pixel, vec4(sum, 1.0));
}
