#include "sample/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "kSampleDepth.h"
#include "kSampleGbuffer.h"
#include "kSampleLighting.h"
#include "kSampleMesh.h"
#include "kSampleResolve.h"
#include "kSampleScreen.h"
#include "sample/shadow_tiles.h"
#include "scene/vector.h"

namespace pellucid::sample {

namespace {

// Of shaders/mesh.glsl.
struct DrawConstants {
  glm::mat4 clipFromWorld;
  glm::vec4 baseColor, surface;
};
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr std::uint32_t kImages = 7;  // that a pass reads at most
constexpr VkDeviceSize kUniformSlice = (sizeof(Uniforms) + 255) / 256 * 256;
constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT, kHalf = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkImageUsageFlags kDrawn = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;

std::vector<VkDescriptorSetLayoutBinding> bindings() {
  std::vector<VkDescriptorSetLayoutBinding> all = {
      {0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kStages, nullptr}};
  for (std::uint32_t i = 1; i <= kImages; ++i)
    all.push_back({i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr});
  return all;
}

template <class T>
VkDeviceSize bytes(const std::vector<T>& values) {
  return static_cast<VkDeviceSize>(values.size() * sizeof(T));
}

PellucidImage use(const DepthBuffer& depth) { return {depth.view(), kDepthRead}; }

double halton(std::uint64_t index, std::uint64_t base) {
  double result = 0, part = 1;
  for (; index > 0; index /= base)
    result += (part /= static_cast<double>(base)) * static_cast<double>(index % base);
  return result;
}

PellucidLight described(const SceneLight& light, std::uint32_t firstTile, std::size_t tileCount) {
  PellucidLight l{};
  l.type = light.light.type;
  const auto copy = [](const Vector3& from, float(&to)[3]) {
    std::transform(from.begin(), from.end(), to, [](double v) { return static_cast<float>(v); });
  };
  copy(light.light.position, l.position);
  copy(light.light.direction, l.direction);
  copy(light.light.color, l.color);
  l.intensity = static_cast<float>(light.light.intensity);
  l.innerConeAngle = static_cast<float>(light.light.innerConeAngle);
  l.outerConeAngle = static_cast<float>(light.light.outerConeAngle);
  l.firstShadowMap = firstTile;
  l.shadowMapCount = static_cast<std::uint32_t>(tileCount);
  return l;
}

}  // namespace

Renderer::Renderer(Device& device, const Scene& scene, VkExtent2D extent, std::uint32_t mapTexels)
    : device_(device),
      scene_(scene),
      extent_(extent),
      mapTexels_(mapTexels),
      vertices_(device, bytes(scene.model.vertices), VK_BUFFER_USAGE_VERTEX_BUFFER_BIT),
      indices_(device, bytes(scene.model.indices), VK_BUFFER_USAGE_INDEX_BUFFER_BIT),
      textures_(device, scene.model),
      normal_(device, width(), height(), VK_FORMAT_A2B10G10R10_UNORM_PACK32, kDrawn),
      albedo_(device, width(), height(), VK_FORMAT_R8G8B8A8_SRGB, kDrawn),
      surface_(device, width(), height(), VK_FORMAT_R32_UINT, kDrawn),
      irradiance_(device, width(), height(), kHalf, kDrawn),
      color_(device, width(), height(), kHalf, kDrawn),
      picture_(device, width(), height(), VK_FORMAT_R8G8B8A8_UNORM, kDrawn),
      depth_(device, width(), height(), kDepth),
      backDepth_(device, width(), height(), kDepth),
      shadows_{{{device, maps(1), maps(1), kDepth, kCascadeCount},
                {device, maps(kAtlasColumns), maps(kAtlasColumns), VK_FORMAT_D16_UNORM, 1},
                {device, maps(1), maps(1), kDepth, kCubeFaces}}},
      layout_(device, bindings(), {kStages, 0, sizeof(DrawConstants)}),
      lighting_(device),
      resolve_(device),
      linear_(device),
      compare_(device),
      pool_(device),
      uniforms_(device, kFramesInFlight * kUniformSlice, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      pellucid_(device, scene.materials) {
  std::memcpy(vertices_.mapped(), scene.model.vertices.data(), static_cast<std::size_t>(vertices_.size()));
  std::memcpy(indices_.mapped(), scene.model.indices.data(), static_cast<std::size_t>(indices_.size()));
  for (auto& history : history_) {
    history = std::make_unique<GpuImage>(device, width(), height(), kHalf, kDrawn);
    history->clear();  // the first frame binds one that no frame has drawn
  }
  createPasses();
  createSlots();
}

Renderer::~Renderer() { vkDeviceWaitIdle(device_.handle()); }

void Renderer::createPasses() {
  const VkClearValue zero{}, far{};  // depths are reversed: 0 is far
  const auto color = [&](const GpuImage& image, VkFormat format) {
    return Attachment{image.use().view, format, zero, VK_IMAGE_LAYOUT_GENERAL};
  };
  const auto pass = [&](VkExtent2D extent, const std::vector<Attachment>& colors,
                        const std::optional<Attachment>& depth) {
    return std::make_unique<DrawPass>(device_, extent, colors, depth);
  };
  gbufferPass_ = pass(extent_,
                      {color(normal_, VK_FORMAT_A2B10G10R10_UNORM_PACK32),
                       color(albedo_, VK_FORMAT_R8G8B8A8_SRGB), color(surface_, VK_FORMAT_R32_UINT)},
                      Attachment{depth_.view(), kDepth, far, kDepthRead});
  backPass_ = pass(extent_, {}, Attachment{backDepth_.view(), kDepth, far, kDepthRead});
  lightingPass_ = pass(extent_, {color(irradiance_, kHalf), color(color_, kHalf)}, {});
  for (std::size_t i = 0; i < 2; ++i)
    resolvePass_[i] =
        pass(extent_, {color(*history_[i], kHalf), color(picture_, VK_FORMAT_R8G8B8A8_UNORM)}, {});
  for (std::size_t i = 0; i < kShadowImages; ++i)
    for (std::size_t layer = 0; layer < shadows_[i].layers(); ++layer)
      shadowPasses_[i].push_back(
          pass(shadows_[i].extent(), {},
               Attachment{shadows_[i].layer(layer), shadows_[i].format(), far, kDepthRead}));
  const Spirv screen{kSampleScreen, sizeof kSampleScreen};
  createPipeline(device_, *lightingPass_, layout_, screen, {kSampleLighting, sizeof kSampleLighting}, {},
                 lighting_);
  createPipeline(device_, *resolvePass_[0], layout_, screen, {kSampleResolve, sizeof kSampleResolve}, {},
                 resolve_);
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.addressModeU = sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, linear_.receive()), "vkCreateSampler");
  sampler.compareEnable = VK_TRUE;
  sampler.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;  // reversed: lit where nothing nearer is stored
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, compare_.receive()), "vkCreateSampler");
}

void Renderer::createSlots() {
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.flags = VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT;
  pool.queueFamilyIndex = device_.queueFamily();
  check(vkCreateCommandPool(device_.handle(), &pool, nullptr, pool_.receive()), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr, pool_,
                                             VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, VK_FENCE_CREATE_SIGNALED_BIT};
  for (Slot& slot : slots_) {
    check(vkAllocateCommandBuffers(device_.handle(), &commands, &slot.commands), "vkAllocateCommandBuffers");
    slot.done = std::make_unique<Owned<VkFence, vkDestroyFence>>(device_);
    check(vkCreateFence(device_.handle(), &fence, nullptr, slot.done->receive()), "vkCreateFence");
  }
}

void Renderer::draw(const Settings& settings, const ViewCamera& camera) {
  const Slot& slot = slots_[next_ % kFramesInFlight];
  const VkFence done = *slot.done;
  check(vkWaitForFences(device_.handle(), 1, &done, VK_TRUE, UINT64_MAX), "vkWaitForFences");
  check(vkResetFences(device_.handle(), 1, &done), "vkResetFences");
  settings_ = settings;
  makeFrame(camera);
  const Uniforms constants = uniforms(camera);
  std::memcpy(static_cast<char*>(uniforms_.mapped()) + next_ % kFramesInFlight * kUniformSlice, &constants,
              sizeof constants);
  const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                       VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT};
  check(vkBeginCommandBuffer(slot.commands, &begin), "vkBeginCommandBuffer");
  drawShadows(slot.commands);
  drawGbuffer(slot.commands);
  light(slot.commands);
  if (settings.pellucid) pellucid_.record(slot.commands, frame_);
  resolve(slot.commands);
  check(vkEndCommandBuffer(slot.commands), "vkEndCommandBuffer");
  VkSubmitInfo submit{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  submit.commandBufferCount = 1;
  submit.pCommandBuffers = &slot.commands;
  check(vkQueueSubmit(device_.queue(), 1, &submit, done), "vkQueueSubmit");
  ++next_;
}

void Renderer::makeFrame(const ViewCamera& camera) {
  Frame& f = frame_ = {};
  f.index = next_;
  f.extent = extent_;
  const auto scaled = [&](std::uint32_t side) {
    return std::max(1u, static_cast<std::uint32_t>(std::lround(side * settings_.scale)));
  };
  f.rect = {scaled(extent_.width), scaled(extent_.height)};
  const ModelCamera& lens = camera.lens;
  const double aspect = static_cast<double>(extent_.width) / extent_.height;
  const glm::dmat4 still = toGlm(perspective(
      lens.verticalFov, aspect, {lens.range.nearPlane, std::numeric_limits<double>::infinity(), true}));
  f.viewFromWorld = toGlm(lens.viewFromWorld);
  previous_ = next_ > 0 ? current_ : still * f.viewFromWorld;
  current_ = still * f.viewFromWorld;
  const std::uint64_t sample = next_ % 8 + 1;
  if (settings_.taa)
    jitter_ = {halton(sample, 2) - 0.5, halton(sample, 3) - 0.5};
  else
    jitter_ = {0, 0};
  const glm::dvec3 moved(2 * jitter_.x / f.rect.width, 2 * jitter_.y / f.rect.height, 0);
  f.clipFromView = glm::translate(glm::dmat4(1), moved) * still;
  f.metersPerUnit = static_cast<float>(scene_.model.metersPerUnit);
  if (settings_.mistake == Mistake::Units)
    f.metersPerUnit *= 10;  // centimeters, taken for millimeters' tenth
  f.preExposure = settings_.exposure * std::numbers::inv_pi_v<float>;  // albedo times it is radiance
  f.normal = normal_.use();
  f.albedo = albedo_.use();
  f.surface = surface_.use();
  f.depth = use(depth_);
  f.backDepth = use(backDepth_);
  f.irradiance = irradiance_.use();
  f.color = color_.use();
  for (std::size_t i = 0; i < kShadowImages; ++i) f.shadows[i] = use(shadows_[i]);
  f.quality = settings_.quality;
  f.transient = [this](std::uint32_t slot, const PellucidImageNeed& need) { return transient(slot, need); };
  f.hasAmbient = settings_.ambient;
  for (std::size_t i = 0; i < f.ambient.size(); ++i) f.ambient[i] = toGlm(scene_.ambient[i]);
  const auto add = [&](const SceneLight& light, const std::vector<ShadowTile>& tiles) {
    f.lights.push_back(described(light, static_cast<std::uint32_t>(f.tiles.size()), tiles.size()));
    f.tiles.insert(f.tiles.end(), tiles.begin(), tiles.end());
  };
  if (settings_.sun)
    add(scene_.sun, cascades(scene_, glm::inverse(f.viewFromWorld), glm::inverse(still), mapTexels_));
  for (std::uint32_t i = 0; settings_.spots && i < scene_.spots.size(); ++i) {
    std::vector<ShadowTile> tiles = fixedTiles(scene_.spots[i], i, mapTexels_);
    for (ShadowTile& tile : tiles) {  // what is drawn, unless that is forgotten
      tile.frontsCulled = settings_.cullFronts && settings_.mistake != Mistake::FrontsUnsaid;
      if (settings_.mistake == Mistake::BiasUnsaid) continue;
      tile.biasConstant = -settings_.biasConstant;  // reversed depths
      tile.biasSlope = -settings_.biasSlope;
    }
    add(scene_.spots[i], tiles);
  }
  if (settings_.point) add(scene_.point, fixedTiles(scene_.point, 0, mapTexels_));
}

Uniforms Renderer::uniforms(const ViewCamera& camera) const {
  const Frame& f = frame_;
  Uniforms u{};
  u.worldFromClip = glm::inverse(f.clipFromView * f.viewFromWorld);
  u.previousFromCurrent = previous_ * glm::inverse(current_);
  u.eye = glm::vec4(toGlm(camera.eye()), 1);
  u.rect = {f.rect.width, f.rect.height, 1.0 / f.rect.width, 1.0 / f.rect.height};
  u.extent = {f.extent.width, f.extent.height, 1.0 / f.extent.width, 1.0 / f.extent.height};
  u.jitter = {jitter_, settings_.taa && next_ > 0 ? 0.1 : 1, 0};
  u.scale = {settings_.exposure, f.preExposure, settings_.specular, 0};
  u.flags = {f.lights.size(), settings_.mistake, settings_.pellucid, 0};
  for (std::size_t i = 0; f.hasAmbient && i < f.ambient.size(); ++i) u.ambient[i] = {f.ambient[i], 0};
  for (std::size_t i = 0; i < f.lights.size(); ++i) {
    const PellucidLight& l = f.lights[i];
    const auto vec4 = [](const float(&v)[3], float w) { return glm::vec4(v[0], v[1], v[2], w); };
    u.lights[i] = {vec4(l.position, static_cast<float>(l.type)),
                   vec4(l.direction, std::cos(l.innerConeAngle)),
                   l.intensity * vec4(l.color, 0),
                   {l.firstShadowMap, l.shadowMapCount, 0, 0}};
    u.lights[i].color.w = std::cos(l.outerConeAngle);
  }
  for (std::size_t i = 0; i < f.tiles.size(); ++i) {
    const ShadowTile& t = f.tiles[i];
    const double side = 1.0 / shadows_[t.image].extent().width;
    u.tiles[i] = {t.clipFromWorld,
                  {t.x * side, t.y * side, t.size * side, t.size * side},
                  {t.image, t.layer, t.texel, side}};
  }
  return u;
}

PellucidImage Renderer::transient(std::uint32_t slot, const PellucidImageNeed& need) {
  auto& image = transients_[{slot, need.format, need.extent[0], need.extent[1]}];
  if (!image) {
    image = std::make_unique<GpuImage>(device_, static_cast<int>(need.extent[0]),
                                       static_cast<int>(need.extent[1]), need.format);
    image->clear();  // from UNDEFINED to GENERAL
  }
  return image->use();
}

VkPipeline Renderer::meshPipeline(const DrawPass& pass, VkCullModeFlags cull) {
  const auto [entry, isNew] =
      meshPipelines_.try_emplace({pass.depthFormat(), pass.colorCount(), cull}, device_);
  if (!isNew) return entry->second;
  const VkVertexInputBindingDescription binding{0, sizeof(Vertex), VK_VERTEX_INPUT_RATE_VERTEX};
  const VkVertexInputAttributeDescription attributes[] = {
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, position)},
      {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, normal)},
      {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, uv)},
      {3, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(Vertex, color)},
      {4, 0, VK_FORMAT_R32_SFLOAT, offsetof(Vertex, mark)},
      {5, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(Vertex, normalUv)},
      {6, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(Vertex, tangent)}};
  DrawState state;
  state.input.vertexBindingDescriptionCount = 1;
  state.input.pVertexBindingDescriptions = &binding;
  state.input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(std::size(attributes));
  state.input.pVertexAttributeDescriptions = attributes;
  state.raster.cullMode = cull;
  state.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  state.raster.depthBiasEnable = state.depthBiasIsDynamic = true;
  state.depth.depthTestEnable = state.depth.depthWriteEnable = true;
  state.depth.depthCompareOp = VK_COMPARE_OP_GREATER;  // reversed
  const Spirv depthOnly{kSampleDepth, sizeof kSampleDepth}, gbuffer{kSampleGbuffer, sizeof kSampleGbuffer};
  createPipeline(device_, pass, layout_, {kSampleMesh, sizeof kSampleMesh},
                 pass.colorCount() > 0 ? gbuffer : depthOnly, state, entry->second);
  return entry->second;
}

void Renderer::drawScene(VkCommandBuffer commands, const DrawPass& pass, const glm::dmat4& clipFromWorld,
                         VkCullModeFlags cull) {
  const VkDeviceSize offset = 0;
  const VkBuffer vertices = vertices_.handle();
  vkCmdBindVertexBuffers(commands, 0, 1, &vertices, &offset);
  vkCmdBindIndexBuffer(commands, indices_.handle(), 0, VK_INDEX_TYPE_UINT32);
  for (const Part& part : scene_.model.parts) {
    const Surface& surface = scene_.model.surfaces[part.surface];
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS,
                      meshPipeline(pass, surface.doubleSided ? VkCullModeFlags{VK_CULL_MODE_NONE} : cull));
    const auto texture = [&](int index) {
      const std::size_t i = index < 0 ? textures_.white() : static_cast<std::size_t>(index);
      return Bound{textures_.image(i).use(), textures_.sampler(i)};
    };
    bind(commands, {texture(surface.texture), texture(surface.normalMap)});
    const DrawConstants constants = {clipFromWorld,
                                     glm::vec4(toGlm(surface.baseColor), surface.alphaCutoff),
                                     {surface.material, surface.material ? 0.45 : 0.8,
                                      surface.normalMap < 0 ? 0 : surface.normalScale, 0}};
    vkCmdPushConstants(commands, layout_, kStages, 0, sizeof constants, &constants);
    vkCmdDrawIndexed(commands, part.indexCount, 1, part.firstIndex, 0, 0);
  }
}

void Renderer::drawShadows(VkCommandBuffer commands) {
  for (std::uint32_t image = 0; image < kShadowImages; ++image)
    for (std::uint32_t layer = 0; layer < shadowPasses_[image].size(); ++layer) {
      const DrawPass& pass = *shadowPasses_[image][layer];
      pass.begin(commands, {{0, 0}, shadows_[image].extent()});
      const bool spots = image == kAtlas;
      vkCmdSetDepthBias(commands, spots ? -settings_.biasConstant : 0, 0, spots ? -settings_.biasSlope : 0);
      for (const ShadowTile& tile : frame_.tiles) {
        if (tile.image != image || tile.layer != layer) continue;
        setViewport(commands, {{static_cast<int>(tile.x), static_cast<int>(tile.y)}, {tile.size, tile.size}});
        drawScene(commands, pass, tile.clipFromWorld,
                  spots && settings_.cullFronts ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT);
      }
      vkCmdEndRenderPass(commands);
    }
}

void Renderer::drawGbuffer(VkCommandBuffer commands) {
  const glm::dmat4 clipFromWorld = frame_.clipFromView * frame_.viewFromWorld;
  vkCmdSetDepthBias(commands, 0, 0, 0);
  for (const auto& [pass, cull] : {std::pair(gbufferPass_.get(), VK_CULL_MODE_BACK_BIT),
                                   std::pair(backPass_.get(), VK_CULL_MODE_FRONT_BIT)}) {
    pass->begin(commands, {{0, 0}, frame_.rect});
    drawScene(commands, *pass, clipFromWorld, cull);
    vkCmdEndRenderPass(commands);
  }
}

void Renderer::light(VkCommandBuffer commands) {
  drawScreen(commands, *lightingPass_, frame_.rect, lighting_,
             {{frame_.normal, nearest()},
              {frame_.albedo, nearest()},
              {frame_.surface, nearest()},
              {frame_.depth, nearest()},
              {frame_.shadows[0], compare_},
              {frame_.shadows[1], compare_},
              {frame_.shadows[2], compare_}});
}

void Renderer::resolve(VkCommandBuffer commands) {
  drawScreen(
      commands, *resolvePass_[frame_.index % 2], extent_, resolve_,
      {{frame_.color, linear_}, {frame_.depth, nearest()}, {history_[(frame_.index + 1) % 2]->use(), linear_}});
}

void Renderer::drawScreen(VkCommandBuffer commands, const DrawPass& pass, VkExtent2D extent,
                          VkPipeline pipeline, const std::vector<Bound>& images) const {
  pass.begin(commands, {{0, 0}, extent});
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  bind(commands, images);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRenderPass(commands);
}

// The frame's uniforms at binding 0, images from 1 on.
void Renderer::bind(VkCommandBuffer commands, const std::vector<Bound>& images) const {
  const VkDescriptorBufferInfo uniforms{uniforms_.handle(), frame_.index % kFramesInFlight * kUniformSlice,
                                        kUniformSlice};
  VkDescriptorImageInfo infos[kImages];
  VkWriteDescriptorSet writes[kImages + 1];
  for (std::uint32_t i = 0; i <= images.size(); ++i) {
    writes[i] = {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType =
        i == 0 ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[i].pBufferInfo = &uniforms;
    if (i == 0) continue;
    infos[i - 1] = {images[i - 1].sampler, images[i - 1].image.view, images[i - 1].image.layout};
    writes[i].pImageInfo = &infos[i - 1];
  }
  layout_.push(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, {writes, images.size() + 1});
}

}  // namespace pellucid::sample
