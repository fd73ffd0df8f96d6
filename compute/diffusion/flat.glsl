// Texels of level 2 that the last pass may filter without looking at depths.

// True where a texel and all around it are full and lie on one plane. `at`: the texel in colors[] and depths[] of `width`
// columns, not in the outermost rows and columns.
bool isFlatAround(uvec4 bits, ivec2 at, int width, uint level) {
  float depth = uintBitsToFloat(bits.z), most = 0.0;
  vec2 size = texelSize(depth, level), slope = unpackHalf2x16(bits.w);
  uint different = 0u;
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      if (x == 0 && y == 0) continue;
      int index = slot(at + ivec2(x, y), width);
      most = max(most, abs(depths[index] - depth - dot(slope, vec2(x, y) * size)));
      different |= colors[index].y ^ bits.y;
    }
  return isPlane(bits) && (different & kSamePlane) == 0u && most * most < kPlaneOffset / inverseSpread(slope, size);
}
