// Probes: in each cell of 1, 2 or 4 pixels a side one gathers, from entry points, what each light brings beyond its diffused
// irradiance. Neighbors take samples of their own, by PELLUCID_PATTERNS patterns; filter_probes.comp shares what they find.
#version 460
#extension GL_GOOGLE_include_directive : require

#define GROUP_SIDE PELLUCID_PROBES_GROUP
#include "gather/probe.glsl"
#include "gather/probe_light.glsl"
#include "gather/probe_shape.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PROBES_DESTINATION, rgba32ui) uniform uimage2D probesImage;

const uint kAdds = 1u << 31; // of pass.entries

// Finds the first pixel of the cell with a solid's surface: all of the place but its normal. Loads of a pixel are at once, so that
// their latencies overlap: the first pixel is the one, as a rule.
bool findSurface(ivec2 cell, int side, out ProbePlace place) {
  for (place.index = 0; place.index < side * side; ++place.index) {
    ivec2 pixel = pixelInCell(cell, side, place.index), within = withinRect(pixel);
    uint value = materialValueAt(inImage(within));
    place.front = frontDistance(inImage(within));
    place.material = within == pixel ? materialIndex(value) : 0u;
    bool thin = place.material != 0u && hasFlag(PELLUCID_FLAG_THIN_WALLS) && materials[place.material - 1u].meta.z != 0u;
    if (place.material != 0u && place.front > 0.0 && !thin) return true;
    if (place.index == 0 && !(contains(cellsOf(frame.rect, side), cell) && cellHoldsMaterial(side * cell))) return false;
  }
  return false;
}

uvec4 probeAt(ivec2 cell, int side, ProbePlace place) {
  uint m = place.material - 1u;
  ivec2 pixel = pixelInCell(cell, side, place.index);
  ViewRay ray = viewRay(frame.camera, pixel);
  vec3 view = normalize(ray.direction);
  place.normal = facetAt(inImage(pixel), place.material, place.front, false);
  if (place.normal == vec3(0.0)) place.normal = -view;
  Surface x = Surface(ray.origin + place.front * ray.direction, place.normal, view, -1.0, place.material);
  BodyFactors body = bodyAt(pixel, x, ray, place.front, m);
  // Packed before lights are gathered, whose sums need the registers.
  uvec4 bits = withReturned(packPlace(place), body.returned - 1.0);
  vec3 added = vec3(0.0);
  Pattern pattern = patternOf(cell, m, place.front);
  for (uint i = 0u; i < pass.lights; ++i) {
    LightConstants light = lights[i];
    added += light.radiance.rgb * gatherLight(m, light, x, pattern, body);
  }
  if ((pass.entries & kAdds) != 0u) added += addedOf(imageLoad(probesImage, cell));
  return withAdded(bits, added);
}

void main() {
  int side = int(pass.spacing);
  ivec2 firstPixel;
  if (!materialPart(ivec2(side * PELLUCID_PROBES_GROUP), firstPixel)) return;
  ivec2 cell = firstPixel / side + ivec2(gl_LocalInvocationID.xy);
  if (!contains(cellsOf(frame.rect, side), cell)) return;
  ProbePlace place;
  bool found = findSurface(cell, side, place);
  imageStore(probesImage, cell, found ? probeAt(cell, side, place) : kNoProbe);
}
