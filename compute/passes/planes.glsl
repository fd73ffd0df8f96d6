// Pixels of planes, of which an invocation does four below each other. Of the including pass: the texels of level 2 in
// resolved[], rows of kWindow.x.
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
  vec3 added = mix(addedOf(a), addedOf(b), across), convexity = vec3(0.0);
  vec3 addedStep = 0.25 * (mix(addedOf(c), addedOf(d), across) - added), convexityStep = vec3(0.0);
  if ((someLight & kSomeConvexity) != 0u) {
    convexity = mix(convexityOf(a), convexityOf(b), across);
    convexityStep = 0.25 * (mix(convexityOf(c), convexityOf(d), across) - convexity);
  }
  [[unroll]] for (int i = 0; i < 4; ++i)
    colors[i].rgb = withLight(colors[i].rgb, added + float(i) * addedStep, convexity + float(i) * convexityStep);
}
#endif

// The spline at a pixel of a texel of level 2, in one direction.
vec3 splineAt(int pixel) { return spline(0.25 * (float(pixel & 3) - 1.5)); }

// Level 2 at a pixel's column, `splineX` splineAt it, in the rows of its texel `texel` of the window and of those beside it.
void coarserRows(int texel, vec3 splineX, out vec3 rows[3]) {
  [[unroll]] for (int y = 0; y < 3; ++y) {
    int row = texel + (y - 1) * kWindow.x;
    rows[y] = splineX.x * unpackColor(resolved[row - 1].xy) + splineX.y * unpackColor(resolved[row].xy) +
              splineX.z * unpackColor(resolved[row + 1].xy);
  }
}

// The same at the pixel's row.
vec3 coarserAt(vec3 rows[3], int y) {
  vec3 splineY = splineAt(y);
  return splineY.x * rows[0] + splineY.y * rows[1] + splineY.z * rows[2];
}

// With what light was gathered; `top`: the first of the pixels.
void storeColumn(ivec2 top, vec4 result[4]) {
#ifdef GATHER
  if (someLight != 0u) addLightOfPlane(top, result);
#endif
  // One branch for all pixels, as branches cost more than what is in them.
  if (tinted(pass.value.w != 0u))
    [[unroll]] for (int i = 0; i < 4; ++i)
      result[i].rgb = sanitize(result[i].rgb * albedoAt(top + ivec2(0, i)));
  [[unroll]] for (int i = 0; i < 4; ++i)
    imageStore(destinationImage, top + ivec2(0, i), vec4(asStored(result[i].rgb), result[i].a));
}

#endif
