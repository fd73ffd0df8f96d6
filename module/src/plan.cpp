// Frame -> plan. Pure: no device, no allocation.
#include <algorithm>

#include "planner.h"
#include "material/pyramid_energy.h"
#include "material/transmittance.h"

namespace pellucid {
namespace {

// Images that the maps of contributing lights lack.
void skipBeside(const FrameFacts& f, Skips& skips) {
  if (!f.lights.beside)
    skips.add("exit depth and caster material",
              "more lights have them than the dispatches of a plan can bind");
  for (uint32_t i = 0; i < f.lights.holdBackFaces; ++i) {
    constexpr const char* kWhy = "a light's shadow map holds back faces, which do not say where light enters";
    if (f.frame.options.cameraThickness == 0) skips.add("light-space thickness", kWhy);
    if (f.gathers) skips.add("gather", kWhy);
  }
  if (f.lights.lackExit)
    skips.add("exit depth", "a shadow map has none: air behind an occluder counts as medium");
  if (f.lights.lackCaster)
    skips.add("caster material",
              "a shadow map has none: light enters through opaque bodies and other materials");
}

// All that does not run, and why.
Skips skipsOf(const FrameFacts& f) {
  Skips skips = f.lights.skips;
  if (!f.translucency())
    skips.add("translucency", "not among the features");
  else if (f.lights.lightCount == 0)
    skips.add("translucency", "no light can contribute");
  else
    skipBeside(f, skips);
  if (f.frame.options.gatherSamples > 0 && f.whyNotGathered) skips.add("gather", f.whyNotGathered);
  if (f.frame.options.reuse == PELLUCID_REUSE_ACCUMULATE && !f.stages.accumulates)
    skips.add("accumulation", "no light is gathered");
  if (!(f.frame.options.features & PELLUCID_FEATURE_DIFFUSION))
    skips.add("diffusion", "not among the features");
  else if (f.debug())
    skips.add("diffusion", "a debug view is written instead");
  else if (!f.diffuses)
    skips.add("diffusion", "no material diffuses");
  if (f.stages.nothing)
    skips.add("all dispatches",
              "no light comes through, nothing diffuses, and the output is the irradiance image");
  if (!f.stages.diffusion) return skips;
  if (f.frame.options.indirectDispatches != 0 && !f.stages.lists)
    skips.add("lists", f.stages.whyNoLists);
  for (uint32_t i = 0; i < f.frame.materialCount; ++i)
    if (const PellucidMaterial& m = f.frame.materials[i];
        f.diffusedCount(m) > 0 && f.pixelsPerMm * deviationOf(m) > levelDeviation(f.pyramid.coarsest))
      skips.add("diffusion radius", "wider than the pyramid holds");
  return skips;
}

// PellucidUse bits of what pipelines must look for.
uint32_t optionsOf(const FrameFacts& f) {
  uint32_t options = f.thinWalls ? PELLUCID_USE_THIN_WALLS : 0;
  const uint32_t count = f.lights.lightCount;  // ambient light is the last one
  if (count > 0 && count <= Lights::kMost && f.lights.active[count - 1] == Lights::kAmbient)
    options |= PELLUCID_USE_AMBIENT;
  bool thesis = f.thesis.angleModel != PELLUCID_ANGLE_NORMAL;
  for (uint32_t i = 0; i < f.frame.materialCount; ++i)
    thesis = thesis || !canBeGathered(modelOf(f.frame.materials[i]));
  return thesis ? options | PELLUCID_USE_THESIS : options;
}

// The first map in a layer above 0, plus 1; 0: none.
uint32_t layeredMap(const PellucidFrame& frame) {
  for (uint32_t i = 0; i < frame.shadowMapCount; ++i)
    if (frame.shadowMaps[i].options.layer > 0) return i + 1;
  return 0;
}

// The frame's plan after one that left `kept`, into an empty plan.
PellucidResult buildPlan(const FrameFacts& f, const History& kept, PellucidPlan* plan) {
  plan->activeLights = f.lights.lightCount;
  plan->constantsSize = f.constants.size;
  plan->listsOffset = f.constants.lists;
  plan->gatherSamples = f.gatherSamples;
  Skips skips = skipsOf(f);
  PlanState state;
  const bool reused = f.stages.keepsHistory && decideReuse(f, kept, &state.history);
  if (f.stages.accumulates && state.history.age > 0)
    state.kept = {1, kept.preExposure, {kept.first[0], kept.first[1]}};
  if (reused) skips.add(f.stages.keepsProbes ? "gather" : "translucency", "reused from an earlier frame");
  plan->skipCount = skips.size;
  std::copy(skips.list.begin(), skips.list.end(), plan->skips);
  plan->historyAge = state.history.age;
  if (!addPasses(f, reused, plan)) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  state.materials = f.frame.materialCount;
  state.rect = renderRect(f.frame);
  state.outputFormat = f.frame.options.outputFormat;
  state.lightTables = f.frame.options.lightTableCount;
  state.options = optionsOf(f);
  state.separate = f.separate();
  state.layeredMap = layeredMap(f.frame);
  if (state.layeredMap > 0) state.layer = f.frame.shadowMaps[state.layeredMap - 1].options.layer;
  std::memcpy(plan->state, &state, sizeof state);
  return PELLUCID_OK;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous,
                                            PellucidPlan* plan) {
  if (!plan) return PELLUCID_ERROR_INVALID_ARGUMENT;
  // The two plans may be one object.
  const History kept = previous ? stateOf(*previous).history : History{};
  *plan = PellucidPlan{};
  Findings silent;
  const auto facts = readFrame(frame, silent);
  return facts ? buildPlan(*facts, kept, plan) : silent.result();
}
