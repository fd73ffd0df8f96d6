// Pellucid in this renderer: all of it. Copy the file; frame.h is the engine's own.
#pragma once
#include "sample/frame.h"

namespace pellucid::sample {
class PellucidPass {
public:
  PellucidPass(Device& device, const std::vector<PellucidMaterial>& materials)
      : materials_(materials),
        ring_(device, kFramesInFlight * slice_, kConstantsUsage) {
    PellucidContextDesc desc;
    pellucidInitContextDesc(&desc);
    desc.instance = device.instance(), desc.physicalDevice = device.physicalDevice();
    desc.device = device.handle(), desc.getInstanceProcAddr = vkGetInstanceProcAddr, desc.message = report;
    desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY;  // cascades, atlas and cube are arrays
    require(pellucidCreateContext(&desc, &context_));
  }
  ~PellucidPass() { pellucidDestroyContext(context_); }

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
    frame.frontDepth = f.depth, frame.backDepth = f.backDepth;
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
      const bool fronts = f.hasFronts && t.image == kAtlas;  // a second map of front faces, beside the engine's
      maps.push_back({fronts ? kFronts : t.image, {t.size, t.size}, PELLUCID_DEPTH_DEVICE});
      put(t.clipFromWorld, maps.back().clipFromWorld);
      maps.back().options = {.offset = {t.x, t.y}, .layer = t.layer, .backFaces = t.frontsCulled && !fronts};
      maps.back().options.depthBiasConstant = t.biasConstant * t.depthStep;  // factors of vkCmdSetDepthBias
      maps.back().options.depthBiasSlope = t.biasSlope, maps.back().options.depthStep = t.depthStep;
    }
    frame.shadowMapCount = static_cast<uint32_t>(maps.size()), frame.shadowMaps = maps.data();
    frame.shadowImageCount = kShadowImages, frame.shadowImages = f.shadows.data();
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t count = std::size(needs);
    require(pellucidGetImageNeeds(&frame, &count, needs));
    for (uint32_t i = 0; i < count; ++i) frame.transients[i] = f.transient(needs[i]);
    if (f.index == 0) require(pellucidValidateFrame(&frame, report, nullptr));
    PellucidPlan plan;
    require(pellucidBuildPlan(&frame, nullptr, &plan));
    const VkDeviceSize at = f.index % kFramesInFlight * slice_;  // the GPU still reads the other slices
    if (!f.ownQueue) barrier(commands, kDrawing, kScope);
    const PellucidConstantsSlice slice{ring_.handle(), at, slice_, static_cast<char*>(ring_.mapped()) + at};
    require(pellucidWriteConstants(&plan, &frame, slice.mapped, slice_));
    require(pellucidRecordPlan(context_, commands, &plan, &frame, &slice));
    if (!f.ownQueue) barrier(commands, kScope, kDrawing);
  }

private:
  static constexpr Scope kScope{PELLUCID_STAGES, PELLUCID_READS | PELLUCID_WRITES};
  static void report(void*, PellucidSeverity, const char* field, const char* sentence) {
    std::fprintf(stderr, "Pellucid: %s: %s\n", field, sentence);
  }
  static void require(PellucidResult result) {
    if (result != PELLUCID_OK) throw DeviceError(std::string("Pellucid: ") + pellucidResultName(result));
  }
  static void put(const glm::dmat4& m, float (&to)[16]) { std::copy_n(&glm::mat4(m)[0][0], 16, to); }
  std::vector<PellucidMaterial> materials_;
  VkDeviceSize slice_ = pellucidGetConstantsSize(kMostMaterials, kMostLights, kMostTiles);
  HostBuffer ring_;
  PellucidContext* context_ = nullptr;
};
}  // namespace pellucid::sample
