#include "reference/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_access.hpp>
#include <iterator>
#include <optional>

#include "common/error.h"
#include "reference/light.h"

namespace pellucid::harness::reference {
namespace {

// Kernels leave out this share beyond their radius.
constexpr double kTail = 1e-4;
// Texels per side of a block that is skipped as a whole where it is out of reach.
constexpr int kBlock = 16;
// A surface seen more obliquely by the light than this counts as if it were not.
constexpr double kLeastCosine = 0.05;
// What curvature adds to the diffusion, or takes from it, at most.
constexpr double kMostConvexity = 0.1;
// Texels: a point on a surface and the pixel that shows it are apart by the slope within them.
constexpr double kSeenTolerance = 0.5;

bool contains(const ShadowMap& map, const glm::dvec3& point) {
  const glm::dvec4 clip = toMatrix(map.clipFromWorld) * glm::dvec4(point, 1);
  return clip.w > 0 && std::abs(clip.x) <= clip.w && std::abs(clip.y) <= clip.w;
}

// Positions of a map's texels, world, scene units.
class Unprojected {
public:
  Unprojected(const Light& light, const ShadowMap& map)
      : light_(light), map_(map), clipFromWorld_(toMatrix(map.clipFromWorld)) {
    const double determinant = glm::determinant(clipFromWorld_);
    if (!(std::abs(determinant) > 0))
      throw InputError("", "shadowMap.clipFromWorld", "the matrix is singular");
    worldFromClip_ = glm::inverse(clipFromWorld_);
    perspective_ = light.type != PELLUCID_LIGHT_DIRECTIONAL;
    if (map.viewFromWorld) viewFromWorld_ = toMatrix(*map.viewFromWorld);
    const bool planar = map.depth.encoding == PELLUCID_DEPTH_VIEW_Z ||
                        (map.depth.encoding == PELLUCID_DEPTH_DISTANCE && !perspective_);
    if (planar && !map.viewFromWorld)
      throw InputError("", "shadowMap.viewFromWorld", "missing, and the depth encoding needs it");
    // Depth grows away from the light, or is reversed.
    const Line ray = rayAt(0.5 * map.depth.image.width, 0.5 * map.depth.image.height);
    const glm::dvec4 far = clipFromWorld_ * glm::dvec4(ray.at(1), 1),
                     near = clipFromWorld_ * glm::dvec4(ray.origin, 1);
    nothing_ = far.z * near.w > near.z * far.w ? 1.0f : 0.0f;
  }

  struct Line {
    glm::dvec3 origin, direction;  // direction of travel, unit
    glm::dvec3 at(double t) const { return origin + t * direction; }
  };
  // The light's ray through continuous map coordinates.
  Line rayAt(double x, double y) const {
    const glm::dvec2 ndc(x / map_.depth.image.width * 2 - 1, y / map_.depth.image.height * 2 - 1);
    // Neither end of the depth range: an infinite one has no point there.
    const glm::dvec4 a = worldFromClip_ * glm::dvec4(ndc, 0.25, 1),
                     b = worldFromClip_ * glm::dvec4(ndc, 0.75, 1);
    const glm::dvec3 p = glm::dvec3(a) / a.w, q = glm::dvec3(b) / b.w;
    if (!perspective_) return {p, glm::normalize(toVector(light_.direction))};
    const glm::dvec3 eye = toVector(light_.position);
    return {eye, glm::normalize(0.5 * (p + q) - eye)};
  }

  std::optional<glm::dvec3> at(int x, int y) const {
    const float stored = *map_.depth.image.at(x, y);
    const Line ray = rayAt(x + 0.5, y + 0.5);
    if (map_.depth.encoding == PELLUCID_DEPTH_DEVICE) {
      if (!(stored >= 0 && stored <= 1) || stored == nothing_) return std::nullopt;
      const Image& image = map_.depth.image;
      const glm::dvec4 p = worldFromClip_ * glm::dvec4((x + 0.5) / image.width * 2 - 1,
                                                       (y + 0.5) / image.height * 2 - 1, double(stored), 1);
      return glm::dvec3(p) / p.w;
    }
    if (!holdsSurface(stored)) return std::nullopt;
    if (map_.depth.encoding == PELLUCID_DEPTH_DISTANCE && perspective_) return ray.at(stored);
    const glm::dvec4 planar = -glm::row(viewFromWorld_, 2);
    const double from = glm::dot(planar, glm::dvec4(ray.origin, 1));
    const double perLength = glm::dot(glm::dvec3(planar), ray.direction);
    return ray.at((stored - from) / perLength);
  }

  // Area across the light's ray that a texel covers at a point, square scene units.
  double across(int x, int y, const glm::dvec3& point) const {
    const Line center = rayAt(x + 0.5, y + 0.5), right = rayAt(x + 1.5, y + 0.5),
               below = rayAt(x + 0.5, y + 1.5);
    if (!perspective_)
      return std::abs(
          glm::dot(glm::cross(right.origin - center.origin, below.origin - center.origin), center.direction));
    const double distance = glm::distance(point, center.origin);
    const glm::dvec3 solid =
        glm::cross(right.direction - center.direction, below.direction - center.direction);
    return std::abs(glm::dot(solid, center.direction)) * distance * distance;
  }

private:
  static glm::dvec3 toVector(const std::array<double, 3>& a) { return {a[0], a[1], a[2]}; }

  const Light& light_;
  const ShadowMap& map_;
  glm::dmat4 clipFromWorld_, worldFromClip_{1}, viewFromWorld_{1};
  bool perspective_;
  float nothing_;
};

}  // namespace

Gather::Gather(const Capture& capture, const SurfaceReader& surfaces,
               const std::vector<PellucidMaterial>& materials, double shadowBias)
    : capture_(capture), surfaces_(surfaces), mm_(surfaces.millimetersPerUnit()) {
  for (const PellucidMaterial& m : materials) {
    kernels_.emplace_back(m);
    radii_.push_back(kernels_.back().radius(kTail));
  }
  for (const Light& light : capture.lights) {
    Blocks& blocks = lights_.emplace_back();
    for (std::size_t map = 0; map < light.shadowMaps.size(); ++map) {
      Blocks more = collect(light, map, shadowBias);
      std::move(more.begin(), more.end(), std::back_inserter(blocks));
    }
  }
}

// What faces away cannot be seen, however thin the part is; what faces the camera is seen unless
// something is clearly in front of it.
bool Gather::cameraSees(const glm::dvec3& world, const glm::dvec3& normal, double tolerance) const {
  const glm::dmat4 viewFromWorld = glm::inverse(surfaces_.worldFromView());
  const glm::dvec3 view(viewFromWorld * glm::dvec4(world, 1));
  const Camera& camera = surfaces_.camera();
  const double planar = camera.planarDepth(view);
  if (!(planar > 0)) return false;
  if (glm::dot(glm::dmat3(viewFromWorld) * normal, camera.rayThrough(view)) > 0) return false;
  const glm::dvec2 pixel = glm::floor(camera.project(view));
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < capture_.width && pixel.y < capture_.height)) return false;
  const std::optional<double> front =
      camera.planarDepth(*capture_.frontDepth.image.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)),
                         capture_.frontDepth.encoding);
  return front && planar <= *front + tolerance;
}

Gather::Blocks Gather::collect(const Light& light, std::size_t mapIndex, double bias) const {
  const ShadowMap& map = light.shadowMaps[mapIndex];
  const int width = map.depth.image.width, height = map.depth.image.height;
  const Unprojected unprojected(light, map);
  std::vector<std::optional<glm::dvec3>> points;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) points.push_back(unprojected.at(x, y));
  const auto point = [&](int x, int y) -> const std::optional<glm::dvec3>& {
    return points[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  };
  // Along one axis, to the nearer of the two neighbors: the other may lie across an edge.
  const auto slope = [&](int x, int y, int dx, int dy) {
    std::optional<glm::dvec3> best;
    for (const int sign : {1, -1}) {
      const int nx = x + sign * dx, ny = y + sign * dy;
      if (nx < 0 || ny < 0 || nx >= width || ny >= height || !point(nx, ny)) continue;
      const glm::dvec3 step = double(sign) * (*point(nx, ny) - *point(x, y));
      if (!best || glm::dot(step, step) < glm::dot(*best, *best)) best = step;
    }
    return best;
  };
  Blocks blocks;
  for (int top = 0; top < height; top += kBlock)
    for (int left = 0; left < width; left += kBlock) {
      Block block;
      glm::dvec3 low(INFINITY), high(-INFINITY);
      for (int y = top; y < std::min(top + kBlock, height); ++y)
        for (int x = left; x < std::min(left + kBlock, width); ++x) {
          const std::optional<glm::dvec3>& p = point(x, y);
          if (!p) continue;
          if (std::any_of(light.shadowMaps.begin(),
                          light.shadowMaps.begin() + static_cast<std::ptrdiff_t>(mapIndex),
                          [&](const ShadowMap& earlier) { return contains(earlier, *p); }))
            continue;
          const Arrival arrival = arrivalAt(light, *p);
          glm::dvec3 normal = arrival.toLight;
          const auto right = slope(x, y, 1, 0), below = slope(x, y, 0, 1);
          if (right && below) {
            const glm::dvec3 n = glm::cross(*right, *below);
            if (glm::length(n) > 0) normal = glm::normalize(glm::dot(n, arrival.toLight) < 0 ? -n : n);
          }
          const double across = unprojected.across(x, y, *p);
          if (cameraSees(*p, normal, kSeenTolerance * std::sqrt(across) + bias)) continue;
          const double area = across * mm_ * mm_;
          const double cosine = std::max(glm::dot(normal, arrival.toLight), kLeastCosine);
          block.texels.push_back({*p * mm_, normal, arrival.irradiance * area, area / cosine});
          low = glm::min(low, *p * mm_);
          high = glm::max(high, *p * mm_);
        }
      if (block.texels.empty()) continue;
      block.center = 0.5 * (low + high);
      block.radius = 0.5 * glm::distance(low, high);
      blocks.push_back(std::move(block));
    }
  return blocks;
}

std::size_t Gather::hiddenTexels() const {
  std::size_t count = 0;
  for (const Blocks& blocks : lights_)
    for (const Block& b : blocks) count += b.texels.size();
  return count;
}

double Gather::meanCurvature(const Surface& surface, double reach) const {
  const Camera& camera = surfaces_.camera();
  const glm::dvec2 pixel = glm::floor(camera.project(surface.position));
  const double planar = camera.planarDepth(surface.position);
  const auto side = [&](glm::dvec2 step) {
    return mm_ * glm::distance(camera.position(pixel + step, planar), camera.position(pixel, planar));
  };
  const glm::dvec2 steps = glm::max(glm::floor(reach / glm::dvec2(side({1, 0}), side({0, 1})) + 0.5), 1.0);
  struct Beside {
    glm::dvec3 apart, turn;  // mm; of the normal
  };
  const auto beside = [&](glm::dvec2 step) -> std::optional<Beside> {
    const glm::dvec2 at = pixel + step * steps;
    if (!(at.x >= 0 && at.y >= 0 && at.x < capture_.width && at.y < capture_.height)) return std::nullopt;
    const std::optional<Surface> other = surfaces_.at(static_cast<int>(at.x), static_cast<int>(at.y));
    if (!other || !other->normal) return std::nullopt;
    const glm::dvec3 apart = mm_ * (other->position - surface.position);
    if (!(glm::length(apart) < 3 * reach)) return std::nullopt;
    return Beside{apart, *other->normal - *surface.normal};
  };
  double sum = 0;
  int count = 0;
  for (const double x : {1, -1})
    for (const double y : {1, -1}) {
      const std::optional<Beside> a = beside({x, 0}), b = beside({0, y});
      if (!a || !b) continue;
      // The trace of the map from steps to turns of the normal.
      const double area = glm::dot(*surface.normal, glm::cross(a->apart, b->apart));
      if (!(std::abs(area) > 0.1 * glm::length(a->apart) * glm::length(b->apart))) continue;
      sum += 0.5 * glm::dot(*surface.normal, glm::cross(a->turn, b->apart) + glm::cross(a->apart, b->turn)) /
             area;
      ++count;
    }
  return count > 0 ? sum / count : 0;
}

Gathered Gather::at(const Surface& surface, std::size_t material) const {
  const GatherKernel& kernel = kernels_[material];
  const double radius = radii_[material];
  const glm::dmat4& worldFromView = surfaces_.worldFromView();
  const glm::dvec3 x = mm_ * glm::dvec3(worldFromView * glm::dvec4(surface.position, 1));
  const std::optional<glm::dvec3> normal =
      surface.normal ? std::optional(glm::dmat3(worldFromView) * *surface.normal) : std::nullopt;
  Gathered result;
  glm::dvec3 irradiance(0);  // mean of what is displaced, of all lights
  for (const Blocks& blocks : lights_) {
    glm::dvec3 displaced(0), entering(0);
    for (const Block& block : blocks) {
      if (glm::distance(block.center, x) > block.radius + radius) continue;
      for (const Texel& y : block.texels) {
        const glm::dvec3 to = x - y.position;
        GatherPath path = gatherPath(to, normal.value_or(-y.normal), y.normal);
        // Half a texel: nearer than that the sum is no integral.
        path.distance = std::max(path.distance, 0.5 * std::sqrt(y.area));
        if (path.distance > radius) continue;
        result.transmitted += (1 - path.facing) * kernel.transmitted(path.distance, path.depth) * y.flux;
        const glm::dvec3 reflected = path.facing * kernel.reflected(path.distance);
        entering += reflected * y.flux;
        displaced += reflected * y.area;
      }
    }
    result.entering += entering;
    irradiance += entering / glm::max(glm::min(displaced, glm::dvec3(1)), glm::dvec3(1e-12));
  }
  result.displaced = result.entering / glm::max(irradiance, glm::dvec3(1e-12));
  const glm::dvec3 convexity = kernel.convexity();
  const double reach = 2 * std::max({convexity.r, convexity.g, convexity.b});
  if (surface.normal && reach > 0)
    result.displaced += glm::clamp(-convexity * meanCurvature(surface, reach), -kMostConvexity, kMostConvexity);
  return result;
}

}  // namespace pellucid::harness::reference
