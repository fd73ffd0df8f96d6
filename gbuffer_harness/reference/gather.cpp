#include "reference/gather.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <iterator>
#include <numbers>
#include <optional>

#include "capture/capture.h"
#include "common/error.h"
#include "reference/camera.h"
#include "reference/light.h"

namespace pellucid::harness::reference {
namespace {

// Kernels leave out this share beyond their radius.
constexpr double kTail = 1e-4;
// Texels per side of a block that is skipped as a whole where it is out of reach.
constexpr int kBlock = 16;
// A surface seen more obliquely by the light than this counts as if it were not.
constexpr double kLeastCosine = 0.2;
// Slope of an exit's own surface across the light within a texel, at most: that of kLeastCosine.
const double kSteepestOwn = std::sqrt(1 - kLeastCosine * kLeastCosine) / kLeastCosine;
// Texels: a point on a surface and the pixel that shows it are apart by the slope within them.
constexpr double kSeenTolerance = 0.5;
// A face that turns away from the light by more than 30 degrees is the other face of a thin part.
constexpr double kMostTurned = 0.5;
// Slope towards the camera from which a surface is a limb.
constexpr double kSteepestSeen = 2;

}  // namespace

Gather::Gather(const Capture& capture, const SurfaceReader& surfaces,
               const std::vector<PellucidMaterial>& materials, bool diffused)
    : capture_(capture), surfaces_(surfaces), mm_(surfaces.millimetersPerUnit()), diffused_(diffused) {
  for (const PellucidMaterial& m : materials) {
    kernels_.push_back(m.thinWalled ? std::nullopt : std::optional<GatherKernel>(m));
    radii_.push_back(m.thinWalled ? 0 : kernels_.back()->radius(kTail));
  }
  for (const Light& light : capture.lights) {
    Blocks& blocks = lights_.emplace_back();
    std::vector<ShadowView>& views = views_.emplace_back();
    if (holdsBackFaces(light)) continue;
    for (const ShadowMap& map : light.shadowMaps) {
      views.emplace_back(light, map);
      Blocks more = collect(light, map, views);
      std::move(more.begin(), more.end(), std::back_inserter(blocks));
    }
  }
}

// The camera knows the normals of what it shows better than the neighbors of a texel that the light grazes.
std::optional<glm::dvec3> Gather::shownNormal(const glm::dvec3& world, const glm::dvec3& toLight,
                                              double tolerance, double uncertain, double offset,
                                              bool biased) const {
  const glm::dvec3 view(glm::inverse(surfaces_.worldFromView()) * glm::dvec4(world, 1));
  const Camera& camera = surfaces_.camera();
  if (!(camera.planarDepth(view) > 0)) return std::nullopt;
  const glm::dvec2 pixel = glm::floor(camera.project(view));
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < capture_.width && pixel.y < capture_.height))
    return std::nullopt;
  const int x = static_cast<int>(pixel.x), y = static_cast<int>(pixel.y);
  if (capture_.material[pixelNumber(capture_.irradiance, x, y)] == 0) return std::nullopt;
  const std::optional<Surface> shown = surfaces_.at(x, y);
  if (!shown) return std::nullopt;
  const glm::dvec3& normal = shown->normal;
  // Limbs, seen at 63 degrees and more, show few of the points where light enters.
  const double facing = std::abs(glm::dot(normal, shown->ray));
  if (!biased && facing * kSteepestSeen <= std::sqrt(1 - std::min(facing * facing, 1.0))) return std::nullopt;
  const double planar = camera.planarDepth(shown->position);
  const auto side = [&](glm::dvec2 step) {
    return glm::distance(camera.position(pixel + 0.5 + step, planar), camera.position(pixel + 0.5, planar));
  };
  const double pixelSide = std::max(side({1, 0}), side({0, 1}));
  const glm::dvec3 outward = glm::dmat3(surfaces_.worldFromView()) * normal;
  if (glm::dot(outward, toLight) <= -kMostTurned) return std::nullopt;
  if (std::abs(glm::dot(normal, view - shown->position)) >
      std::min(tolerance, 0.5 * pixelSide) + offset + uncertain * std::abs(glm::dot(outward, toLight)))
    return std::nullopt;
  return outward;
}

// A face that turns away from the camera cannot be seen, however thin the part is. A face that looks at the
// camera is seen unless something is clearly in front of it.
bool Gather::cameraSees(const glm::dvec3& world, const glm::dvec3& normal, double tolerance,
                        double off) const {
  const glm::dmat4 viewFromWorld = glm::inverse(surfaces_.worldFromView());
  const glm::dvec3 view(viewFromWorld * glm::dvec4(world, 1));
  const Camera& camera = surfaces_.camera();
  const double planar = camera.planarDepth(view);
  if (!(planar > 0)) return false;
  const glm::dvec3 ray = camera.rayThrough(view);
  const double facing = -glm::dot(glm::dmat3(viewFromWorld) * normal, ray);
  if (facing < 0) return false;
  // Along the ray, and of that the planar part.
  tolerance += off / std::max(facing, kLeastCosine) * std::abs(ray.z);
  const glm::dvec2 pixel = glm::floor(camera.project(view));
  if (!(pixel.x >= 0 && pixel.y >= 0 && pixel.x < capture_.width && pixel.y < capture_.height)) return false;
  const std::optional<double> front =
      camera.planarDepth(*capture_.frontDepth.image.at(static_cast<int>(pixel.x), static_cast<int>(pixel.y)),
                         capture_.frontDepth.encoding);
  return front && planar <= *front + tolerance;
}

Gather::Blocks Gather::collect(const Light& light, const ShadowMap& map,
                               const std::vector<ShadowView>& views) const {
  const int width = map.depth.image.width, height = map.depth.image.height;
  const ShadowView& texels = views.back();
  std::vector<std::optional<glm::dvec3>> points;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) points.push_back(texels.surfaceAt(x, y));
  const auto point = [&](int x, int y) -> const std::optional<glm::dvec3>& {
    return points[pixelNumber(map.depth.image, x, y)];
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
          if (std::any_of(views.begin(), views.end() - 1,
                          [&](const ShadowView& earlier) { return earlier.contains(*p); }))
            continue;
          const Arrival arrival = arrivalAt(light, *p);
          glm::dvec3 normal = arrival.toLight;
          const auto right = slope(x, y, 1, 0), below = slope(x, y, 0, 1);
          if (right && below) {
            const glm::dvec3 n = glm::cross(*right, *below);
            if (glm::length(n) > 0) normal = glm::normalize(glm::dot(n, arrival.toLight) < 0 ? -n : n);
          }
          const double across = texels.across(x, y, *p);
          const std::uint8_t of =
              map.casterMaterial.empty() ? 0 : map.casterMaterial[pixelNumber(map.depth.image, x, y)];
          if (!map.casterMaterial.empty() && of == 0) continue;
          if (texels.isClamped(x, y)) continue;
          double exit = INFINITY;
          if (!map.exitDepth.empty())
            if (const auto e = texels.pointAt(x, y, *map.exitDepth.at(x, y)))
              exit = mm_ * glm::distance(*e, *p);
          const double half = kSeenTolerance * std::sqrt(across), uncertain = texels.uncertain(x, y);
          const auto shown = shownNormal(*p, arrival.toLight, half, uncertain, std::abs(map.offsetLength),
                                         map.depthBiasSlope != 0 || map.offsetLength != 0);
          if (shown) normal = *shown;
          // A depth that is off along the light moves the surface along its normal.
          const bool seen =
              shown || cameraSees(*p, normal, half, uncertain * glm::dot(normal, arrival.toLight));
          if (seen && !diffused_) continue;
          const double area = across * mm_ * mm_;
          const double cosine = glm::dot(normal, arrival.toLight), held = std::max(cosine, kLeastCosine);
          block.texels.push_back({*p * mm_, normal, arrival.irradiance * area, area / held,
                                  std::max(cosine, 0.0) / held, seen, exit, of});
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

double Gather::facetReach(const Surface& surface) const {
  const Camera& camera = surfaces_.camera();
  const double planar = camera.planarDepth(surface.position);
  const glm::dvec2 pixel = camera.project(surface.position);
  return 2 * mm_ *
         glm::distance(camera.position(pixel + glm::dvec2(1, 0), planar), camera.position(pixel, planar));
}

double Gather::meanCurvature(const Surface& surface, double reach) const {
  const Camera& camera = surfaces_.camera();
  const glm::dvec2 pixel = glm::floor(camera.project(surface.position));
  const double planar = camera.planarDepth(surface.position);
  const glm::dvec3& normal = surface.normal;
  // Pixels that `reach` takes on the tangent plane, at least to the next quad; planes seen edge-on would have
  // no end.
  const auto pixelAlong = [&](glm::dvec2 step) {
    glm::dvec3 side = camera.position(pixel + step, planar) - camera.position(pixel, planar);
    side -= surface.ray * (glm::dot(normal, side) / std::min(glm::dot(normal, surface.ray), -0.1));
    return mm_ * glm::length(side);
  };
  const double side = std::max(pixelAlong({1, 0}), pixelAlong({0, 1}));
  const double known = std::min(reach / side, 1.0);  // less than a pixel's side is not seen
  reach = std::max(reach, 2 * side);
  const auto stepsAlong = [&](glm::dvec2 step) {
    return std::max(2.0, std::floor(reach / pixelAlong(step) + 0.5));
  };
  struct Beside {
    glm::dvec3 apart{0}, turn{0};  // mm; of the normal
    double weight = 0;             // 1 where the surface goes on
  };
  const auto beside = [&](glm::dvec2 step) -> Beside {
    const glm::dvec2 at = pixel + step;
    if (!(at.x >= 0 && at.y >= 0 && at.x < capture_.width && at.y < capture_.height)) return {};
    const std::optional<Surface> other = surfaces_.at(static_cast<int>(at.x), static_cast<int>(at.y));
    if (!other) return {};
    const glm::dvec3 apart = mm_ * (other->middle - surface.middle);
    const double ratio = glm::dot(apart, apart) / (reach * reach);
    return {apart, other->normal - normal, std::clamp((9 - ratio) / 5, 0.0, 1.0)};
  };
  const auto across = [&](glm::dvec2 axis) -> Beside {
    const double steps = stepsAlong(axis);
    const Beside f = beside(steps * axis), b = beside(-steps * axis);
    return {f.weight * f.apart - b.weight * b.apart, f.weight * f.turn - b.weight * b.turn,
            std::max(f.weight, b.weight)};
  };
  const Beside a = across({1, 0}), b = across({0, 1});
  // The trace of the map from steps to turns of the normal.
  const double area = glm::dot(normal, glm::cross(a.apart, b.apart));
  if (!(std::abs(area) > 0.1 * glm::length(a.apart) * glm::length(b.apart))) return 0;
  const double trace = glm::dot(normal, glm::cross(a.turn, b.apart) + glm::cross(a.apart, b.turn));
  return known * a.weight * b.weight * 0.5 * trace / area;
}

double Gather::thickness(const Surface& surface) const {
  if (!surface.chord) return INFINITY;
  if (capture_.backDepth.encoding == PELLUCID_DEPTH_THICKNESS) return *surface.chord * mm_;
  const glm::dvec2 pixel = glm::floor(surfaces_.camera().project(surface.position));
  struct BackFace {
    glm::dvec3 position;
    double chord;
  };
  const auto back = [&](glm::dvec2 at) -> std::optional<BackFace> {
    if (!(at.x >= 0 && at.y >= 0 && at.x < capture_.width && at.y < capture_.height)) return std::nullopt;
    const std::optional<Surface> s = surfaces_.at(static_cast<int>(at.x), static_cast<int>(at.y));
    if (!s || !s->chord) return std::nullopt;
    return BackFace{s->position + *s->chord * s->ray, *s->chord};
  };
  const glm::dvec3 here = surface.position + *surface.chord * surface.ray;
  double chord = *surface.chord;
  // To the nearer side: the other may lie across an edge. A crease of a pixel's width is no thin body.
  const auto slope = [&](glm::dvec2 axis) -> std::optional<glm::dvec3> {
    const auto f = back(pixel + axis), b = back(pixel - axis);
    if (f && b) {
      chord = std::max(chord, std::min(f->chord, b->chord));
      const glm::dvec3 forward = f->position - here, backward = here - b->position;
      return glm::length(backward) < glm::length(forward) ? backward : forward;
    }
    if (f) return f->position - here;
    if (b) return here - b->position;
    return std::nullopt;
  };
  glm::dvec3 outward = -surface.normal;
  const auto x = slope({1, 0}), y = slope({0, 1});
  if (x && y) {
    const glm::dvec3 n = glm::cross(*x, *y);
    if (glm::length(n) > 0) outward = glm::normalize(glm::dot(n, surface.ray) < 0 ? -n : n);
  }
  const double opposite = 0.5 - 0.5 * glm::dot(surface.normal, outward);
  // Pixels do not tell steeper faces, as of limbs of one pixel.
  const auto cosine = [&](const glm::dvec3& normal) {
    return std::max(std::abs(glm::dot(surface.ray, normal)), kLeastCosine);
  };
  return 0.5 * chord * mm_ * (cosine(surface.normal) + cosine(outward)) / std::max(opposite, 0.01);
}

BodyFactors Gather::bodyAt(const Surface& surface, std::size_t material) const {
  const GatherKernel& kernel = *kernels_[material];
  const double reach = kernel.bodyReach();
  if (!diffused_ || !(reach > 0)) return {};
  const double h = thickness(surface);
  return kernel.body(h, meanCurvature(surface, std::min(reach, h / 4)));
}

// Over the texels of a light's maps.
struct Gather::Sums {
  glm::dvec3 transmitted{0};            // exitance of what enters opposite
  glm::dvec3 entering{0}, hidden{0};    // of what enters hidden and alike: irradiance, part of the profile
  glm::dvec3 opposite{0};               // irradiance of what enters seen and opposite, by the profile
  glm::dvec3 seenEntering{0}, seen{0};  // of what enters seen and alike
};

Gather::Place Gather::placeOf(std::size_t light, const Exit& exit) const {
  const glm::dvec3 world = exit.position / mm_;
  const Arrival arrival = arrivalAt(capture_.lights[light], world);
  const double cosine = glm::dot(exit.normal, arrival.toLight);
  const double slope = std::min(
      std::sqrt(std::max(1 - cosine * cosine, 0.0)) / std::max(std::abs(cosine), 1e-3), kSteepestOwn);
  Place place;
  place.toLight = arrival.toLight;
  place.axis = glm::normalize(arrival.toLight + std::min(cosine, 0.0) * exit.normal);
  place.views = &views_[light];
  if (const ShadowView* view = ShadowView::find(views_[light], world)) {
    const ShadowView::Lookup found = view->at(world);
    place.tolerance = std::max(mm_ * found.texel * (2 + slope), 1e-12);
    double arrives = 1;
    if (found.kind == ShadowView::Kind::Surface) {
      // None where the lit surface is further ahead than a texel's side makes of the slope.
      arrives = std::clamp(2 - found.distance / (found.texel * (1 + slope)), 0.0, 1.0);
      const double behind = found.clamped ? 0 : mm_ * std::max(found.fromExit.value_or(0), 0.0);
      place.shadowed = std::clamp(behind / place.tolerance - 1, 0.0, 1.0);
      place.behind = behind * glm::dot(place.axis, place.toLight);
    }
    place.ownIrradiance = std::max(cosine, 0.0) * arrives * arrival.irradiance;
  }
  return place;
}

// The straight path must stay in the body if the exit lies beyond the map's exit at the texel, or beyond the
// map's exit on the exit's own light ray.
double Gather::inside(const Texel& texel, const Exit& exit, const Place& place) const {
  if (!(texel.exit < INFINITY)) return 1;
  const glm::dvec3 to = exit.position - texel.position;
  const double beyond =
      std::clamp((-glm::dot(to, place.toLight) - texel.exit) / place.tolerance - 1, 0.0, 1.0);
  double stays = 1;
  if (beyond > 0) stays -= beyond * (1 - (1 - place.shadowed) * pathInside(to, exit, place, 0.5));
  // A path that begins before the depth at which the exit's own light ray has left the medium does not cross
  // the gap behind it.
  const double along = -glm::dot(to, place.axis);
  const double crosses = place.shadowed * std::clamp((along - place.behind) / place.tolerance, 0.0, 1.0);
  if (crosses > 0) stays *= 1 - crosses * (1 - pathInside(to, exit, place, 0.5 * place.behind / along));
  return stays;
}

double Gather::pathInside(const glm::dvec3& to, const Exit& exit, const Place& place, double part) const {
  const glm::dvec3 on = (exit.position - part * to) / mm_;
  const ShadowView* view = ShadowView::find(*place.views, on);
  if (!view) return 1;
  const ShadowView::Lookup found = view->at(on);
  if (found.kind != ShadowView::Kind::Surface || !found.fromExit || found.clamped ||
      found.casterMaterial == 0)
    return 1;
  return 1 - std::clamp(mm_ * *found.fromExit / place.tolerance, 0.0, 1.0);
}

Gather::Sums Gather::sums(const Blocks& blocks, const Exit& exit, const Place& place) const {
  const GatherKernel& kernel = *kernels_[exit.material];
  const double radius = radii_[exit.material];
  Sums sums;
  for (const Block& block : blocks) {
    if (glm::distance(block.center, exit.position) > block.radius + radius) continue;
    for (const Texel& y : block.texels) {
      if (y.material != 0 && y.material != exit.material + 1) continue;
      const glm::dvec3 to = exit.position - y.position;
      GatherPath path = gatherPath(to, exit.normal, y.normal);
      // No light comes through a surface that turns little within the reach of a facet: both points lie on
      // one face.
      const double turned = 1 - path.facing,
                   across = turned * std::lerp(std::min(path.distance / exit.reach, 1.0), 1.0,
                                               std::min(2 * turned, 1.0));
      const double side = std::sqrt(y.area);
      // Half a texel: nearer than that the sum is no integral.
      const bool own = path.distance < 0.6 * side;
      path.distance = std::max(path.distance, 0.5 * side);
      if (path.distance > radius) continue;
      const double part = inside(y, exit, place), opposite = part * across, alike = part * (1 - across);
      if (opposite > 0) sums.transmitted += opposite * kernel.transmitted(path.distance, path.depth) * y.flux;
      if (!(alike > 0) && !(y.seen && opposite > 0)) continue;
      // The texel of the exit itself has all that lies within a disc of its area.
      const glm::dvec3 profile = own ? kernel.reflectedWithin(side / std::sqrt(std::numbers::pi)) / y.area
                                     : kernel.reflected(path.distance);
      if (y.seen) {
        sums.opposite += opposite * profile * y.flux;
        sums.seenEntering += alike * profile * y.within * y.flux;
        sums.seen += alike * profile * y.area;
      } else {
        sums.entering += alike * profile * y.within * y.flux;
        sums.hidden += alike * profile * y.area;
      }
    }
  }
  return sums;
}

Gathered Gather::at(const Surface& surface, std::size_t material) const {
  const GatherKernel& kernel = *kernels_[material];
  const glm::dmat4& worldFromView = surfaces_.worldFromView();
  const Exit exit{mm_ * glm::dvec3(worldFromView * glm::dvec4(surface.position, 1)),
                  glm::dmat3(worldFromView) * surface.normal, material, facetReach(surface)};
  const BodyFactors body = bodyAt(surface, material);
  const glm::dvec3 rho = kernel.reflectance();
  Gathered result;
  for (std::size_t i = 0; i < lights_.size(); ++i) {
    if (lights_[i].empty()) continue;
    const Place place = placeOf(i, exit);
    Sums s = sums(lights_[i], exit, place);
    s.transmitted *= body.through;
    result.transmitted += s.transmitted;
    if (!diffused_) continue;
    // The displaced light is the light's own: half of its irradiance at the exit and half of its irradiance
    // around.
    const glm::dvec3 own = place.ownIrradiance, seen = s.seenEntering / glm::max(s.seen, glm::dvec3(1e-12));
    const glm::dvec3 around = 0.5 * (own + seen), hidden = glm::min(s.hidden, glm::dvec3(1));
    // Diffused light is no more than what lies around.
    const glm::dvec3 opposite = glm::min(s.opposite, s.transmitted / rho + own);
    result.returned += body.returned * (s.entering - hidden * around) - opposite;
  }
  result.factor = glm::clamp(body.returned, glm::dvec3(0), glm::dvec3(2));
  return result;
}

}  // namespace pellucid::harness::reference
