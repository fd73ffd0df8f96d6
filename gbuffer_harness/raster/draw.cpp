#include "raster/draw.h"

#include <algorithm>
#include <bit>
#include <glm/gtc/packing.hpp>
#include <map>
#include <utility>

#include "common/error.h"
#include "common/frame_image.h"
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

// Push constants of shaders/draw.glsl.
constexpr std::uint32_t kOwnBindings = 5, kBehindFront = 1, kBehindCaster = 2, kHasColor = 4, kHasLobes = 8,
                        kLobesApart = 256, kIsOffset = 2;
constexpr VkShaderStageFlags kStages =  // that read DrawConstants
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

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
        writes.image(to, wanted.type, VK_NULL_HANDLE, imageOf(planned.frame, b.resource));
    }
}

}  // namespace

class UploadedModel::Pipelines {
public:
  explicit Pipelines(Device& device)
      : device_(device), layout_(device, layoutBindings(), {kStages, 0, sizeof(DrawConstants)}) {}

  const PushLayout& layout() const { return layout_; }

  VkPipeline of(const RenderTarget& target, const PipelineState& state) {
    const auto [entry, isNew] = pipelines_.try_emplace({target.depthFormat(), state}, device_);
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
                   fragmentSpirv(state.shader), drawn, pipeline);
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
