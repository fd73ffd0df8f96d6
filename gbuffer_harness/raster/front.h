// What the first pass over a model leaves for those after it.
#pragma once

#include "raster/draw.h"
#include "raster/raster.h"

namespace pellucid::harness {

inline VkCompareOp nearer(bool reversed) { return reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS; }
inline float farDepth(bool reversed) { return reversed ? 0.0f : 1.0f; }
inline VkClearColorValue clearTo(float value) { return {.float32 = {value, value, value, value}}; }

// Images of RenderTargets that shaders/depth.frag and shaders/caster.frag write.
constexpr std::size_t kPlanar = 0, kDeviceDepth = 1, kCasterObject = 2, kCasterMaterial = 3;

// Images that shaders/depth.frag writes, cleared to "nothing there".
inline std::vector<RenderTarget::Color> depthColors(bool reversed) {
  return {{VK_FORMAT_R32_SFLOAT, clearTo(kNoDepth)}, {VK_FORMAT_R32_SFLOAT, clearTo(farDepth(reversed))}};
}

// An image of a target, which lives as long as the image is held.
inline std::shared_ptr<GpuImage> sharedImage(const std::shared_ptr<const RenderTarget>& target,
                                             std::size_t i) {
  return {target, &target->image(i)};
}

struct FrontTarget {
  // Images of shaders/surface.frag.
  static constexpr std::size_t kNormalPlanar = 0, kAlbedoObject = 1, kMaterial = 2, kDepthNormal = 3;

  std::shared_ptr<const RenderTarget> target;

  FrontTarget(TargetPool& pool, const RasterOptions& options)
      : target(pool.take(options.width, options.height,
                         {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)},
                          {VK_FORMAT_R32G32B32A32_SFLOAT, {.float32 = {0, 0, 0, -1}}},  // no object
                          {VK_FORMAT_R8_UINT, {}},
                          {VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(farDepth(options.reversedZ))}},
                         farDepth(options.reversedZ))) {}
  const GpuImage& normalPlanar() const { return target->image(kNormalPlanar); }
  const GpuImage& albedoObject() const { return target->image(kAlbedoObject); }
  const GpuImage& material() const { return target->image(kMaterial); }
  // Device depth, and the world normal without the normal map.
  const GpuImage& depthNormal() const { return target->image(kDepthNormal); }

  void record(VkCommandBuffer commands, const UploadedModel& model, const DrawView& view) const {
    model.record(commands, *target, view,
                 {FragmentShader::Surface, VK_CULL_MODE_BACK_BIT, nearer(view.reversedDepth), false},
                 VK_CULL_MODE_NONE);
  }
};

}  // namespace pellucid::harness
