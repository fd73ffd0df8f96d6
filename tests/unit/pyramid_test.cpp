// The diffusion pyramid: its levels lie apart, and how much of a profile lies at its elements.
#include "pyramid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

#include "material/pyramid_energy.h"
#include "material/tables.h"

namespace pellucid {
namespace {

struct Box {
  int32_t x, y, width, height;
};

bool apart(const Box& a, const Box& b) {
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
}

void expectApart(uint32_t width, uint32_t height, Rect rect) {
  SCOPED_TRACE(testing::Message() << width << " x " << height);
  const Pyramid pyramid({width, height}, rect);
  const auto box = [&](uint32_t level) {
    const PyramidPlace& p = pyramid.levels[level];
    return Box{p.column, 0, p.rect.width, p.rect.height};
  };
  const auto inside = [&](const Box& b, uint32_t image) {
    const Extent& size = pyramid.images[image];
    return b.x >= 0 && b.y >= 0 && b.x + b.width <= static_cast<int32_t>(size.width) &&
           b.y + b.height <= static_cast<int32_t>(size.height);
  };
  // Texels of level 2 after upsampling and their shares are in the image of level 1.
  const Box second = box(2), upsampled{0, 0, second.width, second.height},
            shares{pyramid.sharesColumn, 0, second.width, second.height};
  EXPECT_TRUE(apart(upsampled, shares));
  EXPECT_TRUE(inside(upsampled, 0) && inside(shares, 0) && inside(box(1), 0));
  for (uint32_t level = 2; level <= PELLUCID_LAST_LEVEL; ++level) {
    EXPECT_TRUE(inside(box(level), imageOfLevel(level))) << level;
    for (uint32_t finer = 2; finer < level; ++finer)
      EXPECT_TRUE(imageOfLevel(finer) != imageOfLevel(level) || apart(box(finer), box(level)))
          << finer << ", " << level;
  }
}

TEST(Pyramid, LevelsLieApart) {
  for (uint32_t width = 1; width <= 140; ++width)
    for (const uint32_t height : {1u, 2u, 47u, 64u, 139u}) expectApart(width, height, {0, 0, width, height});
  for (const auto& [width, height] : {std::pair(1920u, 1080u), {1921u, 1081u}, {3840u, 2160u}})
    expectApart(width, height, {0, 0, width, height});
  for (uint32_t x = 0; x < 9; ++x)
    for (uint32_t width = 1; width <= 61 - x; width += 3) expectApart(61, 47, {x, x / 2, width, 41});
}

double at(const EnergyFrom& from, double x) {
  const double i = (x - from.first) / EnergyFrom::kStep;
  const auto last = static_cast<double>(from.samples.size() - 1);
  if (i <= 0) return 0;
  if (i >= last) return 1;
  const auto low = static_cast<size_t>(i);
  return std::lerp(from.samples[low], from.samples[low + 1], i - std::floor(i));
}

// Burley's profile with d = 1 is a mixture of Gaussians, over all deviations s; see pyramid_energy.cpp.
TEST(PyramidEnergy, OfBurleyIsThatOfItsGaussians) {
  constexpr double kStep = 0.01;
  for (int i = kFine; i < kElements; ++i) {
    const auto element = static_cast<Element>(i);
    const EnergyFrom gaussian = gaussianEnergy(element), burley = burleyEnergy(element);
    for (double x = -9; x < 10; x += 0.3) {  // between samples, too
      double mixed = 0;
      for (double octave = -20; octave < 5; octave += kStep) {
        const double s = std::exp2(octave);
        const double density =
            std::sqrt(2 / std::numbers::pi) / 4 * (std::exp(-s * s / 2) + std::exp(-s * s / 18));
        mixed += at(gaussian, octave + x) * density * s * std::numbers::ln2 * kStep;
      }
      EXPECT_NEAR(at(burley, x), mixed, 2e-3) << i << " at " << x;
    }
  }
}

// Plans leave out levels by it.
TEST(PyramidEnergy, CoarserLevelsBeginWhereStated) {
  const EnergyFrom coarser = gaussianEnergy(kCoarser);
  for (double x = coarser.first; x <= kCoarserBegins; x += EnergyFrom::kStep)
    EXPECT_LE(at(coarser, x), 1e-3) << x;
  EXPECT_GT(at(coarser, kCoarserBegins + 2 * EnergyFrom::kStep), 1e-3);
}

// T(d) is a sum: the order of its exponentials changes nothing, and one of amplitude 0 is none.
TEST(MaterialTables, AreThoseOfTheTermsThatThereAre) {
  PellucidMaterial first{}, second{};
  for (PellucidMaterial* m : {&first, &second}) m->transmittanceModel = PELLUCID_TRANSMITTANCE_EXP2;
  for (int c = 0; c < 3; ++c) {
    const float one[5] = {0.5f, 1, 0, 0, 0}, other[5] = {0, 0, 0.5f, 1, 0};
    std::copy_n(one, 5, first.transmittance[c]);
    std::copy_n(other, 5, second.transmittance[c]);
    first.reflectance[c] = second.reflectance[c] = 0.4f;
  }
  const shared::GatherConstants a = gatherConstants(first), b = gatherConstants(second);
  EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0);
  EXPECT_EQ(a.lengths.z, 2.0f) << "two diffusion lengths, mm";
}

}  // namespace
}  // namespace pellucid
