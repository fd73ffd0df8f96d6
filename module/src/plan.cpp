// Frame -> plan. Pure: no device, no allocation.
#include <algorithm>

#include "dispatches.h"
#include "facts.h"
#include "pyramid.h"
#include "quality.h"
#include "reuse.h"
#include "validate.h"

namespace pellucid {
namespace {

// What runs.
struct Stages {
  bool lights;  // the fused dispatches carry lights
  bool diffusion;
  uint32_t fused;    // fused dispatches
  bool history;      // these write the history, and one more adds it
  bool keepsProbes;  // the history is what the gather's probes have found: these read it
  bool copies;  // the diffusion is all there is: it copies the irradiance before it writes the output, which
                // may be the same image and whose pixels read their neighbors
  LightGroups groups;  // of lights
  bool overlaps;  // the gather runs beside the diffusion, which it does not wait for, with images of its own
  bool addsProbes;  // the diffusion's last dispatch adds what was gathered: no other light comes through
  bool skipsLight;  // the GPU says whether anything was gathered

  // Dispatches that write a color transient or the output.
  uint32_t writers() const { return (history ? 1 : fused) + (diffusion ? 1 : 0) + (copies ? 1 : 0); }
  uint32_t colorTransients() const { return std::min(writers() - 1, 2u); }
  // Of packed texels: the pyramid; what the gather's probes find; entry points, if they do not lie where the
  // pyramid was.
  uint32_t texelTransients() const { return groups.gathered > 0 ? (overlaps ? 3 : 2) : diffusion ? 1 : 0; }
};

Stages stagesOf(const PellucidFrame& frame) {
  const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
  Stages s{};
  if (frame.features & PELLUCID_FEATURE_TRANSLUCENCY || debug) s.groups = lightGroups(frame);
  s.diffusion = frame.features & PELLUCID_FEATURE_DIFFUSION && !debug && anyMaterialDiffuses(frame);
  s.addsProbes = s.diffusion && addsProbes(frame);
  s.fused = s.addsProbes ? 0 : s.groups.fused();
  s.lights = s.fused > 0;
  s.copies = s.diffusion && !s.lights && !frame.separateOutput;
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output.
  if (s.writers() == 0) s.fused = 1;
  s.keepsProbes = keepsProbes(frame);
  s.history = keepsHistory(frame) && !s.keepsProbes;
  // More would be more transients than there are.
  s.overlaps = s.diffusion && s.groups.gathered == 1 && s.colorTransients() <= 1 && !s.history;
  // Points that are kept are read where none is found, too.
  s.skipsLight = s.overlaps && s.addsProbes && !s.keepsProbes && frame.indirectDispatches;
  return s;
}

// What the maps of lights that contribute lack.
void skipBeside(const PellucidFrame& frame, const ViewBounds& view, Builder& b) {
  if (!bindsBeside(frame))
    b.skip("exit depth and caster material", "more lights have them than the dispatches of a plan can bind");
  bool noExit = false, noCaster = false;
  for (uint32_t i = 0; i < frame.lightCount; ++i) {
    const PellucidLight& light = frame.lights[i];
    for (uint32_t k = 0; k < light.shadowMapCount && !view.whySkipped(light); ++k) {
      const PellucidShadowMap& map = frame.shadowMaps[light.firstShadowMap + k];
      noExit = noExit || (map.exitImage == 0 && frame.thicknessSource == PELLUCID_THICKNESS_LIGHT);
      noCaster = noCaster || map.casterMaterialImage == 0;
    }
  }
  if (noExit) b.skip("exit depth", "a shadow map has none: air behind an occluder counts as medium");
  if (noCaster)
    b.skip("caster material",
           "a shadow map has none: light enters through opaque bodies and other materials");
}

bool build(const PellucidFrame& frame, const PellucidHistory& kept, PellucidPlan& plan) {
  const Stages stages = stagesOf(frame);
  Builder b{frame,
            constantsLayout(frame),
            renderRect(frame),
            stages.colorTransients(),
            stages.keepsProbes,
            stages.overlaps,
            stages.skipsLight,
            plan};
  plan.activeLights = b.layout.lightCount;
  plan.constantsSize = b.layout.size;

  const ViewBounds view(frame);
  for (uint32_t i = 0; i < frame.lightCount; ++i)
    if (const char* reason = view.whySkipped(frame.lights[i])) b.skip("light", reason);
  if (!(frame.features & PELLUCID_FEATURE_TRANSLUCENCY))
    b.skip("translucency", "not among the features");
  else if (plan.activeLights == 0)
    b.skip("translucency", "no light can contribute");
  else
    skipBeside(frame, view, b);
  if (frame.gatherSamples == PELLUCID_GATHER_BY_QUALITY && frame.quality > 0)
    if (const char* reason = whyNotGathered(frame)) b.skip("gather", reason);
  if (!(frame.features & PELLUCID_FEATURE_DIFFUSION))
    b.skip("diffusion", "not among the features");
  else if (frame.debugView != PELLUCID_DEBUG_NONE)
    b.skip("diffusion", "a debug view is written instead");
  else if (!stages.diffusion)
    b.skip("diffusion", "no material diffuses");

  uint32_t coarsest = coarsestLevel(frame);
  if (stages.diffusion) {
    const DiffusionReach reach = diffusionReach(frame);
    plan.largestRadius = static_cast<float>(reach.radius);
    plan.quality = frame.quality;
    if (frame.targetError > 0 && !qualityFor(frame.targetError, reach.radius, &plan.quality))
      b.skip("targetError", "no quality is that exact");
    for (uint32_t i = 0; i < frame.materialCount; ++i)
      if (reach.pixelsPerMm * widestDeviation(frame.materials[i]) > levelDeviation(coarsest))
        b.skip("diffusion radius", "wider than the pyramid holds");
    while (reach.deviation > 0 && coarsest > kFirstLevel + 2 &&
           reach.deviation <= deviationWithin(coarsest - 2))
      coarsest -= 2;
  }

  const bool reused = (stages.history || stages.keepsProbes) && decideReuse(frame, kept, &plan.history);
  if (reused) b.skip(stages.keepsProbes ? "gather" : "translucency", "reused from an earlier frame");

  // Images alternate between the two transients; the last write goes to the output.
  uint32_t source = PELLUCID_RESOURCE_IRRADIANCE, next = 0;
  uint32_t remaining = stages.writers();
  const auto destination = [&]() -> uint32_t {
    if (--remaining == 0) return PELLUCID_RESOURCE_OUTPUT;
    const uint32_t transient = kTransient0 + next;
    next ^= 1;
    return transient;
  };
  bool fits = true;
  const auto translucency = [&](const LightGroup& group) {
    const uint32_t to = destination();
    fits = fits && b.translucency(group, source, to);
    source = to;
  };
  const auto forEachFused = [&](auto&& fused) {
    uint32_t index = 0;
    forEachLightGroup(frame, [&](const LightGroup& group) {
      const bool gathers = group.gathered > 0 && !reused && !stages.overlaps;
      if (gathers) fits = fits && b.entryPoints(group) && b.probes(group, index > 0);
      if (++index < stages.groups.gathered) return;
      if (gathers) fits = fits && b.filterProbes();
      fused(group);
    });
  };
  const auto translucencies = [&] {
    if (stages.history) {
      if (!reused)
        forEachFused([&](const LightGroup& group) {
          fits = fits && b.translucency(group, PELLUCID_RESOURCE_HISTORY, PELLUCID_RESOURCE_HISTORY);
        });
      const uint32_t to = destination();
      fits = fits && b.addHistory(source, to);
      source = to;
    } else if (stages.lights)
      forEachFused(translucency);
    else if (stages.fused > 0)
      translucency(LightGroup{});
  };
  const auto diffusion = [&] {
    if (!stages.diffusion) return;
    LightGroup gathered;
    if (stages.overlaps && !reused)
      forEachLightGroup(frame, [&](const LightGroup& group) {
        if (group.gathered > 0) gathered = group;
      });
    // Upsampling makes the last two levels, so that no dispatch of few texels holds up the others.
    const uint32_t downsampled = coarsest - (coarsest == PELLUCID_LAST_LEVEL ? 2 : 0);
    // Entry points, probes and their filter, each beside one of the last three dispatches before the one that
    // adds light: base level, downsampling and upsampling are at least as many.
    const uint32_t before = 2 + (downsampled - kFirstLevel) / 2;
    uint32_t step = 0;
    const auto alongside = [&] {
      const uint32_t left = before - step++;
      if (gathered.gathered == 0 || left > 3) return;
      b.alongside = true;
      fits = fits && (left == 3   ? b.entryPoints(gathered)
                      : left == 2 ? b.probes(gathered, false)
                                  : b.filterProbes());
      b.alongside = false;
    };
    const uint32_t copy = stages.copies ? destination() : source;
    fits = fits && b.baseLevel(source, copy);
    alongside();
    source = copy;
    for (uint32_t finer = kFirstLevel; finer < downsampled; finer += 2) {
      fits = fits && b.downsample(finer);
      alongside();
    }
    fits = fits && b.upsample(coarsest);
    alongside();
    const uint32_t to = destination();
    fits = fits && b.diffuse(source, to, stages.addsProbes);
    if (stages.skipsLight) fits = fits && b.diffuse(source, to, false);
    source = to;
  };
  // Gathered light has already spread on its way through; diffusing it again would spread it twice.
  if (gathers(frame)) {
    diffusion();
    translucencies();
  } else {
    translucencies();
    diffusion();
  }
  return fits;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous,
                                            PellucidPlan* plan) {
  if (!plan) return PELLUCID_ERROR_INVALID_ARGUMENT;
  // The two plans may be one object.
  const PellucidHistory kept = previous ? previous->history : PellucidHistory{};
  *plan = PellucidPlan{};
  const PellucidResult result = checkFrame(frame, nullptr, nullptr);
  if (result != PELLUCID_OK) return result;
  if (!build(*frame, kept, *plan)) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  const Facts facts = factsOf(*frame);
  std::copy(std::begin(facts.hash), std::end(facts.hash), plan->facts);
  return PELLUCID_OK;
}

extern "C" PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count,
                                                PellucidImageNeed* needs) {
  if (!count) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const PellucidResult result = checkFrame(frame, nullptr, nullptr);
  if (result != PELLUCID_OK) return result;
  const Stages stages = stagesOf(*frame);
  const uint32_t colors = stages.colorTransients(), transients = colors + stages.texelTransients();
  const uint32_t room = *count;
  *count = transients + (stages.history || stages.keepsProbes ? 1 : 0);
  if (!needs) return PELLUCID_OK;  // validation asks for the number in every frame
  // Without a plan before it, that of a frame that refreshes a history: every image is in use.
  PellucidPlan plan{};
  if (!build(*frame, {}, plan)) return PELLUCID_ERROR_CAPACITY;
  const uint64_t colorBytes = isWide(*frame) ? 16 : 8;
  for (uint32_t i = 0; i < *count && i < room; ++i) {
    const bool persistent = i == transients, texels = !persistent && i >= colors;
    PyramidExtent size{frame->imageExtent[0], frame->imageExtent[1]};
    const uint32_t texel = i - colors;  // the pyramid, probes, entry points
    const bool kept = persistent && stages.keepsProbes;
    if (texels || kept)
      size = texels && texel == 0 && stages.diffusion ? pyramidExtent(*frame) : PyramidExtent{1, 1};
    const bool entries = texels && stages.groups.gathered > 0 && texel == (stages.overlaps ? 2u : 0u);
    if (kept || entries || (texels && texel == 1)) {
      const uint32_t side = gatherSpacing(*frame);
      const auto fit = [&](uint32_t* most, uint32_t pixels, uint32_t ofMaps) {
        *most = std::max({*most, (pixels - 1) / side + 1, entries ? ofMaps : 0});
      };
      fit(&size.width, frame->imageExtent[0], withCoarserEntries(stages.groups.entryColumns));
      fit(&size.height, frame->imageExtent[1], stages.groups.entryRows);
    }
    PellucidImageNeed& need = needs[i];
    need = {};
    need.format = texels || kept ? VK_FORMAT_R32G32B32A32_UINT : colorFormat(*frame);
    need.extent[0] = size.width;
    need.extent[1] = size.height;
    need.bytes = (texels || kept ? kTexelBytes : colorBytes) * size.width * size.height;
    need.persistent = persistent;
    const uint32_t resource = persistent ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : kTransient0 + i;
    need.firstDispatch = UINT32_MAX;
    for (uint32_t d = 0; d < plan.dispatchCount; ++d)
      for (uint32_t b = 0; b < plan.dispatches[d].bindingCount; ++b)
        if (plan.dispatches[d].bindings[b].resource == resource) {
          need.firstDispatch = std::min(need.firstDispatch, d);
          need.lastDispatch = d;
        }
    // Frames that reuse the history lack the dispatches that refresh it.
    const uint32_t refreshing = stages.keepsProbes ? stages.groups.gatherDispatches()
                                : stages.history   ? stages.fused
                                                   : 0;
    need.firstDispatch -= std::min(need.firstDispatch, refreshing);
  }
  return PELLUCID_OK;
}

extern "C" uint32_t pellucidGetRequiredInputs(uint32_t features) {
  if ((features & (PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION)) == 0) return 0;
  return 1u << PELLUCID_RESOURCE_FRONT_DEPTH | 1u << PELLUCID_RESOURCE_IRRADIANCE |
         1u << PELLUCID_RESOURCE_MATERIAL | 1u << PELLUCID_RESOURCE_OUTPUT;
}
