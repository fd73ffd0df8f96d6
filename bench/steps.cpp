#include "steps.h"

#include "kCombine.h"
#include "kLinearize.h"
#include "kThickness.h"
#include "kTransmittance.h"
#include "kTransmittanceOfThickness.h"
#include "shared/pellucid_shared.h"

namespace pellucid::bench {

using harness::GpuImage;

namespace {

constexpr VkDescriptorType kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
constexpr VkDescriptorType kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
constexpr VkDescriptorType kRead = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
constexpr VkDescriptorType kWrite = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

// The dispatches and their intermediate images. `fused`: thickness and transmittance in one.
class Steps {
public:
  Steps(const std::shared_ptr<const BenchFrame>& frame, bool fused)
      : frame_(frame),
        fused_(fused),
        linearize_(frame->device(), kLinearize, {kUniform, kRead, kWrite}),
        thickness_(frame->device(), kThickness, {kUniform, kRead, kRead, kWrite}),
        transmittance_(frame->device(),
                       fused ? std::span<const uint32_t>(kTransmittance) : kTransmittanceOfThickness,
                       {kUniform, kBuffer, kBuffer, kBuffer, kRead, kRead, kRead, kRead, kRead, kWrite}),
        combine_(frame->device(), kCombine, {kUniform, kRead, kRead, kWrite}),
        front_(frame->image(VK_FORMAT_R32_SFLOAT)),
        back_(frame->image(VK_FORMAT_R32_SFLOAT)),
        chord_(frame->image(VK_FORMAT_R32_SFLOAT)),
        transmitted_(frame->image(VK_FORMAT_R16G16B16A16_SFLOAT)),
        result_(frame->image(VK_FORMAT_R16G16B16A16_SFLOAT)) {}

  void record(VkCommandBuffer commandBuffer) const {
    recordLinearize(commandBuffer);
    computeBarrier(commandBuffer);
    if (!fused_) {
      recordThickness(commandBuffer);
      computeBarrier(commandBuffer);
    }
    recordTransmittance(commandBuffer);
    computeBarrier(commandBuffer);
    recordAddition(commandBuffer);
  }

  void recordThickness(VkCommandBuffer commandBuffer) const {
    dispatch(commandBuffer, thickness_, {front_->use(), back_->use(), chord_->use()});
  }
  void recordTransmittance(VkCommandBuffer commandBuffer) const {
    const PellucidFrame& f = frame_->images();
    dispatch(commandBuffer, transmittance_,
             {frame_->planned(PELLUCID_BINDING_LIGHTS), frame_->planned(PELLUCID_BINDING_SHADOWS),
              frame_->planned(PELLUCID_BINDING_MATERIALS), front_->use(), (fused_ ? back_ : chord_)->use(),
              f.normal, f.material, frame_->planned(PELLUCID_BINDING_SHADOW_IMAGES), transmitted_->use()});
  }
  void recordAddition(VkCommandBuffer commandBuffer) const {
    dispatch(commandBuffer, combine_, {frame_->images().irradiance, transmitted_->use(), result_->use()});
  }

  harness::Image output() const { return rgb(result_->download()); }

private:
  void recordLinearize(VkCommandBuffer commandBuffer) const {
    const PellucidFrame& f = frame_->images();
    dispatch(commandBuffer, linearize_, {f.frontDepth, front_->use()});
    dispatch(commandBuffer, linearize_, {f.backDepth, back_->use()});
  }
  void dispatch(VkCommandBuffer commandBuffer, const ComputePass& pass,
                std::vector<Resource> resources) const {
    resources.insert(resources.begin(), frame_->planned(PELLUCID_BINDING_FRAME));
    pass.record(commandBuffer, frame_->width(), frame_->height(), resources,
                {frame_->run().plan().activeLights});
  }

  std::shared_ptr<const BenchFrame> frame_;
  bool fused_;
  ComputePass linearize_, thickness_, transmittance_, combine_;
  std::shared_ptr<GpuImage> front_, back_, chord_, transmitted_, result_;
};

Variant steps(const std::shared_ptr<const BenchFrame>& frame, bool fused) {
  // Bytes a pixel: a depth, planar distance, thickness or packed normal 4, a color 8, the material 1. The
  // shadow map counts as in the module's plan, 4.
  constexpr double kLinearizing = 4 + 4, kThicknessStep = 4 + 4 + 4, kCombining = 8 + 8 + 8;
  constexpr double kTransmitting = 4 + 4 + 4 + 1 + 4 + 8;
  const auto all = std::make_shared<Steps>(frame, fused);
  return {fused ? "thickness and transmittance in one" : "separate steps",
          fused ? 4u : 5u,
          fused ? 2u : 3u,
          2 * kLinearizing + (fused ? 0 : kThicknessStep) + kTransmitting + kCombining,
          [all](VkCommandBuffer commandBuffer) { all->record(commandBuffer); },
          [all] { return all->output(); }};
}

}  // namespace

TranslucencySteps translucencySteps(const std::shared_ptr<const BenchFrame>& frame) {
  const auto separate = std::make_shared<Steps>(frame, false), one = std::make_shared<Steps>(frame, true);
  for (const auto& all : {separate, one})
    frame->device().run([&](VkCommandBuffer commandBuffer) { all->record(commandBuffer); });
  const auto step = [](const std::shared_ptr<Steps>& all, void (Steps::*record)(VkCommandBuffer) const) {
    return [=](VkCommandBuffer commandBuffer) { (*all.*record)(commandBuffer); };
  };
  return {step(separate, &Steps::recordThickness), step(separate, &Steps::recordTransmittance),
          step(one, &Steps::recordTransmittance), step(separate, &Steps::recordAddition)};
}

std::vector<Variant> translucencyVariants(const std::shared_ptr<const BenchFrame>& frame) {
  return {steps(frame, false), steps(frame, true), moduleVariant(frame, "one dispatch")};
}

}  // namespace pellucid::bench
