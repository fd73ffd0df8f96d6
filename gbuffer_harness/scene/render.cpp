#include "scene/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.h"
#include "common/parallel.h"
#include "common/progress.h"
#include "scene/light_table.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// View rays at pixel centers and what they hit, kept in double until every image is written.
struct Cast {
  Ray ray;
  double viewZPerLength = 1;
  std::optional<Hit> hit;
};

class Renderer {
public:
  Renderer(const SceneModel& model, const SceneParameters& parameters)
      : model_(model), parameters_(parameters), bias_(1e-5 * model.radius) {}

  Capture render() const;
  ShadowMap shadowMap(const Light& light) const;

private:
  Cast cast(const Camera& camera, double x, double y, int width, int height) const;
  void writePixel(Capture& capture, int x, int y) const;
  glm::dvec3 irradiance(const Cast& cast, int x, int y) const;
  static std::uint8_t materialAt(const Cast& cast);  // of the surface that it hits
  float encode(const Camera& camera, PellucidDepthEncoding encoding, const Cast& cast, double t) const;
  float nothing(const Camera& camera, PellucidDepthEncoding encoding) const;

  const SceneModel& model_;
  const SceneParameters& parameters_;
  double bias_;
};

Cast Renderer::cast(const Camera& camera, double x, double y, int width, int height) const {
  Cast cast{camera.ray(x, y, width, height), 1, std::nullopt};
  cast.viewZPerLength = camera.viewZPerLength(cast.ray);
  cast.hit = firstHit(model_.objects, cast.ray, camera.range.nearPlane / cast.viewZPerLength);
  if (cast.hit && cast.hit->enter * cast.viewZPerLength > camera.range.farPlane) cast.hit.reset();
  return cast;
}

float Renderer::nothing(const Camera& camera, PellucidDepthEncoding encoding) const {
  return encoding == PELLUCID_DEPTH_DEVICE ? static_cast<float>(clearDepth(camera.clipFromView)) : kNoDepth;
}

float Renderer::encode(const Camera& camera, PellucidDepthEncoding encoding, const Cast& cast,
                       double t) const {
  const double viewZ = t * cast.viewZPerLength;
  if (viewZ > camera.range.farPlane || std::isinf(viewZ)) return nothing(camera, encoding);
  switch (encoding) {
    case PELLUCID_DEPTH_DEVICE:
      return static_cast<float>(deviceDepth(camera.clipFromView, viewZ));
    case PELLUCID_DEPTH_VIEW_Z:
      return static_cast<float>(viewZ);
    case PELLUCID_DEPTH_DISTANCE:
      return static_cast<float>(t);
    case PELLUCID_DEPTH_THICKNESS:
      break;  // scenes have back depths
  }
  return nothing(camera, encoding);
}

glm::dvec3 Renderer::irradiance(const Cast& cast, int x, int y) const {
  if (model_.paint) {
    const int n = model_.paintSamples;
    glm::dvec3 sum(0);
    int count = 0;
    for (int i = 0; i < n * n; ++i) {
      const Cast sample = this->cast(model_.camera, x + (i % n + 0.5) / n, y + (i / n + 0.5) / n,
                                     parameters_.width, parameters_.height);
      if (!sample.hit) continue;
      sum += model_.paint(sample.ray.at(sample.hit->enter));
      ++count;
    }
    return count ? sum / static_cast<double>(count) : sum;
  }
  const glm::dvec3 point = cast.ray.at(cast.hit->enter);
  const glm::dvec3 normal = cast.hit->object->solid->normal(point);
  glm::dvec3 sum(0);
  for (const Light& light : model_.lights) {
    const glm::dvec3 e = unshadowedIrradiance(light, point, normal);
    if (e != glm::dvec3(0) && reaches(model_.objects, light, point, normal, bias_)) sum += e;
  }
  return sum;
}

std::uint8_t Renderer::materialAt(const Cast& cast) {
  const Object& object = *cast.hit->object;
  return object.materialAt ? object.materialAt(cast.ray.at(cast.hit->enter)) : object.material;
}

void Renderer::writePixel(Capture& capture, int x, int y) const {
  const Cast c = cast(model_.camera, x + 0.5, y + 0.5, capture.width, capture.height);
  if (!c.hit) return;
  const glm::dvec3 point = c.ray.at(c.hit->enter);
  const glm::dvec3 e = irradiance(c, x, y);
  const glm::dvec3 albedo = model_.albedo ? model_.albedo(point) : glm::dvec3(1);

  *capture.frontDepth.image.at(x, y) = encode(model_.camera, capture.frontDepth.encoding, c, c.hit->enter);
  *capture.backDepth.image.at(x, y) = encode(model_.camera, capture.backDepth.encoding, c, c.hit->exit);
  for (int i = 0; i < 3; ++i) {
    capture.irradiance.at(x, y)[i] = static_cast<float>(e[i]);
    if (model_.albedo) capture.albedo.at(x, y)[i] = static_cast<float>(albedo[i]);
  }
  capture.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(capture.width) +
                   static_cast<std::size_t>(x)] = materialAt(c);
}

ShadowMap Renderer::shadowMap(const Light& light) const {
  const int size = parameters_.shadowSize;
  const glm::dvec3 travel = glm::normalize(toGlm(light.direction));
  Camera camera;
  camera.orthographic = light.type == PELLUCID_LIGHT_DIRECTIONAL;
  const glm::dvec3 eye =
      camera.orthographic ? model_.center - 2 * model_.radius * travel : toGlm(light.position);
  const double distance = glm::distance(eye, model_.center);
  if (distance <= model_.radius) {
    throw InputError("", "scene \"" + parameters_.name + "\"",
                     "its light would stand within the objects; enlarge the extent or shrink the objects");
  }
  camera.range = {distance - model_.radius, distance + model_.radius, false};
  camera.viewFromWorld = lookAt(fromGlm(eye), fromGlm(model_.center), {0, 1, 0});
  camera.clipFromView = camera.orthographic
                            ? orthographic(2 * model_.radius, 2 * model_.radius, camera.range)
                            // The cone that touches the sphere.
                            : perspective(2 * std::asin(model_.radius / distance), 1, camera.range);

  ShadowMap map;
  map.depth = {Image(size, size, 1, nothing(camera, parameters_.shadowEncoding)), parameters_.shadowEncoding};
  map.exitDepth = map.depth.image;
  map.casterMaterial.resize(map.depth.image.pixels());
  map.viewFromWorld = camera.viewFromWorld;
  map.clipFromWorld = multiply(camera.clipFromView, camera.viewFromWorld);
  Progress progress("casting a shadow map", static_cast<std::uint64_t>(size));
  parallelRows(size, 0, [&](int y) {
    for (int x = 0; x < size; ++x) {
      const Cast c = cast(camera, x + 0.5, y + 0.5, size, size);
      if (!c.hit) continue;
      *map.depth.image.at(x, y) = encode(camera, map.depth.encoding, c, c.hit->enter);
      *map.exitDepth.at(x, y) = encode(camera, map.depth.encoding, c, c.hit->exit);
      map.casterMaterial[static_cast<std::size_t>(y * size + x)] = materialAt(c);
    }
    progress.advance();
  });
  return map;
}

Capture Renderer::render() const {
  const int width = parameters_.width;
  const int height = parameters_.height;
  const float empty = nothing(model_.camera, parameters_.depthEncoding);
  Capture capture;
  capture.name = parameters_.name;
  capture.width = width;
  capture.height = height;
  capture.metersPerUnit = 0.001;
  capture.clipFromView = model_.camera.clipFromView;
  capture.viewFromWorld = model_.camera.viewFromWorld;
  capture.frontDepth = {Image(width, height, 1, empty), parameters_.depthEncoding};
  capture.backDepth = capture.frontDepth;
  capture.irradiance = Image(width, height, 3);
  if (model_.albedo) capture.albedo = Image(width, height, 3);
  capture.material.resize(capture.irradiance.pixels());
  capture.materials = model_.materials;
  capture.lights = model_.lights;

  Progress progress("casting " + parameters_.name, static_cast<std::uint64_t>(height));
  parallelRows(height, 0, [&](int y) {
    for (int x = 0; x < width; ++x) writePixel(capture, x, y);
    progress.advance();
  });
  if (parameters_.shadowSize > 0) {
    for (Light& light : capture.lights) light.shadowMaps = {shadowMap(light)};
  }
  return capture;
}

}  // namespace

std::optional<Hit> firstHit(const std::vector<Object>& objects, const Ray& ray, double tMin) {
  std::vector<Hit> hits;
  for (const Object& object : objects) {
    if (const std::optional<Span> span = object.solid->firstSpan(ray, tMin)) {
      hits.push_back({&object, span->enter, span->exit});
    }
  }
  if (hits.empty()) return std::nullopt;
  std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) { return a.enter < b.enter; });
  // An object that begins before the union so far ends overlaps it.
  Hit first = hits.front();
  for (const Hit& hit : hits) {
    if (hit.enter <= first.exit) first.exit = std::max(first.exit, hit.exit);
  }
  return first;
}

bool reaches(const std::vector<Object>& objects, const Light& light, const glm::dvec3& point,
             const glm::dvec3& normal, double bias) {
  const glm::dvec3 origin = point + bias * normal;
  double distance = std::numeric_limits<double>::infinity();
  glm::dvec3 toLight = -toGlm(light.direction);
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL) {
    toLight = toGlm(light.position) - origin;
    distance = glm::length(toLight);
  }
  const Ray ray{origin, glm::normalize(toLight)};
  return std::none_of(objects.begin(), objects.end(),
                      [&](const Object& object) { return object.solid->blocks(ray, 0, distance); });
}

glm::dvec3 unshadowedIrradiance(const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
  const glm::dvec3 color = toGlm(light.color) * light.intensity;
  const glm::dvec3 axis = glm::normalize(toGlm(light.direction));
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) return color * std::max(0.0, -glm::dot(axis, normal));

  const glm::dvec3 toLight = toGlm(light.position) - point;
  const double distance = glm::length(toLight);
  double e = std::max(0.0, glm::dot(toLight, normal) / distance) / square(distance);
  if (!light.distanceTable.empty())  // in place of the window
    e *= distance < light.range ? factorAt(light.distanceTable, distance / light.range) : 0;
  else if (light.range > 0)
    e *= std::clamp(1 - std::pow(distance / light.range, 4), 0.0, 1.0);
  if (light.type == PELLUCID_LIGHT_SPOT) {
    const double outer = std::cos(light.outerConeAngle);
    const double width = std::max(0.001, std::cos(light.innerConeAngle) - outer);
    e *= square(std::clamp((-glm::dot(axis, toLight) / distance - outer) / width, 0.0, 1.0));
  }
  if (!light.angleTable.empty())
    e *= factorAt(light.angleTable,
                  std::acos(std::clamp(-glm::dot(axis, toLight) / distance, -1.0, 1.0)) / std::numbers::pi);
  return color * e;
}

Capture renderCapture(const SceneModel& model, const SceneParameters& parameters) {
  return Renderer(model, parameters).render();
}

}  // namespace pellucid::harness
