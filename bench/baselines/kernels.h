// The baselines' kernels for a material, as their shaders read them. The material has Gaussians and Burley
// distances.
#pragma once

#include <glm/vec4.hpp>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::bench {

// Six Gaussians of variances that the channels share, as d'Eon & Luebke 2007 have them, fitted to Burley's
// profile: rgb: weight, of sum 1; w: standard deviation (mm) that takes the Gaussian before to this one.
std::vector<glm::vec4> sharedGaussians(const PellucidMaterial& material);

// Pre-integrated kernel of Jimenez et al. 2015, quadratically spaced within the radius of 99.9 %: rgb:
// weight, of sum 1; w: offset (mm). The center is first, the outermost second. taps: odd.
std::vector<glm::vec4> separableKernel(const PellucidMaterial& material, int taps);

// Burley distances, then samples at the golden angle, their radii at equal steps of the widest channel's
// cumulative distribution: x, y: direction; z: radius (mm); w: 1 / probability density (mm^2).
std::vector<glm::vec4> burleyDiskKernel(const PellucidMaterial& material, int samples);

}  // namespace pellucid::bench
