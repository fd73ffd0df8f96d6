#include "metrics/surface.h"

#include <algorithm>
#include <cmath>

#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr double kSteepestSlope = 2;  // depth a pixel width that needs no explanation
constexpr double kStepGrowth = 2;     // of a step to the next one on a curved surface

}  // namespace

Surfaces::Surfaces(const Capture& capture)
    : width_(capture.width),
      height_(capture.height),
      pixels_(static_cast<std::size_t>(capture.width) * static_cast<std::size_t>(capture.height)) {
  const reference::Camera camera(capture.clipFromView, width_, height_);
  forEachSurface(capture, camera, [&](int x, int y, double depth) {
    const glm::dvec3 side =
        camera.position({x + 1.0, y + 0.5}, depth) - camera.position({x + 0.0, y + 0.5}, depth);
    pixels_[index(x, y)] = {depth, glm::length(side), capture.material[index(x, y)]};
  });
}

Surfaces::Surfaces(int width, int height)
    : width_(width),
      height_(height),
      pixels_(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), Pixel{0, 1, 1}) {}

bool Surfaces::covered(int x, int y) const {
  return x >= 0 && y >= 0 && x < width_ && y < height_ && at(x, y).material != 0;
}

bool Surfaces::connected(int x, int y, int stepX, int stepY) const {
  const int nextX = x + stepX, nextY = y + stepY;
  if (!covered(x, y) || !covered(nextX, nextY)) return false;
  const Pixel &here = at(x, y), &next = at(nextX, nextY);
  if (here.material != next.material) return false;
  const double step = next.depth - here.depth;
  const double length = std::hypot(stepX, stepY) * std::max(here.width, next.width);
  double explained = kSteepestSlope * length;
  const auto explain = [&](int fromX, int fromY, int toX, int toY) {
    if (!covered(fromX, fromY) || !covered(toX, toY)) return;
    const double beside = at(toX, toY).depth - at(fromX, fromY).depth;
    if (beside * step > 0) explained = std::max(explained, kStepGrowth * std::abs(beside));
  };
  explain(x - stepX, y - stepY, x, y);
  explain(nextX, nextY, nextX + stepX, nextY + stepY);
  return std::abs(step) <= explained;
}

bool Surfaces::wholeBlock(int left, int top, int side) const {
  if (left < 0 || top < 0 || left + side > width_ || top + side > height_) return false;
  for (int y = top; y < top + side; ++y)
    for (int x = left; x < left + side; ++x) {
      if (!covered(x, y)) return false;
      if (x + 1 < left + side && !connected(x, y, 1, 0)) return false;
      if (y + 1 < top + side && !connected(x, y, 0, 1)) return false;
    }
  return true;
}

std::array<float, 4> visibleMiddle(const Capture& capture) {
  const reference::Camera camera(capture.clipFromView, capture.width, capture.height);
  glm::dvec3 sum(0);
  double count = 0;
  forEachSurface(capture, camera, [&](int x, int y, double depth) {
    sum += camera.position({x + 0.5, y + 0.5}, depth);
    ++count;
  });
  if (count == 0) return {0, 0, 0, 0};
  const glm::dvec4 middle = glm::inverse(toGlm(capture.viewFromWorld)) * glm::dvec4(sum / count, 1);
  return {static_cast<float>(middle.x), static_cast<float>(middle.y), static_cast<float>(middle.z), 1};
}

}  // namespace pellucid::harness
