// Solids that a ray can be intersected with: polyhedra, ellipsoids and distance fields. Double precision.
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <vector>

namespace pellucid::harness {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Ray {
  glm::dvec3 origin, direction;  // unit direction
  glm::dvec3 at(double t) const { return origin + t * direction; }
};

// Distances along a ray between which it is inside a solid; exit may be infinity.
struct Span {
  double enter, exit;
};

class Solid {
public:
  virtual ~Solid() = default;

  // The first span that begins at t >= tMin. A span already begun at tMin is passed over: its front
  // face lies before tMin, as a face in front of a near plane does.
  virtual std::optional<Span> firstSpan(const Ray& ray, double tMin) const = 0;

  // Whether a span begins in [tMin, tMax]; cheaper than firstSpan where the exit costs extra.
  virtual bool blocks(const Ray& ray, double tMin, double tMax) const;

  // Where a ray that begins inside leaves, if that is nearer than `limit`; 0 when it begins outside.
  virtual std::optional<double> exit(const Ray& ray, double limit) const;

  virtual bool contains(const glm::dvec3& point) const;

  // Outward unit normal at a point of the surface.
  virtual glm::dvec3 normal(const glm::dvec3& point) const = 0;
};

// Points with dot(normal, p) <= offset for every plane: slabs, wedges, boxes, tapered blades.
class Polyhedron : public Solid {
public:
  struct Plane {
    glm::dvec3 normal;  // outward, unit
    double offset;
  };
  explicit Polyhedron(std::vector<Plane> planes) : planes_(std::move(planes)) {}
  // Axes are unit and perpendicular; an infinite half extent leaves that pair of faces out.
  static Polyhedron box(const glm::dvec3& center, const glm::dmat3& axes, const glm::dvec3& halfExtent);

  std::optional<Span> firstSpan(const Ray& ray, double tMin) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override;

private:
  std::vector<Plane> planes_;
};

class Ellipsoid : public Solid {
public:
  Ellipsoid(const glm::dvec3& center, const glm::dvec3& radii) : center_(center), radii_(radii) {}

  std::optional<Span> firstSpan(const Ray& ray, double tMin) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override;

private:
  glm::dvec3 center_, radii_;
};

// A solid given by a function that is negative inside, found by sphere tracing (Hart 1996) and a
// bracketed root search to 1e-9 scene units. Only the part inside the bounding box exists.
class DistanceField : public Solid {
public:
  std::optional<Span> firstSpan(const Ray& ray, double tMin) const override;
  bool blocks(const Ray& ray, double tMin, double tMax) const override;
  std::optional<double> exit(const Ray& ray, double limit) const override;
  bool contains(const glm::dvec3& point) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override;

  // At most the distance to the surface times a constant the field has been scaled for.
  virtual double distance(const glm::dvec3& point) const = 0;

protected:
  DistanceField(const glm::dvec3& boxMin, const glm::dvec3& boxMax, double smallestStep)
      : boxMin_(boxMin), boxMax_(boxMax), smallestStep_(smallestStep) {}

private:
  std::optional<Span> clipToBox(const Ray& ray) const;
  double march(const Ray& ray, double t, double end, double sign) const;
  double findEntry(const Ray& ray, const Span& box, double tMin, double end) const;

  glm::dvec3 boxMin_, boxMax_;
  double smallestStep_;  // features thinner than this may be missed
};

}  // namespace pellucid::harness
