#version 450
// The rect becomes the whole picture, with temporal antialiasing, and that becomes what a display shows.
#extension GL_GOOGLE_include_directive : require
#include "../../common/shaders/srgb.glsl"
#include "frame.glsl"

layout(set = 0, binding = 1) uniform sampler2D colorImage;
layout(set = 0, binding = 2) uniform sampler2D depthImage;
layout(set = 0, binding = 3) uniform sampler2D history;

layout(location = 0) out vec4 outHistory;
layout(location = 1) out vec4 outPicture;

// Narkowicz 2016, "ACES Filmic Tone Mapping Curve".
vec3 toneMapped(vec3 x) { return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0); }

void main() {
  vec2 uv = gl_FragCoord.xy * frame.extent.zw;
  vec2 at = clamp(uv * frame.rect.xy + frame.jitter.xy, vec2(0.5), frame.rect.xy - 0.5);
  vec3 color = textureLod(colorImage, at * frame.extent.zw, 0.0).rgb;
  vec3 low = color, high = color;
  for (int k = 0; k < 9; ++k) {
    vec2 tap = clamp(at + vec2(k % 3, k / 3) - 1.0, vec2(0.5), frame.rect.xy - 0.5);
    vec3 near = texelFetch(colorImage, ivec2(tap), 0).rgb;
    low = min(low, near);
    high = max(high, near);
  }
  float depth = texelFetch(depthImage, ivec2(at), 0).r;
  vec4 before = frame.previousFromCurrent * vec4(uv * 2.0 - 1.0, depth, 1.0);
  vec2 there = before.xy / before.w * 0.5 + 0.5;
  bool known = frame.jitter.z < 1.0 && all(greaterThan(there, vec2(0.0))) && all(lessThan(there, vec2(1.0)));
  if (known) color = mix(clamp(textureLod(history, there, 0.0).rgb, low, high), color, frame.jitter.z);
  outHistory = vec4(color, 1.0);
  outPicture = vec4(srgb(toneMapped(color)), 1.0);
}
