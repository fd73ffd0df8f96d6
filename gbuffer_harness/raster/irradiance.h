// Irradiance of the visible surfaces, light by light.
#pragma once

#include <functional>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "raster/draw.h"
#include "raster/pipeline.h"

namespace pellucid::harness {

// A shadow map as the irradiance pass reads it: planar distances, kNoDepth where nothing is.
struct ShadowImage {
  const GpuImage* planar = nullptr;
  int size = 0;  // texels across
  Matrix clipFromView, viewFromWorld;
  bool perspective = false;
};

class IrradiancePass {
public:
  // normalPlanar: world normal and planar distance in front of `view`, which is symmetric about its axis;
  // a distance <= 0 holds nothing and gets no light. depthNormal: in yzw the normal of the triangles, by
  // which shadows are offset. The images must outlive this.
  IrradiancePass(Device& device, const GpuImage& normalPlanar, const GpuImage& depthNormal, int width,
                 int height, const DrawView& view);

  // Adds color * intensity * max(N.L, 0) and the attenuation of KHR_lights_punctual, times the part of the
  // shadow maps' texels that see the surface. Outside the map, or without one, nothing shadows.
  // shadows: none, one, or the six of a cube, which have the same size and projection.
  void add(const Light& light, const std::vector<ShadowImage>& shadows);

  // Records the commands of add(). The function keeps what the commands read besides this and the images.
  std::function<void(VkCommandBuffer)> recorder(const Light& light,
                                                const std::vector<ShadowImage>& shadows) const;

  Image irradiance() const;  // RGB

private:
  void createPipeline();
  void record(VkCommandBuffer commandBuffer, const HostBuffer& constants,
              const std::vector<ShadowImage>& shadows) const;

  Device& device_;
  const GpuImage &normalPlanar_, &depthNormal_;
  int width_, height_;
  DrawView view_;
  GpuImage irradiance_;
  Owned<VkSampler, vkDestroySampler> sampler_;
  PushLayout layout_;
  Pipeline pipeline_;
};

}  // namespace pellucid::harness
