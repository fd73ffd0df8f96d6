#include "common/gpu_image.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <limits>

#include "common/error.h"
#include "common/srgb.h"

namespace pellucid::harness {
namespace {

// Finite values stay so: shaders read infinity as no light.
glm::uint16 packFiniteHalf(float v) {
  return glm::packHalf1x16(std::isfinite(v) ? std::clamp(v, -65504.0f, 65504.0f) : v);
}

struct Texel {
  int channels;
  int bytes;  // per channel
};

Texel texelOf(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R32_UINT:
    case VK_FORMAT_R32_SFLOAT:
      return {1, 4};
    case VK_FORMAT_R32G32_SFLOAT:
      return {2, 4};
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return {4, 2};
    case VK_FORMAT_R32G32B32A32_UINT:
    case VK_FORMAT_R32G32B32A32_SFLOAT:
      return {4, 4};
    case VK_FORMAT_R8G8B8A8_SNORM:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
      return {4, 1};
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:  // one word
    case VK_FORMAT_E5B9G9R9_UFLOAT_PACK32:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      return {1, 4};
    case VK_FORMAT_R16G16_SNORM:
      return {2, 2};
    case VK_FORMAT_R8_UINT:
    case VK_FORMAT_R8_UNORM:
      return {1, 1};
    default:
      throw DeviceError("GpuImage does not know VkFormat " + std::to_string(format));
  }
}

// A float of 5 bits of exponent and `mantissa` bits, without sign. GLM's truncates, and has neither 0 nor denormals.
glm::uint32 packSmallFloat(float v, int mantissa) {
  if (std::isnan(v)) return (32u << mantissa) - 1;
  if (!(v > 0)) return 0;
  if (std::isinf(v)) return 31u << mantissa;
  const float largest = std::ldexp(2.0f, 15) - std::ldexp(1.0f, 15 - mantissa);
  v = std::min(v, largest);
  const int exponent = std::max(std::ilogb(v), -14);
  return static_cast<glm::uint32>(std::lround(std::ldexp(v, mantissa - exponent)) + ((exponent + 14L) << mantissa));
}

float unpackSmallFloat(glm::uint32 bits, int mantissa) {
  const glm::uint32 exponent = bits >> mantissa & 31u, steps = bits & ((1u << mantissa) - 1);
  if (exponent == 31) return steps == 0 ? std::numeric_limits<float>::infinity() : std::numeric_limits<float>::quiet_NaN();
  const float value = static_cast<float>(exponent == 0 ? steps : steps + (1u << mantissa));
  return std::ldexp(value, std::max(static_cast<int>(exponent), 1) - 15 - mantissa);
}

// Packs a texel of a format whose texels are one word; nullptr: another format.
glm::uint32 (*packing(VkFormat format))(const glm::vec4&) {
  switch (format) {
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
      return [](const glm::vec4& v) { return packB10G11R11(glm::vec3(v)); };
    case VK_FORMAT_E5B9G9R9_UFLOAT_PACK32:
      return [](const glm::vec4& v) { return glm::packF3x9_E1x5(glm::vec3(v)); };
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      return [](const glm::vec4& v) { return glm::packUnorm3x10_1x2(v); };
    default:
      return nullptr;
  }
}

// The way back of formats that download() reads.
glm::vec3 (*unpacking(VkFormat format))(glm::uint32) {
  switch (format) {
    case VK_FORMAT_B10G11R11_UFLOAT_PACK32:
      return unpackB10G11R11;
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
      return [](glm::uint32 word) { return glm::vec3(glm::unpackUnorm3x10_1x2(word)); };
    default:
      return nullptr;
  }
}

// From any layout and use to GENERAL, ready for everything: the harness values clarity over overlap.
void barrier(VkCommandBuffer commandBuffer, VkImage image, VkImageLayout from, int layer = 0) {
  VkImageMemoryBarrier b{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  b.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  b.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  b.oldLayout = from;
  b.newLayout = VK_IMAGE_LAYOUT_GENERAL;
  b.srcQueueFamilyIndex = b.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  b.image = image;
  b.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, static_cast<uint32_t>(layer), 1};
  vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                       0, 0, nullptr, 0, nullptr, 1, &b);
}

VkBufferImageCopy wholeImage(int width, int height, int layer = 0) {
  VkBufferImageCopy region{};
  region.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, static_cast<uint32_t>(layer), 1};
  region.imageExtent = {static_cast<uint32_t>(width), static_cast<uint32_t>(height), 1};
  return region;
}

}  // namespace

glm::uint32 packB10G11R11(const glm::vec3& c) {
  return packSmallFloat(c.r, 6) | packSmallFloat(c.g, 6) << 11 | packSmallFloat(c.b, 5) << 22;
}

glm::vec3 unpackB10G11R11(glm::uint32 word) {
  return {unpackSmallFloat(word, 6), unpackSmallFloat(word >> 11, 6), unpackSmallFloat(word >> 22, 5)};
}

GpuImage::GpuImage(Device& device, int width, int height, VkFormat format, VkImageUsageFlags more, int layers)
    : device_(device), width_(width), height_(height), format_(format) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {static_cast<uint32_t>(width), static_cast<uint32_t>(height), 1};
  info.mipLevels = 1;
  info.arrayLayers = static_cast<uint32_t>(std::max(layers, 1));
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.usage =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT | more;
  constexpr VkFormat kNotStorage[] = {
      VK_FORMAT_R32G32_SFLOAT,          VK_FORMAT_R16G16_SNORM, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
      VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, VK_FORMAT_R8_UINT,      VK_FORMAT_R8_UNORM,
      VK_FORMAT_R8G8B8A8_SRGB};
  if (std::find(std::begin(kNotStorage), std::end(kNotStorage), format) == std::end(kNotStorage))
    info.usage |= VK_IMAGE_USAGE_STORAGE_BIT;
  const auto limit = static_cast<int>(device.properties().limits.maxImageDimension2D);
  if (width < 1 || height < 1 || width > limit || height > limit)
    throw DeviceError("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                      " does not fit the device, whose limit is " + std::to_string(limit));
  device.share(info);
  check(vkCreateImage(device.handle(), &info, nullptr, &image_), "vkCreateImage");
  VkMemoryRequirements needs;
  vkGetImageMemoryRequirements(device.handle(), image_, &needs);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needs.size;
  allocate.memoryTypeIndex = device.memoryType(needs.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT);
  check(vkAllocateMemory(device.handle(), &allocate, nullptr, &memory_), "vkAllocateMemory");
  check(vkBindImageMemory(device.handle(), image_, memory_, 0), "vkBindImageMemory");
  VkImageViewCreateInfo view{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view.image = image_;
  view.viewType = layers > 0 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  view.format = format;
  view.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, info.arrayLayers};
  check(vkCreateImageView(device.handle(), &view, nullptr, &view_), "vkCreateImageView");
}

GpuImage::~GpuImage() {
  vkDestroyImageView(device_.handle(), view_, nullptr);
  vkDestroyImage(device_.handle(), image_, nullptr);
  vkFreeMemory(device_.handle(), memory_, nullptr);
}

VkDeviceSize GpuImage::bytes(int width, int height) const {
  const Texel texel = texelOf(format_);
  return static_cast<VkDeviceSize>(width) * static_cast<VkDeviceSize>(height * texel.channels * texel.bytes);
}

void GpuImage::copyFrom(VkCommandBuffer commandBuffer, VkBuffer buffer, int layer) const {
  barrier(commandBuffer, image_, VK_IMAGE_LAYOUT_UNDEFINED, layer);
  const VkBufferImageCopy region = wholeImage(width_, height_, layer);
  vkCmdCopyBufferToImage(commandBuffer, buffer, image_, VK_IMAGE_LAYOUT_GENERAL, 1, &region);
  barrier(commandBuffer, image_, VK_IMAGE_LAYOUT_GENERAL, layer);
}

void GpuImage::transfer(const void* source, int layer) {
  const HostBuffer staging(device_, bytes(), VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  std::memcpy(staging.mapped(), source, static_cast<size_t>(bytes()));
  device_.run([&](VkCommandBuffer commandBuffer) { copyFrom(commandBuffer, staging.handle(), layer); });
  device_.countTransfer(bytes(), 0);
}

void GpuImage::upload(const Image& source, int layer) {
  if (source.width != width_ || source.height != height_)
    throw DeviceError("upload of " + std::to_string(source.width) + " x " + std::to_string(source.height) +
                      " into an image of " + std::to_string(width_) + " x " + std::to_string(height_));
  if (const auto pack = packing(format_)) {
    std::vector<glm::uint32> words(source.pixels());
    for (size_t i = 0; i < words.size(); ++i) {
      const float* p = source.data.data() + i * static_cast<size_t>(source.channels);
      words[i] = pack({p[0], p[1], p[2], source.channels > 3 ? p[3] : 1.0f});
    }
    return transfer(words.data(), layer);
  }
  const Texel texel = texelOf(format_);
  std::vector<float> full(source.pixels() * static_cast<size_t>(texel.channels));
  for (size_t i = 0; i < source.pixels(); ++i)
    for (int c = 0; c < texel.channels; ++c)
      full[i * static_cast<size_t>(texel.channels) + static_cast<size_t>(c)] =
          c < source.channels ? source.data[i * static_cast<size_t>(source.channels) + static_cast<size_t>(c)]
                              : (c == 3 ? 1.0f : 0.0f);
  if (texel.bytes == 4) return transfer(full.data(), layer);
  if (texel.bytes == 1) {
    std::vector<glm::uint8> bytes(full.size());
    const auto pack = format_ == VK_FORMAT_R8G8B8A8_SNORM ? &glm::packSnorm1x8 : &glm::packUnorm1x8;
    std::transform(full.begin(), full.end(), bytes.begin(), pack);
    return transfer(bytes.data(), layer);
  }
  std::vector<glm::uint16> words(full.size());
  const auto pack = format_ == VK_FORMAT_R16G16_SNORM ? &glm::packSnorm1x16 : &packFiniteHalf;
  std::transform(full.begin(), full.end(), words.begin(), pack);
  transfer(words.data(), layer);
}

void GpuImage::upload(const std::vector<std::uint32_t>& source, int layer) {
  if (source.size() * sizeof source[0] != bytes())
    throw DeviceError("upload of " + std::to_string(source.size()) + " words into an image of " +
                      std::to_string(bytes()) + " bytes");
  transfer(source.data(), layer);
}

void GpuImage::upload(const std::vector<std::uint8_t>& source, int layer) {
  if (source.size() != static_cast<size_t>(width_) * static_cast<size_t>(height_))
    throw DeviceError("upload of " + std::to_string(source.size()) + " bytes into an image of " +
                      std::to_string(width_) + " x " + std::to_string(height_));
  transfer(source.data(), layer);
}

void GpuImage::recordClear(VkCommandBuffer commandBuffer) const {
  constexpr VkClearColorValue kZero{};
  constexpr VkImageSubresourceRange kFirst{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  vkCmdClearColorImage(commandBuffer, image_, VK_IMAGE_LAYOUT_GENERAL, &kZero, 1, &kFirst);
}

void GpuImage::clear(std::uint8_t byte) {
  if (byte == 0)
    return device_.run([&](VkCommandBuffer commandBuffer) {
      barrier(commandBuffer, image_, VK_IMAGE_LAYOUT_UNDEFINED);
      recordClear(commandBuffer);
      barrier(commandBuffer, image_, VK_IMAGE_LAYOUT_GENERAL);
    });
  // Fills go by whole words.
  const HostBuffer staging(device_, (bytes() + 3) / 4 * 4,
                           VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  device_.run([&](VkCommandBuffer commandBuffer) {
    vkCmdFillBuffer(commandBuffer, staging.handle(), 0, VK_WHOLE_SIZE, byte * 0x01010101u);
    const VkMemoryBarrier filled{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_TRANSFER_WRITE_BIT,
                                 VK_ACCESS_TRANSFER_READ_BIT};
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 1,
                         &filled, 0, nullptr, 0, nullptr);
    copyFrom(commandBuffer, staging.handle());
  });
}

void GpuImage::fill(std::uint64_t seed, std::uint32_t most) {
  std::vector<std::uint64_t> words((bytes() + 7) / 8);
  std::uint64_t state = seed | 1;  // xorshift64 stays at 0
  for (std::uint64_t& word : words) {
    state ^= state << 13;
    state ^= state >> 7;
    state ^= state << 17;
    word = state;
    if (most >= 255) continue;
    for (int byte = 0; byte < 8; ++byte) {
      const std::uint64_t value = (state >> 8 * byte & 255) % (most + 1);
      word = (word & ~(std::uint64_t{255} << 8 * byte)) | value << 8 * byte;
    }
  }
  transfer(words.data());
}

Image GpuImage::download() const {
  return download({{0, 0}, {static_cast<uint32_t>(width_), static_cast<uint32_t>(height_)}});
}

Image GpuImage::download(const VkRect2D& rect) const {
  const Texel texel = texelOf(format_);
  const auto unpack = unpacking(format_);
  const int width = static_cast<int>(rect.extent.width), height = static_cast<int>(rect.extent.height);
  Image result(width, height, unpack ? 3 : texel.channels);
  HostBuffer staging(device_, bytes(width, height), VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  device_.countTransfer(0, bytes(width, height));
  device_.run([&](VkCommandBuffer commandBuffer) {
    barrier(commandBuffer, image_, VK_IMAGE_LAYOUT_GENERAL);
    VkBufferImageCopy region = wholeImage(width, height);
    region.imageOffset = {rect.offset.x, rect.offset.y, 0};
    vkCmdCopyImageToBuffer(commandBuffer, image_, VK_IMAGE_LAYOUT_GENERAL, staging.handle(), 1, &region);
  });
  if (unpack) {
    const auto* words = static_cast<const glm::uint32*>(staging.mapped());
    for (size_t i = 0; i < result.pixels(); ++i) {
      const glm::vec3 color = unpack(words[i]);
      for (int c = 0; c < 3; ++c) result.data[3 * i + static_cast<size_t>(c)] = color[c];
    }
  } else if (format_ == VK_FORMAT_R8G8B8A8_SRGB) {
    const auto* bytes = static_cast<const std::uint8_t*>(staging.mapped());
    for (size_t i = 0; i < result.data.size(); ++i)
      result.data[i] = i % 4 == 3 ? glm::unpackUnorm1x8(bytes[i]) : static_cast<float>(linearOf(bytes[i]));
  } else if (texel.bytes == 4) {
    std::memcpy(result.data.data(), staging.mapped(), result.data.size() * sizeof(float));
  } else if (texel.bytes == 2) {
    const auto* half = static_cast<const glm::uint16*>(staging.mapped());
    std::transform(half, half + result.data.size(), result.data.begin(),
                   [](glm::uint16 v) { return glm::unpackHalf1x16(v); });
  } else {
    const auto* bytes = static_cast<const std::uint8_t*>(staging.mapped());
    std::transform(bytes, bytes + result.data.size(), result.data.begin(), [this](std::uint8_t v) {
      return format_ == VK_FORMAT_R8G8B8A8_SNORM                                    ? glm::unpackSnorm1x8(v)
             : format_ == VK_FORMAT_R8_UNORM || format_ == VK_FORMAT_R8G8B8A8_UNORM ? glm::unpackUnorm1x8(v)
                                                                                    : static_cast<float>(v);
    });
  }
  return result;
}

}  // namespace pellucid::harness
