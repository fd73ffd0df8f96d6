#include "raster/irradiance.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kRasterIrradiance.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

static_assert(PELLUCID_SHADER_LIGHT_DIRECTIONAL == PELLUCID_LIGHT_DIRECTIONAL);
static_assert(PELLUCID_SHADER_LIGHT_SPOT == PELLUCID_LIGHT_SPOT);

// The uniform block of shaders/irradiance.comp.
struct Constants {
  glm::mat4 viewFromWorld, shadowFromView;
  glm::vec4 shadowPlanar, shadow, eye;
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

void setShadow(Constants& constants, const ShadowImage& shadow, const glm::dmat4& worldFromView) {
  const glm::dmat4 shadowView = toGlm(shadow.viewFromWorld) * worldFromView;
  constants.shadowFromView = glm::mat4(toGlm(shadow.clipFromView) * shadowView);
  constants.shadowPlanar = -glm::vec4(glm::transpose(shadowView)[2]);
  // The view is 2 / clipFromView[0] wide, at planar distance 1 if it is a perspective.
  const double texel = 2 / shadow.clipFromView[0] / shadow.size;
  constants.shadow = glm::vec4(shadow.size, shadow.perspective, texel, 0);
}

}  // namespace

IrradiancePass::IrradiancePass(Device& device, const GpuImage& normalPlanar, int width, int height,
                               const DrawView& view)
    : device_(device),
      normalPlanar_(normalPlanar),
      width_(width),
      height_(height),
      view_(view),
      irradiance_(device, width, height, VK_FORMAT_R32G32B32A32_SFLOAT),
      sampler_(device),
      setLayout_(device),
      layout_(device),
      pipeline_(device) {
  irradiance_.clear();
  createPipeline();
}

void IrradiancePass::createPipeline() {
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, sampler_.receive()), "vkCreateSampler");

  const VkDescriptorType types[] = {
      VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
      VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE};
  VkDescriptorSetLayoutBinding bindings[std::size(types)]{};
  for (std::uint32_t i = 0; i < std::size(types); ++i)
    bindings[i] = {i, types[i], 1, VK_SHADER_STAGE_COMPUTE_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<std::uint32_t>(std::size(bindings));
  set.pBindings = bindings;
  check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, setLayout_.receive()),
        "vkCreateDescriptorSetLayout");
  const VkDescriptorSetLayout sets[] = {setLayout_};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = sets;
  check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, layout_.receive()),
        "vkCreatePipelineLayout");

  Owned<VkShaderModule, vkDestroyShaderModule> shader(device_);
  VkShaderModuleCreateInfo code{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  code.codeSize = sizeof kRasterIrradiance;
  code.pCode = kRasterIrradiance;
  check(vkCreateShaderModule(device_.handle(), &code, nullptr, shader.receive()), "vkCreateShaderModule");
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = {VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
  info.stage.module = shader;
  info.stage.pName = "main";
  info.layout = layout_;
  check(vkCreateComputePipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline_.receive()),
        "vkCreateComputePipelines");
  pushDescriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(device_.handle(), "vkCmdPushDescriptorSetKHR"));
}

void IrradiancePass::add(const Light& light, const ShadowImage* shadow) {
  const glm::dmat4 viewFromWorld = toGlm(view_.viewFromWorld);
  Constants constants{};
  constants.viewFromWorld = glm::mat4(viewFromWorld);
  constants.light = lightConstants(light, viewFromWorld);
  const bool perspective = view_.clipFromView[15] == 0;
  constants.eye = glm::vec4(1 / view_.clipFromView[0], 1 / view_.clipFromView[5], perspective, 0);
  if (shadow) setShadow(constants, *shadow, glm::inverse(viewFromWorld));
  const HostBuffer buffer(device_, sizeof constants, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT);
  std::memcpy(buffer.mapped(), &constants, sizeof constants);

  const GpuImage* images[] = {&normalPlanar_, shadow ? shadow->planar : &normalPlanar_, &irradiance_};
  VkDescriptorImageInfo imageInfos[std::size(images)];
  const VkDescriptorBufferInfo bufferInfo{buffer.handle(), 0, VK_WHOLE_SIZE};
  VkWriteDescriptorSet writes[1 + std::size(images)];
  for (std::uint32_t i = 0; i < std::size(writes); ++i) {
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
  }
  writes[0].descriptorType = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  writes[0].pBufferInfo = &bufferInfo;
  for (std::uint32_t i = 0; i < std::size(images); ++i) {
    imageInfos[i] = {sampler_, images[i]->use().view, images[i]->use().layout};
    writes[1 + i].descriptorType = images[i] == &irradiance_ ? VK_DESCRIPTOR_TYPE_STORAGE_IMAGE
                                                             : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[1 + i].pImageInfo = &imageInfos[i];
  }
  device_.run([&](VkCommandBuffer commandBuffer) {
    vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline_);
    pushDescriptors_(commandBuffer, VK_PIPELINE_BIND_POINT_COMPUTE, layout_, 0,
                     static_cast<std::uint32_t>(std::size(writes)), writes);
    const auto groups = [](int pixels, int size) {
      return static_cast<std::uint32_t>((pixels + size - 1) / size);
    };
    vkCmdDispatch(commandBuffer, groups(width_, PELLUCID_GROUP_X), groups(height_, PELLUCID_GROUP_Y), 1);
    // The next light, or the download, reads what this one wrote.
    const VkMemoryBarrier barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, VK_ACCESS_SHADER_WRITE_BIT,
                                  VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT};
    vkCmdPipelineBarrier(commandBuffer, VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 1, &barrier, 0, nullptr, 0, nullptr);
  });
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
