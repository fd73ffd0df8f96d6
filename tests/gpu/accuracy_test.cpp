// Costs of float arithmetic and 16-bit storage: errors of the shaders on small images, against float64.
#include "gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace {

using namespace pellucid::test;

using Accuracy = GpuTest;

constexpr int kSide = 64;

struct DepthFormat {
  const char* name;
  int bits;  // of a normalized integer; 0: a float
  bool reversed;

  // As Vulkan converts normalized integers: the nearest float of n / (2^bits - 1).
  float store(double depth) const {
    if (bits == 0) return static_cast<float>(depth);
    const double most = std::ldexp(1.0, bits) - 1;
    return static_cast<float>(std::round(depth * most) / most);
  }
};

// Surfaces are .3 to 5 m away and .5 to 30 mm thick. The thickness is that of the stored depths in float64.
TEST_F(Accuracy, ThicknessFromDeviceDepthKeepsWhatTheDepthsHold) {
  for (const DepthFormat& format :
       {DepthFormat{"D16", 16, false}, DepthFormat{"D24", 24, false}, DepthFormat{"D32 float", 0, false},
        DepthFormat{"D32 float, reversed", 0, true}})
    for (const auto& [n, f] : {std::pair{0.1, 10.0}, {0.01, double(INFINITY)}}) {
      SCOPED_TRACE(testing::Message() << format.name << ", " << n << " .. " << f);
      // Device depth = a + b / planar distance, as float matrices hold them.
      double a = std::isinf(f) ? 1 : f / (f - n), b = std::isinf(f) ? -n : -f * n / (f - n);
      if (format.reversed) a = 1 - a, b = -b;
      a = double(static_cast<float>(a)), b = double(static_cast<float>(b));
      Capture c = flatCapture(kSide, kSide);
      c.metersPerUnit = 1;
      c.frontDepth.encoding = c.backDepth.encoding = PELLUCID_DEPTH_DEVICE;
      c.clipFromView = {2, 0, 0, 0, 0, -2, 0, 0, 0, 0, -a, -1, 0, 0, b, 0};
      c.lights = {backLight()};
      std::mt19937 random(7);
      const auto logarithmic = [&](double least, double most) {
        return std::exp(std::uniform_real_distribution<double>(std::log(least), std::log(most))(random));
      };
      for (size_t i = 0; i < c.material.size(); ++i) {
        const double front = logarithmic(0.3, 5);
        c.frontDepth.image.data[i] = format.store(a + b / front);
        c.backDepth.image.data[i] = format.store(a + b / (front + logarithmic(0.0005, 0.03)));
      }
      ReplaySettings settings = inFloats();
      settings.debugView = PELLUCID_DEBUG_THICKNESS;
      const Image gpu = replay(c, testMaterial(), settings);
      int pixels = 0;
      double worst = 0;
      for (size_t i = 0; i < c.material.size(); ++i) {
        const double front = b / (double(c.frontDepth.image.data[i]) - a),
                     exact = b / (double(c.backDepth.image.data[i]) - a) - front;
        if (!(exact > 0)) continue;  // one number for both: nothing is behind
        ++pixels;
        // The view ray of the pixel, of planar length 1.
        const double x = ((static_cast<double>(i % kSide) + 0.5) * 2 / kSide - 1) / 2,
                     y = ((static_cast<double>(i / kSide) + 0.5) * 2 / kSide - 1) / 2;
        const double chord = exact * std::sqrt(1 + x * x + y * y) * 1000;  // mm
        worst = std::max(worst, std::abs(double(gpu.data[4 * i]) - chord) / chord);
      }
      EXPECT_GT(pixels, 1000);
      // A subtraction that is exact, or rounds once, two products of denominators that round once each, a
      // quotient, and the length of the ray: some ten roundings of 6e-8. The difference of two linearized
      // depths would be off by 5e-5 and more.
      EXPECT_LT(worst, 1e-6);
    }
}

// The frame with 16-bit colors, output and intermediates, against the same with 32-bit ones.
TEST_F(Accuracy, SixteenBitColorsRoundAFewTimes) {
  Capture c = flatCapture(kSide, kSide);
  c.lights = {backLight()};
  for (const double irradiance : {1e-4, 1e3})
    for (const uint32_t samples : {0u, 8u}) {
      SCOPED_TRACE(testing::Message() << irradiance << ", " << samples << " samples");
      std::mt19937 random(11);
      std::uniform_real_distribution<float> factor(0.25f, 4);
      for (float& value : c.irradiance.data) value = static_cast<float>(irradiance) * factor(random);
      c.lights[0].intensity = irradiance;
      ReplaySettings settings;
      settings.translucency.gatherSamples = samples;
      const Image half = replay(c, testMaterial(), settings);
      settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
      const Image whole = replay(c, testMaterial(), settings);
      double worst = 0, squares = 0;
      for (size_t i = 0; i < whole.pixels(); ++i)
        for (size_t k = 0; k < 3; ++k) {
          const double exact = double(whole.data[4 * i + k]),
                       relative = std::abs(double(half.data[4 * i + k]) - exact) / exact;
          worst = std::max(worst, relative);
          squares += relative * relative;
        }
      // A half rounds by 2^-11 = 4.9e-4 down to 6e-5. The output rounds once, its irradiance and levels
      // before once each: averages of many, whose errors do not add up.
      EXPECT_LT(worst, 2e-3);
      EXPECT_LT(std::sqrt(squares / (3.0 * static_cast<double>(whole.pixels()))), 5e-4);
      EXPECT_GT(worst, 1e-4) << "nothing was stored in 16 bits";
    }
}

}  // namespace
