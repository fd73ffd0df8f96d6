// Where the diffusion pyramid's levels lie: apart, and inside the image that the plan asks for.
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
  const uint32_t extent[2] = {width, height};
  const Pyramid pyramid(extent, rect);
  const auto box = [&](uint32_t level) {
    const PyramidPlace& p = pyramid.levels[level];
    return Box{p.x, p.y, p.rect.width, p.rect.height};
  };
  // Texels of level 2 after upsampling and their shares are written while the levels from 2 on are read.
  const Box second = box(2);
  std::vector<Box> boxes = {{0, 0, second.width, second.height},
                            {pyramid.sharesColumn, 0, second.width, second.height}};
  const size_t upsampled = boxes.size();
  for (uint32_t level = 2; level <= pyramid.coarsest; ++level) boxes.push_back(box(level));
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_TRUE(apart(boxes[i], boxes[j])) << i << " and " << j;
    EXPECT_LE(boxes[i].x + boxes[i].width, static_cast<int32_t>(pyramid.width)) << i;
    EXPECT_LE(boxes[i].y + boxes[i].height, static_cast<int32_t>(pyramid.height)) << i;
    // Level 1 is read while the next two are written.
    if (i >= upsampled) {
      EXPECT_TRUE(apart(box(kFirstLevel), boxes[i])) << i;
    }
  }
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
