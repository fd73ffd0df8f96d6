// Adds passes to a frame's plan, with the images and grids that they have there. Passes of one kind are told
// in docs/how-it-works.md.
#pragma once

#include "planner.h"

namespace pellucid {

// The lights of a group with one thickness a pixel, and debug views.
void addTranslucency(Planner& p, const LightGroup& group, uint32_t source, uint32_t destination);
// All lights of a group that thin walls let through, in a frame that gathers.
void addThinWalls(Planner& p, const LightGroup& group, uint32_t source, uint32_t destination);
// The light that an earlier dispatch or frame left in frame.history.
void addHistory(Planner& p, uint32_t source, uint32_t destination);

// Level 1 of the pyramid and the blocks' words. `copy`: where pixels go that the last dispatch reads;
// `source` itself: nowhere.
void addBaseLevel(Planner& p, uint32_t source, uint32_t copy);
void addListBlocks(Planner& p);
// Two levels from `finer`.
void addDownsample(Planner& p, uint32_t finer);
void addUpsample(Planner& p, uint32_t coarsest);
// With the light of the probes, if the frame has some.
void addDiffuse(Planner& p, uint32_t source, uint32_t destination);

// Entry points of the group's shadow maps.
void addEntryPoints(Planner& p, const LightGroup& group);
// Probes that gather from the entry points. `adds`: to what they found in an earlier dispatch.
void addProbes(Planner& p, const LightGroup& group, bool adds);
// The mean of each probe and those around it.
void addProbeFilter(Planner& p);

}  // namespace pellucid
