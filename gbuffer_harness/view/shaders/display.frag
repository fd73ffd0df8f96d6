#version 450
#extension GL_GOOGLE_include_directive : require
// The shown part of a frame, as pixels of the screen. Inputs that the frame does not have are images of one texel.
layout(set = 0, binding = 0) uniform sampler2D resultImage;
layout(set = 0, binding = 1) uniform sampler2D irradianceImage;
layout(set = 0, binding = 2) uniform sampler2D albedoImage;
layout(set = 0, binding = 3) uniform usampler2D materialImage;
layout(set = 0, binding = 4) uniform sampler2D depthImage;
layout(set = 0, binding = 5) uniform sampler2D truthImage;

layout(push_constant) uniform Push {
  vec2 origin;      // of the picture on the screen, pixels
  vec2 extent;      // of the picture, texels
  float scale;      // pixels of the screen a texel
  int shown;        // Shown
  int channel;      // of false colors
  float exposure;
  float low, high;  // ends of the false colors
  int isLegend;     // 1: the false colors themselves, bottom to top
  int hasTruth;
  int isFalseColor;
} push;

layout(location = 0) out vec4 color;

#include "../../common/shaders/srgb.glsl"

const int kAfter = 0, kBefore = 1, kThrough = 2, kDifference = 3, kTruth = 4, kDebug = 5, kFrontDepth = 6,
          kAlbedo = 7, kMaterial = 8;

vec4 fetch(sampler2D image, ivec2 p) { return texelFetch(image, min(p, textureSize(image, 0) - 1), 0); }
uint materialAt(ivec2 p) { return texelFetch(materialImage, min(p, textureSize(materialImage, 0) - 1), 0).r; }

vec3 before(ivec2 p) { return fetch(irradianceImage, p).rgb * fetch(albedoImage, p).rgb; }
vec3 after(ivec2 p) { return materialAt(p) != 0u ? fetch(resultImage, p).rgb : before(p); }

vec3 valueAt(ivec2 p) {
  switch (push.shown) {
    case kBefore: return before(p);
    case kThrough: return materialAt(p) != 0u ? max(fetch(resultImage, p).rgb - before(p), 0.0) : vec3(0.0);
    case kDifference: return abs(after(p) - (push.hasTruth != 0 ? fetch(truthImage, p).rgb : before(p)));
    case kTruth: return fetch(truthImage, p).rgb;
    case kDebug: return fetch(resultImage, p).rgb;
    case kFrontDepth: return fetch(depthImage, p).rrr;
    case kAlbedo: return fetch(albedoImage, p).rgb;
    case kMaterial: return vec3(materialAt(p));
    default: return after(p);
  }
}

// 0..1 to black, blue, magenta, orange, yellow, white, whose luminance rises all the way; already sRGB.
vec3 falseColor(float t) {
  const vec3 stops[6] = vec3[](vec3(0.0), vec3(0.16, 0.11, 0.55), vec3(0.63, 0.16, 0.58), vec3(0.93, 0.41, 0.23),
                               vec3(0.98, 0.79, 0.20), vec3(1.0));
  float x = clamp(t, 0.0, 1.0) * 5.0;
  int i = min(int(x), 4);
  return mix(stops[i], stops[i + 1], x - float(i));
}

bool isFinite(vec3 c) { return !(any(isnan(c)) || any(isinf(c))); }

void main() {
  if (push.isLegend != 0) {
    color = vec4(falseColor(1.0 - (gl_FragCoord.y - push.origin.y) / push.extent.y), 1.0);
    return;
  }
  // Enlarged texels stay squares; of a picture that is shown smaller, the texels under the pixel are averaged.
  vec2 first = (gl_FragCoord.xy - 0.5 - push.origin) / push.scale;
  int samples = clamp(int(ceil(1.0 / push.scale)), 1, 8);
  vec3 sum = vec3(0.0);
  for (int y = 0; y < samples; ++y)
    for (int x = 0; x < samples; ++x) {
      vec2 at = first + (vec2(x, y) + 0.5) / (float(samples) * push.scale);
      sum += valueAt(ivec2(clamp(at, vec2(0.0), push.extent - 1.0)));
    }
  vec3 value = sum / float(samples * samples);
  if (!isFinite(value)) {
    color = vec4(1.0, 0.0, 1.0, 1.0);
    return;
  }
  if (push.isFalseColor != 0) {
    float range = push.high - push.low;
    color = vec4(falseColor(range > 0.0 ? (value[push.channel] - push.low) / range : 0.0), 1.0);
    return;
  }
  color = vec4(srgb(value * push.exposure), 1.0);
}
