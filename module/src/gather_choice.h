// Whether and how finely the frame gathers light from its shadow maps.
#pragma once

#include "materials.h"

namespace pellucid {

struct GatherChoice {
  GatherChoice(const Inputs& inputs, const Materials& materials);

  const char* whyNotGathered;  // NULL: lights with a map can be. Static string
  uint32_t gatherSamples;      // of each probe, 0 where no light can be gathered
  uint32_t gatherSpacing;      // pixels a side of what one probe stands for
  bool gathers;                // lights with a map are gathered from
  bool shapes;                 // curved surfaces return more or less light than planes, as probes find
  // Of an entry point across the light, scene units: of the frame's shortest mean free path a half. A half
  // costs heads 3 % of the gather's error, twice as much 60 % (docs/lab.md).
  float longestEntrySide;

  bool isGathered(const Inputs& inputs, const PellucidLight& light) const {
    return light.shadowMapCount > 0 && gathers && !inputs.holdsBackFaces(light);
  }
};

}  // namespace pellucid
