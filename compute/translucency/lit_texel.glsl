// A pixel with the light that comes through, or what a debug view shows of it.

struct Texels {
  uint value;
  vec4 source, normal;
  float front, back; // as stored
};

// All at once and whatever the flags say (a stand-in is bound where an image is missing), so that their
// latencies overlap: the pass waits for memory more than it computes.
Texels fetch(ivec2 pixel) {
  Texels t;
  t.value = materialValueAt(pixel);
  t.source = texelFetch(sourceImage, pixel, 0);
  t.front = texelFetch(frontDepthImage, pixel, 0).x;
  t.back = hasFlag(PELLUCID_FLAG_CHORD) ? texelFetch(backDepthImage, pixel, 0).x : 0.0;
  t.normal = texelFetch(normalImage, pixel, 0);
  return t;
}

// Irradiance and the light that comes through, or what a debug view shows.
vec3 resultAt(ivec2 pixel, Texels t, float front, uint m) {
  vec3 arriving = vec3(0.0), visible = vec3(0.0), transmitted = vec3(0.0);
  vec3 thickness = vec3(-1.0);
  bool lets = pass.value.x == PELLUCID_LIGHT_ALL || (pass.value.x == PELLUCID_LIGHT_WALLS) == isThinWalled(m + 1u);
  // Marked pixels keep their irradiance.
  if (lets && front > 0.0 && (t.value & frame.marks.x) == 0u) {
    Surface s = surfaceAt(pixel, front, t.front, t.back, t.normal);
    s.material = m + 1u;
    float mm = frame.camera.range.w;
    if (s.chord >= 0.0) thickness.r = s.chord * mm;
    for (uint i = 0u; i < pass.value.y; ++i) {
      LightConstants light = lights[i];
      if (light.meta.x == PELLUCID_SHADER_LIGHT_AMBIENT) {
        if (!kDebugViews || frame.flags.z > PELLUCID_SHADER_DEBUG_OCCLUSION) transmitted += ambientExitance(s, pixel, m);
        continue;
      }
      Transmitted through = lightTransmission(light, s, pixel);
      transmitted += exitanceOf(through, m);
      if (kDebugViews) {
        arriving += through.arriving;
        visible += through.arriving * through.visible;
        if (through.visible > 0.0 && thickness.b < 0.0) thickness.b = through.thickness * mm;
        LightTexels l = lightTexels(light, lightAt(light, s.position), s, s.position, 0.0, kEverywhere);
        if (l.held != vec4(0.0) && light.meta.w == 0u && thickness.g < 0.0) thickness.g = meanThickness(l.held, l.thickness, m) * mm;
      }
    }
  }
  if (kDebugViews) {
    // The divisors are positive where they are used; nothing arriving shows as 0.
    vec3 some = vec3(greaterThan(arriving, vec3(0.0)));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_THICKNESS) return min(thickness, vec3(kLargestHalf));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_TRANSMITTANCE) return some * transmitted / max(visible, vec3(1.0e-30));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_OCCLUSION) return some * visible / max(arriving, vec3(1.0e-30));
  }
  return sanitize(sanitize(t.source.rgb) + transmitted * materials[m].inverseReflectance.rgb);
}
