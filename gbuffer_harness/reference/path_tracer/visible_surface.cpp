#include "reference/path_tracer/visible_surface.h"

#include <limits>

#include "common/error.h"
#include "common/parallel.h"
#include "common/progress.h"
#include "scene/model.h"

namespace pellucid::harness::reference {

namespace {

// Pixels: the rasterizer's and Embree's rounding differ along silhouettes, where a ray that misses is moved
// by less than half a pixel.
constexpr double kShifts[][2] = {{0, 0},  {.05, 0}, {-.05, 0}, {0, .05}, {0, -.05},
                                 {.4, 0}, {-.4, 0}, {0, .4},   {0, -.4}};

std::optional<SurfacePoint> find(const harness::Camera& camera, const Capture& capture, const TraceScene& scene, int x,
                                 int y) {
  for (const auto& [dx, dy] : kShifts) {
    const Ray world = camera.ray(x + 0.5 + dx, y + 0.5 + dy, capture.width, capture.height);
    const auto point = scene.first({scene.fromWorld(world.origin), world.direction}, 0);
    if (point && point->material != 0) return point;
  }
  return std::nullopt;
}

harness::Camera cameraOf(const Capture& capture) {
  harness::Camera camera;
  camera.clipFromView = capture.clipFromView;
  camera.viewFromWorld = capture.viewFromWorld;
  camera.orthographic = capture.clipFromView[11] == 0;  // w does not go by z
  return camera;
}

}  // namespace

VisibleSurface visibleSurface(const Capture& capture, const TraceScene& scene) {
  if (capture.clipFromView[11] > 0)
    throw InputError(capture.name, "camera.clipFromView", "looks along +z; rays are cast along -z");
  const harness::Camera camera = cameraOf(capture);
  VisibleSurface surface{capture.width, capture.height, {}, 0};
  surface.points.resize(capture.material.size());
  std::vector<std::size_t> missed(static_cast<std::size_t>(capture.height));
  parallelRows(capture.height, 0, [&](int y) {
    std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(capture.width);
    for (int x = 0; x < capture.width; ++x, ++i) {
      if (capture.material[i] == 0) continue;
      surface.points[i] = find(camera, capture, scene, x, y);
      missed[static_cast<std::size_t>(y)] += !surface.points[i];
    }
  });
  for (const std::size_t count : missed) surface.missed += count;
  return surface;
}

VisibleSurface hiddenSurface(const Capture& capture, const TraceScene& scene, const VisibleSurface& visible) {
  const harness::Camera camera = cameraOf(capture);
  VisibleSurface hidden{visible.width, visible.height, {}, 0};
  hidden.points.resize(visible.points.size());
  parallelRows(visible.height, 0, [&](int y) {
    std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(visible.width);
    for (int x = 0; x < visible.width; ++x, ++i) {
      if (!visible.points[i]) continue;
      const SurfacePoint& front = *visible.points[i];
      const glm::dvec3 direction = camera.ray(x + 0.5, y + 0.5, visible.width, visible.height).direction;
      const auto exit = scene.exit(front.body, {front.position - scene.offset() * front.face, direction},
                                   std::numeric_limits<double>::infinity());
      if (exit && exit->material != 0) hidden.points[i] = exit;
    }
  });
  return hidden;
}

Image tracedIrradiance(const VisibleSurface& surface, const TraceScene& scene, const Emitters& emitters,
                       int count) {
  constexpr std::uint64_t kSeed = 0x1adace;  // a stream of its own
  Image result(surface.width, surface.height, 3);
  Progress progress("tracing irradiance", static_cast<std::uint64_t>(surface.height));
  parallelRows(surface.height, 0, [&](int y) {
    for (int x = 0; x < surface.width; ++x) {
      const std::size_t i =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(surface.width) + static_cast<std::size_t>(x);
      if (!surface.points[i]) continue;
      glm::dvec3 sum(0);
      for (int s = 0; s < count; ++s) {
        PathRandom random(kSeed, i, static_cast<std::uint64_t>(s));
        sum += sampleIrradiance(scene, emitters, *surface.points[i], random);
      }
      for (int c = 0; c < 3; ++c) result.at(x, y)[c] = static_cast<float>(sum[c] / count);
    }
    progress.advance();
  });
  return result;
}

}  // namespace pellucid::harness::reference
