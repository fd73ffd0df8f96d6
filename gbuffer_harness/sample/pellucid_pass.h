// Pellucid in this renderer: all of it. Copy this file and frame.h, and fill a Frame from your engine's data.
#pragma once
#include <algorithm>
#include <cstdio>
#include <iterator>
#include <stdexcept>
#include <string>

#include "sample/frame.h"

namespace pellucid::sample {
class PellucidPass {
public:
  PellucidPass(VkInstance instance, VkPhysicalDevice physicalDevice, VkDevice device,
               const std::vector<PellucidMaterial>& materials)
      : materials_(materials) {
    PellucidContextDesc desc;
    pellucidInitContextDesc(&desc);
    desc.instance = instance, desc.physicalDevice = physicalDevice, desc.device = device;
    desc.getInstanceProcAddr = vkGetInstanceProcAddr, desc.message = report;
    desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;  // cascades, atlas and cube are arrays
    require(pellucidCreateContext(&desc, &context_));
  }
  PellucidPass(const PellucidPass&) = delete;
  PellucidPass& operator=(const PellucidPass&) = delete;
  ~PellucidPass() { pellucidDestroyContext(context_); }

  // Bytes of Frame::constants, a multiple of 256.
  static VkDeviceSize sliceSize() { return pellucidGetConstantsSize(kMostMaterials, kMostLights, kMostTiles); }

  // Adds the diffuse light of pixels with a material to the color: after lighting, before antialiasing.
  void record(VkCommandBuffer commands, const Frame& f) {
    PellucidFrame frame;
    pellucidInitFrame(&frame);
    std::copy_n(&f.extent.width, 2, frame.imageExtent);
    std::copy_n(&f.rect.width, 2, frame.options.renderRect + 2);
    // The rendered rect has a projection of its own; clipFromView is that of the whole image.
    const double x = 1.0 * f.rect.width / f.extent.width, y = 1.0 * f.rect.height / f.extent.height;
    const glm::dmat4 whole(x, 0, 0, 0, 0, y, 0, 0, 0, 0, 1, 0, x - 1, y - 1, 0, 1);
    put(whole * f.clipFromView, frame.clipFromView);
    put(f.viewFromWorld, frame.viewFromWorld);
    std::copy_n(&f.lookedAt[0], 4, frame.options.anchor);  // noise stays with the body as it moves on the screen
    frame.metersPerUnit = f.metersPerUnit, frame.preExposure = f.preExposure;
    frame.frontDepth = f.depth, frame.backDepth = f.backDepth;  // no view, if all maps hold front faces
    frame.albedo = f.albedo, frame.irradiance = f.irradiance;
    frame.material = f.surface, frame.output = f.color;
    frame.options.materialMask = 0xFF0000, frame.options.materialShift = 16;  // beside roughness
    frame.options.addToOutput = 1;                                            // to specular light
    frame.materialCount = static_cast<uint32_t>(materials_.size()), frame.materials = materials_.data();
    frame.options.gatherSamples = f.gatherSamples;
    frame.options.ambient = f.hasAmbient ? &f.ambient[0][0] : nullptr;
    frame.lightCount = static_cast<uint32_t>(f.lights.size()), frame.lights = f.lights.data();
    std::vector<PellucidShadowMap> maps;
    for (const ShadowTile& t : f.tiles) {
      const bool fronts = f.hasFronts && t.image == kAtlas;  // a second map of front faces without bias, beside the engine's
      maps.push_back({fronts ? kFronts : t.image, {t.size, t.size}, PELLUCID_DEPTH_DEVICE});
      put(t.clipFromWorld, maps.back().clipFromWorld);
      maps.back().options = {.offset = {t.x, t.y}, .layer = t.layer, .backFaces = t.frontsCulled && !fronts};
      if (fronts) continue;
      maps.back().options.depthBiasConstant = t.biasConstant * t.depthStep;  // factors of vkCmdSetDepthBias; D32: 2^-24
      maps.back().options.depthBiasSlope = t.biasSlope, maps.back().options.depthStep = t.depthStep;
    }
    frame.shadowMapCount = static_cast<uint32_t>(maps.size()), frame.shadowMaps = maps.data();
    frame.shadowImageCount = kShadowImages, frame.shadowImages = f.shadows.data();
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t count = std::size(needs);
    require(pellucidGetImageNeeds(&frame, &count, needs));
    for (uint32_t i = 0; i < count; ++i) frame.transients[i] = f.transient(needs[i]);
    if (f.index == 0) require(pellucidValidateFrame(&frame, report, nullptr));  // in debug builds each frame
    PellucidPlan plan;
    require(pellucidBuildPlan(&frame, nullptr, &plan));
    require(pellucidWriteConstants(&plan, &frame, f.constants.mapped, f.constants.size));
    if (!f.ownQueue) barrier(commands, kDrawing, kDrawn, PELLUCID_STAGES, PELLUCID_READS | PELLUCID_WRITES);
    require(pellucidRecordPlan(context_, commands, &plan, &frame, &f.constants));
    if (!f.ownQueue) barrier(commands, PELLUCID_STAGES, PELLUCID_WRITES, kDrawing, kDrawn | VK_ACCESS_SHADER_READ_BIT);
  }

private:
  // The passes that draw inputs, and those that read the output. Compute passes among them add COMPUTE_SHADER and SHADER_WRITE.
  static constexpr VkPipelineStageFlags kDrawing =
      VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT |
      VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  static constexpr VkAccessFlags kDrawn =
      VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  static void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkAccessFlags written,
                      VkPipelineStageFlags to, VkAccessFlags used) {
    const VkMemoryBarrier memory{VK_STRUCTURE_TYPE_MEMORY_BARRIER, nullptr, written, used};
    vkCmdPipelineBarrier(commands, from, to, 0, 1, &memory, 0, nullptr, 0, nullptr);
  }
  static void report(void*, PellucidSeverity, const char* field, const char* sentence) {
    std::fprintf(stderr, "Pellucid: %s: %s\n", field, sentence);
  }
  static void require(PellucidResult result) {
    if (result != PELLUCID_OK) throw std::runtime_error(std::string("Pellucid: ") + pellucidResultName(result));
  }
  static void put(const glm::dmat4& m, float (&to)[16]) { std::copy_n(&glm::mat4(m)[0][0], 16, to); }
  std::vector<PellucidMaterial> materials_;
  PellucidContext* context_ = nullptr;
};
}  // namespace pellucid::sample
