#include "raster/irradiance.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "kRasterIrradiance.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

// The bindings of shaders/irradiance.comp.
constexpr VkDescriptorType kTypes[] = {
    VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
    VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER};
constexpr std::uint32_t kShadowBinding = 2, kIrradianceBinding = 3, kTrianglesBinding = 4;

static_assert(PELLUCID_SHADER_LIGHT_DIRECTIONAL == PELLUCID_LIGHT_DIRECTIONAL);
static_assert(PELLUCID_SHADER_LIGHT_SPOT == PELLUCID_LIGHT_SPOT);

constexpr std::uint32_t kShadowMaps = 6;  // SHADOW_MAPS

// The uniform block.
struct Constants {
  struct ShadowView {
    glm::mat4 clipFromView;
    glm::vec4 planar;
  };
  glm::mat4 viewFromWorld;
  ShadowView shadowViews[kShadowMaps];
  glm::vec4 shadow, eye;
  shared::LightConstants light;
};

shared::LightConstants lightConstants(const Light& light, const glm::dmat4& viewFromWorld) {
  shared::LightConstants constants{};
  constants.meta.x = light.type;
  constants.radiance = glm::vec4(toGlm(light.color) * light.intensity, 0);
  constants.position = glm::vec4(viewFromWorld * glm::dvec4(toGlm(light.position), 1));
  constants.position.w = static_cast<float>(light.range > 0 ? 1 / light.range : 0);
  constants.direction = glm::vec4(glm::normalize(glm::dmat3(viewFromWorld) * toGlm(light.direction)), 0);
  // KHR_lights_punctual, "Inner and Outer Cone Angles"; 0.001 is its own guard.
  const double outer = std::cos(light.outerConeAngle);
  const double scale = 1 / std::max(0.001, std::cos(light.innerConeAngle) - outer);
  constants.cone = glm::vec4(scale, -outer * scale, 0, 0);
  return constants;
}

void setShadows(Constants& constants, const std::vector<ShadowImage>& shadows,
                const glm::dmat4& worldFromView) {
  for (std::size_t i = 0; i < shadows.size(); ++i) {
    const glm::dmat4 shadowView = toGlm(shadows[i].viewFromWorld) * worldFromView;
    constants.shadowViews[i] = {glm::mat4(toGlm(shadows[i].clipFromView) * shadowView),
                                -glm::vec4(glm::transpose(shadowView)[2])};
  }
  if (shadows.empty()) return;
  // The view is 2 / clipFromView[0] wide, at planar distance 1 if it is a perspective.
  const ShadowImage& first = shadows.front();
  const double texel = 2 / first.clipFromView[0] / first.size;
  constants.shadow = glm::vec4(first.size, first.perspective, texel, shadows.size());
}

std::vector<VkDescriptorSetLayoutBinding> layoutBindings() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < std::size(kTypes); ++i)
    bindings.push_back(
        {i, kTypes[i], i == kShadowBinding ? kShadowMaps : 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr});
  return bindings;
}

}  // namespace

IrradiancePass::IrradiancePass(Device& device, const GpuImage& normalPlanar, const GpuImage& depthNormal,
                               int width, int height, const DrawView& view)
    : device_(device),
      normalPlanar_(normalPlanar),
      depthNormal_(depthNormal),
      width_(width),
      height_(height),
      view_(view),
      irradiance_(device, width, height, VK_FORMAT_R32G32B32A32_SFLOAT),
      sampler_(device),
      layout_(device, layoutBindings()),
      pipeline_(device) {
  irradiance_.clear();
  createPipeline();
}

void IrradiancePass::createPipeline() {
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, sampler_.receive()), "vkCreateSampler");

  ShaderModule shader(device_);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage =
      loadStage(device_, VK_SHADER_STAGE_COMPUTE_BIT, {kRasterIrradiance, sizeof kRasterIrradiance}, shader);
  info.layout = layout_;
  check(vkCreateComputePipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline_.receive()),
        "vkCreateComputePipelines");
}

void IrradiancePass::add(const Light& light, const std::vector<ShadowImage>& shadows) {
  device_.run(recorder(light, shadows));
}

std::function<void(VkCommandBuffer)> IrradiancePass::recorder(const Light& light,
                                                              const std::vector<ShadowImage>& shadows) const {
  const glm::dmat4 viewFromWorld = toGlm(view_.viewFromWorld);
  Constants constants{};
  constants.viewFromWorld = glm::mat4(viewFromWorld);
  constants.light = lightConstants(light, viewFromWorld);
  const bool perspective = view_.clipFromView[15] == 0;
  constants.eye = glm::vec4(1 / view_.clipFromView[0], 1 / view_.clipFromView[5], perspective, 0);
  setShadows(constants, shadows, glm::inverse(viewFromWorld));
  const auto buffer =
      std::make_shared<HostBuffer>(device_, sizeof constants, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  std::memcpy(buffer->mapped(), &constants, sizeof constants);
  return [this, buffer, shadows](VkCommandBuffer commandBuffer) { record(commandBuffer, *buffer, shadows); };
}

void IrradiancePass::record(VkCommandBuffer commandBuffer, const HostBuffer& constants,
                            const std::vector<ShadowImage>& shadows) const {
  const auto imageInfo = [&](const GpuImage& image) {
    return VkDescriptorImageInfo{sampler_, image.use().view, image.use().layout};
  };
  const VkDescriptorBufferInfo bufferInfo{constants.handle(), 0, VK_WHOLE_SIZE};
  const VkDescriptorImageInfo surface = imageInfo(normalPlanar_), triangles = imageInfo(depthNormal_),
                              target = imageInfo(irradiance_);
  // A descriptor that is not read must be valid all the same.
  VkDescriptorImageInfo maps[kShadowMaps];
  for (std::size_t i = 0; i < kShadowMaps; ++i)
    maps[i] = imageInfo(i < shadows.size() ? *shadows[i].planar : normalPlanar_);
  VkWriteDescriptorSet writes[std::size(kTypes)];
  for (std::uint32_t i = 0; i < std::size(writes); ++i) {
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = i;
    writes[i].descriptorCount = i == kShadowBinding ? kShadowMaps : 1;
    writes[i].descriptorType = kTypes[i];
  }
  writes[0].pBufferInfo = &bufferInfo;
  writes[1].pImageInfo = &surface;
  writes[kShadowBinding].pImageInfo = maps;
  writes[kIrradianceBinding].pImageInfo = &target;
  writes[kTrianglesBinding].pImageInfo = &triangles;
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
  layout_.push(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, writes);
  const auto groups = [](int pixels, int size) {
    return static_cast<std::uint32_t>((pixels + size - 1) / size);
  };
  vkCmdDispatch(commandBuffer, groups(width_, PELLUCID_GROUP_X), groups(height_, PELLUCID_GROUP_Y), 1);
  // The next light, or the download, reads what this one wrote.
  const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                                VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
  vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                       VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
}

Image IrradiancePass::irradiance() const {
  const Image rgba = irradiance_.download();
  Image rgb(width_, height_, 3);
  for (std::size_t i = 0; i < rgb.pixels(); ++i)
    std::copy_n(rgba.data.begin() + static_cast<std::ptrdiff_t>(4 * i), 3,
                rgb.data.begin() + static_cast<std::ptrdiff_t>(3 * i));
  return rgb;
}

}  // namespace pellucid::harness
