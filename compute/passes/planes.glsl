// Pixels of planes, of which an invocation does four below each other.
#ifndef PELLUCID_PLANES_GLSL
#define PELLUCID_PLANES_GLSL

// The quadratic B-spline at -1, 0 and 1 for a point at most half a texel from 0.
vec3 spline(float at) {
  return vec3(0.5 * (0.5 - at) * (0.5 - at), 0.75 - at * at, 0.5 * (0.5 + at) * (0.5 + at));
}

#ifdef GATHER
shared uint someLight; // kSome* of the points around all pixels

// Four pixels below each other, a column of a cell, with what is linear between the four points around it. The cell and
// those around are one surface, so that points need no test.
void addLightOfPlane(ivec2 pixel, inout vec4 colors[4]) {
  ivec2 cell = pixel >> 2;
  float across = 0.25 * float(pixel.x & 3);
  uvec4 a = texelFetch(pointsImage, cell, 0), b = texelFetch(pointsImage, cell + ivec2(1, 0), 0);
  uvec4 c = texelFetch(pointsImage, cell + ivec2(0, 1), 0), d = texelFetch(pointsImage, cell + ivec2(1, 1), 0);
  vec3 added = mix(addedOf(a), addedOf(b), across), displaced = vec3(0.0);
  vec3 addedStep = 0.25 * (mix(addedOf(c), addedOf(d), across) - added), displacedStep = vec3(0.0);
  if ((someLight & kSomeDisplaced) != 0u) {
    displaced = mix(displacedOf(a), displacedOf(b), across);
    displacedStep = 0.25 * (mix(displacedOf(c), displacedOf(d), across) - displaced);
  }
  [[unroll]] for (int i = 0; i < 4; ++i)
    colors[i].rgb = withLight(colors[i].rgb, added + float(i) * addedStep, displaced + float(i) * displacedStep);
}
#endif

#endif
