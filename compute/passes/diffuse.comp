// One axis of the depth-aware diffusion. Offsets are fixed lengths on the surface, so a tap stands for
// the cell of pixels around it; its weight falls with the depth gap as the profile's Gaussians do, and
// the weights that remain are renormalized: constant irradiance stays constant whatever is left out.
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "passes/bindings.glsl"

layout(set = 0, binding = PELLUCID_BINDING_KERNELS) readonly buffer Kernels { KernelConstants kernels[]; };

void main() {
  ivec2 pixel = invocationPixel();
  if (!insideRect(pixel)) return;
  uint material = materialAt(pixel);
  if (material == 0u) return;
  uint m = material - 1u;

  vec4 source = texelFetch(sourceImage, pixel, 0);
  vec3 sum = sanitize(source.rgb) * kernels[m].tap[0].rgb;
  vec3 weights = kernels[m].tap[0].rgb;
  float front = frontDistance(pixel);
  ivec2 axis = ivec2(pass.value.xy);
  float size = dot(pixelSize(frame.camera, front), vec2(axis));
  // Without a front surface or a pixel size there is no scale to diffuse over.
  int taps = front > 0.0 && size > 0.0 ? PELLUCID_KERNEL_TAPS : 1;
  for (int i = 1; i < taps; ++i) {
    vec4 tap = kernels[m].tap[i];
    // The clamp keeps a kernel wider than any image within int; such a tap falls outside the rect.
    int offset = int(min(tap.w / size + 0.5, 1.0e6));
    for (int side = -1; side <= 1; side += 2) {
      ivec2 at = pixel + side * offset * axis;
      if (!insideRect(at) || materialAt(at) != material) continue;
      float depth = frontDistance(at);
      if (!(depth > 0.0)) continue;
      float gap = (depth - front) * frame.camera.range.w;
      vec3 weight = tap.rgb * exp(-gap * gap * kernels[m].tapFalloff[i].rgb);
      sum += weight * sanitize(texelFetch(sourceImage, at, 0).rgb);
      weights += weight;
    }
  }
  // tap[0] is > 0 for every channel, so the divisor is.
  writeResult(pixel, sum / weights, source.a, pass.value.z != 0u);
}
