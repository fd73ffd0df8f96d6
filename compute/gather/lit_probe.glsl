// A probe on its surface, with the light of all lights of the dispatch.
#include "gather/probe_light.glsl"
#include "gather/probe_shape.glsl"

const uint kAdds = 1u << 31; // of pass.value.z

// Sets the probe's normal and light. `normalTexel`: of the normal image at the probe's pixel.
void lightProbe(inout Probe probe, ivec2 cell, ivec2 pixel, vec4 normalTexel) {
  ViewRay ray = viewRay(frame.camera, pixel);
  vec3 normal = vec3(0.0), loss = vec3(0.0);
  if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
  Surface x = makeSurface(ray, probe.front, -1.0, normal);
  probe.normal = x.hasNormal ? x.normal : -x.view;
  uint m = probe.material - 1u;
  if (x.hasNormal && hasFlag(PELLUCID_FLAG_DIFFUSED)) {
    probe.convexity = convexityAt(pixel, x, ray, probe.front, m);
    loss = thinLoss(pixel, x, m);
  }
  Pattern pattern = patternOf(cell, m, probe.front);
  for (uint i = 0u; i < pass.value.y; ++i) {
    LightConstants light = lights[i];
    if (kDirectional) light.meta.xz = uvec2(PELLUCID_SHADER_LIGHT_DIRECTIONAL, 1u);
    probe.added += light.radiance.rgb * gatherLight(m, light, x, pattern, loss);
  }
  if ((pass.value.z & kAdds) != 0u) probe.added += addedOf(imageLoad(probesImage, cell));
}
