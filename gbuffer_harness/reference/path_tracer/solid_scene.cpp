#include "reference/path_tracer/trace_scene.h"

#include <algorithm>
#include <limits>

#include "scene/model.h"
#include "scene/render.h"

namespace pellucid::harness::reference {

namespace {

// Share of the scene's radius; solids find their surfaces to 1e-9 mm.
constexpr double kSolidOffset = 1e-6;

class SolidScene : public TraceScene {
public:
  explicit SolidScene(const SceneModel& model)
      : TraceScene(glm::dvec3(0), 1), model_(model), offset_(kSolidOffset * model.radius) {}

  std::optional<SurfacePoint> first(const Ray& ray, double from) const override {
    const std::optional<Hit> hit = firstHit(model_.objects, ray, from);
    if (!hit) return std::nullopt;
    return point(*hit->object, ray.at(hit->enter));
  }

  bool occluded(const Ray& ray, double distance) const override {
    return std::any_of(model_.objects.begin(), model_.objects.end(),
                       [&](const Object& object) { return object.solid->blocks(ray, 0, distance); });
  }

  std::optional<SurfacePoint> exit(int body, const Ray& ray, double limit) const override {
    const Object* object = &model_.objects[static_cast<std::size_t>(body)];
    double passed = 0;
    for (;;) {
      const Ray rest{ray.at(passed), ray.direction};
      const std::optional<double> length = object->solid->exit(rest, limit - passed);
      const double reach = length.value_or(limit - passed);
      if (const Object* block = blocking(rest, reach)) {
        SurfacePoint blocked = point(*block, rest.at(reach));
        blocked.material = 0;
        return blocked;
      }
      if (!length) return std::nullopt;
      passed += *length;
      const Object* next = around(ray.at(passed + offset_), *object);
      if (!next) return point(*object, ray.at(passed));
      object = next;
    }
  }

  std::optional<Sphere> bounds() const override {
    if (model_.endless) return std::nullopt;
    return Sphere{model_.center, model_.radius};
  }
  double offset() const override { return offset_; }

private:
  SurfacePoint point(const Object& object, const glm::dvec3& position) const {
    const glm::dvec3 normal = object.solid->normal(position);
    return {position, normal, normal, static_cast<int>(&object - model_.objects.data()),
            object.materialAt ? object.materialAt(position) : object.material};
  }

  // Another translucent object that holds the point.
  const Object* around(const glm::dvec3& position, const Object& besides) const {
    for (const Object& object : model_.objects)
      if (&object != &besides && !isOpaque(object) && object.solid->contains(position)) return &object;
    return nullptr;
  }

  static bool isOpaque(const Object& object) { return object.material == 0 && !object.materialAt; }

  // Something opaque within the distance.
  const Object* blocking(const Ray& ray, double distance) const {
    for (const Object& object : model_.objects)
      if (isOpaque(object) && object.solid->blocks(ray, 0, distance)) return &object;
    return nullptr;
  }

  const SceneModel& model_;
  double offset_;
};

}  // namespace

std::unique_ptr<TraceScene> makeSolidScene(const SceneModel& model) {
  return std::make_unique<SolidScene>(model);
}

}  // namespace pellucid::harness::reference
