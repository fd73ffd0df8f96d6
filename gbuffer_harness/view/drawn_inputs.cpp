#include "view/drawn_inputs.h"

#include <utility>

namespace pellucid::harness {

std::shared_ptr<const InputImages> drawnInputs(const DrawnFrame& drawn, const ReplaySettings& settings) {
  const RasterOptions& options = drawn.options();
  const DrawnFrame::Images& images = drawn.images();
  if (!areOnDevice(options) || options.normalsInViewSpace || preExposureOf(settings) != 1 ||
      settings.materialMask != 0 || settings.normalFormat != VK_FORMAT_R32G32B32A32_SFLOAT)
    return std::make_shared<const InputImages>(drawn.device(), drawn.capture(), settings);
  InputImages::Images inputs;
  inputs.shape.backDepth = drawn.hasBackDepth();
  inputs.shape.normal = inputs.shape.albedo = true;
  inputs.frontDepth = images.frontDepth;
  if (drawn.hasBackDepth()) inputs.backDepth = images.backDepth;
  const auto& front = images.front.target;
  inputs.normal = sharedImage(front, FrontTarget::kNormalPlanar);
  inputs.albedo = sharedImage(front, FrontTarget::kAlbedoObject);
  inputs.material = sharedImage(front, FrontTarget::kMaterial);
  inputs.irradiance = drawn.irradianceIn(irradianceFormat(settings));
  const int size = options.shadowSize;
  for (const std::vector<DrawnMap>& maps : images.maps)
    for (const DrawnMap& map : maps) {
      FrameShape::Map& place = inputs.shape.maps.emplace_back();
      place.extent = {size, size};
      const DeviceMap mapped = deviceMap(map, options);
      std::size_t i = 0;
      for (const auto& image : {mapped.depth, mapped.exit, mapped.casterMaterial}) {
        if (image) {
          place.images[i] = static_cast<int>(inputs.shadows.size());
          inputs.shadows.push_back(image);
        }
        ++i;
      }
    }
  inputs.shape.shadowImages = inputs.shadows.size();
  return std::make_shared<const InputImages>(std::move(inputs));
}

}  // namespace pellucid::harness
