#include "raster/draw.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <map>
#include <utility>

#include "common/error.h"
#include "common/srgb.h"
#include "kRasterCaster.h"
#include "kRasterCount.h"
#include "kRasterDepth.h"
#include "kRasterMesh.h"
#include "kRasterReflected.h"
#include "kRasterSurface.h"
#include "kRasterTransmit.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

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

// Push constants of shaders/draw.glsl.
struct DrawConstants {
  glm::mat4 clipFromWorld;
  glm::vec4 planar;
  glm::vec4 baseColor;
  glm::vec4 addedColor;
  glm::uvec4 ids;
};
static_assert(sizeof(DrawConstants) == 128, "what every device has for push constants");
constexpr std::uint32_t kOwnBindings = 5, kBehindFront = 1, kBehindCaster = 2, kHasColor = 4, kHasLobes = 8,
                        kLobesApart = 256, kIsOffset = 2;
constexpr VkShaderStageFlags kStages =  // that read DrawConstants
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

// By FragmentShader.
const Spirv kFragmentShaders[] = {
    {kRasterSurface, sizeof kRasterSurface}, {kRasterReflected, sizeof kRasterReflected},
    {kRasterDepth, sizeof kRasterDepth},     {kRasterCaster, sizeof kRasterCaster},
    {kRasterCount, sizeof kRasterCount},     {kRasterTransmit, sizeof kRasterTransmit}};

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
                                     {PELLUCID_BINDING_MATERIAL, image}};
  for (std::uint32_t i = 0; i < PELLUCID_SHADOW_IMAGE_COUNT; ++i)
    all.push_back({PELLUCID_BINDING_SHADOW_IMAGES + i, image});
  return all;
}

std::vector<VkDescriptorSetLayoutBinding> layoutBindings() {
  std::vector<VkDescriptorSetLayoutBinding> bindings;
  for (std::uint32_t i = 0; i < kOwnBindings; ++i)
    bindings.push_back(
        {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  for (const PlannedBinding& b : plannedBindings())
    bindings.push_back({kOwnBindings + b.binding, b.type, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  return bindings;
}

void addPlanned(const PlannedInputs& planned, DescriptorWrites& writes) {
  PellucidBinding bindings[PELLUCID_MAX_BINDINGS];
  const std::uint32_t count = pellucidGetBindings(&planned.plan, 0, bindings);
  for (const PlannedBinding& wanted : plannedBindings())
    for (std::uint32_t i = 0; i < count; ++i) {
      const PellucidBinding& b = bindings[i];
      if (b.binding != wanted.binding) continue;
      const std::uint32_t to = kOwnBindings + b.binding;
      if (b.resource == PELLUCID_RESOURCE_CONSTANTS)
        writes.buffer(to, wanted.type, {planned.constants, b.offset, b.size});
      else
        writes.image(to, wanted.type, VK_NULL_HANDLE, *pellucidGetImage(&planned.frame, b.resource));
    }
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

class UploadedModel::Pipelines {
public:
  explicit Pipelines(Device& device)
      : device_(device), layout_(device, layoutBindings(), {kStages, 0, sizeof(DrawConstants)}) {}

  const PushLayout& layout() const { return layout_; }

  VkPipeline of(const RenderTarget& target, const PipelineState& state) {
    const auto [entry, isNew] = pipelines_.try_emplace({target.pass().depthFormat(), state}, device_);
    if (isNew) create(entry->second, target, state);
    return entry->second;
  }

private:
  void create(Pipeline& pipeline, const RenderTarget& target, const PipelineState& state) const {
    DrawState drawn;
    drawn.input = UploadedMesh::vertexInput();
    drawn.raster.cullMode = state.cull;
    drawn.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
    drawn.raster.depthBiasEnable = state.depthBiasConstant != 0 || state.depthBiasSlope != 0;
    drawn.raster.depthBiasConstantFactor = state.depthBiasConstant;
    drawn.raster.depthBiasSlopeFactor = state.depthBiasSlope;
    drawn.depth.depthTestEnable = drawn.depth.depthWriteEnable = state.depthTest.has_value();
    drawn.depth.depthCompareOp = state.depthTest.value_or(VK_COMPARE_OP_ALWAYS);
    drawn.blend.blendEnable = state.add;
    drawn.blend.srcColorBlendFactor = drawn.blend.dstColorBlendFactor = VK_BLEND_FACTOR_ONE;
    drawn.blend.srcAlphaBlendFactor = drawn.blend.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    createPipeline(device_, target.pass(), layout_, {kRasterMesh, sizeof kRasterMesh},
                   kFragmentShaders[static_cast<std::size_t>(state.shader)], drawn, pipeline);
  }

  Device& device_;
  PushLayout layout_;
  // By the target's depth format; created where they are drawn with first.
  std::map<std::pair<VkFormat, PipelineState>, Pipeline> pipelines_;
};

UploadedModel::UploadedModel(Device& device, const Model& model)
    : model_(model), mesh_(device, model), pipelines_(device.kept<Pipelines>()) {}

void UploadedModel::record(VkCommandBuffer commandBuffer, const RenderTarget& target, const DrawView& view,
                           const PipelineState& state, VkCullModeFlags doubleSidedCull,
                           const EarlierPass& earlier) const {
  PipelineState doubleSided = state, opaque = state;
  doubleSided.cull = doubleSidedCull;
  opaque.cull = VK_CULL_MODE_NONE;
  const glm::dmat4 viewFromWorld = toGlm(view.viewFromWorld);
  DrawConstants constants{};
  constants.clipFromWorld = glm::mat4(toGlm(view.clipFromView) * viewFromWorld);
  constants.planar = -glm::vec4(glm::transpose(viewFromWorld)[2]);
  const std::size_t none = mesh_.white();
  const GpuImage& white = mesh_.image(none);

  target.begin(commandBuffer);
  mesh_.bind(commandBuffer);
  for (const Part& part : model_.parts) {
    const Surface& surface = model_.surfaces[part.surface];
    // What is opaque ends the light's way by either side.
    const bool ends = earlier.caster && surface.material == 0;
    vkCmdBindPipeline(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      pipelines_.of(target, ends                  ? opaque
                                            : surface.doubleSided ? doubleSided
                                                                  : state));
    const auto textureOr = [none](int index) { return index < 0 ? none : static_cast<std::size_t>(index); };
    const std::size_t color = textureOr(surface.texture), normal = textureOr(surface.normalMap),
                      lobe = textureOr(surface.lobeMap);
    const GpuImage* const object = earlier.caster ? earlier.caster : earlier.albedoObject;
    const GpuImage* images[kOwnBindings] = {&mesh_.image(color), earlier.depth ? earlier.depth : &white,
                                            object ? object : &white, &mesh_.image(normal),
                                            &mesh_.image(lobe)};
    const std::size_t samplers[kOwnBindings] = {color, none, none, normal, lobe};
    DescriptorWrites writes;
    for (std::uint32_t i = 0; i < kOwnBindings; ++i)
      writes.image(i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, mesh_.sampler(samplers[i]),
                   images[i]->use());
    if (earlier.planned) addPlanned(*earlier.planned, writes);
    pipelines_.layout().push(commandBuffer, VK_PIPELINE_BIND_POINT_GRAPHICS, writes.all());
    constants.baseColor = vec4(surface.baseColor, surface.alphaCutoff);
    constants.addedColor = vec4(surface.addedColor, part.object);
    const float normalScale = surface.normalMap < 0 ? 0 : static_cast<float>(surface.normalScale);
    const std::uint32_t behind = earlier.depth == nullptr ? 0 : earlier.caster ? kBehindCaster : kBehindFront;
    const std::uint32_t apart = surface.lobes == SurfaceLobes::Apart ? kLobesApart : 0;
    const std::uint32_t has = (surface.texture < 0 ? 0 : kHasColor) | (surface.lobeMap < 0 ? 0 : kHasLobes);
    constants.ids = {
        surface.material | apart | highHalf(surface.displaced),
        view.reversedDepth | (view.normalOffset != 0 ? kIsOffset : 0) | highHalf(surface.backscatter),
        behind | has,
        earlier.planned ? earlier.planned->plan.dispatches[0].pushConstants[1]
                        : std::bit_cast<std::uint32_t>(
                              view.normalOffset != 0 ? static_cast<float>(view.normalOffset) : normalScale)};
    vkCmdPushConstants(commandBuffer, pipelines_.layout(), kStages, 0, sizeof constants, &constants);
    vkCmdDrawIndexed(commandBuffer, part.indexCount, 1, part.firstIndex, 0, 0);
  }
  target.end(commandBuffer);
}

}  // namespace pellucid::harness
