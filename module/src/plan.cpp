// Frame -> plan. Pure: no device, no allocation.
#include "plan.h"

#include "plan_diffusion.h"
#include "plan_gather.h"
#include "plan_state.h"
#include "plan_translucency.h"

namespace pellucid {
namespace {

// Images that the maps of contributing lights lack.
void skipBeside(PlanBuilder& b) {
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
void addSkips(PlanBuilder& b) {
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

// Asks for the dispatches of all stages in their order. Images alternate between the two color transients;
// the last write goes to the output.
class Stager {
public:
  Stager(PlanBuilder& builder, bool reuses)
      : b_(builder), stages_(builder.facts.stages), reused_(reuses), remaining_(stages_.writers()) {}

  void addAll() {
    if (stages_.nothing) return;
    // Gathered light has already spread on its way through; diffusing it again would spread it twice.
    if (b_.facts.gathers) {
      thinWalls();
      diffusion();
      translucency();
    } else {
      translucency();
      diffusion();
    }
  }

private:
  uint32_t destination() {
    if (--remaining_ == 0) return PELLUCID_RESOURCE_OUTPUT;
    const uint32_t transient = kTransient0 + next_;
    next_ ^= 1;
    return transient;
  }

  // Entry points and probes of each group, and what the groups share: all lights that are gathered from.
  void gather() {
    if (stages_.gathered == 0 || stages_.overlaps || reused_) return;
    for (uint32_t i = 0; i < stages_.gathered; ++i) {
      const LightGroup& group = b_.facts.lights.list()[i];
      addEntryPoints(b_, group);
      addProbes(b_, group, i > 0);
    }
    addSpatialFilter(b_);
  }

  // Before the diffusion, as without a gather: materials say whether light spreads within a sheet.
  void thinWalls() {
    if (stages_.walls == 0) return;
    for (const LightGroup& group : b_.facts.lights.list()) {
      if (group.lightCount == 0) continue;
      const uint32_t to = destination();
      addThinWalls(b_, group, source_, to);
      source_ = to;
    }
  }

  void fused(const LightGroup& group) {
    const uint32_t to = destination();
    addTranslucency(b_, group, source_, to);
    source_ = to;
  }

  void translucency() {
    const auto each = [&](auto&& add) {
      for (const LightGroup& group : b_.facts.lights.list().subspan(stages_.gathered)) add(group);
    };
    if (stages_.history) {
      if (!reused_)
        each([&](const LightGroup& group) {
          addTranslucency(b_, group, PELLUCID_RESOURCE_HISTORY, PELLUCID_RESOURCE_HISTORY);
        });
      const uint32_t to = destination();
      addHistory(b_, source_, to);
      source_ = to;
    } else if (stages_.lights) {
      each([&](const LightGroup& group) { fused(group); });
    } else if (stages_.fused > 0) {
      fused(LightGroup{});
    }
  }

  void diffusion() {
    if (!stages_.diffusion) return;
    const uint32_t copy = stages_.copies ? destination() : source_;
    addBaseLevel(b_, source_, copy);
    if (stages_.lists) addListBlocks(b_);
    source_ = copy;
    gather();
    // Entry points, probes and the spatial filter run beside one of the next dispatches each.
    uint32_t step = stages_.overlaps && !reused_ ? 0 : 3;
    const auto alongside = [&](bool beside) {
      const LightGroup& group = b_.facts.lights.list().front();
      if (step == 0 && group.gathered == 0) ++step;
      b_.alongside = beside;
      if (step == 0) addEntryPoints(b_, group);
      if (step == 1) addProbes(b_, group, false);
      if (step == 2) addSpatialFilter(b_);
      b_.alongside = false;
      ++step;
    };
    for (uint32_t finer = kFirstLevel; finer < b_.facts.coarsestLevel; finer += 2) {
      addDownsample(b_, finer);
      if (step < 3) alongside(true);
    }
    addUpsample(b_, b_.facts.coarsestLevel);
    if (step < 3) alongside(true);
    while (step < 3) alongside(false);
    const uint32_t to = destination();
    addDiffuse(b_, source_, to);
    source_ = to;
  }

  PlanBuilder& b_;
  const Stages& stages_;
  const bool reused_;  // an earlier frame's light stands in for this frame's
  uint32_t source_ = PELLUCID_RESOURCE_IRRADIANCE, next_ = 0, remaining_;
};

}  // namespace

PellucidResult buildPlan(const FrameFacts& f, const History& kept, PellucidPlan* plan) {
  *plan = PellucidPlan{};
  PlanBuilder b(f, *plan);
  plan->activeLights = f.lights.lightCount;
  plan->constantsSize = f.constants.size;
  plan->gatherSamples = f.gatherSamples;
  if (f.stages.diffusion) plan->largestRadius = static_cast<float>(f.reach.radius);
  addSkips(b);
  PlanState state;
  const bool reused = f.stages.keepsHistory && decideReuse(f, kept, &state.history);
  if (reused) b.skip(f.stages.keepsProbes ? "gather" : "translucency", "reused from an earlier frame");
  plan->historyAge = state.history.age;
  Stager(b, reused).addAll();
  if (!b.fits || !f.lights.fitPlan()) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  state.frame = hashOf(f);
  keep(state, plan);
  return PELLUCID_OK;
}

}  // namespace pellucid
