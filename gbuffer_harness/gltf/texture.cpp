#include "gltf/texture.h"

#include <algorithm>
#include <cmath>
#include <memory>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STBI_NO_STDIO
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

#include "common/srgb.h"

namespace pellucid::harness {

namespace {

constexpr long long kMaxPixels = 1LL << 26;
// The most pixels in a byte: deflate makes 1032 bytes of one, of 8 pixels each in a PNG of one bit. An image
// that claims more is damaged, and memory would be taken for it. A JPEG cannot have more either, at a bit for
// each block of 64 pixels.
constexpr long long kMaxPixelsPerByte = 8 * 1032;

TextureWrap wrapOf(const GltfDocument& document, int mode, const std::string& field) {
  switch (mode) {
    case TINYGLTF_TEXTURE_WRAP_REPEAT:
      return TextureWrap::Repeat;
    case TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE:
      return TextureWrap::Clamp;
    case TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT:
      return TextureWrap::Mirror;
    default:
      document.fail(field, std::to_string(mode) + " is not a wrap mode");
  }
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

Texture readTexture(const GltfDocument& document, int textureIndex, const std::string& field) {
  const tinygltf::Model& model = document.model;
  const tinygltf::Texture& source =
      model.textures[document.index(textureIndex, model.textures.size(), field, "textures")];
  const std::string textureName = "textures[" + std::to_string(textureIndex) + "]";
  if (source.source < 0)
    document.fail(textureName + ".source",
                  "is missing: the image is in an extension; "
                  "`gltf-transform png in.glb out.glb` makes PNG files, and `ktxdecompress` of KTX files");
  const std::size_t image =
      document.index(source.source, model.images.size(), textureName + ".source", "images");
  const std::string name = "images[" + std::to_string(image) + "]";

  GltfDocument::Bytes bytes{document.images[image].data(), document.images[image].size()};
  if (model.images[image].bufferView >= 0)
    bytes = document.bufferView(model.images[image].bufferView, name);
  else if (bytes.size == 0)
    document.fail(name + ".uri", "\"" + model.images[image].uri + "\" cannot be read");

  const auto* data = static_cast<const stbi_uc*>(bytes.data);
  const int size = static_cast<int>(bytes.size);  // files have at most 2^30 bytes
  int width = 0, height = 0, channels = 0;
  if (!stbi_info_from_memory(data, size, &width, &height, &channels))
    document.fail(name, "is neither PNG nor JPEG; `gltf-transform png in.glb out.glb` makes PNG files");
  if (static_cast<long long>(width) * height > kMaxPixels)
    document.fail(name,
                  std::to_string(width) + " x " + std::to_string(height) + " pixels are more than 2^26");
  if (static_cast<long long>(width) * height > kMaxPixelsPerByte * size)
    document.fail(name, std::to_string(width) + " x " + std::to_string(height) + " pixels cannot be in " +
                            std::to_string(size) + " bytes");
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load_from_memory(data, size, &width, &height, &channels, 4), stbi_image_free);
  if (!pixels) document.fail(name, std::string("cannot be decoded: ") + stbi_failure_reason());

  Texture texture;
  texture.width = width;
  texture.height = height;
  const std::size_t count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 4;
  texture.rgba.assign(pixels.get(), pixels.get() + count);
  if (source.sampler != -1) {
    const std::size_t i =
        document.index(source.sampler, model.samplers.size(), textureName + ".sampler", "samplers");
    const std::string sampler = "samplers[" + std::to_string(i) + "]";
    texture.wrapU = wrapOf(document, model.samplers[i].wrapS, sampler + ".wrapS");
    texture.wrapV = wrapOf(document, model.samplers[i].wrapT, sampler + ".wrapT");
  }
  return texture;
}

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
