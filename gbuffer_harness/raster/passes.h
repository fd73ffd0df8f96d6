// Resources of drawing besides the model, kept from frame to frame: compute passes, and images in turns.
#pragma once

#include <cstdint>

#include "common/pixel_pass.h"
#include "raster/front.h"
#include "raster/irradiance.h"

namespace pellucid::harness {

// Pixels, counted by shaders/depths.comp.
struct DepthCounts {
  std::uint32_t material = 0;  // that have a material
  std::uint32_t open = 0;      // of these, those without a back depth
  std::uint32_t back = 0;      // of all, those with one
};

// Images of the back faces that a capture's depths are made of.
struct BackFaces {
  std::shared_ptr<const RenderTarget> depths;  // of shaders/depth.frag
  std::shared_ptr<const RenderTarget> counts;  // of shaders/count.frag
};

class DrawPasses {
public:
  explicit DrawPasses(Device& device);

  // Writes the depths as options store them. The counts are there once the commands have run.
  void recordDepths(VkCommandBuffer commands, const FrontTarget& front, const BackFaces& back,
                    const GpuImage& frontDepth, const GpuImage& backDepth,
                    const RasterOptions& options) const;
  DepthCounts counts() const;

  // irradiance *= share, which FragmentShader::Reflected drew.
  void recordReflection(VkCommandBuffer commands, const GpuImage& irradiance, const GpuImage& share) const;

  // RGB of an image in R16G16B16A16_SFLOAT, alpha 1: the bits of GpuImage::upload().
  void recordHalves(VkCommandBuffer commands, const GpuImage& from, const GpuImage& to) const;

  void nextFrame() {
    targets.nextFrame();
    images.nextFrame();
  }

  TargetPool targets;
  ImagePool images;
  const IrradiancePass irradiance;

private:
  PixelPass depths_, reflection_, halves_;
  HostBuffer counts_;
};

}  // namespace pellucid::harness
