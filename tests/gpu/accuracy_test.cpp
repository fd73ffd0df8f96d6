// Costs of float arithmetic and 16-bit storage: errors of the shaders on small images, against float64.
#include "gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace {

using namespace pellucid::test;

// A depth buffer's format, its projection, and how far thicknesses measured from it are off. Surfaces are 0.3
// to 5 m away and 0.5 to 30 mm thick.
struct DepthErrors {
  std::string format;
  double nearPlane, farPlane;  // m; infinite: no far plane
  // Worst relative errors of the thickness, from the stored depths' in float64.
  double shader;
  double naive;  // of the float32 difference of two linearized depths
  int pixels;    // whose stored depths differ
};

// The frame with 16-bit colors, output and intermediates, against the same with 32-bit ones.
struct HalfErrors {
  double irradiance;   // of about 1 in the middle
  uint32_t samples;    // of the gather
  double worst, rmse;  // relative to the 32-bit result of the pixel and channel
};

constexpr int kSide = 96;
constexpr double kInfinite = std::numeric_limits<double>::infinity();

// e^{-d} for each channel, and two Gaussians that diffuse over a few pixels.
PellucidMaterial material() {
  PellucidMaterial m{};
  m.structSize = sizeof m;
  m.transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  m.gaussianCount = 2;
  for (int c = 0; c < 3; ++c) {
    m.transmittance[c][0] = m.transmittance[c][1] = 1;
    m.reflectance[c] = 0.5f;
    m.gaussianVariance[c][0] = 0.2f;
    m.gaussianVariance[c][1] = 4;
    m.gaussianWeight[c][0] = m.gaussianWeight[c][1] = 0.5f;
    m.radius[c] = 7;
  }
  return m;
}

Capture wholeScreen() {
  Capture c;
  c.name = "accuracy";
  c.width = c.height = kSide;
  c.frontDepth.image = c.backDepth.image = Image(kSide, kSide, 1);
  c.irradiance = Image(kSide, kSide, 3, 1);
  c.material.assign(c.irradiance.pixels(), 1);
  c.materials.resize(1);
  Light light;
  light.direction = {0, 0, 1};
  c.lights = {light};
  return c;
}

struct Projection {
  float a, b;  // device depth = a + b / planar distance; as float matrices hold them
  double depth(double distance) const { return static_cast<double>(a) + static_cast<double>(b) / distance; }
  double distance(double depth) const { return static_cast<double>(b) / (depth - static_cast<double>(a)); }
  float distance(float depth) const { return b / (depth - a); }
};

Projection projectionOf(double n, double f, bool reversed) {
  const double a = std::isinf(f) ? 1 : f / (f - n), b = std::isinf(f) ? -n : -f * n / (f - n);
  return reversed ? Projection{static_cast<float>(1 - a), static_cast<float>(-b)}
                  : Projection{static_cast<float>(a), static_cast<float>(b)};
}

struct Format {
  const char* name;
  int bits;  // of a normalized integer; 0: a float
  bool reversed;
};

// As Vulkan converts normalized integers: the nearest float of n / (2^bits - 1).
float store(const Format& format, double depth) {
  if (format.bits == 0) return static_cast<float>(depth);
  const double most = std::ldexp(1.0, format.bits) - 1;
  return static_cast<float>(std::round(depth * most) / most);
}

DepthErrors measureDepth(Replayer& replayer, const Format& format, double n, double f) {
  const Projection projection = projectionOf(n, f, format.reversed);
  Capture c = wholeScreen();
  c.frontDepth.encoding = c.backDepth.encoding = PELLUCID_DEPTH_DEVICE;
  c.clipFromView = {};
  c.clipFromView[0] = 2;
  c.clipFromView[5] = -2;
  c.clipFromView[10] = -static_cast<double>(projection.a);
  c.clipFromView[11] = -1;
  c.clipFromView[14] = static_cast<double>(projection.b);
  std::mt19937 random(7);
  const auto logarithmic = [&](double least, double most) {
    return std::exp(std::uniform_real_distribution<double>(std::log(least), std::log(most))(random));
  };
  for (size_t i = 0; i < c.material.size(); ++i) {
    const double front = logarithmic(0.3, 5);
    c.frontDepth.image.data[i] = store(format, projection.depth(front));
    c.backDepth.image.data[i] = store(format, projection.depth(front + logarithmic(0.0005, 0.03)));
  }
  ReplaySettings settings = inFloats();
  settings.debugView = PELLUCID_DEBUG_THICKNESS;
  const Image gpu = replayer.run(c, {material()}, settings).output;

  DepthErrors errors{format.name, n, f, 0, 0, 0};
  for (size_t i = 0; i < c.material.size(); ++i) {
    const float front = c.frontDepth.image.data[i], back = c.backDepth.image.data[i];
    const double exact =
        projection.distance(static_cast<double>(back)) - projection.distance(static_cast<double>(front));
    if (!(exact > 0)) continue;  // one number for both: nothing is behind
    ++errors.pixels;
    // The view ray of the pixel, of planar length 1.
    const double x = ((static_cast<double>(i % kSide) + 0.5) * 2 / kSide - 1) / 2,
                 y = ((static_cast<double>(i / kSide) + 0.5) * 2 / kSide - 1) / 2;
    const double chord = exact * std::sqrt(1 + x * x + y * y) * 1000;  // mm
    errors.shader = std::max(errors.shader, std::abs(static_cast<double>(gpu.data[4 * i]) - chord) / chord);
    const float naive = projection.distance(back) - projection.distance(front);
    errors.naive = std::max(errors.naive, std::abs(static_cast<double>(naive) - exact) / exact);
  }
  return errors;
}

std::vector<DepthErrors> measureDepths(Replayer& replayer) {
  std::vector<DepthErrors> rows;
  for (const Format& format : {Format{"D16", 16, false}, Format{"D24", 24, false},
                               Format{"D32 float", 0, false}, Format{"D32 float, reversed", 0, true}})
    for (const auto& [n, f] : {std::pair{0.1, 10.0}, {0.1, 1000.0}, {0.01, 1000.0}, {0.01, kInfinite}})
      rows.push_back(measureDepth(replayer, format, n, f));
  return rows;
}

std::vector<HalfErrors> measureHalves(Replayer& replayer) {
  Capture c = wholeScreen();
  c.metersPerUnit = 0.001;
  c.clipFromView = kIdentity;
  c.clipFromView[0] = 4.0 / kSide;  // pixels of half a millimeter
  c.clipFromView[5] = -4.0 / kSide;
  c.clipFromView[10] = -1.0 / 100;
  std::fill(c.frontDepth.image.data.begin(), c.frontDepth.image.data.end(), 10.0f);
  std::fill(c.backDepth.image.data.begin(), c.backDepth.image.data.end(), 11.0f);
  std::vector<HalfErrors> rows;
  for (const double irradiance : {1e-4, 1e-2, 1.0, 1e3})
    for (const uint32_t samples : {0u, 8u, 16u}) {
      std::mt19937 random(11);
      std::uniform_real_distribution<float> factor(0.25f, 4);
      for (float& value : c.irradiance.data) value = static_cast<float>(irradiance) * factor(random);
      c.lights[0].intensity = irradiance;
      ReplaySettings settings;
      settings.translucency.gatherSamples = samples;
      const Image half = replayer.run(c, {material()}, settings).output;
      settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
      const Image whole = replayer.run(c, {material()}, settings).output;
      HalfErrors errors{irradiance, samples, 0, 0};
      for (size_t i = 0; i < whole.pixels(); ++i)
        for (size_t k = 4 * i; k < 4 * i + 3; ++k) {
          const double exact = static_cast<double>(whole.data[k]);
          const double relative = std::abs(static_cast<double>(half.data[k]) - exact) / exact;
          errors.worst = std::max(errors.worst, relative);
          errors.rmse += relative * relative;
        }
      errors.rmse = std::sqrt(errors.rmse / static_cast<double>(3 * whole.pixels()));
      rows.push_back(errors);
    }
  return rows;
}

class Accuracy : public GpuTest {};

TEST_F(Accuracy, ThicknessFromDeviceDepthKeepsWhatTheDepthsHold) {
  for (const DepthErrors& e : measureDepths(replayer())) {
    SCOPED_TRACE(e.format + ", " + std::to_string(e.nearPlane) + " .. " + std::to_string(e.farPlane));
    EXPECT_GT(e.pixels, 1000);
    // A subtraction that is exact, or rounds once, two products of denominators that round once each, a
    // quotient, and the length of the ray: some ten roundings of 6e-8.
    EXPECT_LT(e.shader, 1e-6);
    // Linearized depths near 5 m are off by 3e-7 m each; the thinnest surface is 5e-4 m thick.
    EXPECT_GT(e.naive, 5e-5) << "surfaces are too thick to tell the two apart";
    EXPECT_GT(e.naive, 50 * e.shader);
  }
}

TEST_F(Accuracy, SixteenBitColorsRoundAFewTimes) {
  for (const HalfErrors& e : measureHalves(replayer())) {
    SCOPED_TRACE(std::to_string(e.irradiance) + ", " + std::to_string(e.samples) + " samples");
    // A half rounds by 2^-11 = 4.9e-4 down to 6e-5. The output rounds once, its irradiance and levels before
    // once each: averages of many, whose errors do not add up.
    EXPECT_LT(e.worst, 2e-3);
    EXPECT_LT(e.rmse, 5e-4);
    EXPECT_GT(e.worst, 1e-4) << "nothing was stored in 16 bits";
  }
}

}  // namespace
