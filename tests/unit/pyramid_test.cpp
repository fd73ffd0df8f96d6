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

PellucidFrame frameOf(uint32_t width, uint32_t height, const Rect& rect) {
  PellucidFrame f;
  pellucidInitFrame(&f);
  f.imageExtent[0] = width;
  f.imageExtent[1] = height;
  f.renderRect[0] = rect.x;
  f.renderRect[1] = rect.y;
  f.renderRect[2] = rect.width;
  f.renderRect[3] = rect.height;
  return f;
}

void expectApart(PellucidFrame f, bool keepsFirst = false) {
  if (keepsFirst) {
    f.quality = 3;
    f.normal.view = reinterpret_cast<VkImageView>(uintptr_t{1});
  }
  ASSERT_EQ(keepsFirstLevel(f), keepsFirst);
  SCOPED_TRACE(std::to_string(f.imageExtent[0]) + " x " + std::to_string(f.imageExtent[1]));
  const auto box = [&](uint32_t level) {
    const PyramidPlace p = placeOf(f, level);
    return Box{p.x, p.y, p.rect.width, p.rect.height};
  };
  // Resolved texels of level 2 and their shares are written while the levels from 2 on are read.
  const Box second = box(2);
  const ResolvedPlace place = resolvedPlaceOf(f);
  std::vector<Box> boxes = {{place.x, place.y, second.width, second.height},
                            {place.sharesX, place.sharesY, second.width, second.height}};
  const size_t resolved = boxes.size();
  for (uint32_t level = 2; level <= coarsestLevel(f); ++level) {
    const Box b = box(level);
    boxes.push_back(b);
    // Clusters read slopes of the levels beside them.
    if (keepsFirstLevel(f) && level >= PELLUCID_FIRST_BESIDE)
      boxes.push_back({clusterColumn(f, level), b.y, b.width, b.height});
    // The coarsest level has no clusters.
    if (keepsFirstLevel(f) && level >= PELLUCID_FIRST_BESIDE && level < coarsestLevel(f)) {
      const PyramidTexel seconds = secondPlace(f, level);
      boxes.push_back({seconds.x, seconds.y, b.width, b.height});
    }
  }
  if (keepsFirst) {
    const PyramidTexel summed = summedPlace(f);
    boxes.push_back({summed.x, summed.y, 1, 1});
  }
  const PyramidExtent extent = pyramidExtent(f);
  for (size_t i = 0; i < boxes.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_TRUE(apart(boxes[i], boxes[j])) << i << " and " << j;
    EXPECT_LE(boxes[i].x + boxes[i].width, static_cast<int32_t>(extent.width)) << i;
    EXPECT_LE(boxes[i].y + boxes[i].height, static_cast<int32_t>(extent.height)) << i;
    // Level 1 is read while the next two are written and, where it is kept, with all others.
    if (i >= resolved || keepsFirstLevel(f)) {
      EXPECT_TRUE(apart(box(kFirstLevel), boxes[i])) << i;
    }
  }
}

TEST(Pyramid, LevelsLieApart) {
  for (uint32_t width = 1; width <= 140; ++width)
    for (const uint32_t height : {1u, 2u, 47u, 64u, 139u})
      for (const bool keepsFirst : {false, true}) expectApart(frameOf(width, height, {}), keepsFirst);
  for (const bool keepsFirst : {false, true}) {
    expectApart(frameOf(1920, 1080, {}), keepsFirst);
    expectApart(frameOf(1921, 1081, {}), keepsFirst);
    expectApart(frameOf(3840, 2160, {}), keepsFirst);
  }
}

TEST(Pyramid, LevelsOfPartsLieApart) {
  for (uint32_t x = 0; x < 9; ++x)
    for (uint32_t width = 1; width <= 61 - x; width += 3)
      for (const bool keepsFirst : {false, true})
        expectApart(frameOf(61, 47, {x, x / 2, width, 41}), keepsFirst);
}

}  // namespace
}  // namespace pellucid
