// Irradiance of the visible surfaces, light by light.
#pragma once

#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/pixel_pass.h"
#include "raster/draw.h"

namespace pellucid::harness {

// A shadow map as the irradiance pass reads it.
struct ShadowImage {
  PellucidImage planar{};  // planar distances, kNoDepth where nothing is
  int size = 0;            // texels across
  Matrix clipFromView, viewFromWorld;
  bool perspective = false;
  PellucidImage depths{};  // reversed device depths of an engine, read where Shadows::filter > 0
};

// The maps of a light: none, one, the six of a cube, which have the same projection, or cascades, of which
// the first that contains a point shadows it. All have one size.
struct Shadows {
  std::vector<ShadowImage> images;
  int filter = 0;  // ShadowDrawing::filter
};

// Surfaces that lights shine on.
struct LitSurfaces {
  // World normal and planar distance in front of `view`; a distance <= 0 holds nothing and gets no light.
  const GpuImage& normalPlanar;
  const GpuImage& depthNormal;  // in yzw the normal of the triangles, by which shadows are offset
  const GpuImage& irradiance;   // R32G32B32A32_SFLOAT, of the same size
  DrawView view;
};

class IrradiancePass {
public:
  explicit IrradiancePass(Device& device);

  // Adds color * intensity * max(N.L, 0) and the attenuation of KHR_lights_punctual, times the part of the
  // shadow maps' texels that see the surface. Outside the map, or without one, nothing shadows.
  void record(VkCommandBuffer commands, const LitSurfaces& surfaces, const Light& light,
              const Shadows& shadows) const;

private:
  PixelPass one_, six_;   // shadow maps at most: a CPU computes every branch of a choice among six
  HostBuffer constants_;  // written by the commands, so that those of the next light may follow
};

}  // namespace pellucid::harness
