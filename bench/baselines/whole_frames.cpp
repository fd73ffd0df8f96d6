#include "baselines/whole_frames.h"

#include <algorithm>
#include <cstring>
#include <glm/vec4.hpp>

#include "baselines/kernels.h"
#include "kBurleyTransmittance.h"
#include "kGaussianTransmittance.h"
#include "shared/pellucid_shared.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr uint32_t kMaps = 4;  // of transmitted.glsl

// A pass over the frame's lights; the bindings of transmitted.glsl.
class Transmittance {
public:
  Transmittance(const std::shared_ptr<const BenchFrame>& frame, std::span<const uint32_t> spirv,
                const std::vector<glm::vec4>& kernel)
      : frame_(frame),
        kernel_(frame->device(), kernel.size() * sizeof(glm::vec4), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
        pass_(frame->device(), spirv, types()),
        result_(frame->image(VK_FORMAT_R16G16B16A16_SFLOAT)) {
    std::memcpy(kernel_.mapped(), kernel.data(), kernel.size() * sizeof(glm::vec4));
  }

  void record(VkCommandBuffer commandBuffer) const {
    const PellucidFrame& f = frame_->images();
    std::vector<Resource> resources = {frame_->planned(PELLUCID_BINDING_FRAME),
                                       frame_->planned(PELLUCID_BINDING_LIGHTS),
                                       frame_->planned(PELLUCID_BINDING_SHADOWS),
                                       VkDescriptorBufferInfo{kernel_.handle(), 0, kernel_.size()},
                                       f.frontDepth,
                                       f.material,
                                       f.normal,
                                       f.irradiance,
                                       result_->use()};
    // Bindings that no light names hold any image.
    for (uint32_t i = 0; i < kMaps; ++i)
      resources.push_back(frame_->isPlanned(PELLUCID_BINDING_SHADOW_IMAGES + i)
                              ? frame_->planned(PELLUCID_BINDING_SHADOW_IMAGES + i)
                              : Resource(f.frontDepth));
    pass_.record(commandBuffer, frame_->width(), frame_->height(), resources,
                 {frame_->run().plan().activeLights});
  }

  const std::shared_ptr<GpuImage>& result() const { return result_; }

private:
  static std::vector<VkDescriptorType> types() {
    constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                               kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
    std::vector<VkDescriptorType> all = {
        VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, kBuffer, kBuffer, kBuffer, kRead, kRead, kRead, kRead,
        VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
    all.insert(all.end(), kMaps, kRead);
    return all;
  }

  std::shared_ptr<const BenchFrame> frame_;
  HostBuffer kernel_;
  ComputePass pass_;
  std::shared_ptr<GpuImage> result_;
};

TransmittancePass pass(const std::shared_ptr<const BenchFrame>& frame, const std::string& name,
                       std::span<const uint32_t> spirv, const std::vector<glm::vec4>& kernel) {
  // Bytes a pixel: depth, material, normal, irradiance, a shadow texel a light; the result.
  const double bytes = 4 + 1 + 4 + 8 + 4.0 * frame->run().plan().activeLights + 8;
  const auto all = std::make_shared<Transmittance>(frame, spirv, kernel);
  const uint64_t image = 8 * static_cast<uint64_t>(frame->width()) * static_cast<uint64_t>(frame->height());
  return {{name, 1, 0, bytes, [all](VkCommandBuffer commandBuffer) { all->record(commandBuffer); },
           [all] { return rgb(all->result()->download()); }, image},
          all->result()};
}

WholeFrame inTurn(const std::string& name, const Variant& first, const Variant& second) {
  return {{name, first.dispatches + second.dispatches, first.barriers + second.barriers + 1,
           first.bytesPerPixel + second.bytesPerPixel,
           [a = first.record, b = second.record](VkCommandBuffer commandBuffer) {
             a(commandBuffer);
             computeBarrier(commandBuffer);
             b(commandBuffer);
           },
           second.output, first.transientBytes + second.transientBytes},
          first.name,
          second.name};
}

}  // namespace

ReplaySettings transmittanceSettings() {
  ReplaySettings settings;
  settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
  settings.normalFormat = VK_FORMAT_R8G8B8A8_SNORM;
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
  if (capture.normal.empty()) return "they need normals";
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
  return pass(frame, "Jimenez 2010, six Gaussians", kGaussianTransmittance, kernel);
}

TransmittancePass burleyTransmittance(const std::shared_ptr<const BenchFrame>& frame) {
  const float* d = frame->material().burleyDistance;
  return pass(frame, "HDRP, Burley's slab", kBurleyTransmittance, {{d[0], d[1], d[2], 0}});
}

std::vector<WholeFrame> wholeFrames(const std::shared_ptr<const BenchFrame>& frame) {
  const TransmittancePass gaussians = gaussianTransmittance(frame), slab = burleyTransmittance(frame);
  std::vector<WholeFrame> all;
  for (const int taps : kSeparableTaps)
    all.push_back(inTurn("Jimenez 2010 + 2015, " + std::to_string(taps) + " taps", gaussians.variant,
                         separable(frame, taps, gaussians.image)));
  for (const int samples : kBurleySamples)
    all.push_back(inTurn("HDRP, " + std::to_string(samples) + " samples", slab.variant,
                         burleyDisk(frame, samples, slab.image)));
  all.push_back(
      inTurn("Jimenez 2009, six Gaussians", gaussians.variant, gaussianSum(frame, gaussians.image)));
  return all;
}

}  // namespace pellucid::bench
