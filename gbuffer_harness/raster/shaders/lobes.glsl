// The two lobes of a surface: light that it reflects, and light that comes through; Surface of model.h.
#ifndef PELLUCID_RASTER_LOBES_GLSL
#define PELLUCID_RASTER_LOBES_GLSL
#include "draw.glsl"

// Mean over the pixel's footprint: there are no mip levels.
vec4 meanOf(sampler2D image, vec2 uv) {
  const int n = 4;
  vec2 dx = dFdx(uv), dy = dFdy(uv);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < n * n; ++i) {
    vec2 offset = (vec2(i % n, i / n) + 0.5) / float(n) - 0.5;
    sum += textureLod(image, uv + dx * offset.x + dy * offset.y, 0.0);
  }
  return sum / float(n * n);
}

struct Lobes {
  vec3 reflected, through;
};

Lobes lobesOf(vec2 uv, vec2 lobeUv, vec3 vertexColor) {
  vec4 map = meanOf(lobeMap, lobeUv);
  float displaced = unpackHalf2x16(draw.ids.x).y;
  Lobes lobes;
  lobes.reflected = meanOf(baseColorTexture, uv).rgb * draw.baseColor.rgb * vertexColor * (1.0 - displaced * map.a);
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
