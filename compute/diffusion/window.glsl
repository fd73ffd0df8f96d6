// The part of each level that an upsampling group holds in shared memory.
#ifndef PELLUCID_WINDOW_GLSL
#define PELLUCID_WINDOW_GLSL

// A part of a level that a group needs. Groups start at texels 16 k - 1 of level 2, k.x even, so that these are the same
// everywhere.
struct Window {
  ivec2 corner; // first texel
  int columns;  // texels
  int first;    // in upsampled[]
};

Window windowOf(uint level, ivec2 k) {
  if (level == 3u) return Window(8 * k - 1, 17, 0);
  if (level == 4u) return Window(4 * k - 1, 10, 153);
  if (level == 5u) return Window(2 * k - 1, 6, 213);
  if (level == 6u) return Window(k - 1, 4, 237);
  return Window((k - 2) >> 1, 3, 249);
}

// In upsampled[], of a texel in the window.
int indexOf(Window window, ivec2 texel) {
  ivec2 at = texel - window.corner;
  return window.first + at.y * window.columns + at.x;
}

// The other way round, from the window's first one on.
ivec2 texelOf(Window window, int index) {
  int row = int((float(index) + 0.5) / float(window.columns));
  return window.corner + ivec2(index - row * window.columns, row);
}

// First texel of level 6 or 7 that the group makes.
ivec2 firstMade(uint level, ivec2 k) {
  ivec2 last = windowOf(7u, k).corner;
  return level == 6u ? 2 * last - 1 : last;
}

// True where the group can tell what a texel around its window is. It knows few others of levels that it makes.
bool known(uint level, ivec2 texel, ivec2 k) {
  if (level > 5u) {
    ivec2 at = texel - firstMade(level, k);
    return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(level == 6u ? kSide6 : 3)));
  }
  return true;
}

// A texel of levels 2 to 5.
uvec4 storedTexel(uint level, ivec2 texel) {
  return level < 4u ? texelFetch(pyramidImage, inAtlas(level, texel), 0)
                    : texelFetch(coarserLevelsImage, inAtlas(level, texel), 0);
}

// Such a texel, nothing where downsampling wrote nothing. All groups of the coarser levels run.
uvec4 writtenTexel(uint level, ivec2 texel, bool checks) {
  return !checks || level > 3u || isNearMaterial(texel << level) ? storedTexel(level, texel) : uvec4(0u);
}

uvec4 texelAt(uint level, ivec2 texel, ivec2 k) {
  if (level > 5u) {
    ivec2 at = texel - firstMade(level, k);
    return upsampled[kMade + (level == 6u ? at.y * kSide6 + at.x : kSide6 * kSide6 + at.y * 3 + at.x)];
  }
  return storedTexel(level, texel);
}

#endif
