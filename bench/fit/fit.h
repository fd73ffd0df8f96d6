// The fit of module/src/pyramid_energy_table.h: a model of the diffusion pyramid on a plane that faces the
// camera, in float64, and the weights of its elements that come nearest to a Gaussian; docs/how-it-works.md,
// "Fitted tables".
#pragma once

#include <Eigen/Dense>
#include <array>
#include <vector>

#include "material/pyramid_energy.h"
#include "material/pyramid_energy_table.h"

namespace pellucid::fit {

// Weights of consecutive pixels or texels along an axis, from `first` on: all filters of the pyramid are
// products of one along rows and one along columns.
struct Kernel {
  int first = 0;
  std::vector<double> weights;
};

// Elements of a kernel: the pixel, the fine filter, and level e for e > 1.
constexpr int kPixel = 0, kFineFilter = 1, kFirstLevelElement = 2, kLastElement = 7,
              kElementCount = kLastElement + 1;

// How element e weights pixels around a pixel; 0 is the pixel. `phase`: its place, pixels; the kernel repeats
// every 2^e of them.
Kernel elementKernel(int element, int phase);

// Variance of a kernel around pixel 0, squared pixels.
double varianceOf(const Kernel& kernel);

// Expected squared error near straight edges, at all places and angles, of sums of elements from Gaussians: a
// quadratic form of the elements' weights. In squared contrasts, up to a factor that all share.
class EdgeError {
public:
  // Deviations in pixels, 1/8 to 64.
  explicit EdgeError(const std::vector<double>& deviations);

  // Error from the Gaussian with that index, by these weights of all elements, whose sum is 1.
  double of(Eigen::Index gaussian, const Eigen::VectorXd& weights) const;

  // Weights with the least sum of that error and, of each element but the pixel, `penalty` times o^2 times
  // the error that the element in the pixel's place makes of a sharp image, times its weight squared; o:
  // octaves between the element's deviation and the Gaussian's. Without the penalty, elements far from the
  // Gaussian have weights that cancel each other.
  Eigen::VectorXd best(Eigen::Index gaussian, double penalty) const;

private:
  std::vector<double> deviations_;
  Eigen::MatrixXd elements_;   // products of elements' responses, e x e
  Eigen::MatrixXd products_;   // of elements' and Gaussians' responses, e x g
  Eigen::VectorXd gaussians_;  // squared responses, g
};

// Cumulative weights of the fine filter, levels 2 and 3, and all coarser ones over a Gaussian's deviation.
using EnergyTable = std::array<GaussianEnergy, kElements>;

// Minimizes EdgeError for each Gaussian. Values of four decimals, as the file has.
EnergyTable fitEnergyTable();

}  // namespace pellucid::fit
