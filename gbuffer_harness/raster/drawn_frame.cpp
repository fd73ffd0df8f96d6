#include "raster/drawn_frame.h"

#include <utility>

#include "scene/vector.h"

namespace pellucid::harness {

DrawnFrame::DrawnFrame(Device& device, std::shared_ptr<DrawPasses> passes, const RasterOptions& options,
                       Capture outline, Images images, const DepthCounts& counts,
                       std::vector<DispatchTime> times)
    : device_(device),
      passes_(std::move(passes)),
      options_(options),
      outline_(std::move(outline)),
      images_(std::move(images)),
      counts_(counts),
      times_(std::move(times)) {
  for (std::size_t i = 0; i < images_.maps.size(); ++i)
    for (const DrawnMap& map : images_.maps[i]) outline_.lights[i].shadowMaps.push_back(map.outline);
  placeShadowMaps(options.shadow.placement, options.shadowSize, outline_.lights);
}

std::vector<std::string> DrawnFrame::warnings() const {
  std::vector<std::string> warnings;
  if (counts_.material == 0) warnings.push_back("no pixel has a material: nothing is translucent");
  if (counts_.open > 0)
    warnings.push_back(std::to_string(counts_.open) + " of " + std::to_string(counts_.material) +
                       " material pixels look through an open or single-sided mesh: they have no "
                       "back depth" +
                       (hasBackDepth() ? "" : ", and the capture no backDepth"));
  for (std::size_t i = 0; i < outline_.lights.size() && options_.shadowSize > 0; ++i)
    if (outline_.lights[i].shadowMaps.empty())
      warnings.push_back("lights[" + std::to_string(i) +
                         "] stands within or too close to the model for one shadow map: it has none "
                         "and nothing shadows it");
  return warnings;
}

std::shared_ptr<GpuImage> DrawnFrame::irradianceIn(VkFormat format) const {
  if (format == VK_FORMAT_R32G32B32A32_SFLOAT) return images_.irradiance;
  const std::shared_ptr<GpuImage> image = passes_->images.take(options_.width, options_.height, format);
  if (format == VK_FORMAT_R16G16B16A16_SFLOAT)
    device_.run(
        [&](VkCommandBuffer commands) { passes_->recordHalves(commands, *images_.irradiance, *image); });
  else
    image->upload(rgb(images_.irradiance->download()));
  return image;
}

VkRect2D DrawnFrame::whole() const {
  return {{0, 0}, {static_cast<std::uint32_t>(options_.width), static_cast<std::uint32_t>(options_.height)}};
}

Capture DrawnFrame::surfaces(const VkRect2D& rect) const {
  Capture capture = outline_;
  capture.width = static_cast<int>(rect.extent.width);
  capture.height = static_cast<int>(rect.extent.height);
  capture.frontDepth.image = images_.frontDepth->download(rect);
  if (hasBackDepth()) capture.backDepth.image = images_.backDepth->download(rect);
  capture.irradiance = rgb(images_.irradiance->download(rect));
  capture.albedo = rgb(images_.front.albedoObject().download(rect));
  const Image material = images_.front.material().download(rect);
  capture.material.assign(material.data.begin(), material.data.end());
  const Image normalPlanar = images_.front.normalPlanar().download(rect);
  capture.normal = Image(capture.width, capture.height, 3);
  const glm::dmat3 rotation =
      options_.normalsInViewSpace ? glm::dmat3(toGlm(capture.viewFromWorld)) : glm::dmat3(1);
  for (std::size_t i = 0; i < normalPlanar.pixels(); ++i) {
    const float* n = &normalPlanar.data[4 * i];
    if (!(n[3] > 0)) continue;
    const glm::dvec3 normal = rotation * glm::dvec3(n[0], n[1], n[2]);
    for (int c = 0; c < 3; ++c)
      capture.normal.data[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(normal[c]);
  }
  return capture;
}

std::vector<Light> DrawnFrame::lights() const {
  std::vector<Light> lights = outline_.lights;
  for (std::size_t i = 0; i < images_.maps.size(); ++i)
    for (std::size_t k = 0; k < images_.maps[i].size(); ++k) {
      ShadowMap map = downloadMap(images_.maps[i][k], options_);
      const ShadowMap& place = outline_.lights[i].shadowMaps[k];
      map.sharedImage = place.sharedImage;
      map.offset = place.offset;
      map.layer = place.layer;
      lights[i].shadowMaps[k] = std::move(map);
    }
  return lights;
}

std::vector<std::uint8_t> DrawnFrame::material() const {
  const Image material = images_.front.material().download();
  return {material.data.begin(), material.data.end()};
}

Capture DrawnFrame::capture() const {
  Capture capture = surfaces(whole());
  capture.lights = lights();
  return capture;
}

RasterResult DrawnFrame::result() const {
  RasterResult result;
  result.capture = capture();
  result.openPixels = counts_.open;
  if (images_.share) result.reflectedShare = rgb(images_.share->image(0).download());
  result.warnings = warnings();
  return result;
}

}  // namespace pellucid::harness
