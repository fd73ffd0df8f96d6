#include "sample/renderer.h"

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>
#include <utility>

#include "kSampleDepth.h"
#include "kSampleGbuffer.h"
#include "kSampleLighting.h"
#include "kSampleMesh.h"
#include "kSampleResolve.h"
#include "kSampleScreen.h"
#include "replay/frame.h"
#include "scene/vector.h"

namespace pellucid::sample {

namespace {

// Push constants and uniforms of shaders/frame.glsl.
struct DrawConstants {
  glm::mat4 clipFromWorld;
  glm::vec4 baseColor, surface;
};
struct UniformLight {
  glm::vec4 position, direction, color;
  glm::uvec4 tiles;
};
struct UniformTile {
  glm::mat4 clipFromWorld;
  glm::vec4 rect, places;
};
struct Uniforms {
  glm::mat4 worldFromClip, previousFromCurrent;
  glm::vec4 eye, rect, extent, jitter, scale;
  glm::uvec4 flags;
  glm::vec4 ambient[9];
  UniformLight lights[kMostLights];
  UniformTile tiles[kMostTiles];
};

constexpr VkDeviceSize kUniformSlice = (sizeof(Uniforms) + 255) / 256 * 256;
constexpr VkShaderStageFlags kStages = VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;
constexpr std::uint32_t kImages = 7;  // that a pass reads at most
constexpr std::uint32_t kCascadeCount = 4, kAtlasColumns = 2, kCubeFaces = 6;
constexpr VkFormat kDepth = VK_FORMAT_D32_SFLOAT, kShadowDepth = VK_FORMAT_D16_UNORM,
                   kHalf = VK_FORMAT_R16G16B16A16_SFLOAT;
constexpr VkFormat kFormats[] = {VK_FORMAT_A2B10G10R10_UNORM_PACK32,
                                 VK_FORMAT_R8G8B8A8_SRGB,
                                 VK_FORMAT_R32_UINT,
                                 kHalf,
                                 kHalf,
                                 kHalf,
                                 kHalf,
                                 VK_FORMAT_R8G8B8A8_UNORM};

std::vector<VkDescriptorSetLayoutBinding> bindings() {
  std::vector<VkDescriptorSetLayoutBinding> all = {{0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 1, kStages}};
  for (std::uint32_t i = 1; i <= kImages; ++i)
    all.push_back({i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT});
  return all;
}

PellucidImage use(const DepthBuffer& depth) { return {depth.view(), kDepthRead}; }

}  // namespace

Renderer::Renderer(Device& device, const Scene& scene, VkExtent2D extent, std::uint32_t mapTexels)
    : device_(device),
      scene_(scene),
      extent_(extent),
      mapTexels_(mapTexels),
      mesh_(device, scene.model),
      shadows_{{{device, {mapTexels, mapTexels}, kShadowDepth, kCascadeCount},
                {device, {mapTexels * kAtlasColumns, mapTexels * kAtlasColumns}, kShadowDepth, 1},
                {device, {mapTexels, mapTexels}, kShadowDepth, kCubeFaces},
                {device, {mapTexels * kAtlasColumns, mapTexels * kAtlasColumns}, kDepth, 1}}},
      pool_(device),
      layout_(device, bindings(), {kStages, 0, sizeof(DrawConstants)}),
      lighting_(device),
      resolve_(device),
      linear_(device),
      compare_(device),
      submissions_(device),
      uniforms_(device, kFramesInFlight * kUniformSlice, VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT),
      pellucid_(device.instance(), device.physicalDevice(), device.handle(), scene.materials),
      constants_(device, kFramesInFlight * PellucidPass::sliceSize(),
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                     VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT) {
  for (std::size_t i = 0; i < kShadowImages; ++i)
    for (std::size_t layer = 0; layer < shadows_[i].layers(); ++layer)
      shadowPasses_[i].push_back(
          passTo(shadows_[i].extent(), {}, shadows_[i].layer(layer), shadows_[i].format()));
  resize(extent);
  createPipelines();
}

void Renderer::resize(VkExtent2D extent) {
  vkDeviceWaitIdle(device_.handle());
  extent_ = extent;
  resized_ = next_;
  for (std::size_t i = 0; i < kTargets; ++i)
    targets_[i] =
        std::make_unique<GpuImage>(device_, static_cast<int>(extent.width), static_cast<int>(extent.height),
                                   kFormats[i], VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  targets_[kHistory + (next_ + 1) % 2]->clear();  // the next frame binds it, and no frame has drawn it
  depth_.emplace(device_, extent, kDepth);
  backDepth_.emplace(device_, extent, kDepth);
  gbufferPass_ = passTo(extent, {kNormal, kAlbedo, kSurface}, depth_->view(), kDepth);
  backPass_ = passTo(extent, {}, backDepth_->view(), kDepth);
  lightingPass_ = passTo(extent, {kIrradiance, kColor}, VK_NULL_HANDLE, kDepth);
  for (int i = 0; i < 2; ++i)
    resolvePasses_[i] = passTo(extent, {kHistory + i, kPicture}, VK_NULL_HANDLE, kDepth);
}

std::unique_ptr<DrawPass> Renderer::passTo(VkExtent2D extent, const std::vector<int>& colors,
                                           VkImageView depth, VkFormat depthFormat) const {
  std::vector<Attachment> attachments;  // cleared to 0, which is far of reversed depths
  for (const int i : colors)
    attachments.push_back({targets_[i]->use().view, kFormats[i], {}, VK_IMAGE_LAYOUT_GENERAL});
  return std::make_unique<DrawPass>(
      device_, extent, attachments,
      depth ? std::optional(Attachment{depth, depthFormat, {}, kDepthRead}) : std::nullopt);
}

void Renderer::createPipelines() {
  const Spirv screen{kSampleScreen, sizeof kSampleScreen};
  createPipeline(device_, *lightingPass_, layout_, screen, {kSampleLighting, sizeof kSampleLighting}, {},
                 lighting_);
  createPipeline(device_, *resolvePasses_[0], layout_, screen, {kSampleResolve, sizeof kSampleResolve}, {},
                 resolve_);
  VkSamplerCreateInfo sampler{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  sampler.magFilter = sampler.minFilter = VK_FILTER_LINEAR;
  sampler.addressModeU = sampler.addressModeV = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, linear_.receive()), "vkCreateSampler");
  sampler.compareEnable = VK_TRUE;
  sampler.compareOp = VK_COMPARE_OP_GREATER_OR_EQUAL;  // reversed: lit where nothing nearer is stored
  check(vkCreateSampler(device_.handle(), &sampler, nullptr, compare_.receive()), "vkCreateSampler");
}

void Renderer::draw(const Settings& settings, const ViewCamera& camera) {
  VkCommandBuffer commands = submissions_.begin(next_);
  settings_ = settings;
  makeFrame(camera);
  writeUniforms(camera);
  drawShadows(commands);
  drawGbuffer(commands);
  light(commands);
  if (frame_.ownQueue) {
    pellucid_.record(submissions_.goOn(device_.computeQueue(), PELLUCID_STAGES), frame_);
    commands = submissions_.goOn(device_.queue(), kDrawing.stages);
  } else if (settings.pellucid) {
    pellucid_.record(commands, frame_);
  }
  resolve(commands);
  submissions_.end();
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
  const double aspect = static_cast<double>(extent_.width) / extent_.height;
  const ClipRange range{camera.lens.range.nearPlane, std::numeric_limits<double>::infinity(), true};
  const glm::dmat4 still = toGlm(perspective(camera.lens.verticalFov, aspect, range));
  f.viewFromWorld = toGlm(camera.lens.viewFromWorld);
  f.lookedAt = glm::vec4(toGlm(camera.pivot), 1);
  previous_ = std::exchange(current_, still * f.viewFromWorld);
  // The sequence R2 of Roberts 2018, eight samples in turns.
  const double sample = settings_.taa ? static_cast<double>(next_ % 8) : 0;
  jitter_ = glm::fract(0.5 + sample * glm::dvec2(0.7548776662466927, 0.5698402909980532)) - 0.5;
  const glm::dvec3 moved(2 * jitter_.x / f.rect.width, 2 * jitter_.y / f.rect.height, 0);
  f.clipFromView = glm::translate(glm::dmat4(1), moved) * still;
  f.metersPerUnit = static_cast<float>(scene_.model.metersPerUnit);
  if (settings_.mistake == Mistake::Units) f.metersPerUnit /= 10;  // centimeters taken for millimeters
  f.preExposure =
      settings_.exposure * std::numbers::inv_pi_v<float>;  // albedo times what is stored is radiance
  f.normal = targets_[kNormal]->use();
  f.albedo = targets_[kAlbedo]->use();
  f.surface = targets_[kSurface]->use();
  f.depth = use(*depth_);
  f.backDepth = use(*backDepth_);
  f.irradiance = targets_[kIrradiance]->use();
  f.color = targets_[kColor]->use();
  std::transform(shadows_.begin(), shadows_.end(), f.shadows.begin(), use);
  f.hasFronts = settings_.cullFronts && settings_.fronts;
  f.hasAmbient = settings_.ambient;
  for (std::size_t i = 0; i < f.ambient.size(); ++i) f.ambient[i] = toGlm(scene_.ambient[i]);
  f.gatherSamples = settings_.gatherSamples;
  f.ownQueue = settings_.pellucid && settings_.ownQueue;
  const VkDeviceSize size = PellucidPass::sliceSize(), slice = next_ % kFramesInFlight * size;
  f.constants = {constants_.handle(), slice, size, static_cast<char*>(constants_.mapped()) + slice};
  transients_.clear();
  pool_.nextFrame();  // keeps what the frames in flight use
  f.transient = [this](const PellucidImageNeed& need) {
    const int width = static_cast<int>(need.extent[0]), height = static_cast<int>(need.extent[1]);
    return transients_.emplace_back(pool_.take(width, height, need.format))->use();
  };
  lit_.clear();
  for (const SceneLight& light : scene_.lights) {
    if (light.light.type == PELLUCID_LIGHT_SPOT && settings_.spots) addLight(light, light.views);
    if (light.light.type == PELLUCID_LIGHT_POINT && settings_.point) addLight(light, light.views);
    if (light.light.type == PELLUCID_LIGHT_DIRECTIONAL && settings_.sun)
      addLight(light, frameCascades(scene_.bounds, light.light, camera.lens, aspect, kCascadeCount,
                                    static_cast<int>(mapTexels_)));
  }
}

void Renderer::addLight(const SceneLight& light, const std::vector<LightView>& views) {
  lit_.push_back(&light.light);
  PellucidLight& l = frame_.lights.emplace_back(pellucidLight(light.light));
  l.firstShadowMap = static_cast<std::uint32_t>(frame_.tiles.size());
  l.shadowMapCount = static_cast<std::uint32_t>(views.size());
  const bool spot = l.type == PELLUCID_LIGHT_SPOT;
  const auto inAtlas = std::count_if(frame_.tiles.begin(), frame_.tiles.end(),
                                     [](const ShadowTile& tile) { return tile.image == kAtlas; });
  for (const LightView& view : views) {
    ShadowTile& t = frame_.tiles.emplace_back();
    t.image = spot ? kAtlas : l.type == PELLUCID_LIGHT_POINT ? kCube : kCascades;
    t.size = mapTexels_;
    t.clipFromWorld = toGlm(view.clipFromView) * toGlm(view.viewFromWorld);
    t.texel = 2 / (view.clipFromView[0] * mapTexels_);
    t.depthStep = 1.0f / 65535;  // of kShadowDepth
    if (settings_.mistake != Mistake::Bias) {
      t.biasConstant = -settings_.biasConstant;  // away from the light is less, as depths are reversed
      t.biasSlope = -settings_.biasSlope;
    }
    if (!spot) {
      t.layer = static_cast<std::uint32_t>(frame_.tiles.size()) - 1 - l.firstShadowMap;
      continue;
    }
    t.x = static_cast<std::uint32_t>(inAtlas) % kAtlasColumns * mapTexels_;
    t.y = static_cast<std::uint32_t>(inAtlas) / kAtlasColumns * mapTexels_;
    t.frontsCulled = settings_.cullFronts && settings_.mistake != Mistake::Fronts;
  }
}

void Renderer::writeUniforms(const ViewCamera& camera) const {
  const Frame& f = frame_;
  Uniforms u{};
  u.worldFromClip = glm::inverse(f.clipFromView * f.viewFromWorld);
  u.previousFromCurrent = previous_ * glm::inverse(current_);
  u.eye = glm::vec4(toGlm(camera.eye()), 1);
  u.rect = {f.rect.width, f.rect.height, 1.0 / f.rect.width, 1.0 / f.rect.height};
  u.extent = {f.extent.width, f.extent.height, 1.0 / f.extent.width, 1.0 / f.extent.height};
  u.jitter = {jitter_, settings_.taa && next_ > resized_ ? 0.1 : 1, 0};
  u.scale = {settings_.exposure, f.preExposure, settings_.specular, 0};
  u.flags = {f.lights.size(), settings_.mistake, settings_.pellucid, 0};
  for (std::size_t i = 0; f.hasAmbient && i < f.ambient.size(); ++i) u.ambient[i] = {f.ambient[i], 0};
  for (std::size_t i = 0; i < f.lights.size(); ++i) {
    const PellucidLight& l = f.lights[i];
    const auto vec4 = [](const float* v, float w) { return glm::vec4(v[0], v[1], v[2], w); };
    u.lights[i] = {vec4(l.position, static_cast<float>(l.type)),
                   vec4(l.direction, std::cos(l.innerConeAngle)),
                   vec4(l.color, 0) * l.intensity + glm::vec4(0, 0, 0, std::cos(l.outerConeAngle)),
                   {l.firstShadowMap, l.shadowMapCount, 0, 0}};
  }
  for (std::size_t i = 0; i < f.tiles.size(); ++i) {
    const ShadowTile& t = f.tiles[i];
    const double side = 1.0 / shadows_[t.image].extent().width;
    u.tiles[i] = {t.clipFromWorld,
                  {t.x * side, t.y * side, t.size * side, t.size * side},
                  {t.image, t.layer, t.texel, side}};
  }
  std::memcpy(static_cast<char*>(uniforms_.mapped()) + next_ % kFramesInFlight * kUniformSlice, &u, sizeof u);
}

VkPipeline Renderer::meshPipeline(const DrawPass& pass, VkCullModeFlags cull) {
  const auto [entry, isNew] =
      meshPipelines_.try_emplace({pass.depthFormat(), pass.colorCount(), cull}, device_);
  if (!isNew) return entry->second;
  DrawState state;
  state.input = UploadedMesh::vertexInput();
  state.raster.cullMode = cull;
  state.raster.frontFace = VK_FRONT_FACE_COUNTER_CLOCKWISE;
  state.raster.depthBiasEnable = state.depthBiasIsDynamic = true;
  state.depth.depthTestEnable = state.depth.depthWriteEnable = true;
  state.depth.depthCompareOp = VK_COMPARE_OP_GREATER;  // reversed
  const Spirv vertex{kSampleMesh, sizeof kSampleMesh}, gbuffer{kSampleGbuffer, sizeof kSampleGbuffer},
      depth{kSampleDepth, sizeof kSampleDepth};
  createPipeline(device_, pass, layout_, vertex, pass.colorCount() > 0 ? gbuffer : depth, state,
                 entry->second);
  return entry->second;
}

void Renderer::drawScene(VkCommandBuffer commands, const DrawPass& pass, const glm::dmat4& clipFromWorld,
                         VkCullModeFlags cull) {
  mesh_.bind(commands);
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, meshPipeline(pass, cull));
  bind(commands, {});
  for (const Part& part : scene_.model.parts) {
    const Surface& surface = scene_.model.surfaces[part.surface];
    const float roughness = surface.material ? 0.45f : 0.8f;
    const DrawConstants constants = {
        clipFromWorld, {toGlm(surface.baseColor), 0}, {surface.material, roughness, 0, 0}};
    vkCmdPushConstants(commands, layout_, kStages, 0, sizeof constants, &constants);
    vkCmdDrawIndexed(commands, part.indexCount, 1, part.firstIndex, 0, 0);
  }
}

void Renderer::drawShadows(VkCommandBuffer commands) {
  for (std::uint32_t image = 0; image < kShadowImages; ++image) {
    const float biased = image == kFronts ? 0.0f : 1.0f;
    vkCmdSetDepthBias(commands, -biased * settings_.biasConstant, 0, -biased * settings_.biasSlope);
    for (std::uint32_t layer = 0; layer < shadowPasses_[image].size(); ++layer) {
      if (image == kFronts && !frame_.hasFronts) continue;
      const DrawPass& pass = *shadowPasses_[image][layer];
      pass.begin(commands, {{0, 0}, shadows_[image].extent()});
      const VkCullModeFlags cull =
          image == kAtlas && settings_.cullFronts ? VK_CULL_MODE_FRONT_BIT : VK_CULL_MODE_BACK_BIT;
      for (const ShadowTile& t : frame_.tiles) {
        if (t.image != (image == kFronts ? kAtlas : image) || t.layer != layer) continue;
        setViewport(commands, {{static_cast<int>(t.x), static_cast<int>(t.y)}, {t.size, t.size}});
        drawScene(commands, pass, t.clipFromWorld, cull);
      }
      vkCmdEndRenderPass(commands);
    }
  }
}

void Renderer::drawGbuffer(VkCommandBuffer commands) {
  vkCmdSetDepthBias(commands, 0, 0, 0);
  for (const auto& [pass, cull] : {std::pair(gbufferPass_.get(), VK_CULL_MODE_BACK_BIT),
                                   std::pair(backPass_.get(), VK_CULL_MODE_FRONT_BIT)}) {
    pass->begin(commands, {{0, 0}, frame_.rect});
    drawScene(commands, *pass, frame_.clipFromView * frame_.viewFromWorld, cull);
    vkCmdEndRenderPass(commands);
  }
}

void Renderer::light(VkCommandBuffer commands) const {
  std::vector<Bound> images;
  for (const PellucidImage& image : {frame_.normal, frame_.albedo, frame_.surface, frame_.depth})
    images.push_back({image, nearest()});
  for (std::uint32_t i = kCascades; i <= kCube; ++i) images.push_back({frame_.shadows[i], compare_});
  drawScreen(commands, *lightingPass_, frame_.rect, lighting_, images);
}

void Renderer::resolve(VkCommandBuffer commands) const {
  const PellucidImage before = targets_[kHistory + (frame_.index + 1) % 2]->use();
  drawScreen(
      commands, *resolvePasses_[frame_.index % 2], extent_, resolve_,
      std::array{Bound{frame_.color, linear_}, Bound{frame_.depth, nearest()}, Bound{before, linear_}});
}

void Renderer::drawScreen(VkCommandBuffer commands, const DrawPass& pass, VkExtent2D extent,
                          VkPipeline pipeline, std::span<const Bound> images) const {
  pass.begin(commands, {{0, 0}, extent});
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline);
  bind(commands, images);
  vkCmdDraw(commands, 3, 1, 0, 0);
  vkCmdEndRenderPass(commands);
}

// The frame's uniforms at binding 0, images from 1 on.
void Renderer::bind(VkCommandBuffer commands, std::span<const Bound> images) const {
  DescriptorWrites writes;
  writes.buffer(0, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                {uniforms_.handle(), frame_.index % kFramesInFlight * kUniformSlice, kUniformSlice});
  for (std::uint32_t i = 0; i < images.size(); ++i)
    writes.image(i + 1, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, images[i].sampler, images[i].image);
  layout_.push(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, writes.all());
}

}  // namespace pellucid::sample
