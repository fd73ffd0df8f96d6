// A probe on its surface, with the light of all lights of the dispatch.
#include "gather/probe_light.glsl"
#include "gather/probe_shape.glsl"

const uint kAdds = 1u << 31; // of pass.value.z

// A cell may have two invocations, which pays where it has two lights: half of the probe's chain is left to each.
const bool kShares = gl_WorkGroupSize.z > 1u;
// One tells the other how thin the body is, then light.
shared vec3 told[GROUP_SIDE * GROUP_SIDE];

// Sets the probe's normal and light, where one was found. `normalTexel`: of the normal image at the probe's pixel. For all
// invocations, as they wait for each other.
void lightProbe(inout Probe probe, bool found, ivec2 cell, int side, vec4 normalTexel) {
  bool first = gl_LocalInvocationID.z == 0u, last = gl_LocalInvocationID.z == gl_WorkGroupSize.z - 1u, shaped = false;
  uint m = probe.material - 1u;
  vec3 loss = vec3(0.0);
  Surface x;
  if (found) {
    ivec2 pixel = pixelInCell(cell, side, probe.index);
    ViewRay ray = viewRay(frame.camera, pixel);
    vec3 normal = vec3(0.0);
    if (hasFlag(PELLUCID_FLAG_NORMAL)) normal = mat3(frame.viewFromNormal) * decodeNormal(normalTexel);
    x = makeSurface(ray, probe.front, -1.0, normal);
    probe.normal = x.hasNormal ? x.normal : -x.view;
    shaped = x.hasNormal && hasFlag(PELLUCID_FLAG_DIFFUSED);
    if (shaped && first) probe.convexity = convexityAt(pixel, x, ray, probe.front, m);
    if (shaped && last) loss = thinLoss(pixel, x, m);
  }
  if (kShares) {
    if (last) told[cellInGroup()] = loss;
    barrier();
    loss = told[cellInGroup()];
    barrier();
  }
  if (found) {
    Pattern pattern = patternOf(cell, m, probe.front);
    for (uint i = gl_LocalInvocationID.z; i < pass.value.y; i += gl_WorkGroupSize.z) {
      LightConstants light = lights[i];
      if (kDirectional) light.meta.xz = uvec2(PELLUCID_SHADER_LIGHT_DIRECTIONAL, 1u);
      probe.added += light.radiance.rgb * gatherLight(m, light, x, pattern, loss);
    }
  }
  if (kShares) {
    if (last) told[cellInGroup()] = probe.added;
    barrier();
    if (first) probe.added += told[cellInGroup()];
  }
  if (found && first && (pass.value.z & kAdds) != 0u) probe.added += addedOf(imageLoad(probesImage, cell));
}
