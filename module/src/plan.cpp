// Frame -> plan. Pure: no device, no allocation.
#include "plan.h"

#include <algorithm>

#include "passes.h"
#include "plan_state.h"
#include "pyramid_energy.h"

namespace pellucid {
namespace {

// Images that the maps of contributing lights lack.
void skipBeside(const FrameFacts& f, Skips& skips) {
  if (!f.lights.beside)
    skips.add("exit depth and caster material",
              "more lights have them than the dispatches of a plan can bind");
  for (uint32_t i = 0; i < f.lights.holdBackFaces; ++i) {
    constexpr const char* kWhy = "a light's shadow map holds back faces, which do not say where light enters";
    if (f.frame.thicknessSource == PELLUCID_THICKNESS_LIGHT) skips.add("light-space thickness", kWhy);
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
  if (f.askedSamples > 0 && f.whyNotGathered) skips.add("gather", f.whyNotGathered);
  if (!(f.frame.features & PELLUCID_FEATURE_DIFFUSION))
    skips.add("diffusion", "not among the features");
  else if (f.debug())
    skips.add("diffusion", "a debug view is written instead");
  else if (!f.diffuses)
    skips.add("diffusion", "no material diffuses");
  if (f.stages.nothing)
    skips.add("all dispatches",
              "no light comes through, nothing diffuses, and the output is the irradiance image");
  if (f.missesTarget) skips.add("targetError", "no number of samples is that exact");
  if (!f.stages.diffusion) return skips;
  if (f.frame.indirectDispatches != PELLUCID_INDIRECT_NONE && !f.stages.lists)
    skips.add("lists", whyNoLists(f, f.lights, f.blocks));
  for (uint32_t i = 0; i < f.frame.materialCount; ++i)
    if (f.reach.pixelsPerMm * widestDeviation(f.diffused(i)) > levelDeviation(f.pyramid.coarsest))
      skips.add("diffusion radius", "wider than the pyramid holds");
  return skips;
}

// Adds the passes of a frame along the data flow. Colors alternate between the two color transients; the last
// write goes to the output.
class Flow {
public:
  Flow(Planner& planner, bool reuses)
      : p_(planner), stages_(planner.facts.stages), reused_(reuses), remaining_(stages_.writers()) {}

  void addAll() {
    if (stages_.nothing) return;
    // Gathered light has already spread on its way through; diffusing it again would spread it twice.
    if (p_.facts.gathers) {
      thinWalls();
      diffusion();
      translucency();
    } else {
      translucency();
      diffusion();
    }
  }

private:
  // Calls add(source, destination) for a pass that goes over pixels.
  template <class Add>
  void pixels(Add&& add) {
    uint32_t destination = PELLUCID_RESOURCE_OUTPUT;
    if (--remaining_ > 0) {
      destination = kTransient0 + next_;
      next_ ^= 1;
    }
    add(source_, destination);
    source_ = destination;
  }

  // Before the diffusion, as without a gather: materials say whether light spreads within a sheet.
  void thinWalls() {
    if (stages_.walls == 0) return;
    for (const LightGroup& group : p_.facts.lights.list())
      if (group.lightCount > 0)
        pixels([&](uint32_t from, uint32_t to) { addThinWalls(p_, group, from, to); });
  }

  void translucency() {
    const auto groups = p_.facts.lights.list().subspan(stages_.gathered);
    if (stages_.history) {
      for (const LightGroup& group : groups)
        if (!reused_) addTranslucency(p_, group, PELLUCID_RESOURCE_HISTORY, PELLUCID_RESOURCE_HISTORY);
      pixels([&](uint32_t from, uint32_t to) { addHistory(p_, from, to); });
    } else if (stages_.lights) {
      for (const LightGroup& group : groups)
        pixels([&](uint32_t from, uint32_t to) { addTranslucency(p_, group, from, to); });
    } else if (stages_.fused > 0) {
      pixels([&](uint32_t from, uint32_t to) { addTranslucency(p_, LightGroup{}, from, to); });
    }
  }

  void diffusion() {
    if (!stages_.diffusion) return;
    if (stages_.copies)
      pixels([&](uint32_t from, uint32_t to) { addBaseLevel(p_, from, to); });
    else
      addBaseLevel(p_, source_, source_);
    if (stages_.lists) addListBlocks(p_);
    for (uint32_t finer = kFirstLevel; finer < p_.facts.coarsestLevel; finer += 2) addDownsample(p_, finer);
    addUpsample(p_, p_.facts.coarsestLevel);
    gather();
    pixels([&](uint32_t from, uint32_t to) { addDiffuse(p_, from, to); });
  }

  // Entry points and probes of each group, and the filter that they share.
  void gather() {
    if (stages_.gathered == 0 || reused_) return;
    for (uint32_t i = 0; i < stages_.gathered; ++i) {
      const LightGroup& group = p_.facts.lights.list()[i];
      if (group.gathered > 0) addEntryPoints(p_, group);
      addProbes(p_, group, i > 0);
    }
    addProbeFilter(p_);
  }

  Planner& p_;
  const Stages& stages_;
  const bool reused_;  // an earlier frame's light stands in for this frame's
  uint32_t source_ = PELLUCID_RESOURCE_IRRADIANCE, next_ = 0, remaining_;
};

}  // namespace

bool addPasses(const FrameFacts& f, bool reused, PellucidPlan* plan) {
  Planner planner(f, *plan);
  Flow(planner, reused).addAll();
  return planner.finish() && f.lights.fitPlan();
}

PellucidResult buildPlan(const FrameFacts& f, const History& kept, PellucidPlan* plan) {
  *plan = PellucidPlan{};
  plan->activeLights = f.lights.lightCount;
  plan->constantsSize = f.constants.size;
  plan->gatherSamples = f.gatherSamples;
  if (f.stages.diffusion) plan->largestRadius = static_cast<float>(f.reach.radius);
  Skips skips = skipsOf(f);
  PlanState state;
  const bool reused = f.stages.keepsHistory && decideReuse(f, kept, &state.history);
  if (reused) skips.add(f.stages.keepsProbes ? "gather" : "translucency", "reused from an earlier frame");
  plan->skipCount = skips.size;
  std::copy(skips.list.begin(), skips.list.end(), plan->skips);
  plan->historyAge = state.history.age;
  if (!addPasses(f, reused, plan)) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  state.frame = hashOf(f);
  keep(state, plan);
  return PELLUCID_OK;
}

}  // namespace pellucid
