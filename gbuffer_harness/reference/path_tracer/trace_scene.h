// A scene to trace paths through: closed bodies, some filled with a medium, some opaque. Lengths in mm, in
// coordinates of the scene's own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>

#include "scene/solid.h"

namespace pellucid::harness {
struct Model;
struct SceneModel;
}  // namespace pellucid::harness

namespace pellucid::harness::reference {

struct SurfacePoint {
  glm::dvec3 position;
  glm::dvec3 face;        // outward unit normal of the surface itself
  glm::dvec3 normal;      // outward unit normal to shade with; interpolated on meshes
  int body;               // to hand to exit()
  std::uint8_t material;  // as in the material image; 0: opaque
};

class TraceScene {
public:
  virtual ~TraceScene() = default;

  // First surface that the ray meets from outside, at a distance >= `from`.
  virtual std::optional<SurfacePoint> first(const Ray& ray, double from) const = 0;

  // True when anything stands within `distance` of the ray's origin.
  virtual bool occluded(const Ray& ray, double distance) const = 0;

  // The point at which a ray that starts inside a body leaves it, or meets something opaque of any body,
  // whose material is 0; if that is nearer than `limit`.
  virtual std::optional<SurfacePoint> exit(int body, const Ray& ray, double limit) const = 0;

  // A sphere around all of it; nothing for scenes without end.
  struct Sphere {
    glm::dvec3 center;
    double radius;
  };
  virtual std::optional<Sphere> bounds() const = 0;

  // How far rays start off a surface: what rounding may shift a point by.
  virtual double offset() const = 0;

  // World units are scaled about `center()`, so that a scene far from the origin keeps its digits.
  glm::dvec3 fromWorld(const glm::dvec3& world) const { return (world - center_) * millimetersPerUnit_; }
  glm::dvec3 toWorld(const glm::dvec3& point) const { return point / millimetersPerUnit_ + center_; }
  double millimetersPerUnit() const { return millimetersPerUnit_; }

protected:
  TraceScene(const glm::dvec3& center, double millimetersPerUnit)
      : center_(center), millimetersPerUnit_(millimetersPerUnit) {}

private:
  glm::dvec3 center_;
  double millimetersPerUnit_;  // > 0
};

// A procedural scene, exact. Each object is a body; where objects overlap, a way through one goes on in the
// other, with the medium it began in. The model must outlive the scene.
std::unique_ptr<TraceScene> makeSolidScene(const SceneModel& model);

// A triangle mesh, with rays by Embree. Parts of one object are one body; a part's own surface says its
// material. Bodies with a material must be closed (raster/bodies.h). A hit from the wrong side does not
// end a way through a body: what another translucent body, or a fold of the same one, encloses is medium,
// too. Faces are culled as the rasterizer does: first() passes back faces unless their surface is
// double-sided. All of the model is copied.
std::unique_ptr<TraceScene> makeMeshScene(const Model& model);

}  // namespace pellucid::harness::reference
