#include "metrics/eye.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <glm/glm.hpp>
#include <numbers>
#include <numeric>
#include <utility>

#include "common/parallel.h"
#include "common/png.h"

namespace pellucid::harness {

namespace {

using Color = glm::dvec3;

struct Plane {
  int width, height;
  std::vector<Color> data;
  Plane(int w, int h)
      : width(w), height(h), data(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// IEC 61966-2-1; columns.
const glm::dmat3 kXyzFromRgb(0.4123907993, 0.2126390059, 0.0193308187, 0.3575843394, 0.7151686788,
                             0.1191947798, 0.1804807884, 0.0721923154, 0.9505321522);
const glm::dmat3 kRgbFromXyz(3.2409699419, -0.9692436363, 0.0556300797, -1.5373831776, 1.8759675015,
                             -0.2039769589, -0.4986107603, 0.0415550574, 1.0569715142);
const Color kWhite = kXyzFromRgb * Color(1);

// Relative to the display's white.
Color relativeXyz(const Color& rgb) { return kXyzFromRgb * rgb / kWhite; }

// The linearized CIELAB that the contrast sensitivities are known in: luminance, red-green, blue-yellow.
Color opponentFromRgb(const Color& rgb) {
  const Color v = relativeXyz(rgb);
  return {116 * v[1] - 16, 500 * (v[0] - v[1]), 200 * (v[1] - v[2])};
}

Color rgbFromOpponent(const Color& v) {
  const double y = (v[0] + 16) / 116;
  return kRgbFromXyz * (kWhite * Color(y + v.y / 500, y, y - v.z / 200));
}

// CIELAB whose a and b shrink with the lightness (Hunt 1952): colors of dark pixels are hardly seen.
Color huntLabFromRgb(const Color& rgb) {
  constexpr double kDelta = 6.0 / 29;
  Color f = relativeXyz(rgb);
  for (int i = 0; i < 3; ++i)
    f[i] = f[i] > kDelta * kDelta * kDelta ? std::cbrt(f[i]) : f[i] / (3 * kDelta * kDelta) + 4.0 / 29;
  const double lightness = 116 * f[1] - 16;
  return {lightness, 0.01 * lightness * 500 * (f[0] - f[1]), 0.01 * lightness * 200 * (f[1] - f[2])};
}

// Abasi et al. 2020: for large differences nearer to what people judge than the Euclidean distance.
double hyab(const Color& a, const Color& b) {
  return std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]);
}

// Weights of a filter along one axis, from -radius to radius.
using Kernel = std::vector<double>;

double sumOf(const Kernel& kernel) { return std::accumulate(kernel.begin(), kernel.end(), 0.0); }

Kernel kernelOf(int radius, const std::function<double(int)>& weight) {
  Kernel kernel;
  for (int i = -radius; i <= radius; ++i) kernel.push_back(weight(i));
  return kernel;
}

// The outermost pixels go on beyond the image.
Plane filter(const Plane& image, const std::array<Kernel, 3>& alongX, const std::array<Kernel, 3>& alongY) {
  Plane rows(image.width, image.height), result(image.width, image.height);
  const auto pass = [](const Plane& from, Plane& to, const std::array<Kernel, 3>& kernels, bool horizontal) {
    const int radius = static_cast<int>(kernels[0].size()) / 2;
    parallelRows(from.height, 0, [&](int y) {
      for (int x = 0; x < from.width; ++x) {
        Color sum(0);
        for (int i = -radius; i <= radius; ++i) {
          const int px = horizontal ? std::clamp(x + i, 0, from.width - 1) : x;
          const int py = horizontal ? y : std::clamp(y + i, 0, from.height - 1);
          const auto k = static_cast<std::size_t>(i + radius);
          sum += Color(kernels[0][k], kernels[1][k], kernels[2][k]) * from.data[from.index(px, py)];
        }
        to.data[to.index(x, y)] = sum;
      }
    });
  };
  pass(image, rows, alongX, true);
  pass(rows, result, alongY, false);
  return result;
}

// ---- Color pipeline

// Contrast sensitivity of a channel as the paper's sum of Gaussians a sqrt(pi / b) exp(-pi^2 x^2 / b), x in
// degrees; table 1.
struct Sensitivity {
  double a1, b1, a2, b2;
};
constexpr std::array<Sensitivity, 3> kSensitivities = {
    {{1, 0.0047, 0, 1e-5}, {1, 0.0053, 0, 1e-5}, {34.1, 0.04, 13.5, 0.025}}};

// Opponent channels as the eye resolves them.
Plane filterBySensitivity(const Plane& opponent, double pixelsPerDegree) {
  constexpr double kPi = std::numbers::pi;
  // Three standard deviations of the widest Gaussian.
  const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * kPi * kPi)) * pixelsPerDegree));
  std::array<Kernel, 3> first, second;
  for (std::size_t c = 0; c < 3; ++c) {
    const Sensitivity& s = kSensitivities[c];
    const auto gaussian = [&](double b) {
      return kernelOf(radius, [&](int i) {
        const double x = i / pixelsPerDegree;
        return std::exp(-kPi * kPi * x * x / b);
      });
    };
    first[c] = gaussian(s.b1);
    second[c] = gaussian(s.b2);
    // In two dimensions each Gaussian is a product of two; all weights of the sum add up to 1.
    const double w1 = s.a1 * std::sqrt(kPi / s.b1), w2 = s.a2 * std::sqrt(kPi / s.b2);
    const double total = w1 * std::pow(sumOf(first[c]), 2) + w2 * std::pow(sumOf(second[c]), 2);
    for (double& w : first[c]) w *= std::sqrt(w1 / total);
    for (double& w : second[c]) w *= std::sqrt(w2 / total);
  }
  Plane result = filter(opponent, first, first);
  const Plane added = filter(opponent, second, second);
  for (std::size_t i = 0; i < result.data.size(); ++i) result.data[i] += added.data[i];
  return result;
}

// 0 .. 1 of a HyAB distance: most of the range is for the differences that are common.
double remapColor(double distance) {
  constexpr double kExponent = 0.7, kCommon = 0.4, kCommonRange = 0.95;
  static const double largest =
      std::pow(hyab(huntLabFromRgb({0, 1, 0}), huntLabFromRgb({0, 0, 1})), kExponent);
  const double error = std::pow(distance, kExponent), knee = kCommon * largest;
  if (error < knee) return kCommonRange * error / knee;
  return kCommonRange + (error - knee) / (largest - knee) * (1 - kCommonRange);
}

// ---- Feature pipeline

// Magnitudes of edges and points (lines) in the lightness of each pixel.
struct Features {
  std::vector<double> edge, point;
};

Features featuresOf(const Plane& opponent, double pixelsPerDegree) {
  constexpr double kFeatureWidth = 0.082;  // degrees
  const double deviation = 0.5 * kFeatureWidth * pixelsPerDegree;
  const int radius = static_cast<int>(std::ceil(3 * deviation));
  const auto gaussian = [&](int i) { return std::exp(-i * i / (2 * deviation * deviation)); };
  Kernel smooth = kernelOf(radius, gaussian);
  for (const double total = sumOf(smooth); double& w : smooth) w /= total;
  // Positive and negative weights of derivatives add up to 1 and -1.
  const auto derivative = [&](const std::function<double(int)>& weight) {
    Kernel kernel = kernelOf(radius, weight);
    double positive = 0, negative = 0;
    for (const double w : kernel) (w > 0 ? positive : negative) += w;
    for (double& w : kernel) w /= w > 0 ? positive : -negative;
    return kernel;
  };
  const Kernel first = derivative([&](int i) { return -i * gaussian(i); });
  const Kernel second =
      derivative([&](int i) { return (i * i / (deviation * deviation) - 1) * gaussian(i); });

  Plane lightness(opponent.width, opponent.height);  // thrice, for three filters at once
  for (std::size_t i = 0; i < lightness.data.size(); ++i)
    lightness.data[i] = Color((opponent.data[i].x + 16) / 116);
  const Plane x = filter(lightness, {first, second, smooth}, {smooth, smooth, smooth});
  const Plane y = filter(lightness, {smooth, smooth, smooth}, {first, second, smooth});
  Features features;
  for (std::size_t i = 0; i < x.data.size(); ++i) {
    features.edge.push_back(std::hypot(x.data[i][0], y.data[i][0]));
    features.point.push_back(std::hypot(x.data[i][1], y.data[i][1]));
  }
  return features;
}

double featureError(const Features& a, const Features& b, std::size_t i) {
  constexpr double kExponent = 0.5;
  const double difference = std::max(std::abs(a.edge[i] - b.edge[i]), std::abs(a.point[i] - b.point[i]));
  return std::pow(difference / std::numbers::sqrt2, kExponent);
}

Plane displayed(const Image& image, double exposure) {
  Plane plane(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      if (!finitePixel(image, x, y)) continue;
      const float* const rgb = image.at(x, y);
      plane.data[plane.index(x, y)] = glm::clamp(exposure * Color(rgb[0], rgb[1], rgb[2]), 0.0, 1.0);
    }
  return plane;
}

// Images that the color pipeline and the features compare.
std::pair<Plane, Features> seen(const Image& image, double exposure, double pixelsPerDegree) {
  Plane opponent = displayed(image, exposure);
  for (Color& color : opponent.data) color = opponentFromRgb(color);
  Plane lab = filterBySensitivity(opponent, pixelsPerDegree);
  for (Color& color : lab.data) color = huntLabFromRgb(glm::clamp(rgbFromOpponent(color), 0.0, 1.0));
  return {std::move(lab), featuresOf(opponent, pixelsPerDegree)};
}

Image blackOutside(Image image, const Mask& mask) {
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] == 0) std::fill_n(&image.data[3 * i], 3, 0.0f);
  return image;
}

}  // namespace

Image flipImage(const Image& test, const Image& reference, double exposure, double pixelsPerDegree) {
  const Mask everywhere(reference.pixels(), 1);
  requireImage("A", test, reference.width, reference.height, everywhere);
  requireImage("B", reference, reference.width, reference.height, everywhere);
  const auto [labA, featuresA] = seen(test, exposure, pixelsPerDegree);
  const auto [labB, featuresB] = seen(reference, exposure, pixelsPerDegree);
  Image result(reference.width, reference.height, 1);
  for (std::size_t i = 0; i < result.data.size(); ++i)
    result.data[i] = static_cast<float>(
        std::pow(remapColor(hyab(labA.data[i], labB.data[i])), 1 - featureError(featuresA, featuresB, i)));
  return result;
}

Flip measureFlip(const Image& test, const Image& reference, const Mask& mask) {
  requireImage("A", test, reference.width, reference.height, mask);
  requireImage("B", reference, reference.width, reference.height, mask);
  const Image a = blackOutside(test, mask), b = blackOutside(reference, mask);
  Flip flip;
  const Image map = flipImage(a, b, static_cast<double>(autoExposure(b)));
  std::vector<float> values;
  for (std::size_t i = 0; i < mask.size(); ++i)
    if (mask[i] != 0) values.push_back(map.data[i]);
  if (values.empty()) return flip;
  flip.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const auto rank = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / 100);
  std::nth_element(values.begin(), rank, values.end());
  flip.p99 = *rank;
  return flip;
}

}  // namespace pellucid::harness
