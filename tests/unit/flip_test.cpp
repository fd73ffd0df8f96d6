// FLIP against what its definition says of simple pairs, and against its authors' implementation.
#include "metrics/eye.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "common/error.h"

namespace pellucid::harness {
namespace {

constexpr int kWidth = 96, kHeight = 64;

using Paint = std::function<std::array<double, 3>(int x, int y)>;

Image painted(const Paint& paint) {
  Image image(kWidth, kHeight, 3);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      const std::array<double, 3> color = paint(x, y);
      for (std::size_t c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(color[c]);
    }
  return image;
}

Paint plain(double r, double g, double b) {
  return [=](int, int) { return std::array<double, 3>{r, g, b}; };
}

std::array<double, 3> skin(int, int) { return {0.6, 0.4, 0.3}; }

std::array<double, 3> waves(double x, double y, double phase, double green, double blue) {
  return {0.5 + 0.4 * std::sin(x * 0.3 + phase), 0.5 + green * std::sin(y * 0.2),
          blue + 0.4 * std::sin((x + y) * 0.25)};
}

struct Pair {
  const char* name;
  Paint reference, test;
  double mean, center;  // of the authors' implementation; center: pixel (48, 32)
};

// Means that FLIP.h 1.6 (github.com/NVlabs/flip) gives for these images at 67 pixels a degree.
TEST(Flip, AgreesWithTheAuthors) {
  const Pair pairs[] = {{"black and white", plain(0, 0, 0), plain(1, 1, 1), 0.967325, 0.967392},
                        {"green and blue", plain(0, 1, 0), plain(0, 0, 1), 1, 1},
                        {"waves", [](int x, int y) { return waves(x, y, 0, 0.4, 0.5); },
                         [](int x, int y) { return waves(x, y, 0.2, 0.35, 0.45); }, 0.258321, 0.193080},
                        {"dot", skin,
                         [](int x, int y) {
                           return x == 48 && y == 32 ? std::array<double, 3>{1, 1, 1} : skin(x, y);
                         },
                         0.000751, 0.278062},
                        {"edge", skin,
                         [](int x, int y) {
                           return x >= 48 ? std::array<double, 3>{0.5, 0.4, 0.3} : skin(x, y);
                         },
                         0.108467, 0.196316},
                        {"dark", plain(0.03, 0.02, 0.015), plain(0.04, 0.02, 0.015), 0.087347, 0.087352}};
  for (const Pair& pair : pairs) {
    SCOPED_TRACE(pair.name);
    const Image map = flipImage(painted(pair.test), painted(pair.reference), 1);
    double sum = 0;
    for (const float value : map.data) sum += value;
    // Theirs is in float: 5e-5 was the farthest of all pixels.
    EXPECT_NEAR(sum / static_cast<double>(map.data.size()), pair.mean, 1e-4);
    EXPECT_NEAR(*map.at(48, 32), pair.center, 1e-4);
  }
}

TEST(Flip, IsSymmetricAndClampsWhatADisplayClamps) {
  const Image a = painted(skin), b = painted([](int x, int y) { return waves(x, y, 0, 0.4, 0.5); });
  EXPECT_EQ(flipImage(a, b, 1).data, flipImage(b, a, 1).data);
  for (const float value : flipImage(painted(plain(2, 2, 2)), painted(plain(5, 7, 9)), 1).data)
    EXPECT_EQ(value, 0);
}

TEST(Flip, ExposureScalesBoth) {
  const Image a = painted(plain(0.06, 0.04, 0.03)), b = painted(plain(0.05, 0.04, 0.03));
  const Image once = flipImage(a, b, 10), scaled = flipImage(painted(skin), painted(plain(0.5, 0.4, 0.3)), 1);
  for (std::size_t i = 0; i < once.data.size(); ++i) EXPECT_NEAR(once.data[i], scaled.data[i], 1e-5);
}

TEST(Flip, OnlyTheMaskIsSeen) {
  // The left half differs, and is not in the mask: black in both.
  const Image b = painted(skin);
  Image a = b;
  Mask mask(a.pixels(), 1);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth / 2; ++x) {
      a.at(x, y)[0] = 9;
      mask[pixelIndex(a, x, y)] = 0;
    }
  const Flip outside = measureFlip(a, b, mask);
  EXPECT_EQ(outside.mean, 0);
  EXPECT_EQ(outside.p99, 0);
  a.at(70, 30)[1] = 0.9f;
  const Flip dot = measureFlip(a, b, mask);
  EXPECT_GT(dot.mean, 0);
  EXPECT_GT(dot.p99, 0);
  EXPECT_EQ(measureFlip(a, b, Mask(mask.size())).mean, 0);
  EXPECT_THROW(measureFlip(Image(5, 5, 3), b, mask), InputError);
}

}  // namespace
}  // namespace pellucid::harness
