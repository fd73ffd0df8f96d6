#include "metrics/moved_capture.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include "common/error.h"
#include "scene/camera.h"

namespace pellucid::harness {

namespace {

struct Move {
  int x, y, rim;
};

Image moved(const Image& image, const Move& move, float nothing) {
  Image result(image.width, image.height, image.channels, nothing);
  for (int y = move.rim; y < image.height - move.rim && !image.empty(); ++y)
    std::copy_n(
        image.at(move.rim, y),
        static_cast<std::size_t>(image.width - 2 * move.rim) * static_cast<std::size_t>(image.channels),
        result.at(move.rim + move.x, y + move.y));
  return result;
}

DepthImage moved(const DepthImage& depth, const Move& move, const Matrix& clipFromView) {
  const double nothing = depth.encoding == PELLUCID_DEPTH_DEVICE ? clearDepth(clipFromView) : kNoDepth;
  return {moved(depth.image, move, static_cast<float>(nothing)), depth.encoding};
}

}  // namespace

Capture movedCapture(const Capture& capture, int shiftX, int shiftY, int rim) {
  if (std::max(std::abs(shiftX), std::abs(shiftY)) > rim ||
      2 * rim >= std::min(capture.width, capture.height))
    throw InputError(capture.name, "shift",
                     std::to_string(shiftX) + ", " + std::to_string(shiftY) + " with a rim of " +
                         std::to_string(rim) + " pixels: at most the rim, and the rim less than half of " +
                         std::to_string(capture.width) + "x" + std::to_string(capture.height));
  const Move move{shiftX, shiftY, rim};
  Capture result = capture;
  result.truth.reset();
  result.frontDepth = moved(capture.frontDepth, move, capture.clipFromView);
  result.backDepth = moved(capture.backDepth, move, capture.clipFromView);
  result.irradiance = moved(capture.irradiance, move, 0);
  result.hiddenIrradiance = moved(capture.hiddenIrradiance, move, 0);
  result.albedo = moved(capture.albedo, move, 0);
  result.material.assign(capture.material.size(), 0);
  for (int y = rim; y < capture.height - rim; ++y) {
    const auto row = [&](int left, int top) {
      return static_cast<std::ptrdiff_t>(top) * capture.width + left;
    };
    std::copy_n(capture.material.begin() + row(rim, y), capture.width - 2 * rim,
                result.material.begin() + row(rim + shiftX, y + shiftY));
  }
  for (std::size_t column = 0; column < 4; ++column) {
    double* const m = &result.clipFromView[4 * column];
    m[0] += 2.0 * shiftX / capture.width * m[3];
    m[1] += 2.0 * shiftY / capture.height * m[3];
  }
  return result;
}

}  // namespace pellucid::harness
