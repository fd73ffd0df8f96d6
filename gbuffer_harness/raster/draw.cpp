#include "raster/draw.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <deque>
#include <glm/gtc/packing.hpp>

#include "common/error.h"
#include "common/srgb.h"
#include "kRasterCaster.h"
#include "kRasterCount.h"
#include "kRasterDepth.h"
#include "kRasterMesh.h"
#include "kRasterReflected.h"
#include "kRasterSurface.h"
#include "kRasterTransmit.h"
#include "replay/frame.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

// Of shaders/draw.glsl.
constexpr std::uint32_t kOwnBindings = 5, kBehindFront = 1, kBehindCaster = 2, kLobesApart = 256;

using ShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

struct Spirv {
  const std::uint32_t* words;
  std::size_t bytes;
};

Spirv fragmentSpirv(FragmentShader shader) {
  switch (shader) {
    case FragmentShader::Surface:
      return {kRasterSurface, sizeof kRasterSurface};
    case FragmentShader::Depth:
      return {kRasterDepth, sizeof kRasterDepth};
    case FragmentShader::Caster:
      return {kRasterCaster, sizeof kRasterCaster};
    case FragmentShader::Count:
      return {kRasterCount, sizeof kRasterCount};
    case FragmentShader::Reflected:
      return {kRasterReflected, sizeof kRasterReflected};
    case FragmentShader::Transmit:
      return {kRasterTransmit, sizeof kRasterTransmit};
  }
  throw DeviceError("no such fragment shader");
}

VkPipelineShaderStageCreateInfo loadStage(Device& device, VkShaderStageFlagBits stage, Spirv code,
                                          ShaderModule& shader) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code.bytes;
  info.pCode = code.words;
  check(vkCreateShaderModule(device.handle(), &info, nullptr, shader.receive()), "vkCreateShaderModule");
  VkPipelineShaderStageCreateInfo result{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  result.stage = stage;
  result.module = shader;
  result.pName = "main";
  return result;
}

template <class T>
VkDeviceSize byteCount(const std::vector<T>& values) {
  return static_cast<VkDeviceSize>(values.size() * sizeof(T));
}

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

glm::vec4 vec4(const std::array<double, 3>& rgb, double w) {
  return {static_cast<float>(rgb[0]), static_cast<float>(rgb[1]), static_cast<float>(rgb[2]),
          static_cast<float>(w)};
}

// A half float in the upper 16 bits.
std::uint32_t highHalf(double value) {
  return glm::packHalf2x16({0.0f, static_cast<float>(std::min(value, 65504.0))});
}

// Bindings of the module's fused dispatch that shaders/transmit.frag reads; they follow those of draw.glsl.
struct PlannedBinding {
  std::uint32_t binding;
  VkDescriptorType type;
};
std::vector<PlannedBinding> plannedBindings() {
  constexpr VkDescriptorType buffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  constexpr VkDescriptorType image = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  std::vector<PlannedBinding> all = {{PELLUCID_BINDING_FRAME, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                                     {PELLUCID_BINDING_LIGHTS, buffer},
                                     {PELLUCID_BINDING_SHADOWS, buffer},
                                     {PELLUCID_BINDING_MATERIALS, buffer},
                                     {PELLUCID_BINDING_NORMAL, image},
                                     {PELLUCID_BINDING_MATERIAL, image}};
  for (std::uint32_t i = 0; i < PELLUCID_SHADOW_IMAGE_COUNT; ++i)
    all.push_back({PELLUCID_BINDING_SHADOW_IMAGES + i, image});
  return all;
}

// The writes of one push, with what they point to.
class DescriptorWrites {
public:
  void image(std::uint32_t binding, VkDescriptorType type, VkSampler sampler, const PellucidImage& use) {
    images_.push_back({sampler, use.view, use.layout});
    add(binding, type).pImageInfo = &images_.back();
  }
  void buffer(std::uint32_t binding, VkDescriptorType type, const VkDescriptorBufferInfo& range) {
    buffers_.push_back(range);
    add(binding, type).pBufferInfo = &buffers_.back();
  }
  const std::vector<VkWriteDescriptorSet>& all() const { return writes_; }

private:
  VkWriteDescriptorSet& add(std::uint32_t binding, VkDescriptorType type) {
    VkWriteDescriptorSet& write =
        writes_.emplace_back(VkWriteDescriptorSet{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET});
    write.dstBinding = binding;
    write.descriptorCount = 1;
    write.descriptorType = type;
    return write;
  }

  std::deque<VkDescriptorImageInfo> images_;  // a deque's elements stay where they are
  std::deque<VkDescriptorBufferInfo> buffers_;
  std::vector<VkWriteDescriptorSet> writes_;
};

void addPlanned(const PlannedInputs& planned, DescriptorWrites& writes) {
  for (const PlannedBinding& wanted : plannedBindings())
    for (std::uint32_t i = 0; i < planned.dispatch.bindingCount; ++i) {
      const PellucidBinding& b = planned.dispatch.bindings[i];
      if (b.binding != wanted.binding) continue;
      const std::uint32_t to = kOwnBindings + b.binding;
      if (b.resource == PELLUCID_RESOURCE_CONSTANTS)
        writes.buffer(to, wanted.type, {planned.constants, b.offset, b.size});
      else
        writes.image(to, wanted.type, VK_NULL_HANDLE, imageOf(planned.frame, b.resource));
    }
}

}  // namespace

UploadedModel::UploadedModel(Device& device, const Model& model)
    : device_(device),
      model_(model),
      vertices_(device, byteCount(model.vertices), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      indices_(device, byteCount(model.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT),
      setLayout_(device),
      layout_(device) {
  if (!device.canDraw()) throw DeviceError(device.description() + " computes but has no queue that draws");
  std::memcpy(vertices_.mapped(), model.vertices.data(), static_cast<std::size_t>(vertices_.size()));
  std::memcpy(indices_.mapped(), model.indices.data(), static_cast<std::size_t>(indices_.size()));

  const auto add = [&](const Texture& texture, VkFilter filter) {
    textures_.push_back(
        std::make_unique<GpuImage>(device, texture.width, texture.height, VK_FORMAT_R16G16B16A16_SFLOAT));
    textures_.back()->upload(linearImage(texture));
    VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
    info.magFilter = info.minFilter = filter;
    info.addressModeU = addressMode(texture.wrapU);
    info.addressModeV = addressMode(texture.wrapV);
    samplers_.push_back(std::make_unique<Owned<VkSampler, vkDestroySampler>>(device));
    check(vkCreateSampler(device.handle(), &info, nullptr, samplers_.back()->receive()), "vkCreateSampler");
  };
  for (const Texture& texture : model.textures) add(texture, VK_FILTER_LINEAR);
  // Its sampler also serves texelFetch from formats that need not filter.
  add({1, 1, {255, 255, 255, 255}}, VK_FILTER_NEAREST);
  createLayout();
}

void UploadedModel::createLayout() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < kOwnBindings; ++i)
    bindings.push_back(
        {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  for (const PlannedBinding& b : plannedBindings())
    bindings.push_back({kOwnBindings + b.binding, b.type, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = static_cast<std::uint32_t>(bindings.size());
  set.pBindings = bindings.data();
  check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, setLayout_.receive()),
        "vkCreateDescriptorSetLayout");
  const VkPushConstantRange constants{VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                                      sizeof(DrawConstants)};
  const VkDescriptorSetLayout sets[] = {setLayout_};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = sets;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &constants;
  check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, layout_.receive()),
        "vkCreatePipelineLayout");
  pushDescriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(device_.handle(), "vkCmdPushDescriptorSetKHR"));
}

VkPipeline UploadedModel::pipelineOf(const RenderTarget& target, const PipelineState& state) const {
  const auto [entry, isNew] = pipelines_.try_emplace({target.depthFormat(), state}, device_);
  if (isNew) createPipeline(entry->second, target, state);
  return entry->second;
}

void UploadedModel::createPipeline(Pipeline& pipeline, const RenderTarget& target,
                                   const PipelineState& state) const {
  ShaderModule vertex(device_), fragment(device_);
  const VkPipelineShaderStageCreateInfo stages[] = {
      loadStage(device_, VK_SHADER_STAGE_VERTEX_BIT, {kRasterMesh, sizeof kRasterMesh}, vertex),
      loadStage(device_, VK_SHADER_STAGE_FRAGMENT_BIT, fragmentSpirv(state.shader), fragment)};

  const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attributes[] = {
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
      {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
      {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
      {3, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
      {4, 0, VK_FORMAT_R32_SFLOAT, offsetof(Vertex, mark)},
      {5, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, normalUv)},
      {6, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)},
      {7, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, lobeUv)}};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = 1;
  input.pVertexBindingDescriptions = &binding;
  input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(std::size(attributes));
  input.pVertexAttributeDescriptions = attributes;
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.cullMode = state.cull;
  raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  raster.lineWidth = 1;
  raster.depthBiasEnable = state.depthBiasConstant != 0 || state.depthBiasSlope != 0;
  raster.depthBiasConstantFactor = state.depthBiasConstant;
  raster.depthBiasSlopeFactor = state.depthBiasSlope;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineDepthStencilStateCreateInfo depth{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = depth.depthWriteEnable = state.depthTest.has_value();
  depth.depthCompareOp = state.depthTest.value_or(VK_COMPARE_OP_ALWAYS);
  VkPipelineColorBlendAttachmentState blend{};
  blend.blendEnable = state.add;
  blend.srcColorBlendFactor = blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.srcAlphaBlendFactor = blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                         VK_COLOR_COMPONENT_A_BIT;
  const std::vector<VkPipelineColorBlendAttachmentState> blends(target.colorCount(), blend);
  VkPipelineColorBlendStateCreateInfo colors{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  colors.attachmentCount = static_cast<std::uint32_t>(blends.size());
  colors.pAttachments = blends.data();
  const VkDynamicState dynamicStates[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = static_cast<std::uint32_t>(std::size(dynamicStates));
  dynamic.pDynamicStates = dynamicStates;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = static_cast<std::uint32_t>(std::size(stages));
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &colors;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  info.renderPass = target.renderPass();
  check(vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline.receive()),
        "vkCreateGraphicsPipelines");
}

void UploadedModel::draw(const RenderTarget& target, const DrawView& view, const PipelineState& state,
                         VkCullModeFlags doubleSidedCull, const EarlierPass& earlier) const {
  device_.run([&](VkCommandBuffer commandBuffer) {
    record(commandBuffer, target, view, state, doubleSidedCull, earlier);
  });
}

void UploadedModel::record(VkCommandBuffer commandBuffer, const RenderTarget& target, const DrawView& view,
                           const PipelineState& state, VkCullModeFlags doubleSidedCull,
                           const EarlierPass& earlier) const {
  PipelineState doubleSided = state;
  doubleSided.cull = doubleSidedCull;
  const glm::dmat4 viewFromWorld = toGlm(view.viewFromWorld);
  DrawConstants constants{};
  constants.clipFromWorld = glm::mat4(toGlm(view.clipFromView) * viewFromWorld);
  constants.planar = -glm::vec4(glm::transpose(viewFromWorld)[2]);
  const GpuImage& white = *textures_.back();

  target.begin(commandBuffer);
  const VkDeviceSize offset = 0;
  const VkBuffer vertexBuffer = vertices_.handle();
  vkCmdBindVertexBuffers(commandBuffer, 0, 1, &vertexBuffer, &offset);
  vkCmdBindIndexBuffer(commandBuffer, indices_.handle(), 0, VK_INDEX_TYPE_UINT32);
  for (const Part& part : model_.parts) {
    const Surface& surface = model_.surfaces[part.surface];
    vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pipelineOf(target, surface.doubleSided ? doubleSided : state));
    const std::size_t none = textures_.size() - 1;
    const auto textureOr = [none](int index) { return index < 0 ? none : static_cast<std::size_t>(index); };
    const std::size_t color = textureOr(surface.texture), normal = textureOr(surface.normalMap),
                      lobe = textureOr(surface.lobeMap);
    const GpuImage* const object = earlier.caster ? earlier.caster : earlier.albedoObject;
    const GpuImage* images[kOwnBindings] = {textures_[color].get(), earlier.depth ? earlier.depth : &white,
                                            object ? object : &white, textures_[normal].get(),
                                            textures_[lobe].get()};
    const std::size_t samplers[kOwnBindings] = {color, none, none, normal, lobe};
    DescriptorWrites writes;
    for (std::uint32_t i = 0; i < kOwnBindings; ++i)
      writes.image(i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, *samplers_[samplers[i]], images[i]->use());
    if (earlier.planned) addPlanned(*earlier.planned, writes);
    pushDescriptors_(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0,
                     static_cast<std::uint32_t>(writes.all().size()), writes.all().data());
    constants.baseColor = vec4(surface.baseColor, surface.alphaCutoff);
    constants.addedColor = vec4(surface.addedColor, part.object);
    const float normalScale = surface.normalMap < 0 ? 0 : static_cast<float>(surface.normalScale);
    const std::uint32_t behind = earlier.depth == nullptr ? 0 : earlier.caster ? kBehindCaster : kBehindFront;
    const std::uint32_t apart = surface.lobes == SurfaceLobes::Apart ? kLobesApart : 0;
    constants.ids = {surface.material | apart | highHalf(surface.displaced),
                     view.reversedDepth | highHalf(surface.backscatter), behind,
                     earlier.planned ? earlier.planned->dispatch.pushConstants[1]
                                     : std::bit_cast<std::uint32_t>(normalScale)};
    vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0,
                       sizeof constants, &constants);
    vkCmdDrawIndexed(commandBuffer, part.indexCount, 1, part.firstIndex, 0, 0);
  }
  target.end(commandBuffer);
}

}  // namespace pellucid::harness
