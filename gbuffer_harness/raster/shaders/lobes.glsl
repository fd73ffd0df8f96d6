// The two lobes of a surface: light that it reflects, and light that comes through; Surface of model.h.
#ifndef PELLUCID_RASTER_LOBES_GLSL
#define PELLUCID_RASTER_LOBES_GLSL
#include "draw.glsl"

// Mean over the pixel's footprint: there are no mip levels. varies: false for an image of one texel.
vec4 meanOf(sampler2D image, vec2 uv, bool varies) {
  int n = varies ? 4 : 1;
  float part = varies ? 0.25 : 1.0;
  vec2 dx = dFdx(uv), dy = dFdy(uv);
  vec4 sum = vec4(0.0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      vec2 offset = (vec2(x, y) + 0.5) * part - 0.5;
      sum += textureLod(image, uv + dx * offset.x + dy * offset.y, 0.0);
    }
  return sum * (part * part);
}

struct Lobes {
  vec3 reflected, through;
};

Lobes lobesOf(vec2 uv, vec2 lobeUv, vec3 vertexColor) {
  vec4 map = meanOf(lobeMap, lobeUv, (draw.ids.z & HAS_LOBES) != 0u);
  float displaced = unpackHalf2x16(draw.ids.x).y;
  Lobes lobes;
  vec4 color = meanOf(baseColorTexture, uv, (draw.ids.z & HAS_COLOR) != 0u);
  lobes.reflected = color.rgb * draw.baseColor.rgb * vertexColor * (1.0 - displaced * map.a);
  lobes.through = draw.addedColor.rgb * map.rgb * map.a;
  return lobes;
}

bool areApart() { return (draw.ids.x & LOBES_APART) != 0u; }

// Apart, the albedo is that of light that comes through; it also carries the reflected light, and must not be 0.
vec3 albedoOf(Lobes lobes) {
  const float least = 1.0 / 1024.0;
  return areApart() ? max(lobes.through, least) : lobes.reflected + lobes.through;
}

// Factor that makes the albedo the color of reflected light.
vec3 reflectedShare(Lobes lobes) {
  float backscatter = unpackHalf2x16(draw.ids.y).y;
  return areApart() ? (lobes.reflected + backscatter * lobes.through) / albedoOf(lobes) : vec3(1.0);
}

#endif
