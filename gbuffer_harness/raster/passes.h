// Passes of a drawn frame besides its shadow maps, and the images that they leave for each other, kept from
// frame to frame.
#pragma once

#include <cstdint>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "common/pixel_pass.h"
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
      : target(pool.take({options.width,
                          options.height,
                          {{VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(0)},
                           {VK_FORMAT_R32G32B32A32_SFLOAT, {.float32 = {0, 0, 0, -1}}},  // no object
                           {VK_FORMAT_R8_UINT, {}},
                           {VK_FORMAT_R32G32B32A32_SFLOAT, clearTo(farDepth(options.reversedZ))}},
                          farDepth(options.reversedZ)})) {}
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

// A shadow map as the irradiance pass reads it.
struct ShadowImage {
  PellucidImage planar{};  // planar distances, kNoDepth where nothing is
  int size = 0;            // texels across
  Matrix clipFromView, viewFromWorld;
  bool perspective = false;
  PellucidImage depths{};  // reversed device depths of an engine, read with a filter
};

// Surfaces that lights shine on.
struct LitSurfaces {
  // World normal and planar distance in front of `view`; a distance <= 0 holds nothing and gets no light.
  const GpuImage& normalPlanar;
  const GpuImage& depthNormal;  // in yzw the normal of the triangles, by which shadows are offset
  const GpuImage& irradiance;   // R32G32B32A32_SFLOAT, of the same size
  DrawView view;
};

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

  // Adds color * intensity * max(N.L, 0) and the attenuation of KHR_lights_punctual, times the part of the
  // shadow maps' texels that see the surface. Outside the map, or without one, nothing shadows. shadows:
  // none, one, the six of a cube, which have the same projection, or cascades, of which the first that
  // contains a point shadows it. All have one size. filter: ShadowDrawing::filter.
  void recordIrradiance(VkCommandBuffer commands, const LitSurfaces& surfaces, const Light& light,
                        const std::vector<ShadowImage>& shadows, int filter) const;

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

private:
  PixelPass depths_, reflection_, halves_;
  PixelPass one_, six_;  // shadow maps at most: a CPU computes every branch of a choice among six
  HostBuffer counts_;
  HostBuffer constants_;  // of a light, written by the commands, so that those of the next light may follow
};

}  // namespace pellucid::harness
