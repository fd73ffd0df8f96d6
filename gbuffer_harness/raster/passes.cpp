#include "raster/passes.h"

#include <cstring>

#include "kRasterDepths.h"
#include "kRasterHalf.h"
#include "kRasterReflect.h"

namespace pellucid::harness {

namespace {

constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                           kStored = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                           kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

// Push constants of shaders/depths.comp.
struct DepthPush {
  float nothing;
  std::uint32_t isDevice, greaterIsNearer, nearestBack;
};

}  // namespace

DrawPasses::DrawPasses(Device& device)
    : targets(device),
      images(device),
      irradiance(device),
      depths_(device, {kRasterDepths, sizeof kRasterDepths},
              {{kSampled}, {kSampled}, {kSampled}, {kSampled}, {kSampled}, {kStored}, {kStored}, {kBuffer}},
              sizeof(DepthPush)),
      reflection_(device, {kRasterReflect, sizeof kRasterReflect}, {{kStored}, {kSampled}}),
      halves_(device, {kRasterHalf, sizeof kRasterHalf}, {{kSampled}, {kStored}}),
      counts_(device, sizeof(DepthCounts), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT) {}

void DrawPasses::recordDepths(VkCommandBuffer commands, const FrontTarget& front, const BackFaces& back,
                              const GpuImage& frontDepth, const GpuImage& backDepth,
                              const RasterOptions& options) const {
  std::memset(counts_.mapped(), 0, sizeof(DepthCounts));
  const bool isDevice = options.depthEncoding == PELLUCID_DEPTH_DEVICE;
  const DepthPush push{isDevice ? farDepth(options.reversedZ) : kNoDepth, isDevice,
                       isDevice && options.reversedZ, options.backFace == BackFace::Nearest};
  DescriptorWrites writes;
  const GpuImage* const read[] = {&front.normalPlanar(), &front.depthNormal(),
                                  &back.depths->image(isDevice ? kDeviceDepth : kPlanar),
                                  &back.counts->image(0), &front.material()};
  std::uint32_t binding = 0;
  for (const GpuImage* image : read) writes.image(binding++, kSampled, depths_.sampler(), image->use());
  for (const GpuImage* image : {&frontDepth, &backDepth})
    writes.image(binding++, kStored, VK_NULL_HANDLE, image->use());
  writes.buffer(binding, kBuffer, {counts_.handle(), 0, VK_WHOLE_SIZE});
  depths_.record(commands, writes.all(), options.width, options.height, &push);
  barrier(commands, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
          {VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT});
}

DepthCounts DrawPasses::counts() const {
  DepthCounts counts;
  std::memcpy(&counts, counts_.mapped(), sizeof counts);
  return counts;
}

void DrawPasses::recordReflection(VkCommandBuffer commands, const GpuImage& irradianceImage,
                                  const GpuImage& share) const {
  DescriptorWrites writes;
  writes.image(0, kStored, VK_NULL_HANDLE, irradianceImage.use());
  writes.image(1, kSampled, reflection_.sampler(), share.use());
  reflection_.record(commands, writes.all(), irradianceImage.width(), irradianceImage.height());
}

void DrawPasses::recordHalves(VkCommandBuffer commands, const GpuImage& from, const GpuImage& to) const {
  DescriptorWrites writes;
  writes.image(0, kSampled, halves_.sampler(), from.use());
  writes.image(1, kStored, VK_NULL_HANDLE, to.use());
  halves_.record(commands, writes.all(), to.width(), to.height());
}

}  // namespace pellucid::harness
