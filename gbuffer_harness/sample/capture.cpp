// The last frame read back, and as a capture for the harness to replay.
#include "sample/renderer.h"
#include "scene/vector.h"

namespace pellucid::sample {

const GpuImage& Renderer::picture() const {
  check(vkQueueWaitIdle(device_.queue()), "vkQueueWaitIdle");
  return *targets_[kPicture];
}

Image Renderer::rectOf(const Image& image) const {
  return cropped(image, 0, 0, static_cast<int>(frame_.rect.width), static_cast<int>(frame_.rect.height));
}
Image Renderer::color() const { return rgb(rectOf(targets_[kColor]->download())); }
Image Renderer::irradiance() const { return rgb(rectOf(targets_[kIrradiance]->download())); }

Capture Renderer::capture() {
  Capture c;
  c.name = "sample of " + scene_.model.name;
  c.width = static_cast<int>(frame_.rect.width);
  c.height = static_cast<int>(frame_.rect.height);
  c.metersPerUnit = static_cast<double>(frame_.metersPerUnit);
  c.clipFromView = fromGlm(frame_.clipFromView);
  c.viewFromWorld = fromGlm(frame_.viewFromWorld);
  c.materials = scene_.model.materials;
  if (frame_.hasAmbient) c.environment = scene_.ambient;
  c.frontDepth = {rectOf(depth_->download(0, kDepthRead)), PELLUCID_DEPTH_DEVICE};
  c.backDepth = {rectOf(backDepth_->download(0, kDepthRead)), PELLUCID_DEPTH_DEVICE};
  c.irradiance = irradiance();
  for (float& value : c.irradiance.data) value /= frame_.preExposure;
  c.albedo = rgb(rectOf(targets_[kAlbedo]->download()));
  for (const float word : rectOf(targets_[kSurface]->download()).data)
    c.material.push_back(static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(word) >> 16));
  for (std::size_t i = 0; i < lit_.size(); ++i) {
    Light& light = c.lights.emplace_back(*lit_[i]);
    for (std::uint32_t k = 0; k < frame_.lights[i].shadowMapCount; ++k) {
      const ShadowTile& t = frame_.tiles[frame_.lights[i].firstShadowMap + k];
      ShadowMap& map = light.shadowMaps.emplace_back();
      const bool fronts = frame_.hasFronts && t.image == kAtlas;
      const Image layer = shadows_[fronts ? kFronts : t.image].download(static_cast<int>(t.layer), kDepthRead);
      map.offset = {static_cast<int>(t.x), static_cast<int>(t.y)};
      const int size = static_cast<int>(t.size);
      map.depth = {cropped(layer, map.offset[0], map.offset[1], size, size), PELLUCID_DEPTH_DEVICE};
      map.clipFromWorld = fromGlm(t.clipFromWorld);
      map.backFaces = t.frontsCulled && !fronts;
      if (!fronts) {
        map.depthBiasConstant = static_cast<double>(t.biasConstant * t.depthStep);
        map.depthBiasSlope = static_cast<double>(t.biasSlope);
        map.depthStep = static_cast<double>(t.depthStep);
      }
      // A manifest has one array of layers: the cube's follow the cascades.
      map.sharedImage = t.image == kAtlas;
      map.layer = static_cast<int>(t.layer + (t.image == kCube ? shadows_[kCascades].layers() : 0));
    }
  }
  // Lit again, the color lacks what Pellucid added.
  const Image after = color();
  device_.run([this](VkCommandBuffer commands) { light(commands); });
  const Image before = color();
  c.truth.emplace().image = Image(c.width, c.height, 3);
  for (std::size_t i = 0; i < after.data.size(); ++i)
    c.truth->image.data[i] = (after.data[i] - before.data[i]) / frame_.preExposure;
  return c;
}

}  // namespace pellucid::sample
