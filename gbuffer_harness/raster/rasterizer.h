// A model on the device, drawn as often as wanted: frames are images on the device, which become a capture
// when somebody asks.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/dispatch_time.h"
#include "raster/passes.h"
#include "raster/raster.h"
#include "raster/shadow.h"

namespace pellucid::harness {

// A model as the rasterizer drew it.
class DrawnFrame {
public:
  struct Images {
    FrontTarget front;
    std::shared_ptr<GpuImage> frontDepth, backDepth;  // as the options store them
    std::shared_ptr<GpuImage> irradiance;             // R32G32B32A32_SFLOAT
    std::shared_ptr<const RenderTarget> share;  // the reflected one; null: no surface has its lobes apart
    std::vector<std::vector<DrawnMap>> maps;    // of each light
  };

  // outline: the capture but for its images, whose lights have no maps yet.
  DrawnFrame(Device& device, std::shared_ptr<DrawPasses> passes, const RasterOptions& options,
             Capture outline, Images images, const DepthCounts& counts, std::vector<DispatchTime> times);

  // Without images: size, matrices, encodings, lights with the places of their maps, materials.
  const Capture& outline() const { return outline_; }
  const DepthCounts& counts() const { return counts_; }
  const std::vector<DispatchTime>& times() const { return times_; }  // of drawing, by the GPU's clock
  std::vector<std::string> warnings() const;                         // sentences for a person

  Device& device() const { return device_; }
  const RasterOptions& options() const { return options_; }
  const Images& images() const { return images_; }
  bool hasBackDepth() const { return counts_.open == 0 || counts_.back > 0; }
  std::shared_ptr<GpuImage> irradianceIn(VkFormat format) const;

  // The device's images, downloaded anew by each call.
  Capture capture() const;                       // all of it
  Capture surfaces(const VkRect2D& rect) const;  // a part of the images of the surfaces, in its size
  std::vector<Light> lights() const;             // with their maps' images
  std::vector<std::uint8_t> material() const;
  RasterResult result() const;

private:
  VkRect2D whole() const;

  Device& device_;
  std::shared_ptr<DrawPasses> passes_;
  RasterOptions options_;
  Capture outline_;
  Images images_;
  DepthCounts counts_;
  std::vector<DispatchTime> times_;
};

class Rasterizer {
public:
  // Uploads the model, which must outlive it. Its lights and materials may change between frames. Throws
  // InputError for a model without triangles, and what UploadedModel throws.
  Rasterizer(Device& device, const Model& model);
  ~Rasterizer();

  const UploadedModel& uploaded() const { return uploaded_; }

  // One submission, which is waited for; images lie where those of frames lay that nobody holds any more.
  // Throws as rasterize() does.
  std::shared_ptr<const DrawnFrame> draw(const ModelCamera& camera, const RasterOptions& options);

private:
  struct Simplified;

  const UploadedModel& transmission(double simplify);

  Device& device_;
  const Model& model_;
  ModelPoints points_;
  UploadedModel uploaded_;
  std::unique_ptr<Simplified> simplified_;  // as it was drawn last
  std::shared_ptr<DrawPasses> passes_;
};

}  // namespace pellucid::harness
