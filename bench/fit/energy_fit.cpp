#include "fit/energy_fit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "fit/pyramid_model.h"

namespace pellucid::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

// Rows of pixels repeat after this many, which the widest element's 768 and 32 deviations of the widest
// Gaussian fit in.
constexpr int kPeriod = 2048, kFrequencies = kPeriod / 2 + 1;

// A random image of straight edges has a covariance of its contrast squared less a multiple of the distance r
// (Matern 1960: mosaics of random lines have e^{-r/L}). The sum of weights is 1, which leaves -r, and
//   r = sqrt(2 / pi) int_0^inf (1 - e^{-r^2 / (2 t^2)}) dt
// is a mixture of covariances that are products along rows and columns, as all kernels here are. Deviations t
// of the mixture:
constexpr double kFirstOctave = -2, kLastOctave = 9, kOctaveStep = 0.5;

// (f(d + 1) - 2 f(d) + f(d - 1)) of this is the covariance of the means over two pixels at distance d.
double secondIntegral(double d, double t) {
  return t * t * std::expm1(-d * d / (2 * t * t)) +
         d * t * std::sqrt(kPi / 2) * std::erf(d / (t * std::numbers::sqrt2));
}

// Spectrum of the covariance e^{-d^2 / (2 t^2)} between points of a row of pixels, by one side's frequencies, which
// count the other's.
VectorXd spectrumOf(double t) {
  VectorXd covariance(kPeriod);
  for (int i = 0; i < kPeriod; ++i) {
    const double d = std::min(i, kPeriod - i);
    covariance[i] = secondIntegral(d + 1, t) - 2 * secondIntegral(d, t) + secondIntegral(std::abs(d - 1), t);
  }
  VectorXd cosine(kPeriod), spectrum(kFrequencies);
  for (int i = 0; i < kPeriod; ++i) cosine[i] = std::cos(2 * kPi * i / kPeriod);
  for (int f = 0; f < kFrequencies; ++f) {
    double sum = 0;
    for (int i = 0; i < kPeriod; ++i) sum += covariance[i] * cosine[f * i % kPeriod];
    spectrum[f] = sum / kPeriod * (f == 0 || f == kPeriod / 2 ? 1 : 2);
  }
  return spectrum;
}

Eigen::VectorXcd transformOf(const Kernel& kernel) {
  Eigen::VectorXcd result(kFrequencies);
  for (int f = 0; f < kFrequencies; ++f) {
    const double frequency = 2 * kPi * f / kPeriod;
    const std::complex<double> step = std::polar(1.0, frequency);
    std::complex<double> turn = std::polar(1.0, frequency * kernel.first), sum = 0;
    for (const double w : kernel.weights) {
      sum += w * turn;
      turn *= step;
    }
    result[f] = sum;
  }
  return result;
}

double octavesBetween(int element, double deviation) {
  return std::log2(std::sqrt(varianceOf(elementKernel(element, 0))) / deviation);
}

}  // namespace

EdgeError::EdgeError(const std::vector<double>& deviations) : deviations_(deviations) {
  const auto count = static_cast<Index>(deviations.size());
  MatrixXd gaussians(count, kFrequencies);
  for (Index g = 0; g < count; ++g) {
    const double deviation = deviations[static_cast<size_t>(g)];
    const int reach = std::min(kPeriod / 2 - 1, static_cast<int>(8 * deviation) + 2);
    gaussians.row(g) = transformOf(gaussianKernel(deviation, reach)).real().transpose();
  }
  // Means over the pixels of a texel of the last level: of the elements' transforms and of products of two, a
  // column for each pair. The other half of these pixels mirrors this one.
  constexpr int kPhases = (1 << kLastElement) / 2;
  MatrixXd mean = MatrixXd::Zero(kElementCount, kFrequencies);
  MatrixXd pairs = MatrixXd::Zero(kFrequencies, kElementCount * kElementCount);
  for (int phase = 0; phase < kPhases; ++phase) {
    Eigen::MatrixXcd elements(kFrequencies, kElementCount);
    for (int e = 0; e < kElementCount; ++e) elements.col(e) = transformOf(elementKernel(e, phase));
    mean += elements.real().transpose() / kPhases;
    for (int e = 0; e < kElementCount; ++e)
      for (int other = 0; other < kElementCount; ++other)
        pairs.col(e * kElementCount + other) +=
            elements.col(e).cwiseProduct(elements.col(other).conjugate()).real() / kPhases;
  }
  elements_ = MatrixXd::Zero(kElementCount, kElementCount);
  products_ = MatrixXd::Zero(kElementCount, count);
  gaussians_ = VectorXd::Zero(count);
  for (double octave = kFirstOctave; octave <= kLastOctave; octave += kOctaveStep) {
    const double t = std::exp2(octave);  // its weight, too, at equal steps of log2 t
    const VectorXd spectrum = spectrumOf(t);
    // Products along a row. Columns are alike, and a pixel's place in a row says nothing of its place in a
    // column, so those over the image are the squares.
    const VectorXd ofPairs = pairs.transpose() * spectrum;
    elements_ += t * ofPairs.reshaped(kElementCount, kElementCount).cwiseAbs2();
    products_ += t * (mean * spectrum.asDiagonal() * gaussians.transpose()).cwiseAbs2();
    gaussians_ += t * (gaussians.cwiseAbs2() * spectrum).cwiseAbs2();
  }
}

double EdgeError::of(Index gaussian, const VectorXd& weights) const {
  // Rounding may leave less than 0 where both are alike.
  return std::max(0.0, weights.dot(elements_ * weights - 2 * products_.col(gaussian)) + gaussians_[gaussian]);
}

VectorXd EdgeError::best(Index gaussian, double penalty) const {
  // The pixel's weight is what the others leave of 1.
  constexpr int kOthers = kElementCount - 1;
  MatrixXd fromPixel = MatrixXd::Zero(kOthers, kElementCount);
  fromPixel.col(kPixel).setConstant(-1);
  fromPixel.rightCols(kOthers).setIdentity();
  MatrixXd matrix = fromPixel * elements_ * fromPixel.transpose();
  const VectorXd right = fromPixel * (products_.col(gaussian) - elements_.col(kPixel));
  for (int e = 1; e < kElementCount; ++e) {
    const double octaves = octavesBetween(e, deviations_[static_cast<size_t>(gaussian)]);
    matrix(e - 1, e - 1) *= 1 + penalty * octaves * octaves;
  }
  VectorXd weights(kElementCount);
  weights.tail(kOthers) = matrix.ldlt().solve(right);
  weights[kPixel] = 1 - weights.tail(kOthers).sum();
  return weights;
}

}  // namespace pellucid::fit
