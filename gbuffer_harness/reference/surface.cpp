#include "reference/surface.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {
namespace {

// Sides of a pixel that a quad's pixels lie behind the nearest one, at most: a surface at 83 degrees.
constexpr double kReach = 8;

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
      worldFromView_(glm::inverse(toGlm(capture.viewFromWorld))),
      quadColumns_((capture.width + 1) / 2),
      quadRows_((capture.height + 1) / 2) {
  requireImage(capture, capture.frontDepth.image, "frontDepth", 1, false);
  requireImage(capture, capture.backDepth.image, "backDepth", 1, true);
  requireImage(capture, capture.irradiance, "irradiance", 3, false);
  requireImage(capture, capture.hiddenIrradiance, "hiddenIrradiance", 3, true);
  requireImage(capture, capture.albedo, "albedo", 3, true);
  const std::size_t pixels = capture.irradiance.pixels();
  if (capture.material.size() != pixels)
    throw InputError(capture.name, "material",
                     std::to_string(capture.material.size()) + " pixels; need " + std::to_string(pixels));
  for (int row = 0; row < quadRows_; ++row)
    for (int column = 0; column < quadColumns_; ++column) quads_.push_back(makeQuad(column, row));
}

std::uint8_t SurfaceReader::materialAt(int x, int y) const {
  return capture_.material[pixelNumber(capture_.irradiance, x, y)];
}

std::optional<double> SurfaceReader::planarDepth(const DepthImage& depth, int x, int y) const {
  return camera_.planarDepth(*depth.image.at(x, y), depth.encoding);
}

SurfaceReader::Quad SurfaceReader::makeQuad(int column, int row) const {
  struct Pixel {
    int x, y;
    double depth;
  };
  std::vector<Pixel> pixels;
  for (int y = 2 * row; y < std::min(2 * row + 2, capture_.height); ++y)
    for (int x = 2 * column; x < std::min(2 * column + 2, capture_.width); ++x)
      if (const auto depth = planarDepth(capture_.frontDepth, x, y); depth && materialAt(x, y) != 0)
        pixels.push_back({x, y, *depth});
  if (pixels.empty()) return {};
  const Pixel nearest = *std::min_element(pixels.begin(), pixels.end(),
                                          [](const Pixel& a, const Pixel& b) { return a.depth < b.depth; });
  const glm::dvec3 position = camera_.position({nearest.x + 0.5, nearest.y + 0.5}, nearest.depth);
  const double side = std::min(glm::length(flatStep(nearest.x, nearest.y, position, {1, 0})),
                               glm::length(flatStep(nearest.x, nearest.y, position, {0, 1})));
  Quad quad{materialAt(nearest.x, nearest.y), nearest.depth + kReach * side};
  double count = 0;
  for (const Pixel& pixel : pixels) {
    if (materialAt(pixel.x, pixel.y) != quad.material || pixel.depth > quad.farthest) continue;
    quad.middle += camera_.position({pixel.x + 0.5, pixel.y + 0.5}, pixel.depth);
    ++count;
  }
  quad.middle /= count;
  return quad;
}

SurfaceReader::Quad SurfaceReader::quadAt(glm::ivec2 place) const {
  if (place.x < 0 || place.y < 0 || place.x >= quadColumns_ || place.y >= quadRows_) return {};
  return quads_[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(quadColumns_) +
                static_cast<std::size_t>(place.x)];
}

glm::dvec3 SurfaceReader::quadSlope(glm::ivec2 place, glm::ivec2 step) const {
  const Quad own = quadAt(place);
  const double depth = camera_.planarDepth(own.middle);
  glm::dvec3 best = flatStep(2 * place.x, 2 * place.y, own.middle, 2 * step);
  double least = INFINITY;
  for (const int sign : {1, -1}) {
    const Quad other = quadAt(place + sign * step);
    const double difference = std::abs(camera_.planarDepth(other.middle) - depth);
    if (other.material != own.material || !(difference < least)) continue;
    least = difference;
    best = double(sign) * (other.middle - own.middle);
  }
  return best;
}

// The least squares are of offsets along the ray, over the quads of the same material that lie within a
// pixel's side of the tangent plane: quads beyond an edge do not. Within twice as much, limbs of a ball of 32
// pixels' radius would have 2 % too much area; within half as much, 2 % too little.
std::optional<glm::dvec3> SurfaceReader::quadNormal(glm::ivec2 place) const {
  const Quad own = quadAt(place);
  const glm::dvec3 ray = camera_.rayThrough(own.middle);
  glm::dvec3 tangent = glm::cross(quadSlope(place, {1, 0}), quadSlope(place, {0, 1}));
  if (!(glm::length(tangent) > 0) || !finite(tangent)) return std::nullopt;
  tangent = glm::normalize(glm::dot(tangent, ray) > 0 ? -tangent : tangent);
  const double side = std::max(glm::length(flatStep(2 * place.x, 2 * place.y, own.middle, {1, 0})),
                               glm::length(flatStep(2 * place.x, 2 * place.y, own.middle, {0, 1})));
  std::vector<glm::dvec3> points;
  glm::dvec3 mean(0);
  for (int y = -1; y <= 1; ++y)
    for (int x = -1; x <= 1; ++x) {
      const Quad other = quadAt(place + glm::ivec2(x, y));
      const glm::dvec3 apart = other.middle - own.middle;
      if (other.material != own.material || !(std::abs(glm::dot(apart, tangent)) <= side)) continue;
      points.push_back(apart);
      mean += apart;
    }
  mean /= static_cast<double>(points.size());
  const glm::dvec3 right =
      glm::normalize(glm::cross(ray, std::abs(ray.x) < 0.8 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0)));
  const glm::dvec3 down = glm::cross(ray, right);
  double rr = 0, rd = 0, dd = 0;
  glm::dvec2 along(0);
  for (const glm::dvec3& point : points) {
    const double x = glm::dot(point - mean, right), y = glm::dot(point - mean, down);
    rr += x * x;
    rd += x * y;
    dd += y * y;
    along += glm::dot(point - mean, ray) * glm::dvec2(x, y);
  }
  const double determinant = rr * dd - rd * rd;
  constexpr double kInLine = 1e-3;  // of quads in one line, which leave the plane's turn about it open
  if (!(determinant > kInLine * rr * dd)) return tangent;
  const double x = (dd * along.x - rd * along.y) / determinant,
               y = (rr * along.y - rd * along.x) / determinant;
  const glm::dvec3 normal = x * right + y * down - ray;
  return finite(normal) ? std::optional(glm::normalize(normal)) : std::nullopt;
}

std::optional<Surface> SurfaceReader::at(int x, int y) const {
  const std::optional<double> front = planarDepth(capture_.frontDepth, x, y);
  if (!front) return std::nullopt;
  const glm::dvec2 center(x + 0.5, y + 0.5);
  Surface s;
  s.position = camera_.position(center, *front);
  s.ray = camera_.rayThrough(s.position);
  s.pixel = {x, y};
  const Quad quad = quadAt({x / 2, y / 2});
  if (quad.material != 0 && quad.material == materialAt(x, y) && *front <= quad.farthest) {
    s.normal = quadNormal({x / 2, y / 2}).value_or(-s.ray);
    s.middle = quad.middle;
  } else {
    s.normal = facet(s);
    s.middle = s.position;
  }
  if (capture_.backDepth.encoding == PELLUCID_DEPTH_THICKNESS) {
    const float mm = capture_.backDepth.image.empty() ? -1 : *capture_.backDepth.image.at(x, y);
    if (holdsThickness(mm)) s.chord = double(mm) / millimetersPerUnit();
  } else if (!capture_.backDepth.image.empty()) {
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

// Displacement along the surface per pixel step, from the neighbors of the same material to both sides. The
// nearer neighbor counts more, as the farther one may lie across an edge. Beyond a pixel of another material,
// as of dithered hair, the next pixel stands for the neighbor, half as far off in depth. Without neighbors
// the displacement is that of a facing surface.
glm::dvec3 SurfaceReader::slopeAlong(const DepthImage& depth, int x, int y, int stepX, int stepY,
                                     const glm::dvec3& position) const {
  glm::dvec3 sum(0);
  double total = 0;
  for (const int sign : {1, -1}) {
    const auto planarAt = [&](int away) -> std::optional<double> {
      const int nx = x + away * sign * stepX, ny = y + away * sign * stepY;
      if (nx < 0 || ny < 0 || nx >= capture_.width || ny >= capture_.height) return std::nullopt;
      if (materialAt(nx, ny) != materialAt(x, y)) return std::nullopt;
      return planarDepth(depth, nx, ny);
    };
    const double own = camera_.planarDepth(position);
    std::optional<double> there = planarAt(1);
    if (!there)
      if (const std::optional<double> next = planarAt(2)) there = 0.5 * (own + *next);
    if (!there) continue;
    const int nx = x + sign * stepX, ny = y + sign * stepY;
    const glm::dvec3 step = double(sign) * (camera_.position({nx + 0.5, ny + 0.5}, *there) - position);
    const double weight = 1 / std::pow(glm::dot(step, step), 2);
    sum += weight * step;
    total += weight;
  }
  return total > 0 ? sum / total : flatStep(x, y, position, {stepX, stepY});
}

std::optional<glm::dvec3> SurfaceReader::normalFromDepth(const DepthImage& depth, int x, int y,
                                                         const glm::dvec3& position) const {
  const glm::dvec3 n =
      glm::cross(slopeAlong(depth, x, y, 1, 0, position), slopeAlong(depth, x, y, 0, 1, position));
  const double length = glm::length(n);
  if (!(length > 0) || !finite(n)) return std::nullopt;
  return glm::dot(n, camera_.rayThrough(position)) > 0 ? -n / length : n / length;
}

glm::dvec3 SurfaceReader::facet(const Surface& s) const {
  return normalFromDepth(capture_.frontDepth, s.pixel.x, s.pixel.y, s.position).value_or(-s.ray);
}

std::optional<glm::dvec3> SurfaceReader::backFacet(const Surface& s) const {
  if (!s.chord) return std::nullopt;
  return normalFromDepth(capture_.backDepth, s.pixel.x, s.pixel.y, s.position + *s.chord * s.ray);
}

double SurfaceReader::chordBeside(const Surface& s) const {
  double least = INFINITY;
  for (const glm::ivec2& step : {glm::ivec2(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
    const glm::ivec2 p = s.pixel + step;
    if (p.x < 0 || p.y < 0 || p.x >= capture_.width || p.y >= capture_.height ||
        materialAt(p.x, p.y) != materialAt(s.pixel.x, s.pixel.y))
      continue;
    if (const std::optional<Surface> beside = at(p.x, p.y); beside && beside->chord)
      least = std::min(least, *beside->chord * std::abs(beside->ray.z / s.ray.z));
  }
  return std::isinf(least) ? *s.chord : std::max(*s.chord, least);
}

SurfaceReader::HiddenFace SurfaceReader::hiddenFace(const Surface& s) const {
  const glm::dvec3 front = facet(s);
  if (capture_.backDepth.encoding == PELLUCID_DEPTH_THICKNESS)
    return {s.position - *s.chord * front, -front, *s.chord, 1};
  const std::optional<glm::dvec3> towardsEye = backFacet(s);
  const glm::dvec3 back = towardsEye ? -*towardsEye : -front;
  const double cosine = std::abs(glm::dot(front, s.ray)), other = std::abs(glm::dot(back, s.ray));
  const double seen = std::min(3 * std::min(cosine, other), 1.0);
  return {s.position + *s.chord * s.ray, back, 0.5 * chordBeside(s) * (cosine + other),
          seen * (0.5 - 0.5 * glm::dot(front, back))};
}

SurfaceReader::Footprint SurfaceReader::footprint(int x, int y, const Surface& s) const {
  const glm::dvec3 flatX = flatStep(x, y, s.position, {1, 0}), flatY = flatStep(x, y, s.position, {0, 1});
  glm::dvec3 n = s.normal;
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
