// Facts of a frame, each found once: a stage is made from the stages before it, and planning, image needs and
// constants read all of them.
#pragma once

#include "blocks.h"
#include "constants_layout.h"
#include "lights.h"
#include "stages.h"
#include "validate.h"

namespace pellucid {

struct FrameFacts : Inputs, Screen, Materials, GatherChoice {
  // `out` gets warnings.
  FrameFacts(const Inputs& inputs, const Screen& screen, const Materials& materials,
             const GatherChoice& gather, Findings& out);

  Lights lights;
  Blocks blocks;
  Stages stages;
  uint32_t coarsestLevel;  // of the pyramid that the diffusion needs
  ConstantsLayout constants;

  // `active`: index among the lights that contribute.
  const PellucidLight& light(uint32_t active) const { return lights.light(*this, active); }
  bool isGathered(const PellucidLight& light) const { return GatherChoice::isGathered(*this, light); }
};

// use(const FrameFacts&), where nothing is wrong that a plan relies on: image views are not among it. Each
// check relies on the checks before it.
template <class Use>
PellucidResult readFrame(const PellucidFrame* frame, Findings& out, Use&& use) {
  Inputs inputs;
  if (!readInputs(frame, out, &inputs)) return out.result();
  checkFields(inputs, out);
  if (out.result() != PELLUCID_OK) return out.result();
  checkMaterials(inputs, out);
  checkShadowMaps(inputs, out);
  if (out.result() != PELLUCID_OK) return out.result();
  const Screen screen(inputs);
  const Materials materials(inputs, screen);
  const GatherChoice gather(inputs, materials);
  checkLights(inputs, gather, out);
  if (out.result() != PELLUCID_OK) return out.result();
  const FrameFacts facts(inputs, screen, materials, gather, out);
  checkGroups(facts, out);
  return out.result() == PELLUCID_OK ? use(facts) : out.result();
}

}  // namespace pellucid
