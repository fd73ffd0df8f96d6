// Images that frames read, on the device.
#pragma once

#include <memory>
#include <vector>

#include "common/device.h"
#include "common/gpu_image.h"
#include "replay/frame.h"

namespace pellucid::harness {

struct ShadowImageSource;

class InputImages {
public:
  struct Images {
    FrameShape shape;
    std::shared_ptr<GpuImage> frontDepth, backDepth, irradiance, hiddenIrradiance, albedo, material,
        motion;  // null: none
    std::vector<std::shared_ptr<GpuImage>> shadows;
  };

  // Uploads as settings say: formats, material bits, pre-exposure. The capture is not needed afterwards.
  InputImages(Device& device, const Capture& capture, const ReplaySettings& settings);
  // Images that were drawn.
  explicit InputImages(Images images) : images_(std::move(images)) {}

  const FrameShape& shape() const { return images_.shape; }
  void bind(FrameData& data) const;
  GpuImage& irradiance() const { return *images_.irradiance; }

private:
  Images images_;
};

// Multiplies all channels but the alpha of images that have one.
void scaleColors(Image& image, float factor);

// The format of the irradiance that a frame of these settings reads.
VkFormat irradianceFormat(const ReplaySettings& settings);

}  // namespace pellucid::harness
