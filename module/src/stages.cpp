#include "stages.h"

#include "frame.h"

namespace pellucid {

Stages::Stages(const FrameFacts& facts) {
  const PellucidFrame& frame = facts.frame;
  const bool translucency = (frame.features & PELLUCID_FEATURE_TRANSLUCENCY) != 0;
  diffusion = !facts.debug() && (facts.diffuses || facts.lights.gathered > 0);
  if (translucency || facts.debug()) {
    gathered = facts.lights.gathered;
    fused = facts.lights.fused();
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
  lists = diffusion && whyNoLists(facts) == nullptr;
}

}  // namespace pellucid
