#include "gather_choice.h"

#include <algorithm>
#include <iterator>
#include <limits>

#include "diffusion_error_table.h"
#include "frame_error_table.h"
#include "gather.h"
#include "shadow_map.h"

namespace pellucid {
namespace {

const char* whyNot(const Inputs& inputs, const Materials& materials) {
  const PellucidThesisOptions& t = inputs.thesis;
  if (inputs.frame.thicknessSource == PELLUCID_THICKNESS_CAMERA) return "thickness comes from the camera";
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
  if (frame.gatherSpacing != 0) return frame.gatherSpacing;
  const uint64_t pixels = static_cast<uint64_t>(frame.imageExtent[0]) * frame.imageExtent[1];
  return pixels > 1u << 20 ? 4 : pixels > 1u << 19 ? 2 : 1;
}

// The worst at radii up to `radius` pixels; 0: at all.
float diffusionError(double radius) {
  // Errors were measured at some radii; up to the first one that is not less than the frame's.
  size_t count = std::size(kErrorRadii);
  if (radius > 0) {
    const float* least = std::lower_bound(std::begin(kErrorRadii), std::end(kErrorRadii), radius);
    count = std::min(count, static_cast<size_t>(least - kErrorRadii) + 1);
  }
  return *std::max_element(kWorstError, kWorstError + count);
}

// Only maps let light be gathered. Lights have not been checked yet.
bool someLightHasMap(const PellucidFrame& f) {
  return f.lights && std::any_of(f.lights, f.lights + f.lightCount,
                                 [](const PellucidLight& light) { return light.shadowMapCount > 0; });
}

// The least number of samples whose measured error is below frame.targetError; false, and the most: none.
bool samplesOfTarget(const Inputs& inputs, const Materials& materials, bool canGather, uint32_t* samples) {
  const PellucidFrame& frame = inputs.frame;
  const bool lit = inputs.translucency() && frame.lightCount > 0;
  canGather = canGather && someLightHasMap(frame);
  for (size_t i = 0; i < std::size(kTargetSamples); ++i) {
    *samples = kTargetSamples[i];
    const float error = lit ? kFrameError[canGather ? i : 0] : diffusionError(materials.reach.radius);
    if (error < frame.targetError) return true;
  }
  return false;
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
    : whyNotGathered(whyNot(inputs, materials)), askedSamples(inputs.frame.gatherSamples) {
  if (inputs.frame.targetError > 0)
    missesTarget = !samplesOfTarget(inputs, materials, !whyNotGathered, &askedSamples);
  gatherSamples = whyNotGathered ? 0 : askedSamples;
  gatherSpacing = spacingOf(inputs.frame);
  gathers = inputs.translucency() && gatherSamples > 0 && !inputs.debug();
  shapes = gathers && materials.diffuses && inputs.has(PELLUCID_RESOURCE_NORMAL);
  longestEntrySide = entrySide(inputs);
}

}  // namespace pellucid
