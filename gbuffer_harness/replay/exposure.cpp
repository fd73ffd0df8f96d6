#include "replay/exposure.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "common/far_origin.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// Light within these bounds keeps a factor of 16 below what halves hold, and 7 bits of all that is a 100th of
// it.
constexpr double kDimmest = 1.0 / 64, kBrightest = 4096;
constexpr float kLeast = 1e-9F, kMost = 1e9F;  // of the module's preExposure

// In the world, of the surface that the pixel shows; none where the depth says that there is no surface.
std::optional<glm::dvec3> surfaceAt(const Capture& capture, const glm::dmat4& viewFromClip,
                                    const glm::dmat4& worldFromView, int x, int y) {
  const double stored = static_cast<double>(*capture.frontDepth.image.at(x, y));
  const auto inView = [&](double depth) {
    const glm::dvec4 p = viewFromClip * glm::dvec4((x + 0.5) / capture.width * 2 - 1,
                                                   (y + 0.5) / capture.height * 2 - 1, depth, 1);
    return glm::dvec3(p) / p.w;
  };
  glm::dvec3 point;
  if (capture.frontDepth.encoding == PELLUCID_DEPTH_DEVICE) {
    if (!(stored >= 0 && stored <= 1)) return std::nullopt;
    point = inView(stored);
  } else {
    if (!(stored > 0 && stored < 1e9)) return std::nullopt;
    const glm::dvec3 a = inView(0.25), b = inView(0.75);
    point = a + (b - a) * ((-stored - a.z) / (b.z - a.z));
  }
  const glm::dvec3 world = glm::dvec3(worldFromView * glm::dvec4(point, 1));
  if (!std::isfinite(world.x + world.y + world.z)) return std::nullopt;
  return world;
}

void raise(double& largest, double value) {
  if (std::isfinite(value)) largest = std::max(largest, value);
}

}  // namespace

double largestLight(const Capture& capture) {
  const glm::dmat4 viewFromClip = glm::inverse(toGlm(capture.clipFromView)),
                   worldFromView = glm::inverse(toGlm(capture.viewFromWorld));
  double largest = 0;
  std::vector<double> nearest(capture.lights.size(), std::numeric_limits<double>::infinity());  // squared
  for (int y = 0; y < capture.height && !capture.material.empty(); ++y)
    for (int x = 0; x < capture.width; ++x) {
      if (capture.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(capture.width) +
                           static_cast<std::size_t>(x)] == 0)
        continue;
      const float* const light = capture.irradiance.at(x, y);
      for (int c = 0; c < 3; ++c) raise(largest, static_cast<double>(light[c]));
      const auto point = surfaceAt(capture, viewFromClip, worldFromView, x, y);
      for (std::size_t i = 0; point && i < nearest.size(); ++i) {
        const glm::dvec3 toLight = toGlm(capture.lights[i].position) - *point;
        nearest[i] = std::min(nearest[i], glm::dot(toLight, toLight));
      }
    }
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    const Light& light = capture.lights[i];
    const double brightest = light.intensity * *std::max_element(light.color.begin(), light.color.end());
    raise(largest, light.type == PELLUCID_LIGHT_DIRECTIONAL ? brightest : brightest / nearest[i]);
  }
  if (capture.environment)  // of its mean radiance: pi times the first coefficient of 1 / (2 sqrt pi)
    for (const double mean : capture.environment->at(0))
      raise(largest, std::sqrt(std::numbers::pi) / 2 * mean);
  return largest;
}

float preExposureFor(const Capture& capture) {
  const double largest = largestLight(capture);
  if (largest == 0 || (largest >= kDimmest && largest <= kBrightest)) return 1;
  return std::clamp(static_cast<float>(std::exp2(-std::floor(std::log2(largest)))), kLeast, kMost);
}

namespace {

// The distance that is seen, in scene units; 0: the matrix does not say.
double seenDistance(const Matrix& clip) {
  if (clip[15] != 0) return 2 / std::abs(clip[5]);
  // Depths 0 and 1, of which one is the near plane.
  const double depths[] = {clip[14] / clip[10], (clip[14] - clip[15]) / (clip[10] - clip[11])};
  double nearest = INFINITY;
  for (const double depth : depths)
    if (depth > 0) nearest = std::min(nearest, depth);
  return std::isfinite(nearest) ? kNearPlanes * nearest : 0;
}

}  // namespace

std::array<double, 3> worldOrigin(const Capture& capture) {
  const Matrix& view = capture.viewFromWorld;
  std::array<double, 3> eye{};  // the rotation's transpose is its inverse
  double length = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) eye[i] -= view[4 * i + k] * view[12 + k];
    length = std::max(length, std::abs(eye[i]));
  }
  const double seen = seenDistance(capture.clipFromView);
  if (!(seen > 0) || !std::isfinite(length) || !(length > kFarthest * seen)) return {0, 0, 0};
  return originNear(eye, seen);
}

}  // namespace pellucid::harness
