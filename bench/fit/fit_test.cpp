// The model of the pyramid against filters applied one after the other, and the objective against closed
// forms.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "fit/fit.h"

namespace pellucid::fit {
namespace {

double variance(int element) {
  if (element == kPixel) return 0;
  if (element == kFineFilter) return 16.0 / 19;
  return 7.0 / 12 * std::exp2(2 * element) - 13.0 / 12;
}

// docs/how-it-works.md, "Fitted tables".
TEST(PyramidModel, ElementsKeepLightAndPlaceAndHaveTheStatedVariances) {
  for (int e = 0; e < kElementCount; ++e)
    for (int phase = 0; phase < 1 << e; ++phase) {
      const Kernel kernel = elementKernel(e, phase);
      double sum = 0, mean = 0;
      for (size_t i = 0; i < kernel.weights.size(); ++i) {
        sum += kernel.weights[i];
        mean += kernel.weights[i] * (kernel.first + static_cast<double>(i));
      }
      EXPECT_NEAR(sum, 1, 1e-12) << e;
      EXPECT_NEAR(mean, 0, 1e-9) << e << " at " << phase;
      EXPECT_NEAR(varianceOf(kernel), variance(e), 1e-9 * (1 + variance(e))) << e << " at " << phase;
    }
}

// A periodic row through 3 5 5 3, 9 3 3 1 and the spline.
TEST(PyramidModel, Level4IsWhatItsFiltersMakeOfARow) {
  constexpr int kPixels = 128;
  std::mt19937 random(3);
  std::vector<double> row(kPixels);
  for (double& v : row) v = static_cast<double>(random() % 1024) / 1024;
  const auto at = [](const std::vector<double>& r, int i) {
    const int n = static_cast<int>(r.size());
    return r[static_cast<size_t>((i % n + n) % n)];
  };
  std::vector<double> level;
  for (int i = 0; i < kPixels / 2; ++i) level.push_back((at(row, 2 * i) + at(row, 2 * i + 1)) / 2);
  for (int l = 2; l <= 4; ++l) {
    std::vector<double> coarser;
    for (int i = 0; i < kPixels >> l; ++i)
      coarser.push_back((3 * at(level, 2 * i - 1) + 5 * at(level, 2 * i) + 5 * at(level, 2 * i + 1) +
                         3 * at(level, 2 * i + 2)) /
                        16);
    level = coarser;
  }
  for (int l = 3; l >= 2; --l) {
    std::vector<double> finer;
    for (int i = 0; i < kPixels >> l; ++i)
      finer.push_back((3 * at(level, i / 2) + at(level, i % 2 == 0 ? i / 2 - 1 : i / 2 + 1)) / 4);
    level = finer;
  }
  for (int pixel = 40; pixel < 40 + 16; ++pixel) {
    const double x = (pixel % 4 - 1.5) / 4;
    const int texel = pixel / 4;
    const double expected = (0.5 - x) * (0.5 - x) / 2 * at(level, texel - 1) +
                            (0.75 - x * x) * at(level, texel) +
                            (0.5 + x) * (0.5 + x) / 2 * at(level, texel + 1);
    const Kernel kernel = elementKernel(4, pixel);
    double made = 0;
    for (size_t i = 0; i < kernel.weights.size(); ++i)
      made += kernel.weights[i] * at(row, pixel + kernel.first + static_cast<int>(i));
    EXPECT_NEAR(made, expected, 1e-12) << pixel;
  }
}

class EdgeErrors : public testing::Test {
protected:
  static const EdgeError& error() {
    static const EdgeError e({1, 16, 32});
    return e;
  }
};

// Beside a step, Gaussians of deviations a and b differ by the integral of (Phi(x/a) - Phi(x/b))^2, which is
// (sqrt(a^2 + b^2) - (a + b) / sqrt 2) / sqrt(pi / 2).
double betweenGaussians(double a, double b) { return std::hypot(a, b) - (a + b) / std::sqrt(2.0); }

TEST_F(EdgeErrors, GoesAsThatOfAStep) {
  const auto alone = [](int element) {
    return Eigen::VectorXd(Eigen::VectorXd::Unit(kElementCount, element));
  };
  const double pixel = error().of(1, alone(kPixel));
  // Pixels hold means over their area, of variance 1/12; the Gaussian's integral over pixels has as much
  // again.
  const auto between = [](double elementVariance, double deviation) {
    return betweenGaussians(std::sqrt(elementVariance + 1.0 / 12),
                            std::sqrt(deviation * deviation + 2.0 / 12));
  };
  EXPECT_NEAR(error().of(2, alone(kPixel)) / pixel, between(0, 32) / between(0, 16), 0.005);
  // Level 6 is flatter than a Gaussian and changes with the place of the pixel: by 5 %.
  EXPECT_NEAR(error().of(1, alone(6)) / pixel, between(variance(6), 16) / between(0, 16), 0.08);
}

TEST_F(EdgeErrors, IsLeastAtTheFit) {
  std::mt19937 random(5);
  for (int g = 0; g < 3; ++g) {
    const Eigen::VectorXd best = error().best(g, 0);
    EXPECT_NEAR(best.sum(), 1, 1e-12);
    for (int i = 0; i < 20; ++i) {
      Eigen::VectorXd other(kElementCount);
      for (double& w : other) w = static_cast<double>(random() % 2001) / 1e5 - 0.01;
      other[kPixel] -= other.sum();
      EXPECT_GT(error().of(g, best + other), error().of(g, best)) << g;
    }
    // The penalty takes from far elements.
    EXPECT_LT(error().best(g, 1)[kLastElement] * error().best(g, 1)[kLastElement],
              best[kLastElement] * best[kLastElement])
        << g;
  }
}

}  // namespace
}  // namespace pellucid::fit
