// The other GPU tests trust the validation layers; this one makes sure they speak.
#include <gtest/gtest.h>

#include "common/device.h"

namespace {

using namespace pellucid::harness;

TEST(Validation, ReportsAMissingBarrier) {
  Device device({"", true});
  HostBuffer buffer(device, 256, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  device.run([&](VkCommandBuffer commandBuffer) {
    vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 1);
    vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 2);
  });
  ASSERT_FALSE(device.validationMessages().empty());
  EXPECT_NE(device.validationMessages()[0].find("WRITE_AFTER_WRITE"), std::string::npos);
}

TEST(Validation, ReportsWrongUsage) {
  Device device({"", true});
  HostBuffer buffer(device, 256, VK_BUFFER_USAGE_TRANSFER_SRC_BIT);  // not a destination
  device.run(
      [&](VkCommandBuffer commandBuffer) { vkCmdFillBuffer(commandBuffer, buffer.handle(), 0, 256, 1); });
  EXPECT_FALSE(device.validationMessages().empty());
}

}  // namespace
