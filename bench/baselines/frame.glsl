// What every baseline reads: the frame as the module binds it, and a kernel made on the CPU.
#ifndef PELLUCID_BASELINE_FRAME_GLSL
#define PELLUCID_BASELINE_FRAME_GLSL

#include "lib/camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(push_constant) uniform Pass { uvec4 value; } pass;
layout(set = 0, binding = 0) uniform Frame { FrameConstants frame; };
layout(set = 0, binding = 1) readonly buffer Kernel { vec4 kernel[]; };
layout(set = 0, binding = 2) uniform texture2D frontDepthImage;
layout(set = 0, binding = 3) uniform utexture2D materialImage;
layout(set = 0, binding = 4) uniform sampler2D sourceImage; // linear, as the algorithms' authors sample it
layout(set = 0, binding = 5, rgba16f) uniform writeonly image2D destinationImage;

ivec2 imageEnd() { return ivec2(frame.rect.zw); }

// The stencil test of the rasterizing originals.
bool isSkipped(ivec2 pixel) {
  return any(greaterThanEqual(pixel, imageEnd())) || texelFetch(materialImage, pixel, 0).x == 0u;
}

// Planar distance, scene units; not above 0 where nothing is. Beyond the image: that of its edge.
float planarAt(ivec2 pixel) {
  float stored = texelFetch(frontDepthImage, clamp(pixel, ivec2(0), imageEnd() - 1), 0).x;
  bool viewZ = (frame.flags.x & PELLUCID_FLAG_FRONT_VIEW_Z) != 0u;
  return viewZ ? planarDistanceViewZ(stored) : planarDistance(frame.camera, stored);
}

// Far away where nothing is.
float distanceAt(ivec2 pixel) {
  float planar = planarAt(pixel);
  return planar > 0.0 ? planar : kNoDepth;
}

vec3 colorAt(vec2 position) { // pixels; (0.5, 0.5) is the center of the first
  return textureLod(sourceImage, position / vec2(imageEnd()), 0.0).rgb;
}

#endif
