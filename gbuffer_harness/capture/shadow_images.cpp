#include "capture/shadow_images.h"

#include <algorithm>

#include "common/error.h"

namespace pellucid::harness {
namespace {

bool holds(const ShadowMap& map, ShadowContent content) {
  return content == ShadowContent::Depth  ? true
         : content == ShadowContent::Exit ? !map.exitDepth.empty()
                                          : !map.casterMaterial.empty();
}

float texel(const ShadowMap& map, ShadowContent content, int x, int y) {
  if (content == ShadowContent::Depth) return *map.depth.image.at(x, y);
  if (content == ShadowContent::Exit) return *map.exitDepth.at(x, y);
  return map.casterMaterial[static_cast<std::size_t>(y) * static_cast<std::size_t>(map.depth.image.width) +
                            static_cast<std::size_t>(x)];
}

// Grows by a map that shares the image, whatever the map holds: images beside a map have the map's place.
void extend(ShadowImageSource& source, const ShadowMap& map) {
  source.width = std::max(source.width, map.offset[0] + map.depth.image.width);
  source.height = std::max(source.height, map.offset[1] + map.depth.image.height);
  source.layers = std::max(source.layers, map.layer + 1);
}

}  // namespace

Image ShadowImageSource::layer(int index) const {
  // Tiles without a map: a depth in the middle, which a wrong tile would show, and numbers of no material.
  Image image(width, height, 1, content == ShadowContent::Caster ? 0.0f : 0.5f);
  for (const ShadowMap* map : maps) {
    if (map->layer != index) continue;
    for (int y = 0; y < map->depth.image.height; ++y)
      for (int x = 0; x < map->depth.image.width; ++x)
        *image.at(map->offset[0] + x, map->offset[1] + y) = texel(*map, content, x, y);
  }
  return image;
}

ShadowImages shadowImages(const std::vector<Light>& lights) {
  ShadowImages result;
  for (const Light& light : lights)
    for (const ShadowMap& map : light.shadowMaps) {
      std::array<int, 3>& indices = result.ofMap.emplace_back(std::array<int, 3>{-1, -1, -1});
      for (const ShadowContent content : {ShadowContent::Depth, ShadowContent::Exit, ShadowContent::Caster}) {
        if (!holds(map, content)) continue;
        const auto shared =
            std::find_if(result.images.begin(), result.images.end(), [&](const ShadowImageSource& other) {
              return map.sharedImage >= 0 && other.content == content &&
                     other.maps.front()->sharedImage == map.sharedImage;
            });
        const auto found =
            shared != result.images.end() ? shared : result.images.insert(shared, ShadowImageSource{content});
        found->maps.push_back(&map);
        indices[static_cast<std::size_t>(content)] = static_cast<int>(found - result.images.begin());
      }
    }
  for (ShadowImageSource& source : result.images) {
    extend(source, *source.maps.front());
    const int number = source.maps.front()->sharedImage;
    if (number < 0) continue;
    for (const Light& light : lights)
      for (const ShadowMap& map : light.shadowMaps)
        if (map.sharedImage == number) extend(source, map);
  }
  constexpr double kMostBytes = 4e9;  // of an image, as drivers have it at the least
  for (const ShadowImageSource& source : result.images)
    if (4.0 * source.width * source.height * source.layers > kMostBytes)
      throw InputError("", "lights.shadowMap.layer",
                       "an image of " + std::to_string(source.layers) + " layers of " + std::to_string(source.width) + "x" +
                           std::to_string(source.height) + " texels has more than 4 GB; number layers from 0 on");
  return result;
}

bool hasLayers(const std::vector<Light>& lights) {
  return std::any_of(lights.begin(), lights.end(), [](const Light& light) {
    return std::any_of(light.shadowMaps.begin(), light.shadowMaps.end(),
                       [](const ShadowMap& map) { return map.layer > 0; });
  });
}

}  // namespace pellucid::harness
