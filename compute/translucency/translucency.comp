// One thickness a pixel: thickness, transmittance, occlusion and the addition to irradiance, fused, for lights that are not gathered
// from, thin walls and the thesis's options. The exitance T(d) E_back is added as T(d) / rho E_back, so that albedo times the
// diffused sum is T E_back.
#version 460
#extension GL_GOOGLE_include_directive : require

#include "frame/frame.glsl"
#include "translucency/transmission.glsl"

layout(push_constant) uniform Pass { TranslucencyPass pass; };
layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(constant_id = PELLUCID_CONSTANT_DEBUG_VIEWS) const bool kDebugViews = false;

// `front`: planar distance of `stored`.
Surface surfaceAt(ivec2 at, float front, float stored, uint material) {
  ViewRay ray = viewRay(frame.camera, inLattice(at));
  float along = -1.0;
  if (hasFlag(PELLUCID_FLAG_CHORD) && hasFlag(PELLUCID_FLAG_BACK_DEPTH))
    along = chordOf(ray, front, stored, texelFetch(backDepthImage, at, 0).x);
  return surfaceOf(at, ray, front, along, material);
}

// Irradiance and the light that comes through, or what a debug view shows; alpha of the source. `value`: of the material image;
// m: material; `starts`, `keeps`: see main.
vec4 resultAt(ivec2 at, uint value, uint m, bool starts, bool keeps) {
  vec3 arriving = vec3(0.0), visible = vec3(0.0), transmitted = vec3(0.0);
  vec3 thickness = vec3(-1.0);
  bool lets = pass.through == PELLUCID_LIGHT_ALL || (pass.through == PELLUCID_LIGHT_WALLS) == isThinWalled(m + 1u);
  float stored = texelFetch(frontDepthImage, at, 0).x, front = frontDistanceOf(stored);
  // Marked pixels keep their irradiance.
  if (lets && front > 0.0 && (value & frame.marks.x) == 0u) {
    Surface s = surfaceAt(at, front, stored, m + 1u);
    float mm = frame.camera.range.w;
    if (s.chord >= 0.0) thickness.r = s.chord * mm;
    for (uint i = 0u; i < pass.lights; ++i) {
      LightConstants light = lights[i];
      // Debug views of light show lights with a direction.
      bool ambient = isAmbient(light);
      if (kDebugViews && ambient && frame.flags.z <= PELLUCID_SHADER_DEBUG_OCCLUSION) continue;
      Transmitted through = lightTransmission(light, s, at);
      transmitted += exitanceOf(through, m);
      if (kDebugViews && !ambient) {
        vec3 enters = through.arriving * through.opposite;
        arriving += enters;
        visible += enters * through.visible;
        if (through.visible > 0.0 && thickness.b < 0.0) thickness.b = through.thickness * mm;
        LightTexels l = lightTexels(light, lightAt(light, s.position), 0u, s.position, 0.0, kFarthest);
        if (l.weight != vec4(0.0) && light.meta.w == 0u && thickness.g < 0.0) thickness.g = meanThickness(l.weight, l.thickness, m) * mm;
      }
    }
  }
  // Read last: until here its registers let more waves run.
  vec4 source = starts ? vec4(0.0) : texelFetch(sourceImage, at, 0);
  vec3 added = transmitted * materials[m].inverseReflectance.rgb;
  vec3 result = keeps ? change(change(source.rgb) + added) : limited(sanitize(source.rgb) + added);
  if (kDebugViews) {
    // The divisors are positive where they are used; nothing arriving shows as 0.
    vec3 some = vec3(greaterThan(arriving, vec3(0.0)));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_THICKNESS) result = min(thickness, vec3(kLargestHalf));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_TRANSMITTANCE) result = some * transmitted / max(visible, vec3(1.0e-30));
    if (frame.flags.z == PELLUCID_SHADER_DEBUG_OCCLUSION) result = some * visible / max(arriving, vec3(1.0e-30));
  }
  return vec4(result, source.a);
}

void main() {
  ivec2 at = invocationPlace();
  bool inside = insideRect(inLattice(at));
  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there. It keeps changes of the
  // irradiance, which are negative where a thin body returns less light of the sky than comes through.
  bool starts = pass.write == PELLUCID_WRITE_STARTS, keeps = starts || pass.write == PELLUCID_WRITE_KEEPS;
  uint value = inside ? materialValueAt(at) : 0u, material = materialIndex(value);
  if (material != 0u) {
    vec4 result = resultAt(at, value, material - 1u, starts, keeps);
    if (kDebugViews)
      imageStore(destinationImage, at, result);
    else if (keeps)
      imageStore(destinationImage, at, vec4(asStored(result.rgb, false), 0.0));
    else
      writeResult(at, result.rgb, result.a, pass.write == PELLUCID_WRITE_LAST);
  } else if (starts && inside) {
    imageStore(destinationImage, at, vec4(0.0));
  }
}
