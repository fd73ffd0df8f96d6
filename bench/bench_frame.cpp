#include "bench_frame.h"

#include <algorithm>

#include "common/error.h"
#include "common/parallel.h"
#include "reference/surface.h"

namespace pellucid::bench {

using namespace harness;

namespace {

constexpr uint32_t kPushBytes = 16;

std::vector<VkDescriptorSetLayoutBinding> layoutBindings(const std::vector<VkDescriptorType>& types) {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (uint32_t i = 0; i < types.size(); ++i)
    bindings.push_back({i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  return bindings;
}

}  // namespace

ComputePass::ComputePass(Device& device, std::span<const uint32_t> spirv,
                         const std::vector<VkDescriptorType>& types, const Tile& tile)
    : types_(types),
      tile_(tile),
      sampler_(device),
      layout_(device, layoutBindings(types), {VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes}),
      pipeline_(device) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = VK_FILTER_LINEAR;
  info.addressModeU = info.addressModeV = info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device.handle(), &info, nullptr, sampler_.receive()), "vkCreateSampler");
  std::vector<VkSpecializationMapEntry> entries;
  for (uint32_t i = 0; i < tile.specialization.size(); ++i) entries.push_back({i, 4 * i, 4});
  createPipeline(
      device, layout_, {spirv.data(), spirv.size_bytes()},
      {static_cast<uint32_t>(entries.size()), entries.data(), 4 * entries.size(), tile.specialization.data()},
      pipeline_);
}

void ComputePass::record(VkCommandBuffer commandBuffer, int width, int height,
                         const std::vector<Resource>& resources, const std::array<uint32_t, 4>& push) const {
  DescriptorWrites writes;
  for (uint32_t i = 0; i < resources.size(); ++i)
    if (const auto* image = std::get_if<PellucidImage>(&resources[i]))
      writes.image(i, types_[i], sampler_, *image);
    else
      writes.buffer(i, types_[i], std::get<VkDescriptorBufferInfo>(resources[i]));
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  layout_.push(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, writes.all());
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_COMPUTE_BIT, 0, kPushBytes, push.data());
  const auto groups = [](int size, uint32_t tile) { return (static_cast<uint32_t>(size) + tile - 1) / tile; };
  vkCmdDispatch(commandBuffer, groups(width, tile_.width), groups(height, tile_.height), 1);
}

Image outputOf(Device& device, const Variant& variant) {
  device.run(variant.record);
  return variant.output();
}

std::shared_ptr<const GpuImage> normalsOf(Device& device, const Capture& capture) {
  const reference::SurfaceReader surfaces(capture);
  Image normals(capture.width, capture.height, 3);
  parallelRows(capture.height, 0, [&](int y) {
    for (int x = 0; x < capture.width; ++x)
      if (const auto surface = surfaces.at(x, y))
        for (int i = 0; i < 3; ++i) normals.at(x, y)[i] = static_cast<float>(surface->normal[i]);
  });
  auto image = std::make_shared<GpuImage>(device, capture.width, capture.height, VK_FORMAT_R8G8B8A8_SNORM);
  image->upload(normals);
  return image;
}

BenchFrame::BenchFrame(Device& device, const Context& context, const Capture& capture,
                       const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
                       const std::shared_ptr<const InputImages>& inputs,
                       const std::shared_ptr<const GpuImage>& normals)
    : device_(device),
      width_(capture.width),
      height_(capture.height),
      material_(materials.at(0)),
      normals_(normals),
      run_(inputs ? FrameRun(device, context, capture, materials, settings, inputs)
                  : FrameRun(device, context, capture, materials, settings)),
      constants_(device, run_.plan().constantsSize,
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      bindings_(PELLUCID_MAX_BINDINGS) {
  writeConstants();
  bindings_.resize(pellucidGetBindings(&run_.plan(), 0, bindings_.data()));
}

void BenchFrame::writeConstants() const {
  requireOk(pellucidWriteConstants(&run_.plan(), &run_.frame(), constants_.mapped(),
                                   static_cast<size_t>(constants_.size())),
            run_.frame(), "constants");
}

const PellucidBinding* BenchFrame::find(uint32_t binding) const {
  const auto found = std::find_if(bindings_.begin(), bindings_.end(),
                                  [&](const PellucidBinding& b) { return b.binding == binding; });
  return found == bindings_.end() ? nullptr : &*found;
}

bool BenchFrame::isPlanned(uint32_t binding) const { return find(binding) != nullptr; }

Resource BenchFrame::planned(uint32_t binding) const {
  const PellucidBinding* b = find(binding);
  if (!b) throw DeviceError("the plan's first dispatch has no binding " + std::to_string(binding));
  if (b->resource == PELLUCID_RESOURCE_CONSTANTS)
    return VkDescriptorBufferInfo{constants_.handle(), b->offset, b->size};
  return *pellucidGetImage(&run_.frame(), b->resource);
}

std::shared_ptr<GpuImage> BenchFrame::image() const {
  auto result = std::make_shared<GpuImage>(device_, width_, height_, VK_FORMAT_R16G16B16A16_SFLOAT);
  result->clear();
  return result;
}

std::uint64_t BenchFrame::bytesOf(std::uint64_t images) const {
  return images * 8 * static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_);
}

Variant moduleVariant(const std::shared_ptr<const BenchFrame>& frame, const std::string& name) {
  const PellucidPlan& plan = frame->run().plan();
  PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];  // no frame of the bench has a history
  uint32_t count = PELLUCID_MAX_TRANSIENTS;
  requireOk(pellucidGetImageNeeds(&frame->images(), &count, needs), frame->images(), name);
  uint64_t transients = 0;
  for (uint32_t i = 0; i < count; ++i) transients += needs[i].bytes;
  return {name,
          plan.dispatchCount,
          plan.barrierCount,
          transients,
          [frame](VkCommandBuffer commandBuffer) { frame->run().record(commandBuffer); },
          [frame] { return rgb(frame->run().output()); }};
}

}  // namespace pellucid::bench
