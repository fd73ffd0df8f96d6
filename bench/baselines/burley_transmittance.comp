// The transmission that goes with Golubev 2018: a slab of Burley's profile (Christensen and Burley 2015) as thick as the
// shadow map says, lit from behind along a wrapped cosine. kernel[0].rgb: Burley distances (mm).
#version 460
#extension GL_EXT_samplerless_texture_functions : require
#extension GL_GOOGLE_include_directive : require

#include "transmitted.glsl"

// cos(90 - 15 degrees): light wraps around by 15 degrees; normalized as (c + w) / (1 + w)^2.
const float kWrap = 0.25881905;

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  Receiver receiver;
  if (!readReceiver(pixel, receiver)) return;
  vec3 sum = texelFetch(sourceImage, pixel, 0).rgb;
  for (uint i = 0u; i < pass.value.x; ++i) {
    Incident incident = incidentLight(lights[i], receiver.position);
    float cosine = (kWrap - dot(incident.toLight, receiver.normal)) / ((1.0 + kWrap) * (1.0 + kWrap));
    float d;
    if (cosine <= 0.0 || !thicknessAt(lights[i], incident, receiver.position, d)) continue;
    vec3 third = exp(-max(d, 0.0) / (3.0 * kernel[0].rgb)); // e^{-d/l} is its cube
    sum += incident.irradiance * min(cosine, 1.0) * (0.25 * third * third * third + 0.75 * third);
  }
  imageStore(destinationImage, pixel, vec4(sum, 1.0));
}
