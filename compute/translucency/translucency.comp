// Thickness, transmittance, occlusion and the addition to irradiance, fused. PHYSICS: the exitance
// T(d) E_back is added as T(d)/rho E_back, so that albedo times the diffused sum is T E_back.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "frame/tile.glsl"
#include "translucency/lit_surface.glsl"

layout(constant_id = PELLUCID_CONSTANT_DEBUG_VIEWS) const bool kDebugViews = false;

#include "translucency/lit_texel.glsl"

void main() {
  ivec2 tile = evenTile();
  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there.
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  Texels texels[kPixels];
  for (int i = 0; i < kPixels; ++i)
    texels[i] = fetch(withinRect(tile + pixelInTile(i)));
  for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = tile + pixelInTile(i);
    Texels t = texels[i];
    uint material = insideRect(pixel) ? materialIndex(t.value) : 0u;
    float depth = frontDistanceOf(t.front);
    if (starts) t.source = vec4(0.0);
    if (material != 0u) {
      vec3 result = resultAt(pixel, t, depth, material - 1u);
      if (kDebugViews)
        imageStore(destinationImage, pixel, vec4(result, t.source.a));
      else
        writeResult(pixel, result, t.source.a, pass.value.z == PELLUCID_WRITE_LAST);
    } else if (starts && insideRect(pixel)) {
      imageStore(destinationImage, pixel, vec4(0.0));
    }
  }
}
