#include "raster/uploaded_mesh.h"

#include <array>
#include <cstddef>
#include <cstring>

#include "common/error.h"
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

template <class T>
VkDeviceSize byteCount(const std::vector<T>& values) {
  return static_cast<VkDeviceSize>(values.size() * sizeof(T));
}

}  // namespace

UploadedMesh::UploadedMesh(Device& device, const Model& model)
    : vertices_(device, byteCount(model.vertices), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      indices_(device, byteCount(model.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT) {
  if (!device.canDraw()) throw DeviceError(device.description() + " computes but has no queue that draws");
  std::memcpy(vertices_.mapped(), model.vertices.data(), static_cast<std::size_t>(vertices_.size()));
  std::memcpy(indices_.mapped(), model.indices.data(), static_cast<std::size_t>(indices_.size()));
  for (const Texture& texture : model.textures) add(device, texture, VK_FILTER_LINEAR);
  // Its sampler also serves texelFetch from formats that need not filter.
  add(device, {1, 1, {255, 255, 255, 255}}, VK_FILTER_NEAREST);
}

VkPipelineVertexInputStateCreateInfo UploadedMesh::vertexInput() {
  static constexpr VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  static constexpr VkVertexInputAttributeDescription attributes[] = {
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
      {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
      {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
      {3, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
      {4, 0, VK_FORMAT_R32_SFLOAT, offsetof(Vertex, mark)},
      {5, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, normalUv)},
      {6, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)},
      {7, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, lobeUv)},
      {8, 0, VK_FORMAT_R32_SFLOAT, offsetof(Vertex, alpha)}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(std::size(attributes));
  input.pVertexAttributeDescriptions = attributes;
  return input;
}

void UploadedMesh::bind(VkCommandBuffer commandBuffer) const {
  const VkDeviceSize offset = 0;
  const VkBuffer vertexBuffer = vertices_.handle();
  vkCmdBindVertexBuffers(commandBuffer, 0, 1, &vertexBuffer, &offset);
  vkCmdBindIndexBuffer(commandBuffer, indices_.handle(), 0, VK_INDEX_TYPE_UINT32);
}

void UploadedMesh::add(Device& device, const Texture& texture, VkFilter filter) {
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
