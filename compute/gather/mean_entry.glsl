// Entry points of coarser levels.
#ifndef PELLUCID_MEAN_ENTRY_GLSL
#define PELLUCID_MEAN_ENTRY_GLSL

// The mean of four entry points, each `texels` wide; kSeveralSurfaces where their depths are further apart than
// slopes of 70 degrees make them: a sample then takes the entry under it.
uvec4 meanOf(uvec4 bits[4], float texels, EntryMapConstants map) {
  float hidden = 0.0, seen = 0.0, cosine = 0.0, exit = 0.0, count = 0.0, sum = 0.0, least = kNoDepth, most = -kNoDepth;
  uint material = 0u;
  vec3 normal = vec3(0.0);
  bool several = false;
  bool perspective = map.meta.z != 0u;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    several = several || bits[i] == kSeveralSurfaces;
    if (!holdsSurface(bits[i])) continue;
    EntryPoint r = unpackEntry(bits[i]);
    // A map's entry points all know their material, or none does. Light enters where it is not 0.
    several = several || (material != 0u && r.material != 0u && r.material != material);
    material = max(material, r.material);
    least = min(least, r.depth);
    most = max(most, r.depth);
    hidden += r.hidden;
    seen += r.seen;
    cosine += r.cosine;
    normal += r.normal;
    sum += r.depth;
    exit += r.exit;
    count += 1.0;
  }
  // Texels are 2 map.seen.x wide, of perspective maps times depth.
  float limit = 3.0 * texels * 2.0 * map.seen.x * (perspective ? max(abs(least), abs(most)) : 1.0);
  if (several || most - least > 2.0 * limit) return kSeveralSurfaces;
  if (count == 0.0) return kNoEntry;
  float squared = dot(normal, normal), inverse = 1.0 / count;
  // Normals towards one light cancel only in rounding.
  if (squared < 1.0e-6) return kSeveralSurfaces;
  return packEntry(EntryPoint(sum * inverse, normal * inversesqrt(squared), 0.25 * hidden, 0.25 * seen, cosine * inverse,
                           exit * inverse, material));
}

#endif
