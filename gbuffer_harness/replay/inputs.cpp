#include "replay/inputs.h"

#include <algorithm>
#include <cstdint>

#include "capture/shadow_images.h"

namespace pellucid::harness {

void scaleColors(Image& image, float factor) {
  for (size_t i = 0; factor != 1 && i < image.data.size(); ++i)
    if (image.channels == 3 || i % 4 != 3) image.data[i] *= factor;
}

namespace {

std::shared_ptr<GpuImage> uploaded(Device& device, const Image& image, VkFormat format) {
  if (image.empty()) return nullptr;
  auto result = std::make_shared<GpuImage>(device, image.width, image.height, format);
  result->upload(image);
  return result;
}

std::shared_ptr<GpuImage> uploadedShadows(Device& device, const ShadowImageSource& source, bool array) {
  const bool caster = source.content == ShadowContent::Caster;
  auto result = std::make_shared<GpuImage>(device, source.width, source.height,
                                           caster ? VK_FORMAT_R8_UNORM : VK_FORMAT_R32_SFLOAT, 0,
                                           array ? source.layers : 0);
  for (int layer = 0; layer < source.layers; ++layer) {
    const Image image = source.layer(layer);
    if (caster)
      result->upload(std::vector<std::uint8_t>(image.data.begin(), image.data.end()), layer);
    else
      result->upload(image, layer);
  }
  return result;
}

std::shared_ptr<GpuImage> uploadedMaterial(Device& device, const Capture& capture,
                                           const ReplaySettings& settings) {
  const bool packed = settings.materialMask != 0;
  auto result = std::make_shared<GpuImage>(device, capture.width, capture.height,
                                           packed ? VK_FORMAT_R32_UINT : VK_FORMAT_R8_UINT);
  if (!packed) {
    result->upload(capture.material);
    return result;
  }
  std::vector<std::uint32_t> words(capture.material.size());
  for (size_t i = 0; i < words.size(); ++i) {
    const std::uint32_t noise = static_cast<std::uint32_t>(i) * 2654435761u + 12345u;  // Knuth's hash
    words[i] = (noise & ~settings.materialMask) | std::uint32_t{capture.material[i]}
                                                      << settings.materialShift;
  }
  result->upload(words);
  return result;
}

}  // namespace

VkFormat irradianceFormat(const ReplaySettings& settings) {
  return settings.irradianceFormat == VK_FORMAT_UNDEFINED ? settings.outputFormat : settings.irradianceFormat;
}

InputImages::InputImages(Device& device, const Capture& capture, const ReplaySettings& settings) {
  images_.shape = shapeOf(capture);
  images_.frontDepth = uploaded(device, capture.frontDepth.image, VK_FORMAT_R32_SFLOAT);
  images_.backDepth = uploaded(device, capture.backDepth.image, VK_FORMAT_R32_SFLOAT);
  Image irradiance = capture.irradiance;
  scaleColors(irradiance, preExposureOf(settings));
  images_.irradiance = uploaded(device, irradiance, irradianceFormat(settings));
  Image hidden = capture.hiddenIrradiance;
  scaleColors(hidden, preExposureOf(settings));
  images_.hiddenIrradiance = uploaded(device, hidden, VK_FORMAT_R32G32B32A32_SFLOAT);
  images_.albedo = uploaded(device, capture.albedo, VK_FORMAT_R32G32B32A32_SFLOAT);
  images_.material = uploadedMaterial(device, capture, settings);
  if (settings.reuse == PELLUCID_REUSE_ACCUMULATE)
    images_.motion = uploaded(device, capture.motion.empty() ? Image(capture.width, capture.height, 2) : capture.motion,
                              VK_FORMAT_R32G32B32A32_SFLOAT);
  const bool array = hasLayers(capture.lights);
  for (const ShadowImageSource& source : shadowImages(capture.lights).images)
    images_.shadows.push_back(uploadedShadows(device, source, array));
}

void InputImages::bind(FrameData& data) const {
  const auto use = [](const std::shared_ptr<GpuImage>& image) {
    return image ? image->use() : PellucidImage{};
  };
  PellucidFrame& f = data.frame;
  f.frontDepth = use(images_.frontDepth);
  f.backDepth = use(images_.backDepth);
  f.irradiance = use(images_.irradiance);
  if (f.hiddenIrradiance.view)
    f.hiddenIrradiance = use(images_.hiddenIrradiance);  // of light that is asked for
  f.albedo = use(images_.albedo);
  f.material = use(images_.material);
  f.motion = use(images_.motion);
  std::transform(images_.shadows.begin(), images_.shadows.end(), data.shadowImages.begin(), use);
}

}  // namespace pellucid::harness
