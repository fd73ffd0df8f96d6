// Dispatches of the light-space gather (docs/how-it-works.md): where light enters, what probes find of it,
// and their spatial filter. plan_translucency.h or plan_diffusion.h adds the filtered probes to the pixels.
#pragma once

#include "plan_builder.h"

namespace pellucid {

// Entry points of the group's shadow maps.
void addEntryPoints(PlanBuilder& b, const LightGroup& group);

// Probes that gather from the entry points. `adds`: to what they found in an earlier dispatch.
void addProbes(PlanBuilder& b, const LightGroup& group, bool adds);

// The mean of each probe and those around it.
void addSpatialFilter(PlanBuilder& b);

// A dispatch that reads the filtered probes.
void readProbes(const PlanBuilder& b, PellucidDispatch* d, uint32_t binding, VkDescriptorType type);

}  // namespace pellucid
