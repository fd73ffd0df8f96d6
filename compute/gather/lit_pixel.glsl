// A pixel with its gathered light and the light of lights without shadow maps.

// Light that comes through solids from lights without a map, which come last.
vec3 otherLight(ivec2 pixel, float front, float frontStored, uint m) {
  float back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  Surface s = surfaceAt(pixel, front, frontStored, back, texelFetch(normalImage, pixel, 0));
  vec3 transmitted = vec3(0.0);
  for (uint i = pass.value.w; i < pass.value.y; ++i) {
    bool ambient = lights[i].meta.x == PELLUCID_SHADER_LIGHT_AMBIENT;
    transmitted += ambient ? ambientExitance(s, pixel, m) : exitanceOf(chordTransmission(lights[i], s), m);
  }
  return transmitted * materials[m].inverseReflectance.rgb;
}

// `value`, `source`, `frontStored`: the pixel's texels; `others`: there are lights without a map.
void writePixel(ivec2 pixel, int side, uint value, vec4 source, float frontStored, bool others) {
  uint material = materialIndex(value);
  if (material == 0u) return;
  vec3 result = sanitize(source.rgb);
  float front = (value & frame.marks.x) != 0u ? -1.0 : frontDistanceOf(frontStored);
  if (front > 0.0 && side == 1) {
    uvec4 own = imageLoad(probesImage, pixel);
    result = withLight(result, addedOf(own), convexityOf(own));
  } else if (front > 0.0 && someLight != 0u) {
    result = withGathered(result, pixel, side, front, material);
  }
  if (front > 0.0 && others && !isThinWalled(material)) result += otherLight(pixel, front, frontStored, material - 1u);
  writeResult(pixel, max(result, vec3(0.0)), source.a, pass.value.z == PELLUCID_WRITE_LAST);
}
