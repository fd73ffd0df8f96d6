// Entry points of coarser levels.

// A group's entry points. Each level is made from one array in the first part of the other, by turns.
shared uvec4 entries[GROUP_SIDE * GROUP_SIDE], means[GROUP_SIDE * GROUP_SIDE / 4];

// The mean of four entry points; kSeveralSurfaces where their depths are further apart than slopes of 70 degrees make them:
// a sample then takes the entry under it. `limit`: depth change from one to the next, scene units; perspective: over depth.
uvec4 meanOf(uvec4 bits[4], float limit, bool perspective) {
  float hidden = 0.0, seen = 0.0, cosine = 0.0, exit = 0.0, count = 0.0, sum = 0.0, least = kNoDepth, most = -kNoDepth;
  uint material = 0u;
  vec3 normal = vec3(0.0);
  bool several = false;
  [[unroll]] for (int i = 0; i < 4; ++i) {
    several = several || bits[i] == kSeveralSurfaces;
    if (!holdsSurface(bits[i])) continue;
    EntryPoint r = unpackEntry(bits[i]);
    // A map's entry points all know their material, or none does. Light enters where the material is not 0.
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
  if (perspective) limit *= max(abs(least), abs(most));
  if (several || most - least > 2.0 * limit) return kSeveralSurfaces;
  if (count == 0.0) return kNoEntry;
  float squared = dot(normal, normal), inverse = 1.0 / count;
  // Normals towards one light cancel only in rounding.
  if (squared < 1.0e-6) return kSeveralSurfaces;
  return packEntry(EntryPoint(sum * inverse, normal * inversesqrt(squared), 0.25 * hidden, 0.25 * seen, cosine * inverse,
                              exit * inverse, material));
}

// The mean of the four entry points of the level before under one of the level.
uvec4 meanBelow(int level, ivec2 at, float limit, bool perspective) {
  int across = GROUP_SIDE >> level, from = 4 * at.y * across + 2 * at.x;
  uvec4 bits[4];
  [[unroll]] for (int i = 0; i < 4; ++i) {
    int place = from + (i & 1) + (i >> 1) * 2 * across;
    bits[i] = (level & 1) != 0 ? entries[place] : means[place];
  }
  return meanOf(bits, limit, perspective);
}
