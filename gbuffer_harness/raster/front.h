// What the first pass over a model leaves for those after it.
#pragma once

#include "raster/draw.h"
#include "raster/raster.h"

namespace pellucid::harness {

inline VkCompareOp nearer(bool reversed) { return reversed ? VK_COMPARE_OP_GREATER : VK_COMPARE_OP_LESS; }
inline float farDepth(bool reversed) { return reversed ? 0.0f : 1.0f; }
inline VkClearColorValue clearTo(float value) { return {.float32 = {value, value, value, value}}; }

// Images of RenderTargets that shaders/depth.frag and shaders/caster.frag write.
constexpr std::size_t kPlanar = 0, kDeviceDepth = 1, kCaster = 2;

// Images that shaders/depth.frag writes, cleared to "nothing there".
inline std::vector<RenderTarget::Color> depthColors(bool reversed) {
  return {{VK_FORMAT_R32_SFLOAT, clearTo(kNoDepth)}, {VK_FORMAT_R32_SFLOAT, clearTo(farDepth(reversed))}};
}

struct FrontTarget {
  RenderTarget target;

  FrontTarget(Device& device, const RasterOptions& options)
      : target(device, options.width, options.height,
               {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)},
                {VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(-1)},  // no object
                {VK_FORMAT_R8_UINT, {}},
                {VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(farDepth(options.reversedZ))}},
               farDepth(options.reversedZ)) {}
  const GpuImage& normalPlanar() const { return target.image(0); }
  const GpuImage& albedoObject() const { return target.image(1); }
  const GpuImage& material() const { return target.image(2); }
  // Device depth, and the world normal without the normal map.
  const GpuImage& depthNormal() const { return target.image(3); }

  void draw(const UploadedModel& model, const DrawView& view) const {
    model.draw(target, view,
               {FragmentShader::Surface, VK_CULL_MODE_BACK_BIT, nearer(view.reversedDepth), false},
               VK_CULL_MODE_NONE);
  }
};

}  // namespace pellucid::harness
