// Tiny analytic captures and exact answers for the tests of the float64 reference.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "capture/capture.h"
#include "reference/camera.h"
#include "reference/diffusion.h"
#include "reference/surface.h"
#include "scene/vector.h"

namespace pellucid::harness::reference {

// Orthographic, 1 unit = 1 mm, pixels of side `pixel` mm, +x right, +y up, depths 0..200 forward.
inline Matrix orthographic(int width, int height, double pixel) {
  Matrix m = kIdentity;
  m[0] = 2 / (width * pixel);
  m[5] = -2 / (height * pixel);
  m[10] = -1.0 / 200;
  return m;
}

// View x and y (mm) of a pixel coordinate of an orthographic capture.
inline glm::dvec2 planePoint(const Capture& c, double px, double py) {
  return {(px / c.width * 2 - 1) / c.clipFromView[0], (py / c.height * 2 - 1) / c.clipFromView[5]};
}

// Plane facing the camera at depth 100, material 1 everywhere, irradiance 1.
inline Capture facingPlane(int width, int height, double pixel) {
  Capture c;
  c.name = "test";
  c.width = width;
  c.height = height;
  c.metersPerUnit = 0.001;
  c.clipFromView = orthographic(width, height, pixel);
  c.frontDepth.image = Image(width, height, 1, 100.0f);
  c.irradiance = Image(width, height, 3, 1.0f);
  c.material.assign(c.irradiance.pixels(), 1);
  return c;
}

// Same irradiance in R, G and B of every pixel: the mean of `value` over the pixel, given its lower left
// corner in view x and y (mm).
inline void paint(Capture& c, const std::function<double(glm::dvec2)>& meanOver) {
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const float mean = static_cast<float>(meanOver(planePoint(c, x, y + 1)));
      for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = mean;
    }
}

// Fraction of the square of side `pixel` at `corner` where dot(direction, point) > 0.
inline double halfPlaneCoverage(glm::dvec2 corner, double pixel, glm::dvec2 direction) {
  constexpr int kColumns = 256;
  double covered = 0;
  for (int i = 0; i < kColumns; ++i) {
    const double x = corner.x + pixel * (i + 0.5) / kColumns;
    if (std::abs(direction.y) < 1e-12) {
      covered += direction.x * x > 0 ? 1 : 0;
      continue;
    }
    const double edge = std::clamp((-direction.x * x / direction.y - corner.y) / pixel, 0.0, 1.0);
    covered += direction.y > 0 ? 1 - edge : edge;
  }
  return covered / kColumns;
}

// A ball of 8 mm seen along (.4, -.3, -1), by a camera that looks along -z and is sheared, or by one that
// looks that way. Gets the cosines between the ball's normals and the rays, 0 beside the ball. `light`:
// irradiance of a point of the ball, mm from its center.
inline Capture obliqueBall(bool sheared, double* cosines,
                           const std::function<double(const glm::dvec3&)>& light) {
  constexpr int kSide = 80;
  constexpr double kRadius = 8, kPixel = 0.25;
  const glm::dvec3 along(0.4, -0.3, -1), direction = glm::normalize(along);
  Capture c = facingPlane(kSide, kSide, kPixel);
  c.viewFromWorld[14] = -40;
  if (sheared) {  // x + .4 z, y - .3 z: all points of a ray have one place in the image
    c.clipFromView[8] = 0.4 * c.clipFromView[0];
    c.clipFromView[9] = -0.3 * c.clipFromView[5];
    c.clipFromView[12] = 40 * c.clipFromView[8];
    c.clipFromView[13] = 40 * c.clipFromView[9];
  } else {
    const glm::dvec3 x = glm::normalize(glm::cross(direction, glm::dvec3(0, 1, 0))),
                     y = glm::cross(x, direction);
    for (std::size_t i = 0; i < 3; ++i) {
      c.viewFromWorld[4 * i] = x[static_cast<int>(i)];
      c.viewFromWorld[4 * i + 1] = y[static_cast<int>(i)];
      c.viewFromWorld[4 * i + 2] = -direction[static_cast<int>(i)];
    }
  }
  const glm::dmat4 viewFromWorld = toGlm(c.viewFromWorld), worldFromView = glm::inverse(viewFromWorld);
  const Camera camera(c.clipFromView, kSide, kSide);
  for (int py = 0; py < kSide; ++py)
    for (int px = 0; px < kSide; ++px) {
      const std::size_t pixel = static_cast<std::size_t>(py) * kSide + static_cast<std::size_t>(px);
      const glm::dvec3 origin(worldFromView * glm::dvec4(camera.position({px + 0.5, py + 0.5}, 1), 1));
      const double b = glm::dot(origin, direction),
                   inside = b * b - glm::dot(origin, origin) + kRadius * kRadius;
      c.material[pixel] = inside > 0;
      cosines[pixel] = 0;
      if (!(inside > 0)) {
        c.frontDepth.image.data[pixel] = kNoDepth;
        continue;
      }
      const glm::dvec3 p = origin - (b + std::sqrt(inside)) * direction, n = p / kRadius;
      c.frontDepth.image.data[pixel] = static_cast<float>(-(viewFromWorld * glm::dvec4(p, 1)).z);
      cosines[pixel] = -glm::dot(n, direction);
      for (std::size_t i = 0; i < 3; ++i) c.irradiance.data[3 * pixel + i] = static_cast<float>(light(p));
    }
  return c;
}

// T(d) = e^{-2d}, rho = 1/2, profile Burley of distance d in every channel.
inline PellucidMaterial burleyMaterial(double d) {
  PellucidMaterial m{};
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  for (int c = 0; c < 3; ++c) {
    m.transmittance[c][0] = 1;
    m.transmittance[c][1] = 2;
    m.reflectance[c] = 0.5f;
    m.burleyDistance[c] = static_cast<float>(d);
  }
  return m;
}

inline PellucidMaterial gaussianMaterial(double variance) {
  PellucidMaterial m = burleyMaterial(0);
  m.gaussianCount = 1;
  for (int c = 0; c < 3; ++c) {
    m.gaussianVariance[c][0] = static_cast<float>(variance);
    m.gaussianWeight[c][0] = 1;
  }
  return m;
}

// The diffusion of a capture's irradiance, asked pixel by pixel.
class DiffusedCapture {
public:
  DiffusedCapture(const Capture& capture, const PellucidMaterial& material,
                  double discardedEnergy = 1e-5)
      : surfaces_(capture),
        irradiance_(irradianceOf(capture)),
        diffusion_(capture, surfaces_, {material}, irradiance_, discardedEnergy) {}

  double at(int x, int y) const { return diffusion_.at(x, y).x; }
  const Diffusion& diffusion() const { return diffusion_; }

private:
  static std::vector<glm::dvec3> irradianceOf(const Capture& c) {
    std::vector<glm::dvec3> e;
    for (std::size_t i = 0; i < c.irradiance.pixels(); ++i)
      e.emplace_back(c.irradiance.data[3 * i], c.irradiance.data[3 * i + 1], c.irradiance.data[3 * i + 2]);
    return e;
  }

  SurfaceReader surfaces_;
  std::vector<glm::dvec3> irradiance_;
  Diffusion diffusion_;
};

inline double burleyCumulative(double r, double d) {
  return 1 - std::exp(-r / d) / 4 - 3 * std::exp(-r / (3 * d)) / 4;
}

// int_0^z K_0(s) ds, odd in z, from K_0(s) = int_0^inf e^{-s cosh t} dt.
inline double integratedBesselK0(double z) {
  if (z < 0) return -integratedBesselK0(-z);
  constexpr double kEnd = 40;
  constexpr int kIntervals = 4000;
  const auto f = [z](double t) { return -std::expm1(-z * std::cosh(t)) / std::cosh(t); };
  double sum = f(0) + f(kEnd);
  for (int i = 1; i < kIntervals; ++i) sum += (i % 2 ? 4 : 2) * f(kEnd * i / kIntervals);
  return sum * kEnd / kIntervals / 3;
}

// Burley's profile over a lit half-plane, x mm inside the edge.
inline double burleyStep(double x, double d) {
  return 0.5 + (integratedBesselK0(x / d) + 3 * integratedBesselK0(x / (3 * d))) / (4 * std::numbers::pi);
}

inline double gaussianStep(double x, double variance) {
  return 0.5 * (1 + std::erf(x / std::sqrt(2 * variance)));
}

}  // namespace pellucid::harness::reference
