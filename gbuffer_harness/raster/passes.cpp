#include "raster/passes.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "kRasterDepths.h"
#include "kRasterHalf.h"
#include "kRasterIrradiance.h"
#include "kRasterReflect.h"
#include "scene/vector.h"
#include "shared/pellucid_shared.h"

namespace pellucid::harness {

namespace {

static_assert(PELLUCID_SHADER_LIGHT_DIRECTIONAL == PELLUCID_LIGHT_DIRECTIONAL);
static_assert(PELLUCID_SHADER_LIGHT_SPOT == PELLUCID_LIGHT_SPOT);

constexpr std::uint32_t kShadowMaps = 6;  // SHADOW_MAPS

constexpr VkDescriptorType kSampled = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER,
                           kStored = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
                           kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                           kBuffer = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;

// Push constants of shaders/depths.comp.
struct DepthPush {
  float nothing;
  std::uint32_t isDevice, greaterIsNearer, nearestBack;
};

// The uniform block.
struct Constants {
  struct ShadowView {
    glm::mat4 clipFromView;
    glm::vec4 planar, texel;
  };
  glm::mat4 viewFromWorld;
  ShadowView shadowViews[kShadowMaps];
  glm::vec4 shadow, eye;
  glm::ivec4 lookup;
  shared::LightConstants light;
};

shared::LightConstants lightConstants(const Light& light, const glm::dmat4& viewFromWorld) {
  shared::LightConstants constants{};
  constants.meta.x = light.type;
  constants.radiance = glm::vec4(toGlm(light.color) * light.intensity, 0);
  constants.position = glm::vec4(viewFromWorld * glm::dvec4(toGlm(light.position), 1));
  constants.position.w = static_cast<float>(light.range > 0 ? 1 / light.range : 0);
  constants.direction = glm::vec4(glm::normalize(glm::dmat3(viewFromWorld) * toGlm(light.direction)), 0);
  // KHR_lights_punctual, "Inner and Outer Cone Angles". Its guard of .001 would darken spots of less than 2.6 degrees.
  const double outer = std::cos(light.outerConeAngle);
  const double scale = 1 / std::max(1e-6, std::cos(light.innerConeAngle) - outer);
  constants.cone = glm::vec4(scale, -outer * scale, 0, 0);
  return constants;
}

void setShadows(Constants& constants, const std::vector<ShadowImage>& maps, int filter,
                const glm::dmat4& worldFromView) {
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const ShadowImage& image = maps[i];
    const glm::dmat4 shadowView = toGlm(image.viewFromWorld) * worldFromView;
    // The view is 2 / clipFromView[0] wide, at planar distance 1 if it is a perspective.
    constants.shadowViews[i] = {glm::mat4(toGlm(image.clipFromView) * shadowView),
                                -glm::vec4(glm::transpose(shadowView)[2]),
                                glm::vec4(static_cast<float>(2 / image.clipFromView[0] / image.size))};
  }
  if (maps.empty()) return;
  const ShadowImage& first = maps.front();
  constants.shadow = glm::vec4(first.size, first.perspective, 0, 0);
  constants.lookup.x = static_cast<int>(maps.size());
  constants.lookup.y = first.perspective && maps.size() > 1;
  constants.lookup.z = filter;
}

Constants constantsOf(const LitSurfaces& surfaces, const Light& light, const std::vector<ShadowImage>& maps,
                      int filter) {
  const Matrix& clipFromView = surfaces.view.clipFromView;
  const glm::dmat4 viewFromWorld = toGlm(surfaces.view.viewFromWorld);
  Constants constants{};
  constants.viewFromWorld = glm::mat4(viewFromWorld);
  constants.light = lightConstants(light, viewFromWorld);
  const bool perspective = clipFromView[15] == 0;
  constants.eye =
      glm::vec4(1 / clipFromView[0], 1 / clipFromView[5], perspective ? -clipFromView[8] : clipFromView[12],
                perspective ? -clipFromView[9] : clipFromView[13]);
  constants.lookup.w = perspective;
  setShadows(constants, maps, filter, glm::inverse(viewFromWorld));
  return constants;
}

PixelPass irradiancePass(Device& device, std::uint32_t maps) {
  constexpr VkSpecializationMapEntry kEntry{0, 0, sizeof maps};
  return {device,
          {kRasterIrradiance, sizeof kRasterIrradiance},
          {{kUniform}, {kSampled}, {kSampled, kShadowMaps}, {kStored}, {kSampled}},
          0,
          {1, &kEntry, sizeof maps, &maps}};
}

}  // namespace

DrawPasses::DrawPasses(Device& device)
    : targets(device),
      images(device),
      depths_(device, {kRasterDepths, sizeof kRasterDepths},
              {{kSampled}, {kSampled}, {kSampled}, {kSampled}, {kSampled}, {kStored}, {kStored}, {kBuffer}},
              sizeof(DepthPush)),
      reflection_(device, {kRasterReflect, sizeof kRasterReflect}, {{kStored}, {kSampled}}),
      halves_(device, {kRasterHalf, sizeof kRasterHalf}, {{kSampled}, {kStored}}),
      one_(irradiancePass(device, 1)),
      six_(irradiancePass(device, kShadowMaps)),
      counts_(device, sizeof(DepthCounts), VK_BUFFER_USAGE_STORAGE_BUFFER_BIT),
      constants_(device, sizeof(Constants),
                 VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {}

void DrawPasses::recordDepths(VkCommandBuffer commands, const FrontTarget& front, const BackFaces& back,
                              const GpuImage& frontDepth, const GpuImage& backDepth,
                              const RasterOptions& options) const {
  std::memset(counts_.mapped(), 0, sizeof(DepthCounts));
  const bool isDevice = options.depthEncoding == PELLUCID_DEPTH_DEVICE;
  const DepthPush push{isDevice ? farDepth(options.reversedZ) : kNoDepth, isDevice,
                       isDevice && options.reversedZ, options.backFace == BackFace::Nearest};
  DescriptorWrites writes;
  const GpuImage* const read[] = {&front.normalPlanar(), &front.depthNormal(),
                                  &back.depths->image(isDevice ? kDeviceDepth : kPlanar),
                                  &back.counts->image(0), &front.material()};
  std::uint32_t binding = 0;
  for (const GpuImage* image : read) writes.image(binding++, kSampled, depths_.sampler(), image->use());
  for (const GpuImage* image : {&frontDepth, &backDepth})
    writes.image(binding++, kStored, VK_NULL_HANDLE, image->use());
  writes.buffer(binding, kBuffer, {counts_.handle(), 0, VK_WHOLE_SIZE});
  depths_.record(commands, writes.all(), options.width, options.height, &push);
  barrier(commands, {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_SHADER_WRITE_BIT},
          {VK_PIPELINE_STAGE_HOST_BIT, VK_ACCESS_HOST_READ_BIT});
}

DepthCounts DrawPasses::counts() const {
  DepthCounts counts;
  std::memcpy(&counts, counts_.mapped(), sizeof counts);
  return counts;
}

void DrawPasses::recordReflection(VkCommandBuffer commands, const GpuImage& irradiance,
                                  const GpuImage& share) const {
  DescriptorWrites writes;
  writes.image(0, kStored, VK_NULL_HANDLE, irradiance.use());
  writes.image(1, kSampled, reflection_.sampler(), share.use());
  reflection_.record(commands, writes.all(), irradiance.width(), irradiance.height());
}

void DrawPasses::recordHalves(VkCommandBuffer commands, const GpuImage& from, const GpuImage& to) const {
  DescriptorWrites writes;
  writes.image(0, kSampled, halves_.sampler(), from.use());
  writes.image(1, kStored, VK_NULL_HANDLE, to.use());
  halves_.record(commands, writes.all(), to.width(), to.height());
}

void DrawPasses::recordIrradiance(VkCommandBuffer commands, const LitSurfaces& surfaces, const Light& light,
                                  const std::vector<ShadowImage>& shadows, int filter) const {
  const Constants constants = constantsOf(surfaces, light, shadows, filter);
  // The light before is done with the buffer: PixelPass ends with a barrier.
  vkCmdUpdateBuffer(commands, constants_.handle(), 0, sizeof constants, &constants);
  barrier(commands, {VK_PIPELINE_STAGE_TRANSFER_BIT, VK_ACCESS_TRANSFER_WRITE_BIT},
          {VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT, VK_ACCESS_UNIFORM_READ_BIT});

  const PixelPass& pass = shadows.size() <= 1 ? one_ : six_;
  // A descriptor that is not read must be valid all the same.
  VkDescriptorImageInfo maps[kShadowMaps];
  for (std::size_t i = 0; i < kShadowMaps; ++i) {
    const PellucidImage map = i >= shadows.size() ? surfaces.normalPlanar.use()
                              : filter > 0        ? shadows[i].depths
                                                  : shadows[i].planar;
    maps[i] = {pass.sampler(), map.view, map.layout};
  }
  DescriptorWrites single;
  single.buffer(0, kUniform, {constants_.handle(), 0, VK_WHOLE_SIZE});
  single.image(1, kSampled, pass.sampler(), surfaces.normalPlanar.use());
  single.image(3, kStored, VK_NULL_HANDLE, surfaces.irradiance.use());
  single.image(4, kSampled, pass.sampler(), surfaces.depthNormal.use());
  std::vector<VkWriteDescriptorSet> writes = single.all();
  writes.push_back(
      {VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET, nullptr, VK_NULL_HANDLE, 2, 0, kShadowMaps, kSampled, maps});
  pass.record(commands, writes, surfaces.irradiance.width(), surfaces.irradiance.height());
}

}  // namespace pellucid::harness
