#include "frame.h"

#include "pyramid_energy.h"

namespace pellucid {
namespace {

// Leaves out levels for radii that are small in pixels.
uint32_t levelsFor(const Pyramid& pyramid, const DiffusionReach& reach, bool diffusion) {
  uint32_t coarsest = pyramid.coarsest;
  while (diffusion && reach.deviation > 0 && coarsest > kFirstLevel + 2 &&
         reach.deviation <= deviationWithin(coarsest - 2))
    coarsest -= 2;
  return coarsest;
}

}  // namespace

FrameFacts::FrameFacts(const Inputs& inputs, const Screen& screen, const Materials& materials,
                       const GatherChoice& gather, Findings& out)
    : Inputs(inputs),
      Screen(screen),
      Materials(materials),
      GatherChoice(gather),
      lights(inputs, screen, materials, gather, out),
      blocks(lights, screen.rect),
      stages(inputs, materials, gather, lights, blocks),
      coarsestLevel(levelsFor(screen.pyramid, materials.reach, stages.diffusion)),
      constants(inputs, gather, lights, stages, blocks) {}

}  // namespace pellucid
