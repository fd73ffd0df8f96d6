#include "frame.h"

namespace pellucid {

Rect renderRect(const PellucidFrame& frame) {
  if (frame.renderRect[2] == 0) return {0, 0, frame.imageExtent[0], frame.imageExtent[1]};
  return {frame.renderRect[0], frame.renderRect[1], frame.renderRect[2], frame.renderRect[3]};
}

bool anyMaterialDiffuses(const PellucidFrame& frame) {
  for (uint32_t i = 0; i < frame.materialCount; ++i)
    if (frame.materials[i].gaussianCount > 0) return true;
  return false;
}

bool addLight(const PellucidFrame& frame, const PellucidLight& light, LightGroup* group) {
  LightGroup grown = *group;
  for (uint32_t i = 0; i < light.shadowMapCount; ++i) {
    const uint32_t image = frame.shadowMaps[light.firstShadowMap + i].image;
    if (grown.slot(image) < PELLUCID_SHADOW_IMAGE_COUNT) continue;
    if (grown.imageCount == PELLUCID_SHADOW_IMAGE_COUNT) return false;
    grown.images[grown.imageCount++] = image;
  }
  ++grown.lightCount;
  *group = grown;
  return true;
}

uint32_t lightGroupCount(const PellucidFrame& frame) {
  uint32_t count = 0;
  forEachLightGroup(
      frame, [](const LightGroup&, const PellucidLight&) {}, [&](const LightGroup&) { ++count; });
  return count;
}

ConstantsLayout constantsLayout(const PellucidFrame& frame) {
  ConstantsLayout layout{};
  forEachLightGroup(
      frame,
      [&](const LightGroup&, const PellucidLight& light) {
        ++layout.lightCount;
        layout.shadowCount += light.shadowMapCount;
      },
      [](const LightGroup&) {});
  const auto place = [&layout](ConstantsLayout::Range* range, VkDeviceSize elements, VkDeviceSize bytes) {
    // A binding of zero bytes is not valid; an unused one still has room for one element.
    range->size = (elements > 0 ? elements : 1) * bytes;
    range->offset = layout.size;
    layout.size += (range->size + 255) / 256 * 256;
  };
  place(&layout.frame, 1, sizeof(shared::FrameConstants));
  place(&layout.lights, layout.lightCount, sizeof(shared::LightConstants));
  place(&layout.shadows, layout.shadowCount, sizeof(shared::ShadowConstants));
  place(&layout.materials, frame.materialCount, sizeof(shared::MaterialConstants));
  place(&layout.kernels, frame.materialCount, sizeof(shared::KernelConstants));
  return layout;
}

}  // namespace pellucid

extern "C" void pellucidInitFrame(PellucidFrame* frame) {
  if (!frame) return;
  *frame = PellucidFrame{};
  frame->structSize = sizeof(PellucidFrame);
  frame->features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  frame->metersPerUnit = 1;
  for (int i = 0; i < 4; ++i) frame->viewFromWorld[i * 5] = 1;
  frame->outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  for (float& factor : frame->transmittanceFilter) factor = 1;
  frame->faceVector[2] = 1;
  frame->upAxis[1] = 1;
  frame->coherenceThreshold = 0.005f;
}
