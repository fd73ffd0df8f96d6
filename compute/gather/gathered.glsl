// Gathered light of pixels, which take what the four probes around them have.
#include "gather/probe.glsl"

const uint kSomeLight = 1u, kSomeConvexity = 2u;

uint kindsOfLight(uvec4 bits) { return (hasLight(bits) ? kSomeLight : 0u) | (hasConvexity(bits) ? kSomeConvexity : 0u); }

// A pixel that is a quarter of its side off a probe's tangent plane is not of its surface. Half and a tenth of the side err
// more on heads.
const float kPerPixelOff = 4.0;

// Planar distance of a probe's tangent plane: x: in pixel `first`; y, z: its steps, per pixel. w: quarters of a pixel off the
// plane, per distance along the view ray. `pixel`: the probe's.
vec4 tangentPlane(Probe p, ivec2 pixel, ivec2 first) {
  Camera c = frame.camera;
  vec2 sideX = c.rayX.zw + p.front * c.rayX.xy, sideY = c.rayY.zw + p.front * c.rayY.xy;
  // The limit gives planes that are seen edge-on a slope.
  float facing = min(dot(p.normal, viewRay(c, pixel).direction), -0.1);
  vec2 steps = -vec2(dot(p.normal.xy, sideX), dot(p.normal.xy, sideY)) / facing;
  // Pixels have a size in front of the eye.
  float perSide = inversesqrt(max(dot(sideX, sideX), 1.0e-30));
  return vec4(p.front - dot(steps, vec2(pixel - first)), steps, -facing * kPerPixelOff * perSide);
}

// The light of a cell's probe, by packLight, and its material, 0: nothing there. `off`: quarters of a pixel from the probe's
// plane to a surface at `front` in the pixel. The entry point knows where the probes are.
uvec4 probeOf(ivec2 cell, ivec2 pixel, float front, out float off);

// The diffused irradiance D with the light that was gathered.
vec3 withLight(vec3 diffused, vec3 added, vec3 convexity) {
  return sanitize(diffused + diffused * convexity + added);
}

// Adds what is linear between the four probes around the pixel, as far as they are of its material and it lies on their
// planes.
vec3 withGathered(vec3 diffused, ivec2 pixel, int side, float front, uint material) {
  float total = 0.0, perSide = side == 2 ? 0.5 : 0.25;
  vec3 added = vec3(0.0), convexity = vec3(0.0);
  vec2 fraction = vec2(pixel & (side - 1)) * perSide;
  ivec2 cell = pixel >> shiftOf(side);
  [[dont_unroll]] for (int i = 0; i < 4; ++i) {
    ivec2 corner = ivec2(i & 1, i >> 1);
    vec2 linear = mix(1.0 - fraction, fraction, vec2(corner));
    float off;
    uvec4 probe = probeOf(cell + corner, pixel, front, off);
    if (probe.w != material) continue;
    // The floors leave a pixel without a like neighbor the most alike.
    float weight = (exp2(-off * off) + 1.0e-4) * (linear.x * linear.y + 1.0e-4);
    addLight(probe.xyz, weight, added, convexity);
    total += weight;
  }
  // The cell's own probe is of its material, unless the cell has several.
  return total > 0.0 ? withLight(diffused, added / total, convexity / total) : diffused;
}
