#include "common/gpu_image.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/error.h"
#include "gpu_fixture.h"

namespace {

using namespace pellucid::harness;

class GpuImageTest : public pellucid::test::GpuTest {};

TEST_F(GpuImageTest, SignedBytesComeBackToTheNearestStep) {
  Image source(5, 1, 3);
  source.data = {-1, -0.7f, -0.003f, 0, 0.003f, 0.25f, 0.5f, 0.7071f, 0.999f, 1, 0.1f, -0.1f, 2, -2, 0.3f};
  GpuImage image(device(), 5, 1, VK_FORMAT_R8G8B8A8_SNORM);
  image.upload(source);
  const Image back = image.download();
  ASSERT_EQ(back.channels, 4);
  for (int x = 0; x < 5; ++x)
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(back.at(x, 0)[c], std::clamp(source.at(x, 0)[c], -1.0f, 1.0f), 0.5f / 127 + 1e-6f)
          << x << c;
  EXPECT_EQ(back.at(0, 0)[0], -1);
  EXPECT_EQ(back.at(1, 0)[0], 0);
  EXPECT_EQ(back.at(3, 0)[0], 1);
  EXPECT_EQ(back.at(0, 0)[3], 1);
}

TEST_F(GpuImageTest, MemoryThatIsOnlyPreferredMayBeMissing) {
  constexpr VkMemoryPropertyFlags kVisible = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT, kNone = 0x40000000;
  EXPECT_EQ(device().memoryType(~0u, kVisible, kNone), device().memoryType(~0u, kVisible));
  EXPECT_THROW(device().memoryType(~0u, kNone), DeviceError);
}

}  // namespace
