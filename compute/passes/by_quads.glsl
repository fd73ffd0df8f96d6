// Sums over distances in space of a texel's 4 x 4 pixels. Of the including pass: places[] and colors[], in shared memory, and
// kMostOff.
#ifndef PELLUCID_BY_QUADS_GLSL
#define PELLUCID_BY_QUADS_GLSL

struct Sums {
  vec3 color, weight;
};

// From level 2 on a texel's pixels, which have the same windows, are summed by its quads: each of a quad's invocations does a
// fourth of what is summed for the quad's center, and pixels take what is linear between the four quads. Not where one lies
// farther from where these say than kMostOff, the including pass's, allows: the square of sides of a pixel that faces the camera.

// Centers of a texel's quads, rows first, from those of its pixels.
void quadsOf(int firstOfTexel, out vec3 center[4]) {
  [[unroll]] for (int q = 0; q < 4; ++q) {
    center[q] = vec3(0.0);
    [[unroll]] for (int i = 0; i < 4; ++i)
      center[q] += 0.25 * uintBitsToFloat(places[firstOfTexel + 8 * (q >> 1) + 4 * (i >> 1) + 2 * (q & 1) + (i & 1)].xyz);
  }
}

// Parts of the four quads at one of the texel's pixels.
vec4 ofQuads(ivec2 inTexel) {
  vec2 to = 0.5 * vec2(inTexel) - 0.25; // from the first one's center to the next one's
  return vec4((1.0 - to.x) * (1.0 - to.y), to.x * (1.0 - to.y), (1.0 - to.x) * to.y, to.x * to.y);
}

// The quad that one of the texel's pixels lies in. By an index that is not known compilers would put them into memory.
vec3 quadAt(vec3 center[4], ivec2 inTexel) {
  vec3 upper = inTexel.x < 2 ? center[0] : center[1], lower = inTexel.x < 2 ? center[2] : center[3];
  return inTexel.y < 2 ? upper : lower;
}

// What all of a quad's pixels find at a pixel, `sums` what an invocation found of its quad's fourth.
void exchange(inout Sums sums, int invocation, bool byQuads) {
  places[invocation] = floatBitsToUint(vec4(sums.color, sums.weight.r));
  colors[invocation] = floatBitsToUint(sums.weight.gb);
  barrier();
  if (byQuads) {
    int inTexel = invocation % 16;
    vec4 parts = ofQuads(ivec2(inTexel % 4, inTexel / 4));
    sums = Sums(vec3(0.0), vec3(0.0));
    [[unroll]] for (int i = 0; i < 16; ++i) {
      int from = invocation - inTexel + i;
      float part = parts[(i >> 1 & 1) + (i >> 2 & 2)];
      vec4 its = uintBitsToFloat(places[from]);
      sums.color += part * its.rgb;
      sums.weight += part * vec3(its.a, uintBitsToFloat(colors[from]));
    }
  }
  barrier();
}

#endif
