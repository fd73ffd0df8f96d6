// The last frame as a capture, for the harness to replay.
#include <numbers>

#include "sample/renderer.h"
#include "scene/vector.h"

namespace pellucid::sample {

namespace {

glm::vec3 fromOctahedral(glm::vec2 p) {
  glm::vec3 n(p, 1 - std::abs(p.x) - std::abs(p.y));
  const float fold = std::max(-n.z, 0.0f);
  n.x -= n.x < 0 ? -fold : fold;
  n.y -= n.y < 0 ? -fold : fold;
  return glm::normalize(n);
}

Image cropped(const Image& image, std::uint32_t left, std::uint32_t top, VkExtent2D extent) {
  Image result(static_cast<int>(extent.width), static_cast<int>(extent.height), image.channels);
  for (int y = 0; y < result.height; ++y)
    std::copy_n(image.at(static_cast<int>(left), static_cast<int>(top) + y), result.width * image.channels,
                result.at(0, y));
  return result;
}

}  // namespace

void Renderer::wait() const { check(vkQueueWaitIdle(device_.queue()), "vkQueueWaitIdle"); }

const GpuImage& Renderer::picture() const {
  wait();
  return picture_;
}

Image Renderer::rectOf(const Image& image) const { return cropped(image, 0, 0, frame_.rect); }

Image Renderer::color() const {
  wait();
  return rgb(rectOf(color_.download()));
}

Image Renderer::irradiance() const {
  wait();
  return rgb(rectOf(irradiance_.download()));
}

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

  Image color = this->color();
  c.frontDepth = {rectOf(depth_.download(0, kDepthRead)), PELLUCID_DEPTH_DEVICE};
  c.backDepth = {rectOf(backDepth_.download(0, kDepthRead)), PELLUCID_DEPTH_DEVICE};
  c.irradiance = irradiance();
  for (float& value : c.irradiance.data) value /= frame_.preExposure;
  c.albedo = rgb(rectOf(albedo_.download()));
  c.normal = rectOf(normal_.download());
  for (std::size_t i = 0; i < c.normal.pixels(); ++i) {
    float* n = &c.normal.data[3 * i];
    const glm::vec3 normal = fromOctahedral({2 * n[0] - 1, 2 * n[1] - 1});
    for (int k = 0; k < 3; ++k) n[k] = normal[k];
  }
  for (const float word : rectOf(surface_.download()).data)
    c.material.push_back(static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(word) >> 16));

  for (const PellucidLight& l : frame_.lights) {
    Light& light = c.lights.emplace_back();
    light.type = static_cast<PellucidLightType>(l.type);
    std::copy_n(l.position, 3, light.position.begin());
    std::copy_n(l.direction, 3, light.direction.begin());
    std::copy_n(l.color, 3, light.color.begin());
    light.intensity = static_cast<double>(l.intensity);
    light.innerConeAngle = static_cast<double>(l.innerConeAngle);
    light.outerConeAngle = static_cast<double>(l.outerConeAngle);
    for (std::uint32_t i = 0; i < l.shadowMapCount; ++i) {
      const ShadowTile& tile = frame_.tiles[l.firstShadowMap + i];
      ShadowMap& map = light.shadowMaps.emplace_back();
      const Image whole = shadows_[tile.image].download(static_cast<int>(tile.layer), kDepthRead);
      map.depth = {cropped(whole, tile.x, tile.y, {tile.size, tile.size}), PELLUCID_DEPTH_DEVICE};
      map.clipFromWorld = fromGlm(tile.clipFromWorld);
      map.faces = tile.frontsCulled ? PELLUCID_FACES_BACK : PELLUCID_FACES_FRONT;
      map.depthBiasConstant = static_cast<double>(tile.biasConstant * tile.depthStep);
      map.depthBiasSlope = static_cast<double>(tile.biasSlope);
      map.depthStep = static_cast<double>(tile.depthStep);
      map.sharedImage = static_cast<int>(tile.image);
      map.offset = {static_cast<int>(tile.x), static_cast<int>(tile.y)};
      map.layer = static_cast<int>(tile.layer);
    }
  }

  // Lit again, the color lacks what Pellucid added.
  device_.run([this](VkCommandBuffer commands) { light(commands); });
  const Image before = this->color();
  c.truth.emplace().image = Image(c.width, c.height, 3);
  for (std::size_t i = 0; i < color.data.size(); ++i)
    c.truth->image.data[i] = (color.data[i] - before.data[i]) / frame_.preExposure;
  return c;
}

}  // namespace pellucid::sample
