#include "bench_frame.h"

#include <set>
#include <utility>

#include "common/error.h"

namespace pellucid::bench {

using namespace harness;

BenchFrame::BenchFrame(Device& device, const Context& context, const Capture& capture,
                       const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
                       const std::shared_ptr<const InputImages>& inputs)
    : device_(device),
      width_(capture.width),
      height_(capture.height),
      material_(materials.at(0)),
      run_(inputs ? FrameRun(device, context, capture, materials, settings, inputs)
                  : FrameRun(device, context, capture, materials, settings)),
      constants_(device, run_.plan().constantsSize,
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {
  writeConstants();
}

void BenchFrame::writeConstants() const {
  requireOk(pellucidWriteConstants(&run_.plan(), &run_.frame(), constants_.mapped(),
                                   static_cast<size_t>(constants_.size())),
            run_.frame(), "constants");
}

std::vector<PellucidBinding> BenchFrame::bindings(uint32_t dispatch) const {
  std::vector<PellucidBinding> all(PELLUCID_MAX_BINDINGS);
  all.resize(pellucidGetBindings(&run_.plan(), dispatch, all.data()));
  return all;
}

std::optional<PellucidBinding> BenchFrame::find(uint32_t binding) const {
  for (const PellucidBinding& b : bindings(0))
    if (b.binding == binding) return b;
  return std::nullopt;
}

uint64_t BenchFrame::modeledBytes(uint32_t dispatch) const {
  const PellucidFrame& frame = run_.frame();
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];  // no frame of the bench has a history
  uint32_t count = PELLUCID_MAX_TRANSIENTS;
  requireOk(pellucidGetImageNeeds(&frame, &count, needs), frame, "needs");
  const uint64_t pixels = static_cast<uint64_t>(width_) * static_cast<uint64_t>(height_);
  const auto bytesOf = [&](uint32_t resource) -> uint64_t {
    const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
    if (transient < count) return needs[transient].bytes;
    if (resource == PELLUCID_RESOURCE_MATERIAL) return pixels;
    if (resource == PELLUCID_RESOURCE_IRRADIANCE || resource == PELLUCID_RESOURCE_OUTPUT)
      return pixels * (frame.options.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8);
    return 4 * pixels;  // depths, maps as large as the image, normals, albedo
  };
  std::set<std::pair<uint32_t, VkDescriptorType>> images;
  for (const PellucidBinding& b : bindings(dispatch))
    if (b.resource != PELLUCID_RESOURCE_CONSTANTS) images.insert({b.resource, b.type});
  uint64_t bytes = 0;
  for (const auto& [resource, type] : images) bytes += bytesOf(resource);
  return bytes;
}

bool BenchFrame::isPlanned(uint32_t binding) const { return find(binding).has_value(); }

Resource BenchFrame::planned(uint32_t binding) const {
  const std::optional<PellucidBinding> b = find(binding);
  if (!b) throw DeviceError("the plan's first dispatch has no binding " + std::to_string(binding));
  if (b->resource == PELLUCID_RESOURCE_CONSTANTS)
    return VkDescriptorBufferInfo{constants_.handle(), b->offset, b->size};
  return imageOf(run_.frame(), b->resource);
}

std::shared_ptr<GpuImage> BenchFrame::image(VkFormat format) const {
  auto result = std::make_shared<GpuImage>(device_, width_, height_, format);
  result->clear();
  return result;
}

Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name) {
  const PellucidPlan& plan = frame->run().plan();
  double bytes = 0;
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];  // no frame of the bench has a history
  uint32_t count = PELLUCID_MAX_TRANSIENTS;
  requireOk(pellucidGetImageNeeds(&frame->images(), &count, needs), frame->images(), name);
  uint64_t transients = 0;
  for (uint32_t i = 0; i < count; ++i) transients += needs[i].bytes;
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) bytes += static_cast<double>(frame->modeledBytes(i));
  return {name,
          plan.dispatchCount,
          plan.barrierCount,
          bytes / (static_cast<double>(frame->width()) * frame->height()),
          [frame](VkCommandBuffer commandBuffer) { frame->run().record(commandBuffer); },
          [frame] { return rgb(frame->run().output()); },
          transients};
}

}  // namespace pellucid::bench
