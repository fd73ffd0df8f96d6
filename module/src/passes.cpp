// Every pass, one block each: the images that it makes, its pipeline with what it binds, and its dispatches in a frame. At the
// end, the data flow of a frame through them. docs/how-it-works.md tells what each pass does.
#include <bit>

#include "entry_points.h"
#include "planner.h"

#include "kAddHistory.h"
#include "kBaseLevel.h"
#include "kCoarseLevels.h"
#include "kDiffuse.h"
#include "kDownsample.h"
#include "kEntryPoints.h"
#include "kEntryPointsArray.h"
#include "kFilterProbes.h"
#include "kProbes.h"
#include "kTranslucency.h"
#include "kTranslucencyArray.h"
#include "kUpsample.h"

namespace pellucid {
namespace {

constexpr uint32_t kGather = PELLUCID_USE_GATHER, kDiffusion = PELLUCID_USE_DIFFUSION;

// ---- Colors ----------------------------------------------------------------------------------------

// Between passes that go over pixels and write colors, by turns.
constexpr Extent extentOfPixels(const FrameFacts& f) { return {f.frame.imageExtent[0], f.frame.imageExtent[1]}; }
constexpr MadeImage kColors[] = {
    {.texels = Texels::Colors, .made = [](const FrameFacts& f) { return f.stages.writers() > 1; }, .extent = &extentOfPixels},
    {.texels = Texels::Colors, .made = [](const FrameFacts& f) { return f.stages.writers() > 2; }, .extent = &extentOfPixels}};

// Bindings of these passes.
constexpr BindingSet kColorReads =
    bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_BINDING_MATERIAL,
             PELLUCID_BINDING_SOURCE, PELLUCID_BINDING_ALBEDO, PELLUCID_BINDING_HELD);
constexpr BindingSet kColorWrites = bindings(PELLUCID_BINDING_DESTINATION);

// ---- Translucency, thin walls, debug views --------------------------------------------------------

constexpr BindingSet kLightReads =
    kColorReads | shadowImages(PELLUCID_SHADOW_IMAGE_COUNT) |
    bindings(PELLUCID_BINDING_LIGHTS, PELLUCID_BINDING_SHADOWS, PELLUCID_BINDING_MATERIALS,
             PELLUCID_BINDING_BACK_DEPTH, PELLUCID_BINDING_HIDDEN_IRRADIANCE);
constexpr PellucidSpecialization kDebugViews[] = {{PELLUCID_CONSTANT_DEBUG_VIEWS, 1}};

constexpr Pass kTranslucencyPass{.pipeline = "translucency",
                                 .words = kTranslucency,
                                 .wordsOfArrays = kTranslucencyArray,
                                 .uses = PELLUCID_USE_TRANSLUCENCY,
                                 .reads = kLightReads,
                                 .writes = kColorWrites};
constexpr Pass kDebugViewPass{.pipeline = "debug_view",
                              .words = kTranslucency,
                              .wordsOfArrays = kTranslucencyArray,
                              .uses = PELLUCID_USE_DEBUG_VIEWS,
                              .reads = kLightReads,
                              .writes = kColorWrites,
                              .constants = kDebugViews};

// `through`: PELLUCID_LIGHT_* of materials.
void addLights(Planner& p, const Pass& pass, const char* name, const LightGroup& group, uint32_t through,
               uint32_t source, uint32_t destination) {
  const bool starts = destination == PELLUCID_RESOURCE_HISTORY && group.firstLight == 0;
  const uint32_t write = destination == PELLUCID_RESOURCE_OUTPUT    ? PELLUCID_WRITE_LAST
                         : starts                                   ? PELLUCID_WRITE_STARTS
                         : destination == PELLUCID_RESOURCE_HISTORY ? PELLUCID_WRITE_KEEPS
                                                                    : 0;
  Step step = p.add(pass, name);
  step.tiles(PELLUCID_GROUP_X)
      .lights(group)
      .colors(source, destination)
      .push(shared::TranslucencyPass{through, group.lightCount, write});
  // The first dispatch into the history does not read its source.
  if (starts) step.standIn(PELLUCID_BINDING_SOURCE, PELLUCID_RESOURCE_IRRADIANCE);
}

// The lights of a group with one thickness a pixel, and debug views.
void addTranslucency(Planner& p, const LightGroup& group, uint32_t source, uint32_t destination) {
  const bool debug = p.facts.debug();
  addLights(p, debug ? kDebugViewPass : kTranslucencyPass, debug ? "debug view" : "translucency", group,
            p.facts.stages.walls > 0 ? PELLUCID_LIGHT_SOLIDS : PELLUCID_LIGHT_ALL, source, destination);
}

// All lights of a group that thin walls let through, in a frame that gathers.
void addThinWalls(Planner& p, const LightGroup& group, uint32_t source, uint32_t destination) {
  addLights(p, kTranslucencyPass, "thin walls", group, PELLUCID_LIGHT_WALLS, source, destination);
}

// ---- Light of an earlier frame ----------------------------------------------------------------------

// With reuse of pixels' light, the image is kept between frames.
constexpr MadeImage kLightHistory{.texels = Texels::Colors,
                                  .made = [](const FrameFacts& f) { return f.stages.history; },
                                  .extent = &extentOfPixels};

constexpr Pass kAddHistoryPass{.pipeline = "add_history",
                               .words = kAddHistory,
                               .uses = PELLUCID_USE_REUSE,
                               .reads = kColorReads | bindings(PELLUCID_BINDING_HISTORY),
                               .writes = kColorWrites};

// The light that an earlier dispatch or frame left in options.history.
void addHistory(Planner& p, uint32_t source, uint32_t destination) {
  p.add(kAddHistoryPass, "add history")
      .tiles(PELLUCID_GROUP_X)
      .colors(source, destination)
      .image(PELLUCID_BINDING_HISTORY, PELLUCID_RESOURCE_HISTORY)
      .push(shared::AddHistoryPass{destination == PELLUCID_RESOURCE_OUTPUT});
}

// ---- Level 1 of the pyramid and the blocks' words -----------------------------------------------------

constexpr bool diffuses(const FrameFacts& f) { return f.stages.diffusion; }

// Level 1 and, in its place after upsampling, level 2.
constexpr MadeImage kLevel1{.texels = Texels::Packed, .made = &diffuses, .extent = [](const FrameFacts& f) {
                              return f.pyramid.images[imageOfLevel(kFirstLevel)];
                            }};
// Words about the content of each block, and lists of blocks.
constexpr MadeImage kBlocks{.texels = Texels::Words, .made = &diffuses, .extent = [](const FrameFacts& f) {
                              // No rect has more blocks than the whole image.
                              const Blocks blocks(f.lights, {0, 0, f.lattice.extent.x, f.lattice.extent.y});
                              return Extent{Blocks::kColumns, parts(blocks.words(), Blocks::kColumns)};
                            }};

constexpr Pass kBaseLevelPass{
    .pipeline = "base_level",
    .words = kBaseLevel,
    .uses = kDiffusion,
    .reads = bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_BINDING_MATERIAL,
                      PELLUCID_BINDING_SOURCE, PELLUCID_BINDING_GATHER_MAPS),
    .writes = bindings(PELLUCID_BINDING_LEVELS, PELLUCID_BINDING_BLOCKS, PELLUCID_BINDING_LISTS,
                       PELLUCID_BINDING_DESTINATION)};

// `copy`: where pixels go that the last dispatch reads; `source` itself: nowhere.
void addBaseLevel(Planner& p, uint32_t source, uint32_t copy) {
  const bool copies = copy != source;
  Step step = p.add(kBaseLevelPass, "base level");
  step.groups(p.facts.blocks.count())
      .lights(LightGroup{})
      .image(PELLUCID_BINDING_SOURCE, source)
      .image(PELLUCID_BINDING_LEVELS, kLevel1)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::BaseLevelPass{copies});
  if (copies)
    step.image(PELLUCID_BINDING_DESTINATION, copy);
  else
    step.standIn(PELLUCID_BINDING_DESTINATION, PELLUCID_RESOURCE_OUTPUT);
}

// ---- Downsampling -------------------------------------------------------------------------------------

constexpr MadeImage kLevels2And3{.texels = Texels::Packed, .made = &diffuses, .extent = [](const FrameFacts& f) {
                                   return f.pyramid.images[imageOfLevel(2)];
                                 }};
constexpr MadeImage kCoarserLevels{.texels = Texels::Packed, .made = &diffuses, .extent = [](const FrameFacts& f) {
                                     return f.pyramid.images[imageOfLevel(4)];
                                   }};

constexpr Pass kDownsamplePass{
    .pipeline = "downsample",
    .words = kDownsample,
    .uses = kDiffusion,
    .reads = bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_PYRAMID, PELLUCID_BINDING_BLOCKS),
    .writes = bindings(PELLUCID_BINDING_LEVELS)};

// Levels 2 and 3.
void addDownsample(Planner& p) {
  constexpr uint32_t kRowsOfLevel3 = PELLUCID_BLOCK / 8;  // in a block
  p.add(kDownsamplePass, "downsample")
      .blocks(PELLUCID_LIST_DOWNSAMPLE, kRowsOfLevel3 / PELLUCID_DOWNSAMPLE_ROWS)
      .image(PELLUCID_BINDING_PYRAMID, kLevel1)
      .image(PELLUCID_BINDING_LEVELS, kLevels2And3)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks);
}

constexpr Pass kCoarseLevelsPass{.pipeline = "coarse_levels",
                                 .words = kCoarseLevels,
                                 .uses = kDiffusion,
                                 .reads = kDownsamplePass.reads,
                                 .writes = kDownsamplePass.writes};

// Groups of `side` texels that [first, first + size) touches. Shifts round down, as the border's texels begin
// below 0.
uint32_t groupsAlong(int32_t first, int32_t size, uint32_t side) {
  const int shift = std::countr_zero(side);
  return static_cast<uint32_t>(((first + size - 1) >> shift) - (first >> shift) + 1);
}

// Levels 4 to the coarsest. Groups are laid out over level 7, even if the plan does not make this level.
void addCoarseLevels(Planner& p) {
  if (p.facts.coarsestLevel <= 3) return;
  const auto& rect = p.facts.pyramid.levels[PELLUCID_LAST_LEVEL].rect;
  const uint32_t columns = groupsAlong(rect.x, rect.width, PELLUCID_COARSE_COLUMNS);
  p.add(kCoarseLevelsPass, "coarse levels")
      .groups(columns * groupsAlong(rect.y, rect.height, PELLUCID_COARSE_ROWS))
      .image(PELLUCID_BINDING_PYRAMID, kLevels2And3)
      .image(PELLUCID_BINDING_LEVELS, kCoarserLevels)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::CoarseLevelsPass{columns, p.facts.coarsestLevel})
      .list(PELLUCID_LIST_COARSE);
}

// ---- Upsampling ---------------------------------------------------------------------------------------

constexpr Pass kUpsamplePass{
    .pipeline = "upsample",
    .words = kUpsample,
    .uses = kDiffusion,
    .reads = bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_KERNELS, PELLUCID_BINDING_PYRAMID,
                      PELLUCID_BINDING_COARSER_LEVELS, PELLUCID_BINDING_BLOCKS),
    .writes = bindings(PELLUCID_BINDING_LEVELS)};

void addUpsample(Planner& p) {
  p.add(kUpsamplePass, "upsample")
      .blocks(PELLUCID_LIST_UPSAMPLE, 1)
      .image(PELLUCID_BINDING_LEVELS, kLevel1)
      .image(PELLUCID_BINDING_PYRAMID, kLevels2And3)
      .image(PELLUCID_BINDING_COARSER_LEVELS, kCoarserLevels)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::UpsamplePass{p.facts.coarsestLevel});
}

// ---- Entry points of the gather -----------------------------------------------------------------------

constexpr Pass kEntryPointsPass{
    .pipeline = "entry_points",
    .words = kEntryPoints,
    .wordsOfArrays = kEntryPointsArray,
    .uses = kGather,
    .reads = shadowImages(PELLUCID_ENTRY_IMAGE_COUNT) |
             bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_LIGHTS, PELLUCID_BINDING_GATHER_MAPS,
                      PELLUCID_BINDING_ENTRY_MAPS, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_BINDING_BACK_DEPTH, PELLUCID_BINDING_MATERIAL,
                      PELLUCID_BINDING_BLOCKS),
    .writes = bindings(PELLUCID_BINDING_ENTRIES_DESTINATION)};

constexpr bool gathers(const FrameFacts& f) { return f.stages.gathered > 0; }

constexpr Extent extentOfCells(const FrameFacts& f) {
  return {parts(f.lattice.extent.x, f.gatherSpacing), parts(f.lattice.extent.y, f.gatherSpacing)};
}

// Entry points of the maps of a dispatch and, in their place, filtered probes.
constexpr MadeImage kEntries{.texels = Texels::Packed, .made = &gathers, .extent = [](const FrameFacts& f) {
                               const Extent cells = extentOfCells(f);
                               return Extent{std::max(cells.width, withCoarserEntries(f.lights.entryColumns)),
                                             std::max(cells.height, f.lights.entryRows)};
                             }};

// shared::EntryPointsPass::entries
uint32_t entriesOf(const LightGroup& group) { return group.entryColumns | group.entryRows << 16; }

void addEntryPoints(Planner& p, const LightGroup& group) {
  const uint32_t columns = parts(group.entryWidth, PELLUCID_ENTRY_POINTS_GROUP),
                 rows = parts(group.entryHeight, PELLUCID_ENTRY_POINTS_GROUP);
  Step step = p.add(kEntryPointsPass, "entry points");
  step.lights(group)
      .image(PELLUCID_BINDING_ENTRIES_DESTINATION, kEntries)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::EntryPointsPass{entriesOf(group)});
  if (p.facts.stages.lists)
    step.groups(group.entryGroups).list(PELLUCID_LIST_ENTRIES);
  else
    step.groups(columns, rows, group.shadowCount * PELLUCID_ENTRY_LEVELS);
}

// ---- Probes -------------------------------------------------------------------------------------------

constexpr BindingSet kProbeReads = bindings(
    PELLUCID_BINDING_FRAME, PELLUCID_BINDING_LIGHTS, PELLUCID_BINDING_GATHER_MAPS, PELLUCID_BINDING_MATERIALS,
    PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_BINDING_BACK_DEPTH, PELLUCID_BINDING_PYRAMID,
    PELLUCID_BINDING_MATERIAL, PELLUCID_BINDING_ENTRY_POINTS, PELLUCID_BINDING_BLOCKS);
constexpr BindingSet kProbeWrites = bindings(PELLUCID_BINDING_PROBES_DESTINATION);

constexpr Pass kProbesPass{.pipeline = "probes",
                           .words = kProbes,
                           .uses = kGather,
                           .reads = kProbeReads,
                           .writes = kProbeWrites};

constexpr MadeImage kFoundProbes{.texels = Texels::Packed, .made = &gathers, .extent = &extentOfCells};

// Groups of `side` x `side` cells in a block.
uint32_t partsOfBlock(const FrameFacts& f, uint32_t side) {
  const uint32_t along = PELLUCID_BLOCK / (side * f.gatherSpacing);
  return along * along;
}
// `adds`: the dispatch adds its light to the probes of an earlier dispatch.
void addProbes(Planner& p, const LightGroup& group, bool adds) {
  p.add(kProbesPass, "probes")
      .blocks(PELLUCID_LIST_PROBES, partsOfBlock(p.facts, PELLUCID_PROBES_GROUP))
      .lights(group)
      .image(PELLUCID_BINDING_PYRAMID, kLevel1)
      .image(PELLUCID_BINDING_ENTRY_POINTS, kEntries)
      .image(PELLUCID_BINDING_PROBES_DESTINATION, kFoundProbes)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::ProbesPass{p.facts.gatherSpacing, group.gathered, entriesOf(group) | (adds ? 1u << 31 : 0),
                               p.facts.gatherSamples});
}

// ---- Filter of probes ---------------------------------------------------------------------------------

constexpr Pass kFilterProbesPass{.pipeline = "filter_probes",
                                 .words = kFilterProbes,
                                 .uses = kGather,
                                 .reads = bindings(PELLUCID_BINDING_FRAME, PELLUCID_BINDING_MATERIALS,
                                                   PELLUCID_BINDING_FOUND_PROBES, PELLUCID_BINDING_MOTION,
                                                   PELLUCID_BINDING_BLOCKS),
                                 .writes = bindings(PELLUCID_BINDING_FILTERED_DESTINATION)};

// This variant, of probes that are kept between frames, clears cells without material, and can average probes with those of the earlier
// frame. Its registers would cost other frames 2 us.
constexpr PellucidSpecialization kKeeps[] = {{PELLUCID_CONSTANT_KEEPS_PROBES, 1}};
constexpr Pass kKeepProbesPass{.pipeline = "keep_probes",
                               .words = kFilterProbes,
                               .uses = kGather,
                               .reads = kFilterProbesPass.reads,
                               .writes = kFilterProbesPass.writes,
                               .constants = kKeeps};

// With reuse of the gather: kept between frames. With accumulation, the earlier frame's probes lie above or below this frame's.
constexpr MadeImage kProbeHistory{.texels = Texels::Packed,
                                  .made = [](const FrameFacts& f) { return f.stages.keepsProbes; },
                                  .extent = [](const FrameFacts& f) {
                                    const Extent cells = extentOfCells(f);
                                    return Extent{cells.width, f.stages.accumulates ? 2 * cells.height : cells.height};
                                  }};
uint32_t filteredProbes(const Planner& p) {
  return p.facts.stages.keepsProbes ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : p.resource(kEntries);
}

// Probes that are kept, over all blocks: the next frame may have its material in any cell.
void addProbeFilter(Planner& p) {
  const bool keeps = p.facts.stages.keepsProbes;
  const uint32_t perBlock = partsOfBlock(p.facts, PELLUCID_FILTER_GROUP);
  Step step = p.add(keeps ? kKeepProbesPass : kFilterProbesPass, "filter probes");
  step.image(PELLUCID_BINDING_FOUND_PROBES, kFoundProbes)
      .image(PELLUCID_BINDING_FILTERED_DESTINATION, filteredProbes(p))
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::FilterProbesPass{p.facts.gatherSpacing});
  if (keeps)
    step.groups(p.facts.blocks.count(), perBlock);
  else
    step.blocks(PELLUCID_LIST_FILTER, perBlock);
}

// ---- Diffusion of pixels ------------------------------------------------------------------------------

constexpr Pass kDiffusePass{
    .pipeline = "diffuse",
    .words = kDiffuse,
    .uses = kDiffusion,
    .reads = kColorReads |
             bindings(PELLUCID_BINDING_PYRAMID, PELLUCID_BINDING_FILTERED_PROBES, PELLUCID_BINDING_BLOCKS),
    .writes = kColorWrites | bindings(PELLUCID_BINDING_LISTS)};

// With the light of the probes, if the frame has some.
void addDiffuse(Planner& p, uint32_t source, uint32_t destination) {
  const bool probes = p.facts.stages.gathered > 0;
  Step step = p.add(kDiffusePass, "diffuse");
  step.blocks(PELLUCID_LIST_DIFFUSE,
              PELLUCID_BLOCK / PELLUCID_DIFFUSE_COLUMNS * (PELLUCID_BLOCK / PELLUCID_DIFFUSE_ROWS))
      .colors(source, destination)
      .image(PELLUCID_BINDING_PYRAMID, kLevel1)
      .image(PELLUCID_BINDING_BLOCKS, kBlocks)
      .push(shared::DiffusePass{probes ? p.facts.gatherSpacing : 0, destination == PELLUCID_RESOURCE_OUTPUT});
  if (probes)
    step.image(PELLUCID_BINDING_FILTERED_PROBES, filteredProbes(p));
  else
    step.standIn(PELLUCID_BINDING_FILTERED_PROBES, p.resource(kLevel1));
}

// ---- All ----------------------------------------------------------------------------------------------

constexpr const Pass* kPasses[] = {
    &kTranslucencyPass, &kDebugViewPass, &kAddHistoryPass,  &kBaseLevelPass, &kDownsamplePass,   &kCoarseLevelsPass,
    &kUpsamplePass,     &kDiffusePass,   &kEntryPointsPass, &kProbesPass,    &kFilterProbesPass, &kKeepProbesPass};
constexpr bool fitSlots() {
  for (const Pass* pass : kPasses)
    if (slotOf(*pass, PELLUCID_BINDING_SHADOW_IMAGES) > PELLUCID_PLAN_SLOTS) return false;
  return true;
}
static_assert(std::size(kPasses) <= kMostPasses && fitSlots());

// In the order of frame.transients.
constexpr const MadeImage* kTransients[] = {&kColors[0],     &kColors[1],    &kLevel1,  &kLevels2And3,
                                            &kCoarserLevels, &kFoundProbes, &kEntries, &kBlocks};
static_assert(std::size(kTransients) <= PELLUCID_MAX_TRANSIENTS);
constexpr const MadeImage* kHistories[] = {&kLightHistory, &kProbeHistory};

// ---- A frame -----------------------------------------------------------------------------------------

// Adds the passes of a frame along the data flow. Colors alternate between the two color transients; the last
// write goes to the output.
class Flow {
public:
  Flow(Planner& planner, bool reuses)
      : p_(planner), stages_(planner.facts.stages), reused_(reuses), remaining_(stages_.writers()) {}

  void addAll() {
    if (stages_.nothing) return;
    // Light with one thickness a pixel has not spread on its way through: the diffusion spreads it.
    thinWalls();
    translucency();
    diffusion();
  }

private:
  // Calls add(source, destination) for a pass that goes over pixels.
  template <class Add>
  void pixels(Add&& add) {
    uint32_t destination = PELLUCID_RESOURCE_OUTPUT;
    if (--remaining_ > 0) {
      destination = p_.resource(kColors[next_]);
      next_ ^= 1;
    }
    add(source_, destination);
    source_ = destination;
  }

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
    addDownsample(p_);
    addCoarseLevels(p_);
    gather();
    addUpsample(p_);
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
  if (!f.lights.fitPlan()) return false;  // the list of lights has no room for their groups
  Planner planner(f, *plan);
  Flow(planner, reused).addAll();
  return planner.finish();
}

std::span<const Pass* const> allPasses() { return kPasses; }
std::span<const MadeImage* const> transientImages() { return kTransients; }
std::span<const MadeImage* const> historyImages() { return kHistories; }

}  // namespace pellucid
