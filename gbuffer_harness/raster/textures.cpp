#include "raster/textures.h"

#include <array>

#include "common/srgb.h"

namespace pellucid::harness {

namespace {

Image linearImage(const Texture& texture) {
  std::array<float, 256> linear;
  for (std::size_t i = 0; i < linear.size(); ++i)
    linear[i] = texture.isNormalMap ? static_cast<float>(i) / 127.5f - 1
                                    : static_cast<float>(linearOf(static_cast<std::uint8_t>(i)));
  Image image(texture.width, texture.height, 4);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    image.data[i] = i % 4 == 3 ? static_cast<float>(texture.rgba[i]) / 255.0f : linear[texture.rgba[i]];
  return image;
}

VkSamplerAddressMode addressMode(TextureWrap wrap) {
  return wrap == TextureWrap::Repeat  ? VK_SAMPLER_ADDRESS_MODE_REPEAT
         : wrap == TextureWrap::Clamp ? VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE
                                      : VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT;
}

}  // namespace

UploadedTextures::UploadedTextures(Device& device, const Model& model) {
  for (const Texture& texture : model.textures) add(device, texture, VK_FILTER_LINEAR);
  // Its sampler also serves texelFetch from formats that need not filter.
  add(device, {1, 1, {255, 255, 255, 255}}, VK_FILTER_NEAREST);
}

void UploadedTextures::add(Device& device, const Texture& texture, VkFilter filter) {
  images_.push_back(
      std::make_unique<GpuImage>(device, texture.width, texture.height, VK_FORMAT_R16G16B16A16_SFLOAT));
  images_.back()->upload(linearImage(texture));
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = info.minFilter = filter;
  info.addressModeU = addressMode(texture.wrapU);
  info.addressModeV = addressMode(texture.wrapV);
  samplers_.push_back(std::make_unique<Owned<VkSampler, vkDestroySampler>>(device));
  check(vkCreateSampler(device.handle(), &info, nullptr, samplers_.back()->receive()), "vkCreateSampler");
}

}  // namespace pellucid::harness
