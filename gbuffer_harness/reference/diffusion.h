// Brute-force subsurface diffusion: every pixel against every other of its material.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "reference/profile.h"
#include "reference/surface.h"

namespace pellucid::harness::reference {

// Irradiance is constant over a pixel's footprint on its tangent plane. The result at a pixel center x
// is sum_y E_y W(x, y) / sum_y W(x, y), with W the integral of R(distance in 3-D to x) over the
// footprint of pixel y; the sum runs over the pixels of the same material within the cut-off radius.
class Diffusion {
public:
  // Keeps a reference to the irradiance, one value per pixel. `discardedEnergy`: the profile energy that the cut-off
  // radius leaves out at most, [1e-12, 1). Throws InputError naming the material at fault.
  Diffusion(const Capture& capture, const SurfaceReader& surfaces,
            const std::vector<PellucidMaterial>& materials, const std::vector<glm::dvec3>& irradiance,
            double discardedEnergy = 1e-5);

  // Channels without a profile and pixels without material or surface come back as they went in.
  // Safe from several threads.
  glm::dvec3 at(int x, int y) const;

  // Cut-off of the widest profile, mm; 0 if nothing diffuses.
  double radius() const;

private:
  struct Sample {
    glm::dvec3 position;  // mm, view space
    double area;          // mm^2
    ProfileTable::Lanes irradiance;
  };
  struct HalfAxes {
    glm::dvec3 x, y;  // mm
  };
  // The pixels of one material, row by row without gaps.
  struct Layer {
    std::optional<ProfileTable> profile;  // absent: no channel diffuses
    std::array<bool, 3> diffuses{};
    std::vector<Sample> samples;
    std::vector<HalfAxes> footprints;
    std::vector<std::uint32_t> firstAt;  // [y * (width + 1) + x]: first sample of row y at column >= x
    double nearestDepth;                 // scene units
  };
  // Pixels [left, right) x [top, bottom).
  struct Window {
    int left, top, right, bottom;
  };
  struct Sums;

  Layer makeLayer(std::size_t material, const PellucidMaterial& compiled, double discardedEnergy) const;
  void collect(Layer& layer, std::size_t material) const;
  Window reach(const Layer& layer, const Sample& receiver) const;
  void addRow(const Layer& layer, const Sample& receiver, int x, int y, int row, const Window& window,
              Sums& sums) const;

  const Capture& capture_;
  const SurfaceReader& surfaces_;
  const std::vector<glm::dvec3>& irradiance_;
  double mmPerUnit_;
  std::vector<Layer> layers_;  // one per material
};

}  // namespace pellucid::harness::reference
