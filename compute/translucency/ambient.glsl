#ifndef PELLUCID_AMBIENT_GLSL
#define PELLUCID_AMBIENT_GLSL

// Light from all around through thin parts. A thin body sends on what comes from behind, and returns less of what lies on it
// than a half-space does; docs/integration.md says why both count. Include it after translucency/transmission.glsl.

// Irradiance of a face, in the units of the irradiance image. `normal`: unit, view space.
vec3 ambientIrradiance(vec3 normal) {
  vec4 n = vec4(normal, 1.0);
  return max(vec3(dot(n, frame.ambient[0] * n), dot(n, frame.ambient[1] * n), dot(n, frame.ambient[2] * n)), vec3(0.0));
}

// Light that leaves the visible face besides what the irradiance image has: below 0 where more goes through than comes.
vec3 ambientExitance(Surface s, ivec2 pixel, uint m) {
  vec3 front = s.hasNormal ? s.normal : -s.view;
  // A sheet's T is the same at any thickness, and its reflectance is its own.
  if (isThinWalled(m + 1u)) return materialTransmittance(m, 0.0) * ambientIrradiance(-front);
  if (s.chord < 0.0) return vec3(0.0);
  float mm = frame.camera.range.w;
  float facing = abs(dot(front, s.view));
  // Most bodies are thick, whatever their back.
  if (0.5 * s.chord * facing * mm > materials[m].transmittance4.w) return vec3(0.0);
  vec3 back = -facetAt(pixel, m + 1u, true);
  if (back == vec3(0.0)) back = -front;
  vec3 t = materialTransmittance(m, 0.5 * s.chord * (facing + abs(dot(back, s.view))) * mm);
  vec3 kept; // R(h) / rho
  for (int c = 0; c < 3; ++c) {
    vec4 r = materials[m].gather.reflectance[c];
    kept[c] = clamp(r.x - sqrt(max(r.y * t[c] * t[c] + r.z, 0.0)), 0.0, 1.0);
  }
  // A rim has all of the medium behind it.
  float opposite = 0.5 - 0.5 * dot(front, back);
  vec3 lost = (1.0 - kept) * ambientIrradiance(front) / materials[m].inverseReflectance.rgb;
  return opposite * (t * ambientIrradiance(back) - lost);
}

#endif
