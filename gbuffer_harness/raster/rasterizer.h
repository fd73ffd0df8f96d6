// A model on the device, drawn as often as wanted.
#pragma once

#include <memory>

#include "raster/drawn_frame.h"

namespace pellucid::harness {

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
