#include "gltf/texture.h"

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

}  // namespace

Texture readTexture(const GltfDocument& document, int textureIndex, const std::string& field) {
  const tinygltf::Model& model = document.model;
  const tinygltf::Texture& source =
      model.textures[document.index(textureIndex, model.textures.size(), field, "textures")];
  const std::string textureName = "textures[" + std::to_string(textureIndex) + "]";
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
    document.fail(name, "is neither PNG nor JPEG");
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

}  // namespace pellucid::harness
