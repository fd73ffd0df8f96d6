// Metrics of what the eye sees, on images whose answers are known.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "common/error.h"
#include "metrics/eye.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "metrics/spots.h"
#include "metrics/surface.h"
#include "reference/camera.h"

namespace pellucid::harness {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Orthographic, a pixel is 1 unit wide and high; material 1, facing the camera at depth 100.
Capture plane(int width, int height) {
  Capture c;
  c.name = "test";
  c.width = width;
  c.height = height;
  c.clipFromView = {2.0 / width, 0, 0, 0, 0, -2.0 / height, 0, 0, 0, 0, -1e-3, 0, 0, 0, 0, 1};
  c.frontDepth.image = Image(width, height, 1, 100.0f);
  c.irradiance = Image(width, height, 3, 1.0f);
  c.material.assign(c.irradiance.pixels(), 1);
  return c;
}

template <class Depth>
Capture shape(int width, int height, const Depth& depth) {
  Capture c = plane(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) *c.frontDepth.image.at(x, y) = static_cast<float>(depth(x, y));
  return c;
}

Mask everywhere(const Image& image) { return Mask(image.pixels(), 1); }

// Multiplies all channels of the pixels of a rectangle.
void scale(Image& image, int left, int top, int width, int height, float factor) {
  for (int y = top; y < top + height; ++y)
    for (int x = left; x < left + width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] *= factor;
}

// ---- Surfaces

TEST(Surfaces, ASphereIsOneSurfaceAndEndsBeforeTheWall) {
  // Radius 30.3 pixels, 100 units before a wall.
  constexpr double kRadius = 30.3;
  const auto inside = [](int x, int y) { return std::hypot(x - 32, y - 32) < kRadius; };
  const Surfaces surfaces(shape(65, 65, [&](int x, int y) {
    const double d = std::hypot(x - 32, y - 32);
    return inside(x, y) ? 150 - std::sqrt(kRadius * kRadius - d * d) : 250;
  }));
  for (int y = 1; y < 64; ++y)
    for (int x = 1; x < 64; ++x) {
      EXPECT_EQ(surfaces.connected(x, y, 1, 0), inside(x, y) == inside(x + 1, y)) << x << ", " << y;
      EXPECT_EQ(surfaces.connected(x, y, 0, -1), inside(x, y) == inside(x, y - 1)) << x << ", " << y;
    }
}

TEST(Surfaces, MaterialsAndNothingEndASurface) {
  Capture c = plane(6, 4);
  c.material[1] = 2;  // (1, 0)
  c.material[3] = 0;  // (3, 0)
  *c.frontDepth.image.at(5, 0) = kNoDepth;
  const Surfaces surfaces(c);
  EXPECT_FALSE(surfaces.connected(0, 0, 1, 0));
  EXPECT_FALSE(surfaces.connected(2, 0, 1, 0));
  EXPECT_FALSE(surfaces.connected(4, 0, 1, 0));
  EXPECT_FALSE(surfaces.covered(3, 0));
  EXPECT_FALSE(surfaces.covered(5, 0));
  EXPECT_TRUE(surfaces.covered(1, 0));
  EXPECT_FALSE(surfaces.covered(-1, 0));
  EXPECT_FALSE(surfaces.connected(0, 0, 0, -1));
  EXPECT_FALSE(surfaces.wholeBlock(3, 1, 4));  // reaches out of the image
  EXPECT_TRUE(surfaces.wholeBlock(0, 1, 3));
  EXPECT_TRUE(Surfaces(6, 4).connected(2, 0, 1, 0));
}

TEST(Surfaces, EncodingsOfDepthAgree) {
  // Reversed infinite perspective: device depth is near / z; a step of one pixel width and one of ten at z
  // = 50.
  constexpr double kNear = 0.1, kDepth = 50;
  Capture c = plane(64, 64);
  c.clipFromView = {2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 0, -1, 0, 0, kNear, 0};
  const double pixel = kDepth / 64;  // scene units: the view is z wide
  c.frontDepth.encoding = PELLUCID_DEPTH_DEVICE;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const double z = kDepth + pixel * (x < 20 ? 0 : x < 40 ? 1 : 11);
      *c.frontDepth.image.at(x, y) = static_cast<float>(kNear / z);
    }
  const Surfaces surfaces(c);
  EXPECT_TRUE(surfaces.connected(19, 30, 1, 0));
  EXPECT_FALSE(surfaces.connected(39, 30, 1, 0));
}

// ---- Isolated pixels

TEST(Isolated, CountsWhatIsPlanted) {
  Image image(32, 24, 3, 1.0f);
  image.at(5, 5)[0] = 1.31f;
  image.at(20, 9)[2] = 0.76f;  // 1/1.3 = 0.769
  image.at(11, 17)[0] = 1.5f;
  image.at(11, 17)[1] = 0.5f;
  image.at(15, 5)[1] = 1.29f;  // not enough
  image.at(25, 15)[1] = 0.78f;
  const IsolatedPixels found = findIsolated(image, Surfaces(32, 24), everywhere(image));
  EXPECT_EQ(found.count, 3u);
  EXPECT_EQ(found.marks[5 * 32 + 5], 1);
  EXPECT_EQ(found.marks[9 * 32 + 20], 2);
  EXPECT_EQ(found.marks[17 * 32 + 11], 3);
}

TEST(Isolated, NeighborsOfOtherSurfacesDoNotCount) {
  // A strip of surface one pixel wide has two neighbors, a corner three: not judged. Along an edge there
  // are 5.
  const Capture c = shape(16, 16, [](int x, int) { return x < 8 ? 100 : 150; });
  const Surfaces surfaces(c);
  Image image(16, 16, 3, 1.0f);
  scale(image, 8, 0, 8, 16, 5);
  EXPECT_EQ(findIsolated(image, surfaces, everywhere(image)).count, 0u);
  image.at(7, 6)[0] = 1.4f;  // bright on its own surface, dark beside the other one
  image.at(0, 0)[0] = 3;     // a corner
  EXPECT_EQ(findIsolated(image, surfaces, everywhere(image)).count, 1u);
}

TEST(Isolated, DarkPartsMaskAndNanAreLeftOut) {
  Image image(20, 20, 3, 1.0f);
  scale(image, 0, 10, 20, 10, 0.001f);
  image.at(5, 15)[0] = 0.01f;  // below 2 % of the RMS, 0.7
  EXPECT_EQ(findIsolated(image, Surfaces(20, 20), everywhere(image)).count, 0u);
  image.at(5, 15)[0] = 0.02f;
  EXPECT_EQ(findIsolated(image, Surfaces(20, 20), everywhere(image)).count, 1u);
  Mask mask = everywhere(image);
  mask[15 * 20 + 5] = 0;
  EXPECT_EQ(findIsolated(image, Surfaces(20, 20), mask).count, 0u);
  image.at(3, 4)[1] = kNan;
  EXPECT_EQ(findIsolated(image, Surfaces(20, 20), mask).count, 0u);
  EXPECT_THROW(findIsolated(image, Surfaces(20, 21), mask), InputError);
  EXPECT_THROW(findIsolated(Image(20, 20, 1), Surfaces(20, 20), mask), InputError);
}

// ---- Spots

// Light that falls by 6 % from pixel to pixel, as near a terminator: by a factor of 1.3 within five pixels.
Image slope(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c) image.at(x, y)[c] = static_cast<float>(std::pow(0.94, x));
  return image;
}

SpotImage seen(const Image& image) { return {image, Surfaces(image.width, image.height), everywhere(image)}; }
std::vector<Spot> spotsOf(const Image& image) { return seen(image).find(nullptr); }

TEST(Spots, ARegionOnASlopeCountsOnce) {
  Image image = slope(48, 40);
  EXPECT_EQ(spotsOf(image).size(), 0u) << "slopes and their ends at the image's edge";
  scale(image, 20, 12, 3, 3, 1.6f);
  scale(image, 8, 28, 2, 4, 0.6f);
  image.at(30, 20)[2] *= 1.5f;  // a lone pixel, blue alone
  const std::vector<Spot> spots = spotsOf(image);
  ASSERT_EQ(spots.size(), 3u);
  EXPECT_TRUE(spots[0].isBright);
  EXPECT_EQ(spots[0].low, (std::array<int, 2>{20, 12}));
  EXPECT_EQ(spots[0].high, (std::array<int, 2>{22, 14}));
  EXPECT_EQ(spots[0].pixels.size(), 9u);
  EXPECT_EQ(spots[1].pixels.size(), 1u);
  EXPECT_FALSE(spots[2].isBright);
  EXPECT_EQ(spots[2].pixels.size(), 8u);
}

TEST(Spots, HaveFivePixelsAtMost) {
  for (const auto& [width, height, count] :
       {std::array{5, 5, 1}, {1, 5, 1}, {6, 2, 0}, {7, 7, 0}, {2, 30, 0}}) {
    Image image(48, 48, 3, 1.0f);
    scale(image, 9, 9, width, height, 1.5f);
    EXPECT_EQ(spotsOf(image).size(), static_cast<std::size_t>(count)) << width << " x " << height;
    Image dark(48, 48, 3, 1.0f);
    scale(dark, 9, 9, width, height, 1 / 1.5f);
    EXPECT_EQ(spotsOf(dark).size(), static_cast<std::size_t>(count)) << width << " x " << height;
  }
}

// Sixteen passes of a 3x3 mean: what diffusion over some five pixels makes of an image.
Image softened(Image image) {
  for (int pass = 0; pass < 16; ++pass) {
    const Image before = image;
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x)
        for (int c = 0; c < 3; ++c) {
          float sum = 0;
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              sum += before.at(std::clamp(x + dx, 0, image.width - 1),
                               std::clamp(y + dy, 0, image.height - 1))[c];
          image.at(x, y)[c] = sum / 9;
        }
  }
  return image;
}

TEST(Spots, WhatTheIrradianceHasIsNone) {
  // A lit triangle in half shadow, whose corners are sharp, beside a lit patch of 3x3 pixels.
  Image irradiance(64, 64, 3, 0.3f);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c)
        if ((x > 12 && y < 50 && 2 * (y - 10) > x) || (std::abs(x - 50) < 2 && std::abs(y - 20) < 2))
          irradiance.at(x, y)[c] = 1;
  Image diffused = softened(irradiance);
  for (std::size_t i = 0; i < diffused.data.size(); ++i)  // the first pixel keeps some of its light
    diffused.data[i] = 0.8f * diffused.data[i] + 0.2f * irradiance.data[i];
  const SpotImage input = seen(irradiance);
  EXPECT_EQ(seen(irradiance).find(&input).size(), 0u);
  EXPECT_EQ(seen(diffused).find(&input).size(), 0u);
  EXPECT_GE(spotsOf(diffused).size(), 1u) << "the patch, where nothing explains it";
  scale(diffused, 30, 40, 4, 4, 1.5f);  // in the light
  scale(diffused, 4, 40, 1, 1, 1.5f);   // in the shadow
  const std::vector<Spot> spots = seen(diffused).find(&input);
  EXPECT_EQ(spots.size(), 2u);
}

TEST(Spots, WhatTheTruthHasIsNotLacked) {
  Image image(48, 32, 3, 1.0f);
  scale(image, 6, 6, 3, 3, 1.6f);
  scale(image, 20, 6, 3, 3, 1.6f);
  scale(image, 34, 6, 3, 3, 1 / 1.6f);
  Image truth(48, 32, 3, 1.0f);
  scale(truth, 6, 6, 3, 3, 1.3f);   // less, but the rest is no spot
  scale(truth, 34, 6, 3, 3, 1.6f);  // bright where the other is dark
  std::mt19937 random(7);
  std::normal_distribution<float> noise(1, 0.1f);
  for (float& value : truth.data) value *= noise(random);
  const SpotImage a = seen(image);
  const std::vector<Spot> lacked = a.lackedBy(seen(truth), a.find(nullptr));
  ASSERT_EQ(lacked.size(), 2u);
  EXPECT_EQ(lacked[0].low[0], 20);
  EXPECT_EQ(lacked[1].low[0], 34);
  EXPECT_EQ(a.lackedBy(a, a.find(nullptr)).size(), 0u);
}

TEST(Spots, OtherSurfacesDarkPartsAndNanAreLeftOut) {
  // The stripe of the second surface is five times as bright; each surface has a spot beside the edge.
  const Capture c = shape(32, 32, [](int x, int) { return x < 16 ? 100 : 150; });
  Image image(32, 32, 3, 1.0f);
  scale(image, 16, 0, 16, 32, 5);
  const auto find = [&](const Mask& mask) { return SpotImage(image, Surfaces(c), mask).find(nullptr); };
  EXPECT_EQ(find(everywhere(image)).size(), 0u);
  scale(image, 14, 8, 2, 2, 1.5f);
  scale(image, 16, 20, 2, 2, 1.5f);
  EXPECT_EQ(find(everywhere(image)).size(), 2u);
  Mask mask = everywhere(image);
  for (int x = 14; x < 16; ++x)
    for (int y = 8; y < 10; ++y) mask[static_cast<std::size_t>(32 * y + x)] = 0;
  EXPECT_EQ(find(mask).size(), 1u);
  image.at(16, 20)[0] = kNan;
  EXPECT_EQ(find(mask).size(), 1u) << "three pixels are left";
  EXPECT_THROW(SpotImage(image, Surfaces(32, 31), mask), InputError);

  Image dark(32, 32, 3, 1.0f);
  scale(dark, 0, 0, 32, 16, 0.001f);
  scale(dark, 8, 4, 3, 3, 20);  // .02, 2.8 % of the RMS; the surroundings count as 2 %
  EXPECT_EQ(spotsOf(dark).size(), 1u);
  scale(dark, 8, 4, 3, 3, 0.8f);
  EXPECT_EQ(spotsOf(dark).size(), 0u);
}

// ---- Tint

Image varied(int width, int height) {
  Image image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < 3; ++c)
        image.at(x, y)[c] = 1 + 0.5f * std::sin(0.3f * static_cast<float>(x + (c + 1) * y));
  return image;
}

TEST(Tint, StandardDeviationOfBlocks) {
  // Two blocks, red 1.1 and 0.9 of the truth, green 1.2 and 0.8 of it: red over green 0.9167 and 1.125.
  const Image b(16, 8, 3, 2.0f);
  Image a = b;
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x) {
      a.at(x, y)[0] = x < 8 ? 2.2f : 1.8f;
      a.at(x, y)[1] = x < 8 ? 2.4f : 1.6f;
    }
  const Tint tint = measureTint(a, b, everywhere(b));
  EXPECT_EQ(tint.blocks, 2u);
  EXPECT_NEAR(tint.channel[0], 0.1, 1e-6);
  EXPECT_NEAR(tint.channel[1], 0.2, 1e-6);
  EXPECT_EQ(tint.channel[2], 0);
  EXPECT_NEAR(tint.redOverGreen, (0.9 / 0.8 - 1.1 / 1.2) / 2, 1e-6);
}

// ---- Ratio map

TEST(RatioMap, FullColorAtTenPercent) {
  const Image b(8, 4, 3, 1.0f);
  Image a = b;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      a.at(x, y)[0] = 1.2f;
      a.at(x, y)[1] = x % 2 ? 1.15f : 0.95f;  // 1.05 after averaging
      a.at(x, y)[2] = 0.5f;
    }
  const std::vector<std::uint8_t> picture = ratioMap(a, b, everywhere(b));
  EXPECT_EQ(picture[0], 255);
  EXPECT_EQ(picture[1], 191);  // 127.5 * 1.5
  EXPECT_EQ(picture[2], 0);
  EXPECT_EQ(picture[3 * 4], 128);
}

// ---- Flicker

TEST(Flicker, AnImageThatMovedDoesNot) {
  const Image still = varied(24, 16);
  Image moved(24, 16, 3, kNan);  // what enters is not looked at
  for (int y = 0; y < 15; ++y)
    for (int x = 0; x < 21; ++x) std::copy_n(still.at(x, y), 3, moved.at(x + 3, y + 1));
  const Flicker flicker = compareShifted(still, moved, everywhere(still), 3, 1);
  EXPECT_EQ(flicker.pixels, 21u * 15u);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_EQ(flicker.relativeRmse[c], 0);
    EXPECT_EQ(flicker.p999[c], 0);
    EXPECT_EQ(flicker.worst[c], 0);
  }
  EXPECT_GT(compareShifted(still, moved, everywhere(still), 4, 1).relativeRmse[0], 0.01);
}

TEST(Flicker, OnePixelOfTwoThousand) {
  // 2 on a plane of 2: relative to the 5x5 mean 1; RMS of d is 2 / sqrt(2000).
  const Image still(50, 40, 3, 2.0f);
  Image moved = still;
  moved.at(21, 12)[1] = 4;
  const Flicker flicker = compareShifted(still, moved, everywhere(still), 0, 0);
  EXPECT_NEAR(flicker.relativeRmse[1], 1 / std::sqrt(2000.0), 1e-12);
  EXPECT_EQ(flicker.relativeRmse[0], 0);
  EXPECT_EQ(flicker.worst[1], 1);
  EXPECT_EQ(flicker.p999[1], 0);  // two of 2000 may be above
  EXPECT_EQ(flicker.worstPixel, (std::array<int, 2>{21, 12}));
  EXPECT_EQ(compareShifted(still, moved, everywhere(still), 1, 0).worstPixel, (std::array<int, 2>{20, 12}));
}

// A wall that an orthographic camera sees, moved by 2.5 pixels: a linear picture is the same between pixels,
// and a dot is not.
TEST(Flicker, PathsAreFollowedOnTheSurface) {
  Capture still = plane(32, 32), moved = still;
  moved.viewFromWorld[12] = 2.5;
  const auto picture = [](double shift) {
    Image image(32, 32, 3);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 3; ++c)
          image.at(x, y)[c] = static_cast<float>(5 + 0.1 * (x - shift) + 0.2 * c * y);
    return image;
  };
  const Image before = picture(0);
  Image after = picture(2.5);
  Flicker flicker = Reprojection(still, moved).compare(before, after);
  EXPECT_GT(flicker.pixels, 500u);
  for (const double worst : flicker.worst) EXPECT_LT(worst, 1e-5);
  after.at(20, 11)[1] += 1;
  flicker = Reprojection(still, moved).compare(before, after);
  EXPECT_EQ(flicker.worstPixel, (std::array<int, 2>{20, 11}));
  EXPECT_LT(flicker.worst[0], 1e-5);
  const Image motion = Reprojection(still, moved).motion();
  EXPECT_NEAR(motion.at(9, 4)[0], 2.5 / 32, 1e-6);
  EXPECT_NEAR(motion.at(9, 4)[1], 0, 1e-6);
  // What the camera did not see before is left out.
  still.material.assign(32 * 32, 0);
  still.material[5 * 32 + 5] = 1;
  EXPECT_EQ(Reprojection(still, moved).compare(before, after).pixels, 0u);
}

TEST(Flicker, EvenChangeOfTurnedLightsIsNone) {
  const Image still(32, 32, 3, 1.0f);
  Image turned = still;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) turned.at(x, y)[0] += 0.01f * static_cast<float>(x - 2 * y);
  const Flicker even = compareTurned(still, turned, Surfaces(32, 32), everywhere(still));
  EXPECT_EQ(even.pixels, 28u * 28u);    // without a rim of two pixels
  EXPECT_NEAR(even.worst[0], 0, 1e-6);  // rounding of floats near 1
  turned.at(10, 10)[0] += 1;            // less 1/25, its part of the 5x5 mean
  EXPECT_NEAR(compareTurned(still, turned, Surfaces(32, 32), everywhere(still)).worst[0], 0.96, 1e-5);
}

// ---- Moved captures

// Every image of the view says where its pixels come from.
Capture numbered(int width, int height) {
  Capture c = plane(width, height);
  c.backDepth = {Image(width, height, 1), PELLUCID_DEPTH_DEVICE};
  c.albedo = Image(width, height, 3);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const float number = static_cast<float>(1 + x + width * y);
      *c.frontDepth.image.at(x, y) = number;
      *c.backDepth.image.at(x, y) = 0.001f * number;
      for (Image* image : {&c.irradiance, &c.albedo})
        for (int k = 0; k < 3; ++k) image->at(x, y)[k] = number + 0.25f * static_cast<float>(k);
      c.material[pixelIndex(c.irradiance, x, y)] = static_cast<std::uint8_t>(number);
    }
  return c;
}

TEST(MovedCapture, ImagesMoveAndTheRimIsEmpty) {
  const Capture c = numbered(9, 7);
  const Capture moved = movedCapture(c, 2, -1, 2);
  for (int y = 0; y < 7; ++y)
    for (int x = 0; x < 9; ++x) {
      const int fromX = x - 2, fromY = y + 1;
      const bool inside = fromX >= 2 && fromX < 7 && fromY >= 2 && fromY < 5;
      const std::size_t i = pixelIndex(c.irradiance, x, y);
      EXPECT_EQ(*moved.frontDepth.image.at(x, y), inside ? *c.frontDepth.image.at(fromX, fromY) : kNoDepth);
      // The orthographic matrix has device depth 1 far away.
      EXPECT_EQ(*moved.backDepth.image.at(x, y), inside ? *c.backDepth.image.at(fromX, fromY) : 1);
      EXPECT_EQ(moved.material[i], inside ? c.material[pixelIndex(c.irradiance, fromX, fromY)] : 0);
      for (const auto image : {&Capture::irradiance, &Capture::albedo})
        EXPECT_EQ((moved.*image).at(x, y)[2], inside ? (c.*image).at(fromX, fromY)[2] : 0);
    }
  EXPECT_THROW(movedCapture(c, 3, 0, 2), InputError);
  EXPECT_THROW(movedCapture(c, 0, -3, 2), InputError);
  EXPECT_THROW(movedCapture(c, 0, 0, 4), InputError);
}

// ---- All of them

TEST(Eye, ATruthIsRight) {
  const Capture c = plane(24, 24);
  const Image truth = varied(24, 24);
  Image result = truth;
  const EyeMetrics right = measureEye(result, truth, everywhere(truth), &c);
  EXPECT_EQ(right.isolated, 0u);
  EXPECT_EQ(right.flip.mean, 0);
  EXPECT_EQ(right.flip.p99, 0);
  EXPECT_EQ(right.tint.blocks, 9u);
  std::fill_n(result.at(5, 5), 3, 9.0f);
  for (const Capture* capture : {&c, static_cast<const Capture*>(nullptr)}) {
    const EyeMetrics wrong = measureEye(result, truth, everywhere(truth), capture);
    EXPECT_EQ(wrong.isolated, 1u);
    EXPECT_EQ(wrong.isolatedInTruth, 0u);
    EXPECT_EQ(wrong.spots, 1u);
    EXPECT_GT(wrong.tint.channel[0], 0.01);
    EXPECT_GT(wrong.flip.mean, 0);
  }
}

// ---- FLIP, against what its definition says of simple pairs, and against its authors' implementation

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
