// Averages of 4 x 4 texels of level 1 of the pyramid, which stand for texels of level 3 where level 4 is made from them.
#ifndef PELLUCID_BOXES_GLSL
#define PELLUCID_BOXES_GLSL

struct Box {
  uvec2 bits; // color, mass, material and plane, as packed
  float depth;
};

const int kBox = 4, kBoxTexels = kBox * kBox;

ivec2 inBox(int i) { return ivec2(i % kBox, i / kBox); }

uvec4 boxTexel(ivec2 texel) {
  return contains(levelRect(1u), texel) ? texelFetch(pyramidImage, inAtlas(1u, texel), 0) : uvec4(0u);
}

// Where the texels are not one plane: those of the nearest one's material that lie not far behind it.
Box boxOfEdge(ivec2 first) {
  uint material = 0u, any = 0u;
  float nearest = kNoDepth;
  // Here and below a row at once and without a branch, so that its latencies overlap.
  for (int i = 0; i < kBoxTexels; i += kBox)
    [[unroll]] for (int j = 0; j < kBox; ++j) {
      uvec4 bits = boxTexel(first + inBox(i + j));
      bool nearer = hasSurface(bits) && uintBitsToFloat(bits.z) < nearest;
      nearest = nearer ? uintBitsToFloat(bits.z) : nearest;
      material = nearer ? materialBits(bits) : material;
      any = max(any, materialBits(bits));
    }
  if (material == 0u) return Box(uvec2(0u, any << 24), 0.0);
  // As far behind as a texel of level 4 reaches: more lets light over gaps. Tangents of single texels, by which reductions
  // go, are too uncertain for so large a box.
  float spread2 = inverseSpread(vec2(0.0), texelSize(nearest, 4u));
  vec3 color = vec3(0.0);
  float mass = 0.0, weights = 0.0, off = 0.0;
  for (int i = 0; i < kBoxTexels; i += kBox)
    [[unroll]] for (int j = 0; j < kBox; ++j) {
      uvec4 bits = boxTexel(first + inBox(i + j));
      float behind = uintBitsToFloat(bits.z) - nearest;
      bool counts = hasSurface(bits) && materialBits(bits) == material;
      float w = counts ? sameSurface(behind, 0.0, spread2, kReduceFalloff) : 0.0, m = w * massOf(bits.y);
      color += m * unpackColor(bits.xy);
      mass += m;
      off += counts ? w * behind : 0.0;
      weights += w;
    }
  // The nearest one counts, so mass and weights are positive.
  return Box(packColor(color / mass, packArea(mass / float(kBoxTexels)) | material << 8), nearest + off / weights);
}

// What stands for a texel of level 3.
Box boxOf(ivec2 texel) {
  ivec4 rect = levelRect(1u);
  ivec2 first = kBox * texel;
  if (any(greaterThanEqual(first, rect.zw)) || any(lessThanEqual(first + kBox, rect.xy))) return Box(uvec2(0u), 0.0);
  if (any(lessThan(first, rect.xy)) || any(greaterThan(first + kBox, rect.zw))) return boxOfEdge(first);
  ivec2 inImage = inAtlas(1u, first);
  uvec4 base = texelFetch(pyramidImage, inImage, 0);
  float depth = uintBitsToFloat(base.z), off = 0.0, square = 0.0;
  uint different = 0u;
  vec2 tilt = vec2(0.0);
  vec3 color = vec3(0.0);
  for (int i = 0; i < kBoxTexels; i += 8) {
    uvec4 bits[8];
    // Half of them at once, so that their latencies overlap.
    [[unroll]] for (int j = 0; j < 8; ++j)
      bits[j] = texelFetch(pyramidImage, inImage + inBox(i + j), 0);
    [[unroll]] for (int j = 0; j < 8; ++j) {
      float difference = uintBitsToFloat(bits[j].z) - depth;
      different |= bits[j].y ^ base.y;
      color += unpackColor(bits[j].xy);
      off += difference;
      tilt += difference * (vec2(inBox(i + j)) - 1.5);
      square += difference * difference;
    }
  }
  // The plane of least squares: its slope is the covariance over the variance, 5/4.
  const float kInverse = 1.0 / float(kBoxTexels), kBoxVariance = 1.25;
  off *= kInverse;
  tilt *= kInverse / kBoxVariance;
  float residual = kInverse * square - off * off - kBoxVariance * dot(tilt, tilt);
  vec2 size = texelSize(depth, 1u), slope = tilt / max(size, vec2(1.0e-30));
  bool plane = onePlane(base.y, different, residual, slope, float(kBox) * size);
  if ((base.y | different) >> 16 == 0u) return Box(uvec2(0u), 0.0);
  if (!plane) return boxOfEdge(first);
  return Box(packColor(kInverse * color, packArea(areaOf(3u, texel, slope)) | base.y >> 16 & 0xFF00u | kPlane >> 16),
             depth + off);
}

#endif
