#include "stages.h"

#include "frame.h"

namespace pellucid {
namespace {

// True where all light that comes through is gathered, in one group and for every pixel with a material: then
// what adds it needs nothing else of the pixels.
bool addsProbesAlone(const FrameFacts& facts) {
  const LightGroup& group = facts.lights.last;
  return facts.lights.count == 1 && group.lightCount == group.gathered && facts.thesis.materialMarkBit == 0 &&
         facts.gatherSpacing == PELLUCID_DIFFUSE_CELL;
}

}  // namespace

Stages::Stages(const FrameFacts& facts) {
  const PellucidFrame& frame = facts.frame;
  const bool translucency = (frame.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0;
  diffusion = frame.features & PELLUCID_FEATURE_DIFFUSION && !facts.debug() && facts.diffuses;
  addsProbes = diffusion && addsProbesAlone(facts);
  if (translucency || facts.debug()) {
    gathered = facts.lights.gathered;
    fused = addsProbes ? 0 : facts.lights.fused();
    walls = facts.lights.walls(facts);
  }
  lights = fused > 0;
  copies = diffusion && !lights && walls == 0 && !facts.separate();
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output, unless that
  // is what it is.
  nothing = writers() == 0 && facts.inPlace && !facts.has(PELLUCID_RESOURCE_ALBEDO);
  if (writers() == 0 && !nothing) fused = 1;
  keepsHistory =
      frame.reuse != PELLUCID_REUSE_NONE && !facts.debug() && translucency && facts.lights.lightCount > 0;
  keepsProbes = keepsHistory && facts.lights.gathered > 0;
  history = keepsHistory && !keepsProbes;
  // More would be more transients than there are.
  overlaps = diffusion && gathered == 1 && colorTransients() <= 1 && !history;
  // Probes that are kept are read where no light is found, too.
  skipsLight = overlaps && addsProbes && !keepsProbes && frame.indirectDispatches;
}

}  // namespace pellucid
