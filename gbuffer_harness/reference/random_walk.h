// Light inside exact shapes by random walk: isotropic scattering, smooth Fresnel boundary. Lengths in mm.
#pragma once

#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace pellucid::harness::reference {

class WalkShape {
public:
  virtual ~WalkShape() = default;

  // Distance at which a ray that starts inside or on the surface, going inwards, leaves the shape;
  // nothing if that is not within `limit`. Direction is unit.
  virtual std::optional<double> exit(const glm::dvec3& origin, const glm::dvec3& direction,
                                     double limit) const = 0;

  // Outward unit normal at a point of the surface.
  virtual glm::dvec3 normal(const glm::dvec3& point) const = 0;

  // Whether the shape keeps a light in the direction of `toLight` from a point of its surface that faces it.
  virtual bool shadows(const glm::dvec3& point, const glm::dvec3& toLight) const = 0;
};

// Points with dot(normal, p) <= offset for every plane: slabs and wedges.
class WalkPolyhedron : public WalkShape {
public:
  struct Plane {
    glm::dvec3 normal;  // outward, unit
    double offset;
  };
  explicit WalkPolyhedron(std::vector<Plane> planes) : planes_(std::move(planes)) {}
  std::optional<double> exit(const glm::dvec3& origin, const glm::dvec3& direction,
                             double limit) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override;
  bool shadows(const glm::dvec3&, const glm::dvec3&) const override { return false; }

private:
  std::vector<Plane> planes_;
};

// Around the origin.
class WalkSphere : public WalkShape {
public:
  explicit WalkSphere(double radius) : radius_(radius) {}
  std::optional<double> exit(const glm::dvec3& origin, const glm::dvec3& direction,
                             double limit) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override { return glm::normalize(point); }
  bool shadows(const glm::dvec3&, const glm::dvec3&) const override { return false; }

private:
  double radius_;
};

// Around the origin, by sphere tracing (Hart 1996) of the exact distance.
class WalkTorus : public WalkShape {
public:
  WalkTorus(const glm::dvec3& axis, double majorRadius, double minorRadius)
      : axis_(axis), major_(majorRadius), minor_(minorRadius) {}
  std::optional<double> exit(const glm::dvec3& origin, const glm::dvec3& direction,
                             double limit) const override;
  glm::dvec3 normal(const glm::dvec3& point) const override;
  bool shadows(const glm::dvec3& point, const glm::dvec3& toLight) const override;

private:
  glm::dvec3 fromTube(const glm::dvec3& point) const;  // from the tube's center circle
  glm::dvec3 axis_;
  double major_, minor_;
};

struct WalkMedium {
  double scattering, absorption;  // sigma_s', sigma_a, 1/mm; isotropic
  double ior = 1;                 // relative, [1, 3]
};

struct WalkResult {
  double mean, standardError;
};

// Exitance at a point of the surface under a directional light of irradiance 1 at normal incidence, which
// enters as if it were Lambertian. By reciprocity: walks that start at the point as Lambertian light from
// outside does, each scored with the irradiance where it leaves. Same seed, same result, however many
// threads.
WalkResult exitance(const WalkShape& shape, const WalkMedium& medium, const glm::dvec3& point,
                    const glm::dvec3& toLight, std::size_t walks, std::uint64_t seed, int jobs = 0);

}  // namespace pellucid::harness::reference
