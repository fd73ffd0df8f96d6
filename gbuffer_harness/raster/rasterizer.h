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
struct DrawnFrame {
  Device& device;
  std::shared_ptr<DrawPasses> passes;
  RasterOptions options;
  // Without images: size, matrices, encodings, lights with the places of their maps, materials.
  Capture outline;
  FrontTarget front;
  std::shared_ptr<GpuImage> frontDepth, backDepth;  // as the options store them
  std::shared_ptr<GpuImage> irradianceImage;        // R32G32B32A32_SFLOAT
  std::shared_ptr<const RenderTarget> share;        // the reflected one; null: no surface has its lobes apart
  std::vector<std::vector<DrawnMap>> maps;          // of each light
  DepthCounts counts;
  std::vector<DispatchTime> times;  // of drawing, by the GPU's clock

  std::vector<std::string> warnings() const;  // sentences for a person
  bool hasBackDepth() const { return counts.open == 0 || counts.back > 0; }
  std::shared_ptr<GpuImage> irradianceIn(VkFormat format) const;

  // The device's images, downloaded anew by each call.
  Capture capture() const;                       // all of it
  Capture surfaces(const VkRect2D& rect) const;  // a part of the images of the surfaces, in its size
  std::vector<Light> lights() const;             // with their maps' images
  std::vector<std::uint8_t> material() const;
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
