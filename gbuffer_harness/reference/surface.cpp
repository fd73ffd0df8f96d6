#include "reference/surface.h"

#include <cmath>
#include <string>

#include "common/error.h"

namespace pellucid::harness::reference {
namespace {

bool finite(const glm::dvec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

void requireImage(const Capture& c, const Image& image, const char* field, int channels, bool optional) {
  if (optional && image.empty()) return;
  if (image.width != c.width || image.height != c.height || image.channels < channels)
    throw InputError(c.name, field,
                     std::to_string(image.width) + "x" + std::to_string(image.height) + " with " +
                         std::to_string(image.channels) + " channels; need " + std::to_string(c.width) + "x" +
                         std::to_string(c.height) + " with " + std::to_string(channels));
}

}  // namespace

SurfaceReader::SurfaceReader(const Capture& capture)
    : capture_(capture),
      camera_(capture.clipFromView, capture.width, capture.height),
      viewFromWorld_(toMatrix(capture.viewFromWorld)),
      worldFromView_(glm::inverse(viewFromWorld_)) {
  requireImage(capture, capture.frontDepth.image, "frontDepth", 1, false);
  requireImage(capture, capture.backDepth.image, "backDepth", 1, true);
  requireImage(capture, capture.irradiance, "irradiance", 3, false);
  requireImage(capture, capture.normal, "normal", 3, true);
  requireImage(capture, capture.hiddenIrradiance, "hiddenIrradiance", 3, true);
  requireImage(capture, capture.albedo, "albedo", 3, true);
  const std::size_t pixels =
      static_cast<std::size_t>(capture.width) * static_cast<std::size_t>(capture.height);
  if (capture.material.size() != pixels)
    throw InputError(capture.name, "material",
                     std::to_string(capture.material.size()) + " pixels; need " + std::to_string(pixels));
}

std::optional<double> SurfaceReader::planarDepth(const DepthImage& depth, int x, int y) const {
  return camera_.planarDepth(*depth.image.at(x, y), depth.encoding);
}

std::optional<glm::dvec3> SurfaceReader::normalAt(int x, int y) const {
  if (capture_.normal.empty()) return std::nullopt;
  const float* stored = capture_.normal.at(x, y);
  glm::dvec3 n(stored[0], stored[1], stored[2]);
  if (!capture_.normalsInViewSpace) n = glm::dmat3(viewFromWorld_) * n;
  const double length = glm::length(n);
  if (!finite(n) || !(length > 0)) return std::nullopt;
  return n / length;
}

std::optional<Surface> SurfaceReader::at(int x, int y) const {
  const std::optional<double> front = planarDepth(capture_.frontDepth, x, y);
  if (!front) return std::nullopt;
  const glm::dvec2 center(x + 0.5, y + 0.5);
  Surface s;
  s.position = camera_.position(center, *front);
  s.ray = camera_.rayThrough(s.position);
  s.normal = normalAt(x, y);
  s.pixel = {x, y};
  if (!capture_.backDepth.image.empty()) {
    const std::optional<double> back = planarDepth(capture_.backDepth, x, y);
    if (back && *back > *front) s.chord = glm::distance(s.position, camera_.position(center, *back));
  }
  return s;
}

glm::dvec3 SurfaceReader::flatStep(int x, int y, const glm::dvec3& position, const glm::dvec2& step) const {
  const double depth = camera_.planarDepth(position);
  const glm::dvec2 center(x + 0.5, y + 0.5);
  return camera_.position(center + 0.5 * step, depth) - camera_.position(center - 0.5 * step, depth);
}

// Displacement along the surface per pixel step, from whichever neighbor of the same material is
// nearer in depth: the other one may lie across an edge. That of a facing surface when neither can be used.
glm::dvec3 SurfaceReader::slopeAlong(const DepthImage& depth, int x, int y, int stepX, int stepY,
                                     const glm::dvec3& position) const {
  glm::dvec3 best = flatStep(x, y, position, {stepX, stepY});
  double least = INFINITY;
  const auto pixel = [&](int px, int py) {
    return static_cast<std::size_t>(py) * static_cast<std::size_t>(capture_.width) +
           static_cast<std::size_t>(px);
  };
  for (const int sign : {1, -1}) {
    const int nx = x + sign * stepX, ny = y + sign * stepY;
    if (nx < 0 || ny < 0 || nx >= capture_.width || ny >= capture_.height) continue;
    if (capture_.material[pixel(nx, ny)] != capture_.material[pixel(x, y)]) continue;
    const std::optional<double> there = planarDepth(depth, nx, ny);
    if (!there) continue;
    const double difference = std::abs(*there - camera_.planarDepth(position));
    if (difference < least) {
      least = difference;
      best = double(sign) * (camera_.position({nx + 0.5, ny + 0.5}, *there) - position);
    }
  }
  return best;
}

std::optional<glm::dvec3> SurfaceReader::normalFromDepth(const DepthImage& depth, int x, int y,
                                                         const glm::dvec3& position) const {
  const glm::dvec3 n =
      glm::cross(slopeAlong(depth, x, y, 1, 0, position), slopeAlong(depth, x, y, 0, 1, position));
  const double length = glm::length(n);
  if (!(length > 0) || !finite(n)) return std::nullopt;
  return glm::dot(n, camera_.rayThrough(position)) > 0 ? -n / length : n / length;
}

std::optional<glm::dvec3> SurfaceReader::facet(const Surface& s) const {
  return normalFromDepth(capture_.frontDepth, s.pixel.x, s.pixel.y, s.position);
}

std::optional<glm::dvec3> SurfaceReader::backFacet(const Surface& s) const {
  if (!s.chord) return std::nullopt;
  return normalFromDepth(capture_.backDepth, s.pixel.x, s.pixel.y, s.position + *s.chord * s.ray);
}

SurfaceReader::Footprint SurfaceReader::footprint(int x, int y, const Surface& s) const {
  const glm::dvec3 flatX = flatStep(x, y, s.position, {1, 0}), flatY = flatStep(x, y, s.position, {0, 1});
  glm::dvec3 n = s.normal ? *s.normal : facet(s).value_or(-s.ray);
  if (glm::dot(n, s.ray) > 0) n = -n;
  const double cosine = -glm::dot(n, s.ray);
  if (cosine < kLeastCosine) {
    const glm::dvec3 sideways = n + cosine * s.ray;
    n = -kLeastCosine * s.ray + std::sqrt(1 - kLeastCosine * kLeastCosine) * glm::normalize(sideways);
  }
  // Differential of the intersection of the pixel's ray with the tangent plane.
  const auto onPlane = [&](const glm::dvec3& flat) {
    return 0.5 * (flat - s.ray * (glm::dot(n, flat) / glm::dot(n, s.ray)));
  };
  return {onPlane(flatX), onPlane(flatY)};
}

}  // namespace pellucid::harness::reference
