#include "bench_frame.h"

#include "common/error.h"

namespace pellucid::bench {

using namespace harness;

BenchFrame::BenchFrame(Device& device, const Context& context, const Capture& capture,
                       const PellucidMaterial& material, const ReplaySettings& settings)
    : device_(device),
      width_(capture.width),
      height_(capture.height),
      material_(material),
      run_(device, context, capture, {material}, settings),
      constants_(device, run_.plan().constantsSize,
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
  requireOk(pellucidWriteConstants(&run_.plan(), &run_.frame(), constants_.mapped(),
                                   static_cast<size_t>(constants_.size())),
            run_.frame(), capture.name);
}

Resource BenchFrame::planned(uint32_t binding) const {
  const PellucidDispatch& dispatch = run_.plan().dispatches[0];
  for (uint32_t i = 0; i < dispatch.bindingCount; ++i) {
    const PellucidBinding& b = dispatch.bindings[i];
    if (b.binding != binding) continue;
    if (b.resource == PELLUCID_RESOURCE_CONSTANTS)
      return VkDescriptorBufferInfo{constants_.handle(), b.offset, b.size};
    return imageOf(run_.frame(), b.resource);
  }
  throw DeviceError("the plan's first dispatch has no binding " + std::to_string(binding));
}

std::shared_ptr<GpuImage> BenchFrame::image(VkFormat format) const {
  auto result = std::make_shared<GpuImage>(device_, width_, height_, format);
  result->clear();
  return result;
}

Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name) {
  const PellucidPlan& plan = frame->run().plan();
  double bytes = 0;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i)
    bytes += static_cast<double>(plan.dispatches[i].modeledBytes);
  return {name,
          plan.dispatchCount,
          plan.barrierCount,
          bytes / (static_cast<double>(frame->width()) * frame->height()),
          [frame](VkCommandBuffer commandBuffer) { frame->run().record(commandBuffer); },
          [frame] { return rgb(frame->run().output()); }};
}

}  // namespace pellucid::bench
