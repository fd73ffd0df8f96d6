// Which neighboring pixels of a frame show one surface.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "capture/capture.h"
#include "reference/camera.h"

namespace pellucid::harness {

// Calls visit(x, y, view depth) for each pixel that has a material and a depth.
template <class Visit>
void forEachSurface(const Capture& capture, const reference::Camera& camera, const Visit& visit) {
  std::size_t i = 0;
  for (int y = 0; y < capture.height; ++y)
    for (int x = 0; x < capture.width; ++x, ++i) {
      if (capture.material[i] == 0) continue;
      if (const auto depth =
              camera.planarDepth(capture.frontDepth.image.data[i], capture.frontDepth.encoding))
        visit(x, y, *depth);
    }
}

// Two neighboring pixels show one surface when both have the same material, not 0, and their view depths
// differ by at most what the slope explains. It explains the step of a plane tilted by atan(2) = 63 degrees,
// and twice the larger of the two steps beside it on the same line (row, column or diagonal) that go the same
// way.
class Surfaces {
public:
  // Throws InputError for an oblique or singular projection.
  explicit Surfaces(const Capture& capture);
  // All pixels show one surface: for images without a capture.
  Surfaces(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  // True when the pixel has a material and a depth. False outside of the image.
  bool covered(int x, int y) const;
  // True when (x, y) and (x + stepX, y + stepY) show one surface; steps in -1 .. 1.
  bool connected(int x, int y, int stepX, int stepY) const;
  // True when all pixels of the block lie within the image and show one surface with the pixels right of and
  // below them in the block.
  bool wholeBlock(int left, int top, int side) const;

private:
  struct Pixel {
    double depth = 0;  // view depth, scene units
    double width = 0;  // of the pixel at that depth, scene units
    std::uint8_t material = 0;
  };
  const Pixel& at(int x, int y) const { return pixels_[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }

  int width_, height_;
  std::vector<Pixel> pixels_;
};

// In the world, with w 1: the middle of the surfaces with a material that the camera sees, as an engine
// passes the place of the body that it looks at to options.anchor. w 0 where none is seen.
std::array<float, 4> visibleMiddle(const Capture& capture);

}  // namespace pellucid::harness
