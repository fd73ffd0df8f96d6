// One thickness a pixel: thickness, transmittance, occlusion and the addition to irradiance, fused, for lights that are not gathered
// from, thin walls and the thesis's options. The exitance T(d) E_back is added as T(d) / rho E_back, so that albedo times the
// diffused sum is T E_back. An invocation does two pixels: one leaves too much to do for each pixel again, four hold so many
// registers that too few groups run at a time.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_TILE
#define GROUP_ROWS (PELLUCID_TILE / 2)
#include "frame/frame.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LIGHTS) uniform Lights { LightConstants lights[PELLUCID_DISPATCH_LIGHTS]; };
layout(set = 0, binding = PELLUCID_BINDING_SHADOWS) uniform Shadows { ShadowConstants shadows[PELLUCID_DISPATCH_SHADOWS]; };
layout(set = 0, binding = PELLUCID_BINDING_MATERIALS) readonly buffer Materials { MaterialConstants materials[]; };
layout(set = 0, binding = PELLUCID_BINDING_BACK_DEPTH) uniform texture2D backDepthImage;
layout(set = 0, binding = PELLUCID_BINDING_NORMAL) uniform texture2D normalImage;
layout(constant_id = PELLUCID_CONSTANT_DEBUG_VIEWS) const bool kDebugViews = false;

#include "frame/chord.glsl"
#include "frame/shadow_images.glsl"
#include "lib/surface.glsl"

float distanceOf(ivec2 pixel, uint material, bool back) {
  if (!insideRect(pixel) || materialAt(pixel) != material) return -1.0;
  return back ? backDistanceOf(texelFetch(backDepthImage, pixel, 0).x) : frontDistance(pixel);
}

#include "translucency/transmission.glsl"
#include "translucency/ambient.glsl"

Surface surfaceAt(ivec2 pixel, float front, float frontStored, float backStored, vec4 normalTexel) {
  ViewRay ray = viewRay(frame.camera, pixel);
  float along = -1.0;
  if (hasFlag(PELLUCID_FLAG_CHORD) && hasFlag(PELLUCID_FLAG_BACK_DEPTH)) along = chordOf(ray, front, frontStored, backStored);
  vec3 normal = vec3(0.0);
  if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
  return makeSurface(ray, front, along, normal);
}

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

void main() {
  ivec2 tile = ivec2(frame.rect.xy) + ivec2(gl_WorkGroupID.xy) * PELLUCID_TILE + ivec2(gl_LocalInvocationID.xy);
  // A history that starts is 0 wherever nothing came through: the next frame's pixels may lie there.
  bool starts = pass.value.z == PELLUCID_WRITE_STARTS;
  Texels texels[2];
  for (int i = 0; i < 2; ++i) texels[i] = fetch(withinRect(tile + ivec2(0, i * GROUP_ROWS)));
  for (int i = 0; i < 2; ++i) {
    ivec2 pixel = tile + ivec2(0, i * GROUP_ROWS);
    Texels t = texels[i];
    uint material = insideRect(pixel) ? materialIndex(t.value) : 0u;
    float depth = frontDistanceOf(t.front);
    if (starts) t.source = vec4(0.0);
    if (material != 0u) {
      vec3 result = resultAt(pixel, t, depth, material - 1u);
      if (kDebugViews)
        imageStore(destinationImage, pixel, vec4(result, t.source.a));
      else
        writeResult(pixel, result, t.source.a, pass.value.z == PELLUCID_WRITE_LAST);
    } else if (starts && insideRect(pixel)) {
      imageStore(destinationImage, pixel, vec4(0.0));
    }
  }
}
