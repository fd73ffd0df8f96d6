// Where the diffusion pyramid's levels lie: apart, and inside the images that the plan asks for.
#include "pyramid.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace pellucid {
namespace {

struct Box {
  int32_t x, y, width, height;
};

bool apart(const Box& a, const Box& b) {
  return a.x + a.width <= b.x || b.x + b.width <= a.x || a.y + a.height <= b.y || b.y + b.height <= a.y;
}

void expectApart(uint32_t width, uint32_t height, Rect rect) {
  SCOPED_TRACE(std::to_string(width) + " x " + std::to_string(height));
  if (rect.width == 0) rect = {0, 0, width, height};
  const Pyramid pyramid({width, height}, rect);
  const auto box = [&](uint32_t level) {
    const PyramidPlace& p = pyramid.levels[level];
    return Box{p.x, p.y, p.rect.width, p.rect.height};
  };
  const auto inside = [&](const Box& b, uint32_t image) {
    const Pyramid::Extent& size = pyramid.images[image];
    return b.x >= 0 && b.y >= 0 && b.x + b.width <= static_cast<int32_t>(size.width) &&
           b.y + b.height <= static_cast<int32_t>(size.height);
  };
  // Texels of level 2 after upsampling and their shares are in the image of level 1.
  const Box second = box(2), upsampled{0, 0, second.width, second.height},
            shares{pyramid.sharesColumn, 0, second.width, second.height};
  EXPECT_TRUE(apart(upsampled, shares));
  EXPECT_TRUE(inside(upsampled, 0) && inside(shares, 0) && inside(box(1), 0));
  for (uint32_t level = 2; level <= 5; ++level) EXPECT_TRUE(inside(box(level), level / 2)) << level;
  EXPECT_TRUE(apart(box(2), box(3)));
  EXPECT_TRUE(apart(box(4), box(5)));
}

TEST(Pyramid, LevelsLieApart) {
  for (uint32_t width = 1; width <= 140; ++width)
    for (const uint32_t height : {1u, 2u, 47u, 64u, 139u}) expectApart(width, height, {});
  expectApart(1920, 1080, {});
  expectApart(1921, 1081, {});
  expectApart(3840, 2160, {});
}

TEST(Pyramid, LevelsOfPartsLieApart) {
  for (uint32_t x = 0; x < 9; ++x)
    for (uint32_t width = 1; width <= 61 - x; width += 3) expectApart(61, 47, {x, x / 2, width, 41});
}

}  // namespace
}  // namespace pellucid
