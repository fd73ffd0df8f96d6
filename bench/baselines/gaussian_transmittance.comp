// Jimenez et al. 2010, "Real-time realistic skin translucency": T(d) of the profile's six Gaussians (d'Eon and Luebke
// 2007) at the shadow map's thickness. kernel[i]: rgb: weight of Gaussian i; w: variance (mm^2).
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "transmitted.glsl"

// Wrap of the cosine, as the paper has it.
const float kWrap = 0.3;
// mm that a point is moved inwards, against the shadow map's steps: the 0.005 units of the authors' code, in mm of its
// profile by the scale 8.25 (1 - 0.83) / 0.012 that it ships with.
const float kShrink = 0.584;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  Receiver receiver;
  if (!readReceiver(pixel, receiver)) return;
  vec3 sum = texelFetch(sourceImage, pixel, 0).rgb;
  vec3 inner = receiver.position - kShrink / frame.camera.range.w * receiver.normal;
  for (uint i = 0u; i < pass.value.x; ++i) {
    Incident incident = incidentLight(lights[i], inner);
    float d;
    if (!thicknessAt(lights[i], incident, inner, d)) continue;
    vec3 transmittance = vec3(0.0);
    // The integral of a Gaussian over the plane at depth d; the papers print d^2 / v, without the 2.
    for (int k = 0; k < 6; ++k) transmittance += kernel[k].rgb * exp(-d * d / (2.0 * kernel[k].w));
    float cosine = clamp(kWrap - dot(incident.toLight, receiver.normal), 0.0, 1.0);
    sum += incident.irradiance * cosine * transmittance;
  }
  imageStore(destinationImage, pixel, vec4(sum, 1.0));
}
