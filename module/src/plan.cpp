// Frame -> plan. Pure: no device, no allocation.
#include "plan.h"

#include "passes.h"
#include "plan_state.h"

namespace pellucid {
namespace {

// Images that the maps of contributing lights lack.
void skipBeside(Planner& b) {
  const FrameFacts& f = b.facts;
  if (!f.lights.beside)
    b.skip("exit depth and caster material", "more lights have them than the dispatches of a plan can bind");
  bool noExit = false, noCaster = false;
  uint32_t backFaces = 0;
  f.forEachLight([&](const LightGroup&, const PellucidLight& light) {
    if (f.holdsBackFaces(light)) {
      ++backFaces;
      return;
    }
    for (uint32_t k = 0; k < light.shadowMapCount; ++k) {
      const PellucidShadowMap& map = f.frame.shadowMaps[light.firstShadowMap + k];
      noExit = noExit || (map.exitImage == 0 && f.frame.thicknessSource == PELLUCID_THICKNESS_LIGHT);
      noCaster = noCaster || map.casterMaterialImage == 0;
    }
  });
  for (uint32_t i = 0; i < backFaces; ++i) {
    constexpr const char* kWhy = "a light's shadow map holds back faces, which do not say where light enters";
    if (f.frame.thicknessSource == PELLUCID_THICKNESS_LIGHT) b.skip("light-space thickness", kWhy);
    if (f.gathers) b.skip("gather", kWhy);
  }
  if (noExit) b.skip("exit depth", "a shadow map has none: air behind an occluder counts as medium");
  if (noCaster)
    b.skip("caster material",
           "a shadow map has none: light enters through opaque bodies and other materials");
}

// Skips: all that does not run, and why.
void addSkips(Planner& b) {
  const FrameFacts& f = b.facts;
  const auto skipLight = [&](const PellucidLight& light, const char* what) {
    if (const char* reason = f.whySkipped(light))
      b.skip(what, reason);
    else if (f.lacksChord(light) && f.solids)
      b.skip("light in solids", "no back depth to take a thickness from: thin walls alone let it through");
  };
  for (uint32_t i = 0; i < f.frame.lightCount; ++i) skipLight(f.frame.lights[i], "light");
  if (f.ambient.intensity > 0) skipLight(f.ambient, "ambient light");
  if (!(f.frame.features & PELLUCID_FEATURE_TRANSLUCENCY))
    b.skip("translucency", "not among the features");
  else if (f.lights.lightCount == 0)
    b.skip("translucency", "no light can contribute");
  else
    skipBeside(b);
  if (f.frame.gatherSamples > 0 && f.whyNotGathered) b.skip("gather", f.whyNotGathered);
  if (!(f.frame.features & PELLUCID_FEATURE_DIFFUSION))
    b.skip("diffusion", "not among the features");
  else if (f.debug())
    b.skip("diffusion", "a debug view is written instead");
  else if (!f.diffuses)
    b.skip("diffusion", "no material diffuses");
  if (f.stages.nothing)
    b.skip("all dispatches",
           "no light comes through, nothing diffuses, and the output is the irradiance image");
  if (f.missesTarget) b.skip("targetError", "no number of samples is that exact");
  if (!f.stages.diffusion) return;
  if (f.frame.indirectDispatches != PELLUCID_INDIRECT_NONE && !f.stages.lists) b.skip("lists", whyNoLists(f));
  for (uint32_t i = 0; i < f.frame.materialCount; ++i)
    if (f.reach.pixelsPerMm * widestDeviation(f.diffused(i)) > levelDeviation(f.pyramid.coarsest))
      b.skip("diffusion radius", "wider than the pyramid holds");
}

// Adds the passes of a frame along the data flow. Colors alternate between the two color transients; the last write
// goes to the output.
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

PellucidResult buildPlan(const FrameFacts& f, const History& kept, PellucidPlan* plan) {
  *plan = PellucidPlan{};
  Planner b(f, *plan);
  plan->activeLights = f.lights.lightCount;
  plan->constantsSize = f.constants.size;
  plan->gatherSamples = f.gatherSamples;
  if (f.stages.diffusion) plan->largestRadius = static_cast<float>(f.reach.radius);
  addSkips(b);
  PlanState state;
  const bool reused = f.stages.keepsHistory && decideReuse(f, kept, &state.history);
  if (reused) b.skip(f.stages.keepsProbes ? "gather" : "translucency", "reused from an earlier frame");
  plan->historyAge = state.history.age;
  Flow(b, reused).addAll();
  if (!b.finish() || !f.lights.fitPlan()) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  state.frame = hashOf(f);
  keep(state, plan);
  return PELLUCID_OK;
}

}  // namespace pellucid
