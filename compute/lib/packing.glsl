// Packed vectors: unit vectors in two numbers, colors in two words.
#ifndef PELLUCID_PACKING_GLSL
#define PELLUCID_PACKING_GLSL

// ---- Octahedral map of a unit vector; Cigolle et al. 2014, "oct"

vec2 octahedral(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z)); // n is unit: the sum is at least 1
  vec2 sides = vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  return n.z < 0.0 ? (1.0 - abs(p.yx)) * sides : p;
}

vec3 fromOctahedral(vec2 p) {
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  float fold = max(-n.z, 0.0);
  n.xy -= vec2(n.x < 0.0 ? -fold : fold, n.y < 0.0 ? -fold : fold);
  return normalize(n);
}

// ---- Three halves and 16 bits in two words: the layout of colors in packed texels and probes

uvec2 packHalves(vec3 v, uint upper) {
  return uvec2(packHalf2x16(v.rg), (packHalf2x16(vec2(v.b, 0.0)) & 0xFFFFu) | upper << 16);
}

vec3 unpackHalves(uvec2 u) { return vec3(unpackHalf2x16(u.x), unpackHalf2x16(u.y).x); }

#endif
