// Three halves and 16 bits in two words: the layout of colors in packed texels and probes.
#ifndef PELLUCID_HALVES_GLSL
#define PELLUCID_HALVES_GLSL

uvec2 packHalves(vec3 v, uint upper) {
  return uvec2(packHalf2x16(v.rg), (packHalf2x16(vec2(v.b, 0.0)) & 0xFFFFu) | upper << 16);
}

vec3 unpackHalves(uvec2 u) { return vec3(unpackHalf2x16(u.x), unpackHalf2x16(u.y).x); }

#endif
