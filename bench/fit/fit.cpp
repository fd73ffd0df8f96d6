#include "fit/fit.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <iterator>
#include <numbers>

#include "shared/pellucid_filters.h"

namespace pellucid::fit {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kPi = std::numbers::pi;

// ---- The model

constexpr std::array kDownsample = {PELLUCID_DOWNSAMPLE_OUTER, PELLUCID_DOWNSAMPLE_INNER,
                                    PELLUCID_DOWNSAMPLE_INNER, PELLUCID_DOWNSAMPLE_OUTER};
constexpr std::array kFine = {PELLUCID_FINE_LAST, PELLUCID_FINE_NEXT, PELLUCID_FINE_OWN, PELLUCID_FINE_NEXT,
                              PELLUCID_FINE_LAST};

int floorHalf(int i) { return (i - (i & 1)) / 2; }

// Weights of the finer level's texels: texel i averages texels 2 i - 1 to 2 i + 2 of it.
Kernel throughDownsampling(const Kernel& coarser) {
  Kernel finer{2 * coarser.first - 1, std::vector<double>(2 * coarser.weights.size() + 2)};
  for (size_t i = 0; i < coarser.weights.size(); ++i)
    for (size_t k = 0; k < kDownsample.size(); ++k)
      finer.weights[2 * i + k] += coarser.weights[i] * kDownsample[k];
  return finer;
}

// Weights of pixels: texel i of level 1 averages pixels 2 i and 2 i + 1.
Kernel throughBaseLevel(const Kernel& level1) {
  Kernel pixels{2 * level1.first, {}};
  for (const double w : level1.weights) pixels.weights.insert(pixels.weights.end(), {w / 2, w / 2});
  return pixels;
}

// Weights of the coarser level's texels: texel i takes the one that it lies in and the one beside it that is
// nearer.
Kernel throughRefinement(const Kernel& finer) {
  const int last = finer.first + static_cast<int>(finer.weights.size()) - 1;
  Kernel coarser{floorHalf(finer.first) - 1, {}};
  coarser.weights.resize(static_cast<size_t>(floorHalf(last) + 2 - coarser.first));
  for (size_t k = 0; k < finer.weights.size(); ++k) {
    const int i = finer.first + static_cast<int>(k), near = floorHalf(i),
              far = (i & 1) != 0 ? near + 1 : near - 1;
    coarser.weights[static_cast<size_t>(near - coarser.first)] += finer.weights[k] * PELLUCID_REFINEMENT_NEAR;
    coarser.weights[static_cast<size_t>(far - coarser.first)] += finer.weights[k] * PELLUCID_REFINEMENT_FAR;
  }
  return coarser;
}

// Weights of level 2's texels at a pixel: the quadratic B-spline.
Kernel lastInterpolation(int pixel) {
  const int texel = floorHalf(floorHalf(pixel));
  const double at = (pixel - 4 * texel - 1.5) / 4;
  return {texel - 1, {(0.5 - at) * (0.5 - at) / 2, 0.75 - at * at, (0.5 + at) * (0.5 + at) / 2}};
}

}  // namespace

Kernel elementKernel(int element, int phase) {
  if (element == kPixel) return {0, {1}};
  if (element == kFineFilter) return {-2, {kFine.begin(), kFine.end()}};
  Kernel kernel = lastInterpolation(phase);
  for (int level = kFirstLevelElement; level < element; ++level) kernel = throughRefinement(kernel);
  for (int level = element; level > 1; --level) kernel = throughDownsampling(kernel);
  kernel = throughBaseLevel(kernel);
  kernel.first -= phase;
  return kernel;
}

double varianceOf(const Kernel& kernel) {
  double sum = 0;
  for (size_t i = 0; i < kernel.weights.size(); ++i) {
    const double x = kernel.first + static_cast<double>(i);
    sum += kernel.weights[i] * x * x;
  }
  return sum;
}

namespace {

// How a Gaussian of that deviation, integrated over the pixels as the references do, weights pixels around a
// pixel. Reaches `reach` pixels to both sides; what lies beyond is left out.
Kernel gaussianKernel(double deviation, int reach) {
  Kernel kernel{-reach, {}};
  const double scale = 1 / (deviation * std::numbers::sqrt2);
  for (int i = -reach; i <= reach; ++i) {
    // The outer half alone says it, as differences of numbers near 1 would have no digits left.
    const double from = std::abs(i) - 0.5, to = std::abs(i) + 0.5;
    kernel.weights.push_back((std::erfc(from * scale) - std::erfc(to * scale)) / 2);
  }
  return kernel;
}

// ---- The objective

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

// Spectrum of the covariance e^{-d^2 / (2 t^2)} between points of a row of pixels, by one side's frequencies,
// which count the other's.
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

// ---- The table

namespace {

// Measured on the checker of pellucid_diffusion_error at 2, 8, 32, 128 pixels: .001 gives .0052 .0050 .0076
// .0079, .01 .0046 .0050 .0075 .0076, .05 .0046 .0057 .0081 .0082. Without it narrow Gaussians have negative
// weights of level 2, which the module cannot use.
constexpr double kPenalty = 0.015;

constexpr int kPerOctave = static_cast<int>(1 / EnergyFrom::kStep);
// log2 of the deviations that are fitted, pixels.
constexpr int kNarrowest = -3, kWidest = 6;
constexpr int kFits = (kWidest - kNarrowest) * kPerOctave + 1;

}  // namespace

EnergyTable fitEnergyTable() {
  std::vector<double> deviations;
  for (int i = 0; i < kFits; ++i) deviations.push_back(std::exp2(kNarrowest + i * EnergyFrom::kStep));
  const EdgeError error(deviations);
  MatrixXd energies(kFits, kElementCount);  // at an element and coarser ones
  for (int g = 0; g < kFits; ++g) {
    const VectorXd weights = error.best(g, kPenalty);
    double sum = 1;
    for (int e = 0; e < kElementCount; ++e) {
      energies(g, e) = sum;
      sum -= weights[e];
    }
  }
  EnergyTable table;
  for (int i = 0; i < kElements; ++i) {
    // Levels coarser than 4 differ from it by less than 1 % of their variance.
    const int element = i + 1;
    GaussianEnergy& row = table[static_cast<size_t>(i)];
    row.first = element == kFineFilter ? -3 : -4;
    // In pixels, or the level's texels.
    const double octave = row.first + (element == kFineFilter ? 0 : element);
    const int start = static_cast<int>(octave - kNarrowest) * kPerOctave;
    for (int k = 0; k < static_cast<int>(std::size(row.samples)); ++k)
      row.samples[k] = std::round(energies(start + k, element) * 1e4) / 1e4 + 0.0;  // no minus zero
    // Narrower Gaussians have nothing there, wider ones all.
    *std::begin(row.samples) = 0;
    *std::prev(std::end(row.samples)) = 1;
  }
  return table;
}

}  // namespace pellucid::fit
