// Samples on a disk, distributed as Burley's profile of the widest channel: Golubev 2018, "Efficient
// screen-space subsurface scattering using Burley's normalized diffusion in real-time" (SIGGRAPH, Advances in
// Real-Time Rendering). kernel[0].rgb: Burley distances (mm); then per sample x, y: direction; z: radius (mm);
// w: 1 / probability density (mm^2). pass.value.x: samples.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "frame.glsl"

// R(r), Christensen & Burley 2015 eq. 3.
vec3 burley(vec3 d, float r) {
  const float kEightPi = 25.132741;
  return (exp(-r / d) + exp(-r / (3.0 * d))) / (kEightPi * d * r);
}

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (isSkipped(pixel)) return;
  float front = distanceAt(pixel);
  vec2 size = pixelSize(frame.camera, front);
  // A rotation for each pixel turns banding into noise: interleaved gradient noise, Jimenez 2014.
  float angle = 6.2831853 * fract(52.9829189 * fract(dot(vec2(pixel), vec2(0.06711056, 0.00583715))));
  mat2 rotation = mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
  vec3 sum = vec3(0.0), weights = vec3(0.0);
  for (uint i = 1u; i <= pass.value.x; ++i) {
    vec4 s = kernel[i];
    ivec2 at = ivec2(floor(vec2(pixel) + 0.5 + rotation * s.xy * (s.z / size)));
    bool inside = all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, imageEnd()));
    if (!inside || texelFetch(materialImage, at, 0).x == 0u) continue;
    float gap = (distanceAt(at) - front) * frame.camera.range.w;
    vec3 weight = burley(kernel[0].rgb, sqrt(s.z * s.z + gap * gap)) * s.w;
    sum += weight * texelFetch(sourceImage, at, 0).rgb;
    weights += weight;
  }
  // Every sample may have missed, at a thin part.
  vec3 center = texelFetch(sourceImage, pixel, 0).rgb;
  vec3 result = mix(center, sum / weights, greaterThan(weights, vec3(0.0)));
  imageStore(destinationImage, pixel, vec4(result, 1.0));
}
