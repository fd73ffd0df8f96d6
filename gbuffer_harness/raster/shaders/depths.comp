#version 450
// Front and back depth as a capture stores them, and how many pixels have them.

layout(local_size_x = 8, local_size_y = 8) in; // kGroup of common/pixel_pass.cpp

layout(push_constant) uniform Push {
  float nothing;       // stored where nothing is
  uint isDevice;       // 1: device depth, else planar distances
  uint greaterIsNearer;
  uint nearestBack;    // 1: the back depth is of the nearest back face, else of the farthest
} push;

layout(set = 0, binding = 0) uniform sampler2D normalPlanar;
layout(set = 0, binding = 1) uniform sampler2D depthNormal;
layout(set = 0, binding = 2) uniform sampler2D backFaces; // in the stored encoding
layout(set = 0, binding = 3) uniform sampler2D faceCount; // of count.frag
layout(set = 0, binding = 4) uniform usampler2D material;
layout(set = 0, binding = 5, r32f) uniform writeonly image2D frontDepth;
layout(set = 0, binding = 6, r32f) uniform writeonly image2D backDepth;
layout(set = 0, binding = 7) buffer Counts { uint counts[3]; }; // DepthCounts

shared uint groupCounts[3];

// Between the front and the nearest back face of a closed object lies nothing of it, or as many entrances
// as exits along the whole ray.
bool isClosed(vec2 count) { return count.x == 0.0 || (push.nearestBack != 0u && count.y == 1.0); }

void main() {
  if (gl_LocalInvocationIndex < 3u) groupCounts[gl_LocalInvocationIndex] = 0u;
  barrier();
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(pixel, imageSize(frontDepth)))) {
    float planar = texelFetch(normalPlanar, pixel, 0).w;
    bool isSurface = planar > 0.0;
    float front = push.isDevice != 0u ? texelFetch(depthNormal, pixel, 0).r : isSurface ? planar : push.nothing;
    float back = texelFetch(backFaces, pixel, 0).r;
    if (isSurface) {
      // At an edge of the silhouette both are one, but for what rounding makes of steep triangles.
      if (push.greaterIsNearer != 0u ? back > front : back < front) back = front;
      if (!isClosed(texelFetch(faceCount, pixel, 0).xy)) back = push.nothing;
      if (texelFetch(material, pixel, 0).r != 0u) {
        atomicAdd(groupCounts[0], 1u);
        if (back == push.nothing) atomicAdd(groupCounts[1], 1u);
      }
    }
    if (back != push.nothing) atomicAdd(groupCounts[2], 1u);
    imageStore(frontDepth, pixel, vec4(front));
    imageStore(backDepth, pixel, vec4(back));
  }
  barrier();
  if (gl_LocalInvocationIndex < 3u && groupCounts[gl_LocalInvocationIndex] > 0u)
    atomicAdd(counts[gl_LocalInvocationIndex], groupCounts[gl_LocalInvocationIndex]);
}
