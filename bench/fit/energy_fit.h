// Weights of the pyramid's elements that come nearest to a Gaussian; docs/how-it-works.md, "Fitted tables".
#pragma once

#include <Eigen/Dense>
#include <vector>

namespace pellucid::fit {

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

}  // namespace pellucid::fit
