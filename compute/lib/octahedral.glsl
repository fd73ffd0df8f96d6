// Octahedral map of a unit vector; Cigolle et al. 2014, "oct".
#ifndef PELLUCID_OCTAHEDRAL_GLSL
#define PELLUCID_OCTAHEDRAL_GLSL

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

#endif
