// The fused dispatch where all there is to add is the light of one directional light with a shadow map of device depth,
// through materials of two exponentials, on surfaces with normals and device depth. Texel and depth in the map are affine
// in the pixel and, along its ray, in the planar distance, so that no position is needed. It is translucency.comp with
// what never happens taken out, and few branches.
#version 460
#extension GL_EXT_control_flow_attributes : require
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_EXT_spirv_intrinsics : require
#extension GL_GOOGLE_include_directive : require

#define TILE_ROWS PELLUCID_DIRECTIONAL_ROWS
#ifdef QUADS
#include "passes/quad_tile.glsl"
#else
#include "passes/tile.glsl"
#endif
#include "lib/saturate.glsl"
#include "lib/surface.glsl"
#include "lib/transmittance.glsl"
#include "passes/normal_image.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Light { DirectionalConstants light; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_SHADOW_IMAGES) uniform texture2D shadowImage;

// Where the light enters, without a normal: the view ray stands in, as in lib/transmission.glsl.
float cosineOfView(ivec2 pixel) {
  float x = dot(normalize(viewRay(frame.camera, pixel).direction), light.toLight.xyz);
  return clamp(x * light.cone.x + light.cone.y, 0.0, 1.0);
}

float hiddenCosine(ivec2 pixel, vec3 normal) {
  float squared = dot(normal, normal);
  if (hasDirection(squared))
    return clamp(-dot(normal, light.toLightFromNormal.xyz) * inversesqrt(squared), 0.0, 1.0);
  return cosineOfView(pixel);
}

void main() {
  ivec2 tile = evenTile();
  // All loads whatever they will be needed for, so that their latencies overlap.
  uint value[kPixels];
  vec4 source[kPixels];
  vec3 normal[kPixels];
  float front[kPixels], stored[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    ivec2 at = withinRect(tile + pixelInTile(i));
    value[i] = materialValueAt(at);
    source[i] = texelFetch(sourceImage, at, 0);
    front[i] = texelFetch(frontDepthImage, at, 0).x;
    normal[i] = decodeNormal(texelFetch(normalImage, at, 0));
  }
#ifdef QUADS
  vec3 quadNormal = normalOfQuad();
#endif
  // Where rays start and how they run, in the map's texels and depth.
  vec2 first = vec2(tile + pixelInTile(0));
  vec3 origin = light.originBase.xyz + first.x * light.originX.xyz + first.y * light.originY.xyz;
  vec3 direction = light.directionBase.xyz + first.x * light.directionX.xyz + first.y * light.directionY.xyz;
  vec3 inMap[kPixels];
  bool inside[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    front[i] = planarDistance(frame.camera, front[i]);
    float rows = float(GROUP_ROWS * i);
    inMap[i] = origin + rows * light.originY.xyz + front[i] * (direction + rows * light.directionY.xyz);
    vec2 at = clamp(inMap[i].xy, vec2(0.0), light.texels.xy);
    inside[i] = at == inMap[i].xy; // false for NaN
    stored[i] = texelFetch(shadowImage, ivec2(at), 0).x;
  }

  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there.
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  // Colors in units of the largest half: what is clamped to 1 is clamped to that, at no cost.
  float unit = starts ? 0.0 : 1.0 / kLargestHalf;
  uint material[kPixels], lit[kPixels];
  bool writes[kPixels];
  vec3 color[kPixels];
  float thickness[kPixels], cosine[kPixels];
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    ivec2 pixel = tile + pixelInTile(i);
    bool within = pixel == withinRect(pixel);
    uint index = materialIndex(value[i]);
    material[i] = within ? index : 0u;
    writes[i] = within && (starts || index != 0u);
    color[i] = saturate(unit * source[i].rgb);
    thickness[i] = max((inMap[i].z - stored[i]) * light.depth.x - light.depth.y, 0.0); // mm
    // By all(), as each && may become a branch.
    bool holds = all(bvec3(stored[i] >= 0.0, stored[i] <= 1.0, stored[i] != light.depth.z));
    bool thin = thickness[i] <= frame.filterAndLimit.w;
    // Marked pixels keep their irradiance.
    bool marked = (value[i] & frame.marks.x) != 0u;
    bool through = !marked && all(bvec4(front[i] > 0.0, inside[i], holds, thin));
    cosine[i] = hiddenCosine(pixel, normal[i]);
    lit[i] = through ? material[i] : 0u;
  }
  // Material by material of these pixels, which mostly have one: its constants are loaded once.
  for (;;) {
    uint m = 0u;
    [[unroll]] for (int i = 0; i < kPixels; ++i)
      m = max(m, lit[i]);
    if (m == 0u) break;
    vec4 r = materials[m - 1u].transmittance[0], g = materials[m - 1u].transmittance[1],
         b = materials[m - 1u].transmittance[2];
    vec3 entering = (1.0 / kLargestHalf) * light.entering.rgb * materials[m - 1u].inverseReflectance.rgb;
    [[unroll]] for (int i = 0; i < kPixels; ++i) {
      bool mine = lit[i] == m;
      float d = mine ? thickness[i] : 0.0; // of others it may be anything
      vec3 t = vec3(transmittanceExp2(r, d), transmittanceExp2(g, d), transmittanceExp2(b, d));
      vec3 arriving = (mine ? cosine[i] : 0.0) * entering;
      color[i] = clamp(color[i] + arriving * clamp(t, vec3(0.0), vec3(1.0)), vec3(0.0), vec3(1.0));
      lit[i] = mine ? 0u : lit[i];
    }
  }

  // One branch for all pixels, as branches cost more than what is in them.
  if (tinted(pass.value.z == PELLUCID_WRITE_LAST))
    [[unroll]] for (int i = 0; i < kPixels; ++i)
      color[i] = min(color[i] * albedoAt(withinRect(tile + pixelInTile(i))), vec3(1.0));
  [[unroll]] for (int i = 0; i < kPixels; ++i) {
    color[i] = asStored(kLargestHalf * color[i]);
    if (writes[i])
      imageStore(destinationImage, tile + pixelInTile(i), vec4(color[i], starts ? 0.0 : source[i].a));
#ifdef QUADS
    keepPixel(pixelInTile(i), asHalves(color[i]), front[i], material[i]);
#endif
  }
#ifdef QUADS
  barrier();
  writeQuad(quadNormal);
#endif
}
