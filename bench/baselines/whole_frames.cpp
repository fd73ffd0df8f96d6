#include "baselines/whole_frames.h"

#include <algorithm>
#include <cstring>
#include <glm/vec4.hpp>

#include "baselines/kernels.h"
#include "kBurleyDisk.h"
#include "kBurleyTransmittance.h"
#include "kGaussianSum.h"
#include "kGaussianTransmittance.h"
#include "kSeparable.h"
#include "shared/pellucid_shared.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr int kSeparableTaps[] = {11, 17, 25}, kBurleySamples[] = {20, 40, 80};
constexpr uint32_t kMaps = 4;  // of transmitted.glsl

// A pass over the frame with its kernel; the bindings of frame.glsl, and then `more`.
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
                                       VkDescriptorBufferInfo{kernel_.handle(), 0, kernel_.size()},
                                       frame_->images().frontDepth,
                                       frame_->images().material,
                                       source,
                                       destination.use()};
    resources.insert(resources.end(), more.begin(), more.end());
    pass_.record(commandBuffer, frame_->width(), frame_->height(), resources, push);
  }

private:
  static std::vector<VkDescriptorType> types(const std::vector<VkDescriptorType>& more) {
    std::vector<VkDescriptorType> all = {
        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,         VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
        VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,          VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
        VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }

  std::shared_ptr<const BenchFrame> frame_;
  HostBuffer kernel_;
  ComputePass pass_;
};

PellucidImage imageOfSource(const BenchFrame& frame, const Source& source) {
  return source ? source->use() : frame.images().irradiance;
}

std::function<Image()> download(const std::shared_ptr<GpuImage>& image) {
  return [image] { return rgb(image->download()); };
}

// Jimenez et al. 2015, pre-integrated kernel: `taps` an axis, odd.
Variant separable(const std::shared_ptr<const BenchFrame>& frame, int taps, const Source& source = nullptr) {
  const auto pass = std::make_shared<Baseline>(frame, kSeparable, separableKernel(frame->material(), taps));
  const auto across = frame->image(), result = frame->image();
  const auto record = [=, n = static_cast<uint32_t>(taps)](VkCommandBuffer commandBuffer) {
    pass->record(commandBuffer, imageOfSource(*frame, source), *across, {1, 0, n});
    computeBarrier(commandBuffer);
    pass->record(commandBuffer, across->use(), *result, {0, 1, n});
  };
  return {
      "Separable 2015, " + std::to_string(taps) + " taps", 2, 1, frame->bytesOf(1), record, download(result)};
}

// Golubev 2018: one pass of `samples` texels.
Variant burleyDisk(const std::shared_ptr<const BenchFrame>& frame, int samples,
                   const Source& source = nullptr) {
  const auto pass =
      std::make_shared<Baseline>(frame, kBurleyDisk, burleyDiskKernel(frame->material(), samples));
  const auto result = frame->image();
  const auto record = [=, n = static_cast<uint32_t>(samples)](VkCommandBuffer commandBuffer) {
    pass->record(commandBuffer, imageOfSource(*frame, source), *result, {n});
  };
  return {"Burley disk 2018, " + std::to_string(samples) + " samples", 1, 0, 0, record, download(result)};
}

// A pass over the frame's lights.
TransmittancePass transmittance(const std::shared_ptr<const BenchFrame>& frame, const std::string& name,
                                std::span<const uint32_t> spirv, const std::vector<glm::vec4>& kernel) {
  constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                             kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  const auto pass = std::make_shared<Baseline>(
      frame, spirv, kernel, std::vector{kBuffer, kBuffer, kRead, kRead, kRead, kRead, kRead});
  const auto result = frame->image();
  const auto record = [=](VkCommandBuffer commandBuffer) {
    const PellucidFrame& f = frame->images();
    std::vector<Resource> more = {frame->planned(PELLUCID_BINDING_LIGHTS),
                                  frame->planned(PELLUCID_BINDING_SHADOWS), frame->normals().use()};
    // Bindings that no light names hold any image.
    for (uint32_t i = PELLUCID_BINDING_SHADOW_IMAGES; i < PELLUCID_BINDING_SHADOW_IMAGES + kMaps; ++i)
      more.push_back(frame->isPlanned(i) ? frame->planned(i) : Resource(f.frontDepth));
    pass->record(commandBuffer, f.irradiance, *result, {frame->run().plan().activeLights}, more);
  };
  return {{name, 1, 0, frame->bytesOf(1), record, download(result)}, result};
}

WholeFrame inTurn(const std::string& name, const Variant& first, const Variant& second) {
  return {{name, first.dispatches + second.dispatches, first.barriers + second.barriers + 1,
           first.transientBytes + second.transientBytes,
           [a = first.record, b = second.record](VkCommandBuffer commandBuffer) {
             a(commandBuffer);
             computeBarrier(commandBuffer);
             b(commandBuffer);
           },
           second.output},
          second.name};
}

}  // namespace

Variant gaussianSum(const std::shared_ptr<const BenchFrame>& frame, const Source& source) {
  const std::vector<glm::vec4> kernel = sharedGaussians(frame->material());
  const auto count = static_cast<uint32_t>(kernel.size());
  const auto pass =
      std::make_shared<Baseline>(frame, kGaussianSum, kernel, std::vector{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
  const auto across = frame->image(), blurred = frame->image(), sum = frame->image();
  const auto record = [=](VkCommandBuffer commandBuffer) {
    for (uint32_t i = 0; i < count; ++i) {
      if (i > 0) computeBarrier(commandBuffer);
      const PellucidImage from = i == 0 ? imageOfSource(*frame, source) : blurred->use();
      pass->record(commandBuffer, from, *across, {1, 0, i}, {sum->use()});
      computeBarrier(commandBuffer);
      pass->record(commandBuffer, across->use(), *blurred, {0, 1, i}, {sum->use()});
    }
  };
  return {"Gaussian sum 2009, " + std::to_string(count) + " x 7",
          2 * count,
          2 * count - 1,
          frame->bytesOf(2),
          record,
          download(sum)};
}

std::vector<Variant> baselines(const std::shared_ptr<const BenchFrame>& frame) {
  std::vector<Variant> all = {gaussianSum(frame)};
  for (const int taps : kSeparableTaps) all.push_back(separable(frame, taps));
  for (const int samples : kBurleySamples) all.push_back(burleyDisk(frame, samples));
  return all;
}

ReplaySettings transmittanceSettings() {
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  // With camera thickness the plan keeps lights and maps apart, whatever kinds they are.
  settings.translucency.cameraThickness = 1;
  return settings;
}

std::string whyNotRendered(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  size_t maps = 0, images = 0, last = 0;
  for (const Light& light : capture.lights)
    for (const ShadowMap& map : light.shadowMaps) {
      ++maps;
      last = images;
      images += map.casterMaterial.empty() ? 1 : 2;
    }
  if (materials.size() != 1) return "they have one material, and it has " + std::to_string(materials.size());
  const float* d = materials[0].burleyDistance;
  if (materials[0].gaussianCount == 0 || !(std::min({d[0], d[1], d[2]}) > 0))
    return "they need a material with Burley distances";
  if (maps == 0 || maps > kMaps)
    return "they read one to four shadow maps, and it has " + std::to_string(maps);
  if (last >= kMaps)
    return "they read the first four shadow images, and its last map is the " + std::to_string(last + 1) +
           "th: leave the caster materials out";
  return "";
}

TransmittancePass gaussianTransmittance(const std::shared_ptr<const BenchFrame>& frame) {
  std::vector<glm::vec4> kernel = sharedGaussians(frame->material());
  float variance = 0;
  for (glm::vec4& gaussian : kernel) gaussian.w = variance += gaussian.w * gaussian.w;
  return transmittance(frame, "Jimenez 2010, six Gaussians", kGaussianTransmittance, kernel);
}

TransmittancePass burleyTransmittance(const std::shared_ptr<const BenchFrame>& frame) {
  const float* d = frame->material().burleyDistance;
  return transmittance(frame, "HDRP, Burley's slab", kBurleyTransmittance, {{d[0], d[1], d[2], 0}});
}

namespace {

WholeFrame separableFrame(const std::shared_ptr<const BenchFrame>& frame, int taps, const TransmittancePass& light) {
  return inTurn("Jimenez 2010 + 2015, " + std::to_string(taps) + " taps", light.variant,
                separable(frame, taps, light.image));
}

WholeFrame diskFrame(const std::shared_ptr<const BenchFrame>& frame, int samples, const TransmittancePass& light) {
  return inTurn("HDRP, " + std::to_string(samples) + " samples", light.variant, burleyDisk(frame, samples, light.image));
}

}  // namespace

std::vector<WholeFrame> fastestWholeFrames(const std::shared_ptr<const BenchFrame>& frame) {
  return {separableFrame(frame, kSeparableTaps[0], gaussianTransmittance(frame)),
          diskFrame(frame, kBurleySamples[0], burleyTransmittance(frame))};
}

std::vector<WholeFrame> wholeFrames(const std::shared_ptr<const BenchFrame>& frame) {
  const TransmittancePass gaussians = gaussianTransmittance(frame), slab = burleyTransmittance(frame);
  std::vector<WholeFrame> all;
  for (const int taps : kSeparableTaps) all.push_back(separableFrame(frame, taps, gaussians));
  for (const int samples : kBurleySamples) all.push_back(diskFrame(frame, samples, slab));
  all.push_back(
      inTurn("Jimenez 2009, six Gaussians", gaussians.variant, gaussianSum(frame, gaussians.image)));
  return all;
}

}  // namespace pellucid::bench
