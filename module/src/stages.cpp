#include "stages.h"

namespace pellucid {

Stages::Stages(const Inputs& inputs, const Materials& materials, const GatherChoice& gather,
               const Lights& all, const Blocks& blocks) {
  const bool translucency = inputs.translucency(), debug = inputs.debug();
  diffusion = !debug && (materials.diffuses || all.gathered > 0);
  if (translucency || debug) {
    gathered = all.gathered;
    fused = all.fused();
    walls = all.walls(materials, gather);
  }
  lights = fused > 0;
  copies = diffusion && !lights && walls == 0 && !inputs.separate();
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output, unless that
  // is what it is.
  nothing = writers() == 0 && inputs.inPlace && !inputs.has(PELLUCID_RESOURCE_ALBEDO);
  if (writers() == 0 && !nothing) fused = 1;
  keepsHistory =
      inputs.frame.options.reuse != PELLUCID_REUSE_NONE && !debug && translucency && all.lightCount > 0;
  keepsProbes = keepsHistory && all.gathered > 0;
  history = keepsHistory && !keepsProbes;
  lists = diffusion && whyNoLists(inputs, all, blocks) == nullptr;
}

}  // namespace pellucid
