#include "baselines/baselines.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/vec4.hpp>
#include <numbers>

#include "baselines/kernels.h"
#include "kBurleyDisk.h"
#include "kGaussianSum.h"
#include "kSeparable.h"
#include "shared/pellucid_shared.h"

namespace pellucid::bench {

using harness::GpuImage;

namespace {

constexpr VkFormat kFormat = VK_FORMAT_R16G16B16A16_SFLOAT;

// Reads of a pass over the frame, bytes a pixel: color, depth, material; and its write.
constexpr double kReads = 8 + 4 + 1, kWrite = 8;

// A pass over the frame with its kernel; the bindings of frame.glsl.
class Baseline {
public:
  Baseline(const std::shared_ptr<const BenchFrame>& frame, std::span<const uint32_t> spirv,
           const std::vector<glm::vec4>& kernel, const std::vector<VkDescriptorType>& more = {})
      : frame_(frame),
        kernel_(frame->device(), kernel.size() * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
        pass_(frame->device(), spirv, types(more)) {
    std::memcpy(kernel_.mapped(), kernel.data(), kernel.size() * sizeof(glm::vec4));
  }

  void record(VkCommandBuffer commandBuffer, const PellucidImage& source, const GpuImage& destination,
              const std::array<uint32_t, 4>& push, const std::vector<Resource>& more = {}) const {
    std::vector<Resource> resources = {frame_->planned(PELLUCID_BINDING_FRAME),
                                       frame_->images().frontDepth,
                                       frame_->images().material,
                                       source,
                                       destination.use(),
                                       VkDescriptorBufferInfo{kernel_.handle(), 0, kernel_.size()}};
    resources.insert(resources.end(), more.begin(), more.end());
    pass_.record(commandBuffer, frame_->width(), frame_->height(), resources, push);
  }

private:
  static std::vector<VkDescriptorType> types(const std::vector<VkDescriptorType>& more) {
    std::vector<VkDescriptorType> all = {
        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,  VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,  VK_DESCRIPTOR_TYPE_STORAGE_BUFFER};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::shared_ptr<const BenchFrame> frame_;
  harness::HostBuffer kernel_;
  ComputePass pass_;
};

PellucidImage imageOfSource(const BenchFrame& frame, const Source& source) {
  return source ? source->use() : frame.images().irradiance;
}

std::uint64_t bytesOf(const BenchFrame& frame, std::uint64_t images) {
  return images * 8 * static_cast<std::uint64_t>(frame.width()) * static_cast<std::uint64_t>(frame.height());
}

}  // namespace

Variant gaussianSum(const std::shared_ptr<const BenchFrame>& frame, const Source& source) {
  const std::vector<glm::vec4> kernel = sharedGaussians(frame->material());
  const auto count = static_cast<uint32_t>(kernel.size());
  const auto pass =
      std::make_shared<Baseline>(frame, kGaussianSum, kernel, std::vector{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  const auto across = frame->image(kFormat), blurred = frame->image(kFormat), sum = frame->image(kFormat);
  const auto record = [=](VkCommandBuffer commandBuffer) {
    for (uint32_t i = 0; i < count; ++i) {
      if (i > 0) computeBarrier(commandBuffer);
      const PellucidImage from = i == 0 ? imageOfSource(*frame, source) : blurred->use();
      pass->record(commandBuffer, from, *across, {1, 0, i}, {sum->use()});
      computeBarrier(commandBuffer);
      pass->record(commandBuffer, across->use(), *blurred, {0, 1, i}, {sum->use()});
    }
  };
  // The vertical passes also write the sum and, but for the first, read it.
  const double bytes = 2 * count * (kReads + kWrite) + count * 8 + (count - 1) * 8;
  return {"Gaussian sum 2009, " + std::to_string(count) + " x 7",
          2 * count,
          2 * count - 1,
          bytes,
          record,
          [sum] { return rgb(sum->download()); },
          bytesOf(*frame, 2)};
}

Variant separable(const std::shared_ptr<const BenchFrame>& frame, int taps, const Source& source) {
  const auto pass = std::make_shared<Baseline>(frame, kSeparable, separableKernel(frame->material(), taps));
  const auto across = frame->image(kFormat), result = frame->image(kFormat);
  const auto record = [=, n = static_cast<uint32_t>(taps)](VkCommandBuffer commandBuffer) {
    pass->record(commandBuffer, imageOfSource(*frame, source), *across, {1, 0, n});
    computeBarrier(commandBuffer);
    pass->record(commandBuffer, across->use(), *result, {0, 1, n});
  };
  return {"Separable 2015, " + std::to_string(taps) + " taps",
          2,
          1,
          2 * (kReads + kWrite),
          record,
          [result] { return rgb(result->download()); },
          bytesOf(*frame, 1)};
}

Variant burleyDisk(const std::shared_ptr<const BenchFrame>& frame, int samples, const Source& source) {
  const auto pass =
      std::make_shared<Baseline>(frame, kBurleyDisk, burleyDiskKernel(frame->material(), samples));
  const auto result = frame->image(kFormat);
  const auto record = [=, n = static_cast<uint32_t>(samples)](VkCommandBuffer commandBuffer) {
    pass->record(commandBuffer, imageOfSource(*frame, source), *result, {n});
  };
  return {
      "Burley disk 2018, " + std::to_string(samples) + " samples", 1, 0, kReads + kWrite, record, [result] {
        return rgb(result->download());
      }};
}

std::vector<Variant> baselines(const std::shared_ptr<const BenchFrame>& frame) {
  std::vector<Variant> all = {gaussianSum(frame)};
  for (const int taps : kSeparableTaps) all.push_back(separable(frame, taps));
  for (const int samples : kBurleySamples) all.push_back(burleyDisk(frame, samples));
  return all;
}

}  // namespace pellucid::bench
