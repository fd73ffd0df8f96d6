#include "view/display.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "kDisplayFragment.h"
#include "kDisplayVertex.h"

namespace pellucid::harness {

namespace {

constexpr std::uint32_t kBindings = 7;  // of shaders/display.frag

using ShaderModule = Owned<VkShaderModule, vkDestroyShaderModule>;

VkPipelineShaderStageCreateInfo stage(Device& device, VkShaderStageFlagBits bit, const std::uint32_t* words,
                                      std::size_t bytes, ShaderModule& shader) {
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = bytes;
  info.pCode = words;
  check(vkCreateShaderModule(device.handle(), &info, nullptr, shader.receive()), "vkCreateShaderModule");
  VkPipelineShaderStageCreateInfo result{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  result.stage = bit;
  result.module = shader;
  result.pName = "main";
  return result;
}

}  // namespace

ScreenRect fitted(const ScreenRect& area, int width, int height) {
  const float scale =
      std::min(area.width / static_cast<float>(width), area.height / static_cast<float>(height));
  const float w = scale * static_cast<float>(width), h = scale * static_cast<float>(height);
  return {std::round(area.x + (area.width - w) / 2), std::round(area.y + (area.height - h) / 2), w, h};
}

std::optional<Texel> texelAt(const ScreenRect& picture, int width, int height, float x, float y) {
  const float u = (x - picture.x) / picture.width, v = (y - picture.y) / picture.height;
  if (!(u >= 0 && u < 1 && v >= 0 && v < 1)) return std::nullopt;
  return Texel{static_cast<int>(u * static_cast<float>(width)),
               static_cast<int>(v * static_cast<float>(height))};
}

DisplayPass::DisplayPass(Device& device, const RenderTarget& target)
    : device_(device),
      white_(device, 1, 1, VK_FORMAT_R32G32B32A32_SFLOAT),
      sampler_(device),
      setLayout_(device),
      layout_(device),
      pipeline_(device) {
  white_.upload(Image(1, 1, 4, 1.0f));
  const VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};  // texels are fetched
  check(vkCreateSampler(device.handle(), &sampler, nullptr, sampler_.receive()), "vkCreateSampler");
  createLayout();
  createPipeline(target);
  pushDescriptors_ = reinterpret_cast<PFN_vkCmdPushDescriptorSetKHR>(
      vkGetDeviceProcAddr(device.handle(), "vkCmdPushDescriptorSetKHR"));
}

void DisplayPass::createLayout() {
  VkDescriptorSetLayoutBinding bindings[kBindings]{};
  for (std::uint32_t i = 0; i < kBindings; ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo set{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  set.flags = VK_DESCRIPTOR_SET_LAYOUT_CREATE_PUSH_DESCRIPTOR_BIT_KHR;
  set.bindingCount = kBindings;
  set.pBindings = bindings;
  check(vkCreateDescriptorSetLayout(device_.handle(), &set, nullptr, setLayout_.receive()),
        "vkCreateDescriptorSetLayout");
  const VkPushConstantRange constants{VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(Push)};
  const VkDescriptorSetLayout sets[] = {setLayout_};
  VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  layout.setLayoutCount = 1;
  layout.pSetLayouts = sets;
  layout.pushConstantRangeCount = 1;
  layout.pPushConstantRanges = &constants;
  check(vkCreatePipelineLayout(device_.handle(), &layout, nullptr, layout_.receive()),
        "vkCreatePipelineLayout");
}

void DisplayPass::createPipeline(const RenderTarget& target) {
  ShaderModule vertex(device_), fragment(device_);
  const VkPipelineShaderStageCreateInfo stages[] = {
      stage(device_, VK_SHADER_STAGE_VERTEX_BIT, kDisplayVertex, sizeof kDisplayVertex, vertex),
      stage(device_, VK_SHADER_STAGE_FRAGMENT_BIT, kDisplayFragment, sizeof kDisplayFragment, fragment)};
  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  VkPipelineColorBlendAttachmentState blend{};
  blend.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT | VK_COLOR_COMPONENT_B_BIT |
                         VK_COLOR_COMPONENT_A_BIT;
  VkPipelineColorBlendStateCreateInfo colors{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  colors.attachmentCount = 1;
  colors.pAttachments = &blend;
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
  info.pColorBlendState = &colors;
  info.pDynamicState = &dynamic;
  info.layout = layout_;
  info.renderPass = target.renderPass();
  check(vkCreateGraphicsPipelines(device_.handle(), VK_NULL_HANDLE, 1, &info, nullptr, pipeline_.receive()),
        "vkCreateGraphicsPipelines");
}

void DisplayPass::draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, Shown shown, const Push& push,
                       const ScreenRect& clip) const {
  const PellucidFrame& frame = frames.run(shown).frame();
  const GpuImage* const host = frames.hostImage(shown);
  const auto orWhite = [&](const PellucidImage& image) { return image.view ? image : white_.use(); };
  const PellucidImage images[kBindings] = {frame.output,
                                           frame.irradiance,
                                           orWhite(frame.albedo),
                                           frame.material,
                                           orWhite(frame.normal),
                                           frame.frontDepth,
                                           host ? host->use() : white_.use()};
  VkDescriptorImageInfo infos[kBindings];
  VkWriteDescriptorSet writes[kBindings];
  for (std::uint32_t i = 0; i < kBindings; ++i) {
    infos[i] = {sampler_, images[i].view, images[i].layout};
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[i].pImageInfo = &infos[i];
  }
  if (!(clip.width >= 1 && clip.height >= 1)) return;
  const VkViewport viewport{clip.x, clip.y, clip.width, clip.height, 0, 1};
  const VkRect2D scissor{
      {static_cast<std::int32_t>(std::max(clip.x, 0.0f)), static_cast<std::int32_t>(std::max(clip.y, 0.0f))},
      {static_cast<std::uint32_t>(clip.width), static_cast<std::uint32_t>(clip.height)}};
  vkCmdSetViewport(commandBuffer, 0, 1, &viewport);
  vkCmdSetScissor(commandBuffer, 0, 1, &scissor);
  vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline_);
  pushDescriptors_(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, layout_, 0, kBindings, writes);
  vkCmdPushConstants(commandBuffer, layout_, VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof push, &push);
  vkCmdDraw(commandBuffer, 3, 1, 0, 0);
}

void DisplayPass::draw(VkCommandBuffer commandBuffer, const ViewFrames& frames, const Display& display,
                       Shown shown, const ScreenRect& picture, const ScreenRect& clip, float low,
                       float high) const {
  const Capture& capture = frames.capture();
  Push push{};
  push.origin[0] = picture.x;
  push.origin[1] = picture.y;
  push.extent[0] = static_cast<float>(capture.width);
  push.extent[1] = static_cast<float>(capture.height);
  push.scale = picture.width / push.extent[0];
  push.shown = static_cast<std::int32_t>(shown);
  push.toneMap = static_cast<std::int32_t>(display.toneMap);
  push.channel = display.channel;
  push.exposure = display.exposure;
  push.low = low;
  push.high = high;
  push.hasTruth = frames.hostImage(Shown::Truth) != nullptr;
  push.isFalseColor = isFalseColor(shown);
  draw(commandBuffer, frames, shown, push, clip);
}

void DisplayPass::drawLegend(VkCommandBuffer commandBuffer, const ViewFrames& frames,
                             const ScreenRect& rect) const {
  Push push{};
  push.origin[1] = rect.y;
  push.extent[1] = rect.height;
  push.isLegend = 1;
  draw(commandBuffer, frames, Shown::After, push, rect);
}

}  // namespace pellucid::harness
