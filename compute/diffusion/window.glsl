// Parts of levels that an upsampling group k holds in shared upsampled[]. Groups start at texels 16 k - 1 of level 2, k.x
// even, so that windows are alike everywhere. Texels of level 3 and coarser ones, which have been upsampled, come level
// after level: color and material as packed, depth and, in place of the slope, the kernel coverage of each channel.
#include "diffusion/written.glsl"
const int kUpsampled = 153 + 60 + 24 + 12 + 9;
// Levels 6 and, 3 x 3, 7 follow as the pyramid has them, where the group makes them.
const int kMade = kUpsampled;
// Sides of what a group needs of level 5 to make level 6, and of level 6 to make level 7.
const int kSide5 = 18, kSide6 = 8;

layout(set = 0, binding = PELLUCID_BINDING_COARSER_LEVELS) uniform utexture2D coarserLevelsImage;

shared uvec4 upsampled[kMade + kSide6 * kSide6 + 9];
shared uvec2 colors[kSide5 * kSide5]; // of level 5, then 6, to make the next
shared float depths[kSide5 * kSide5];
shared uint needsMade; // whether the group makes levels 6 and 7

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

// Place in upsampled[] of a texel in the window.
int indexOf(Window window, ivec2 texel) {
  ivec2 at = texel - window.corner;
  return window.first + at.y * window.columns + at.x;
}

// The inverse; `index`: from the window's first texel on.
ivec2 texelOf(Window window, int index) {
  int row = int((float(index) + 0.5) / float(window.columns));
  return window.corner + ivec2(index - row * window.columns, row);
}

// The first texel of level 6 or 7 that the group makes.
ivec2 firstMade(uint level, ivec2 k) {
  ivec2 last = windowOf(7u, k).corner;
  return level == 6u ? 2 * last - 1 : last;
}

// True where the group can tell what a texel around its window is. It knows few others of levels that it makes.
bool known(uint level, ivec2 texel, ivec2 k) {
  return level < 6u || contains(ivec4(0, 0, ivec2(level == 6u ? kSide6 : 3)), texel - firstMade(level, k));
}

// A texel of levels 2 to 5.
uvec4 storedTexel(uint level, ivec2 texel) {
  return level < 4u ? texelFetch(pyramidImage, inAtlas(level, texel), 0)
                    : texelFetch(coarserLevelsImage, inAtlas(level, texel), 0);
}

// Such a texel, nothing where none was written.
uvec4 writtenTexel(uint level, ivec2 texel) {
  return isWritten(PELLUCID_LIST_UPSAMPLE, level, texel) ? storedTexel(level, texel) : uvec4(0u);
}

uvec4 texelAt(uint level, ivec2 texel, ivec2 k) {
  if (level < 6u) return storedTexel(level, texel);
  ivec2 at = texel - firstMade(level, k);
  return upsampled[kMade + (level == 6u ? at.y * kSide6 + at.x : kSide6 * kSide6 + at.y * 3 + at.x)];
}
