#include "reference/path_tracer/light_paths.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "common/error.h"
#include "common/parallel.h"
#include "reference/camera.h"
#include "reference/path_tracer/sampling.h"
#include "reference/path_tracer/emitters.h"
#include "reference/path_tracer/walk.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

namespace {

struct Emission {
  Ray ray;          // of the scene's coordinates
  glm::dvec3 flux;  // R, G, B, in units of irradiance times mm^2: the mean over emissions is all that arrives
};

constexpr double kTwoPi = 2 * std::numbers::pi;

// Parallel light: through a point of the disc that the sphere shows it.
Ray throughDisc(const TraceScene::Sphere& bounds, const glm::dvec3& direction, PathRandom& random) {
  const Frame frame(direction);
  const double radius = bounds.radius * std::sqrt(random.uniform()), angle = kTwoPi * random.uniform();
  return {bounds.center + radius * (std::cos(angle) * frame.x + std::sin(angle) * frame.y) -
              2 * bounds.radius * direction,
          direction};
}

// A direction from a point into the cone around the sphere, and the cone's solid angle; all around where the
// point lies within.
struct Aimed {
  glm::dvec3 direction;
  double solidAngle;
};
Aimed aim(const TraceScene::Sphere& bounds, const glm::dvec3& from, PathRandom& random) {
  const glm::dvec3 toCenter = bounds.center - from;
  if (!(glm::length(toCenter) > bounds.radius)) return {uniformDirection(random), 2 * kTwoPi};
  const ConeSample sample = sampleCone(toCenter, bounds.radius, random);
  return {sample.direction, sample.solidAngle};
}

std::optional<Emission> fromLight(const TraceScene& scene, const Light& light,
                                  const TraceScene::Sphere& bounds, PathRandom& random) {
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) {
    const glm::dvec3 direction = glm::normalize(toGlm(light.direction));
    const double area = std::numbers::pi * bounds.radius * bounds.radius;
    return Emission{throughDisc(bounds, direction, random), area * light.intensity * toGlm(light.color)};
  }
  // Irradiance on a surface that faces the light at the length of one unit is the intensity that way, cone
  // and range included; both are functions of where the ray goes, so that it is asked for where it arrives.
  glm::dvec3 from = scene.fromWorld(toGlm(light.position));
  if (light.radius > 0) {
    const glm::dvec3 normal = uniformDirection(random);
    from += light.radius * scene.millimetersPerUnit() * normal;
    const Aimed aimed = aim(bounds, from, random);
    const double cosine = glm::dot(normal, aimed.direction);
    if (!(cosine > 0)) return std::nullopt;
    // Radiance I / (pi r^2), over the sphere's area 4 pi r^2.
    const double square = scene.millimetersPerUnit() * scene.millimetersPerUnit();
    return Emission{{from, aimed.direction},
                    4 * cosine * aimed.solidAngle * light.intensity * square * toGlm(light.color)};
  }
  const Aimed aimed = aim(bounds, from, random);
  const Ray ray{from, aimed.direction};
  const std::optional<SurfacePoint> arrival = scene.first(ray, 0);
  if (!arrival) return std::nullopt;
  const glm::dvec3 way = arrival->position - from;
  const glm::dvec3 e = unshadowedIrradiance(light, scene.toWorld(arrival->position), -aimed.direction);
  return Emission{ray, aimed.solidAngle * glm::dot(way, way) * e};
}

// A random ray from one of the emitters towards the sphere around the scene. Nothing where the ray drawn
// carries no light.
std::optional<Emission> emit(const TraceScene& scene, const Emitters& emitters,
                             const TraceScene::Sphere& bounds, PathRandom& random) {
  const std::size_t count = emitters.lights.size() + (emitters.environment ? 1 : 0);
  if (count == 0) return std::nullopt;
  const auto chosen =
      std::min(count - 1, static_cast<std::size_t>(random.uniform() * static_cast<double>(count)));
  std::optional<Emission> emission;
  if (chosen < emitters.lights.size()) {
    emission = fromLight(scene, emitters.lights[chosen], bounds, random);
  } else {
    const glm::dvec3 direction = uniformDirection(random);
    const double area = std::numbers::pi * bounds.radius * bounds.radius;
    emission = Emission{throughDisc(bounds, direction, random),
                        2 * kTwoPi * area * toGlm(emitters.environment->radiance(-direction.y))};
  }
  if (emission) emission->flux *= static_cast<double>(count);
  return emission;
}

}  // namespace

LightPaths::LightPaths(const Capture& capture, const TraceScene& scene, const std::vector<TraceMedium>& media,
                       const Emitters& emitters)
    : scene_(scene),
      media_(media),
      emitters_(emitters),
      width_(capture.width),
      height_(capture.height),
      clipFromWorld_(toGlm(capture.clipFromView) * toGlm(capture.viewFromWorld)),
      orthographic_(capture.clipFromView[11] == 0),
      material_(capture.material),
      scale_(albedoOverRho(capture, media)),
      pixels_(capture.material.size() -
              static_cast<std::size_t>(std::count(capture.material.begin(), capture.material.end(), 0))) {
  const auto bounds = scene.bounds();
  if (!bounds || emitters.paint)
    throw InputError(capture.name, "lights",
                     "paths from lights need a scene with an end and lights; --entry lambert needs neither");
  if (std::any_of(media.begin(), media.end(), [](const TraceMedium& m) { return m.wall.has_value(); }))
    throw InputError(capture.name, "materials", "one is thin-walled, which --entry lambert alone traces");
  bounds_ = *bounds;
  const glm::dmat4 worldFromView = glm::inverse(toGlm(capture.viewFromWorld));
  eye_ = scene.fromWorld(glm::dvec3(worldFromView[3]));
  forward_ = -glm::dvec3(worldFromView[2]);
  parallel_ =
      glm::dmat3(worldFromView) * Camera(capture.clipFromView, width_, height_).rayThrough({0, 0, -1});
  const double unit = orthographic_ ? scene.millimetersPerUnit() : 1;
  pixelSize_ = {2 * unit / std::abs(capture.clipFromView[0]) / width_,
                2 * unit / std::abs(capture.clipFromView[5]) / height_};
}

std::optional<LightPaths::Arrival> LightPaths::seen(const SurfacePoint& point, const glm::dvec3& flux) const {
  const glm::dvec4 clip = clipFromWorld_ * glm::dvec4(scene_.toWorld(point.position), 1);
  if (!(clip.w > 0)) return std::nullopt;
  const double px = (clip.x / clip.w * 0.5 + 0.5) * width_, py = (clip.y / clip.w * 0.5 + 0.5) * height_;
  if (!(px >= 0 && px < width_ && py >= 0 && py < height_)) return std::nullopt;
  const auto pixel =
      static_cast<std::size_t>(py) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(px);
  if (material_[pixel] == 0 || material_[pixel] != point.material) return std::nullopt;
  glm::dvec3 toEye = orthographic_ ? -parallel_ : eye_ - point.position;
  const double distance = glm::length(toEye);  // above 0: clip.w is
  toEye /= distance;
  const double cosine = glm::dot(toEye, point.face);
  if (!(cosine > 0)) return std::nullopt;
  const double along = -glm::dot(toEye, forward_);  // above 0: the point is in front of the eye
  const double reach = orthographic_ ? glm::dot(point.position - eye_, forward_) / along : distance;
  if (scene_.occluded({point.position + scene_.offset() * point.face, toEye}, reach)) return std::nullopt;
  // Area of surface that the pixel sees: its own, at this depth, over the cosine. A plane's area at depth z
  // lies under the angle of its normal, the view axis, to the ray.
  double area = pixelSize_.x * pixelSize_.y * along / cosine;
  if (!orthographic_) area *= distance * along * distance * along;
  return Arrival{pixel, scale_[pixel] * flux / area, 0};
}

std::optional<LightPaths::Arrival> LightPaths::path(std::uint64_t number, std::uint64_t seed) const {
  PathRandom random(seed, ~std::uint64_t{0}, number);
  const std::optional<Emission> emission = emit(scene_, emitters_, bounds_, random);
  if (!emission) return std::nullopt;
  const std::optional<SurfacePoint> entry = scene_.first(emission->ray, 0);
  if (!entry || entry->material == 0) return std::nullopt;
  const TraceMedium& medium = media_[entry->material - 1u];
  const WalkEntry inside = enter(medium, *entry, emission->ray.direction, random);
  const glm::dvec3 start = entry->position - scene_.offset() * entry->face;
  const std::optional<WalkExit> exit = walkFrom(scene_, medium, entry->body, start, inside.direction, random);
  if (!exit) return std::nullopt;
  return seen(exit->surface, emission->flux * inside.weight * exit->weight);
}

void LightPaths::trace(TruthSums& sums, std::uint64_t count, std::uint64_t seed, int jobs,
                       const std::function<void()>& progress) const {
  sums.width = width_;
  sums.height = height_;
  sums.sum.resize(scale_.size(), glm::dvec3(0));
  sums.sumOfSquares.resize(scale_.size(), glm::dvec3(0));
  // Each row of the image stands for a share of the paths; what arrives is added in their order, so that the
  // sums' rounding does not depend on the threads.
  const std::uint64_t first = sums.samples * pixels_, all = count * pixels_;
  const auto rows = static_cast<std::uint64_t>(height_);
  std::vector<std::vector<Arrival>> arrivals(rows);
  parallelRows(height_, jobs, [&](int row) {
    const auto r = static_cast<std::uint64_t>(row);
    for (std::uint64_t i = all * r / rows; i < all * (r + 1) / rows; ++i)
      if (auto arrival = path(first + i, seed)) {
        arrival->sample = i / pixels_;
        arrivals[r].push_back(*arrival);
      }
    progress();
  });
  addInOrder(arrivals, sums);
  sums.samples += count;
}

// A sample of a pixel is the sum over `pixels_` paths, of which few arrive there.
void LightPaths::addInOrder(const std::vector<std::vector<Arrival>>& arrivals, TruthSums& sums) const {
  std::vector<glm::dvec3> value(scale_.size(), glm::dvec3(0));
  std::vector<std::size_t> touched;
  const auto flush = [&] {
    for (const std::size_t pixel : touched) {
      const glm::dvec3 v = value[pixel] / static_cast<double>(pixels_);
      sums.sum[pixel] += v;
      sums.sumOfSquares[pixel] += v * v;
      value[pixel] = glm::dvec3(0);
    }
    touched.clear();
  };
  std::uint64_t sample = 0;
  for (const auto& row : arrivals)
    for (const Arrival& arrival : row) {
      if (arrival.sample != sample) flush();
      sample = arrival.sample;
      if (value[arrival.pixel] == glm::dvec3(0)) touched.push_back(arrival.pixel);
      value[arrival.pixel] += arrival.value;
    }
  flush();
}

}  // namespace pellucid::harness::reference
