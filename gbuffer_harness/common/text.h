// Words in pictures.
#pragma once

#include <string>
#include <vector>

namespace pellucid::harness {

struct TextRect {
  int left, top, right, bottom;  // pixels
};

inline constexpr int kTextHeight = 9;  // capitals and their margin

// ASCII words as rectangles to fill, right and down of (0, 0).
std::vector<TextRect> textRects(const std::string& words);
int textWidth(const std::string& words);

}  // namespace pellucid::harness
