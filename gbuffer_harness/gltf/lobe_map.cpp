#include "gltf/lobe_map.h"

#include <algorithm>
#include <cmath>

#include "common/srgb.h"
#include "gltf/texture.h"

namespace pellucid::harness {

namespace {

// The inverse of linearOf().
std::uint8_t srgbOf(double linear) {
  const double v = linear <= 0.0031308 ? linear * 12.92 : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0, 1.0)));
}

using Rgba = std::array<double, 4>;

// A texture as a factor: its color, or its alpha, and 1 in what remains.
class Layer {
public:
  Layer(Texture texture, bool isStrength) : texture_(std::move(texture)), isStrength_(isStrength) {
    for (std::size_t i = 0; i < linear_.size(); ++i) linear_[i] = linearOf(static_cast<std::uint8_t>(i));
  }

  // Texel (x, y) of this image when it has `width` x `height` texels.
  Rgba at(int x, int y, int width, int height) const {
    const auto scaled = [](int i, int size, int of) {
      return static_cast<std::size_t>(static_cast<long long>(i) * size / of);
    };
    return texel(scaled(y, texture_.height, height) * static_cast<std::size_t>(texture_.width) +
                 scaled(x, texture_.width, width));
  }
  Rgba mean() const {
    Rgba sum = {0, 0, 0, 0};
    const std::size_t count = texture_.rgba.size() / 4;
    for (std::size_t i = 0; i < count; ++i)
      for (std::size_t c = 0; c < 4; ++c) sum[c] += texel(i)[c];
    for (double& value : sum) value /= static_cast<double>(count);
    return sum;
  }

private:
  Rgba texel(std::size_t i) const {
    const std::uint8_t* t = &texture_.rgba[4 * i];
    return isStrength_ ? Rgba{1, 1, 1, t[3] / 255.0} : Rgba{linear_[t[0]], linear_[t[1]], linear_[t[2]], 1};
  }

  Texture texture_;
  bool isStrength_;
  std::array<double, 256> linear_;
};

}  // namespace

std::optional<LobeMap> readLobeMap(const GltfDocument& document, const std::vector<TextureUse>& colors,
                                   const std::optional<TextureUse>& strength,
                                   std::vector<std::string>& warnings) {
  std::vector<TextureUse> uses = colors;
  if (strength) uses.push_back(*strength);
  if (uses.empty()) return std::nullopt;
  LobeMap map;
  map.coord = uses.front().coord;
  map.texture.width = map.texture.height = 1;
  std::vector<Layer> layers;
  Rgba constant = {1, 1, 1, 1};
  for (std::size_t i = 0; i < uses.size(); ++i) {
    const Texture texture = readTexture(document, uses[i].texture, uses[i].field + ".index");
    const Layer layer(texture, i >= colors.size());
    if (uses[i].coord != map.coord) {
      const Rgba mean = layer.mean();
      for (std::size_t c = 0; c < 4; ++c) constant[c] *= mean[c];
      warnings.push_back(uses[i].field + ": has other texture coordinates than " + uses.front().field +
                         "; its mean stands in for it");
      continue;
    }
    if (i == 0) {
      map.texture.wrapU = texture.wrapU;
      map.texture.wrapV = texture.wrapV;
    }
    map.texture.width = std::max(map.texture.width, texture.width);
    map.texture.height = std::max(map.texture.height, texture.height);
    layers.push_back(layer);
  }
  map.mean = {0, 0, 0};
  for (int y = 0; y < map.texture.height; ++y)
    for (int x = 0; x < map.texture.width; ++x) {
      Rgba product = constant;
      for (const Layer& layer : layers) {
        const Rgba texel = layer.at(x, y, map.texture.width, map.texture.height);
        for (std::size_t c = 0; c < 4; ++c) product[c] *= texel[c];
      }
      for (std::size_t c = 0; c < 3; ++c) {
        map.mean[c] += product[c] * product[3];
        map.texture.rgba.push_back(srgbOf(product[c]));
      }
      map.texture.rgba.push_back(static_cast<std::uint8_t>(std::lround(255 * product[3])));
    }
  for (double& value : map.mean) value /= static_cast<double>(map.texture.width) * map.texture.height;
  return map;
}

}  // namespace pellucid::harness
