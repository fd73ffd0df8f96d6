#include "floor.h"

#include <algorithm>
#include <cmath>

#include "common/error.h"
#include "compute_pass.h"
#include "kFloor.h"

namespace pellucid::bench {

using harness::GpuImage;
using harness::Image;

namespace {

struct Shape {
  uint32_t width, height, pixels;  // of a group in threads; pixels of each thread
};
constexpr Shape kShapes[] = {{8, 8, 1}, {16, 16, 1}, {32, 8, 1}, {8, 8, 2}, {16, 16, 2}, {32, 8, 2}};

// Of halves up to 4, twice: of the irradiance and of the sum.
constexpr float kRounding = 4e-3f;

// What the pass writes.
Image expected(const harness::Capture& c) {
  Image sum = c.irradiance;
  for (size_t i = 0; i < sum.data.size(); ++i)
    sum.data[i] += c.backDepth.image.data[i / 3] - c.frontDepth.image.data[i / 3];
  return sum;
}

}  // namespace

std::vector<Floor> measureFloors(harness::Device& device, const harness::Capture& capture, int repeat) {
  const int width = capture.width, height = capture.height;
  GpuImage front(device, width, height, VK_FORMAT_R32_SFLOAT);
  GpuImage back(device, width, height, VK_FORMAT_R32_SFLOAT);
  GpuImage irradiance(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT);
  GpuImage result(device, width, height, VK_FORMAT_R16G16B16A16_SFLOAT);
  front.upload(capture.frontDepth.image);
  back.upload(capture.backDepth.image);
  irradiance.upload(capture.irradiance);
  constexpr VkDescriptorType kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  const Image right = expected(capture);
  std::vector<Floor> floors;
  for (const Shape& s : kShapes) {
    const ComputePass pass(
        device, kFloor, {kRead, kRead, kRead, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
        {s.width * s.pixels, s.height, std::vector<uint32_t>{s.width, s.height, s.pixels}});
    result.clear();
    const Time time = measure(device, repeat, [&](VkCommandBuffer commandBuffer) {
      pass.record(commandBuffer, width, height, {front.use(), back.use(), irradiance.use(), result.use()});
    });
    const std::string shape = std::to_string(s.width) + "x" + std::to_string(s.height) + ", " +
                              std::to_string(s.pixels) + (s.pixels == 1 ? " pixel" : " pixels") + " a thread";
    const Image written = rgb(result.download());
    if (!std::equal(written.data.begin(), written.data.end(), right.data.begin(), right.data.end(),
                    [](float a, float b) { return std::abs(a - b) < kRounding; }))
      throw harness::DeviceError("the floor pass (" + shape + ") wrote something else than its inputs say");
    floors.push_back({time, shape});
  }
  std::stable_sort(floors.begin(), floors.end(),
                   [](const Floor& a, const Floor& b) { return a.time.median < b.time.median; });
  return floors;
}

}  // namespace pellucid::bench
