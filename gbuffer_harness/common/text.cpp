#include "common/text.h"

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_easy_font.h>
#pragma GCC diagnostic pop

namespace pellucid::harness {

std::vector<TextRect> textRects(const std::string& words) {
  struct Vertex {
    float x, y, z;
    unsigned char color[4];
  };
  std::string writable = words;
  std::vector<Vertex> vertices(writable.size() * 64 + 64);
  const int quads = stb_easy_font_print(0, 0, writable.data(), nullptr, vertices.data(),
                                        static_cast<int>(vertices.size() * sizeof(Vertex)));
  std::vector<TextRect> rects;
  for (int q = 0; q < quads; ++q) {
    const Vertex &a = vertices[static_cast<std::size_t>(4 * q)],
                 &b = vertices[static_cast<std::size_t>(4 * q + 2)];
    rects.push_back(
        {static_cast<int>(a.x), static_cast<int>(a.y), static_cast<int>(b.x), static_cast<int>(b.y)});
  }
  return rects;
}

int textWidth(const std::string& words) {
  std::string writable = words;
  return stb_easy_font_width(writable.data());
}

}  // namespace pellucid::harness
