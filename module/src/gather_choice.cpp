#include "gather_choice.h"

#include <algorithm>
#include <limits>

#include "gather.h"
#include "shadow_map.h"
#include "transmittance.h"

namespace pellucid {
namespace {

const char* whyNot(const Inputs& inputs, const Materials& materials) {
  const PellucidThesisOptions& t = inputs.thesis;
  if (inputs.frame.options.cameraThickness == 1) return "thickness comes from the camera";
  if (t.materialMarkBit != 0) return "materialMarkBit is of one thickness a pixel";
  if (t.angleModel != PELLUCID_ANGLE_NORMAL || t.constantViewDirection != 0 || t.minimumDot != 0 ||
      t.maximumThickness > 0)
    return "angleModel, constantViewDirection, minimumDot and maximumThickness are of one thickness a pixel";
  if (!materials.solids) return "every material is thin-walled";
  for (uint32_t i = 0; i < inputs.frame.materialCount; ++i)
    if (!canBeGathered(inputs.material(i).transmittanceModel))
      return "a material's transmittance model has no profile";
  return nullptr;
}

uint32_t spacingOf(const PellucidFrame& frame) {
  if (frame.options.gatherSpacing != 0) return frame.options.gatherSpacing;
  const uint64_t pixels = static_cast<uint64_t>(frame.imageExtent[0]) * frame.imageExtent[1];
  return pixels > 1u << 20 ? 4 : pixels > 1u << 19 ? 2 : 1;
}

float entrySide(const Inputs& inputs) {
  constexpr float kPerPath = 2;
  float shortest = std::numeric_limits<float>::infinity();
  for (uint32_t i = 0; i < inputs.frame.materialCount; ++i)
    if (const PellucidMaterial m = inputs.material(i); m.thinWalled == 0)
      shortest = std::min(shortest, meanFreePath(m));
  return shortest / (kPerPath * 1000 * inputs.frame.metersPerUnit);
}

}  // namespace

GatherChoice::GatherChoice(const Inputs& inputs, const Materials& materials)
    : whyNotGathered(whyNot(inputs, materials)) {
  gatherSamples = whyNotGathered ? 0 : inputs.frame.options.gatherSamples;
  gatherSpacing = spacingOf(inputs.frame);
  gathers = inputs.translucency() && gatherSamples > 0 && !inputs.debug();
  shapes = gathers && materials.diffuses && inputs.has(PELLUCID_RESOURCE_NORMAL);
  longestEntrySide = entrySide(inputs);
}

}  // namespace pellucid
