#include "frame.h"

#include <bit>

#include "entry_points.h"
#include "material/pyramid_energy.h"

namespace pellucid {
namespace {

// ---- Blocks

// Groups of entry points along a side of a map: a bit for each. Rows of coarser levels have as many bits.
constexpr uint32_t kEntryGroups = kEntryColumns / PELLUCID_ENTRY_POINTS_GROUP;
constexpr uint32_t kEntryGroupRows = 2 * kEntryGroups - (2 * kEntryGroups >> PELLUCID_ENTRY_LEVELS);
static_assert(kEntryGroups * kEntryGroupRows <= 32 * PELLUCID_ENTRY_GROUP_WORDS);

// Blocks that pixels [first, first + size) touch. Shifts round down, as the border begins below 0.
uint32_t blocksAlong(uint32_t first, uint32_t size, int border) {
  constexpr int kShift = std::countr_zero(uint32_t{PELLUCID_BLOCK});
  const int begin = static_cast<int>(first) - border, last = static_cast<int>(first + size) - 1 + border;
  return static_cast<uint32_t>((last >> kShift) - (begin >> kShift) + 1);
}

}  // namespace

Blocks::Blocks(const Lights& lights, const Rect& rect)
    : columns(blocksAlong(rect.x, rect.width, PELLUCID_BLOCK_BORDER)),
      rows(blocksAlong(rect.y, rect.height, PELLUCID_BLOCK_BORDER)),
      touched(blocksAlong(rect.x, rect.width, 0) * blocksAlong(rect.y, rect.height, 0)),
      maps(lights.gathered > 0 ? lights.list().front().shadowCount : 0),
      entryGroups(lights.entryGroups) {}

uint32_t Blocks::listWords() const {
  return static_cast<uint32_t>(pellucid::listWords(std::min<uint32_t>(count(), PELLUCID_LISTED_BLOCKS), maps));
}

// ---- Stages

Stages::Stages(const Setup& setup, const Lights& all, const Blocks& blocks) {
  const bool translucency = setup.translucency(), debug = setup.debug();
  diffusion = !debug && (setup.diffuses || all.gathered > 0);
  // Views of thickness and light show what translucency would have.
  if (translucency || (debug && setup.frame.options.debugView != PELLUCID_DEBUG_IRRADIANCE)) {
    gathered = all.gathered;
    fused = all.fused();
    walls = all.walls;
  }
  lights = fused > 0;
  copies = diffusion && !lights && walls == 0 && !setup.separate();
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output, unless that
  // is what it is.
  nothing = writers() == 0 && setup.inPlace() && !setup.has(PELLUCID_RESOURCE_ALBEDO) && !debug;
  if (writers() == 0 && !nothing) fused = 1;
  keepsHistory =
      setup.frame.options.reuse != PELLUCID_REUSE_NONE && !debug && translucency && all.lightCount > 0;
  keepsProbes = keepsHistory && all.gathered > 0;
  accumulates = keepsProbes && setup.frame.options.reuse == PELLUCID_REUSE_ACCUMULATE;
  if (setup.frame.options.reuse == PELLUCID_REUSE_ACCUMULATE) keepsHistory = keepsProbes;
  history = keepsHistory && !keepsProbes;
  whyNoLists = setup.frame.options.indirectDispatches == 0 ? "frame.options.indirectDispatches asks for none"
               : all.gathered > 1                          ? "lights need several dispatches"
               : blocks.count() > PELLUCID_LISTED_BLOCKS   ? "the image has more blocks than lists can hold"
                                                           : nullptr;
  lists = diffusion && !whyNoLists;
}

// ---- All

namespace {

// Leaves out levels for radii that are small in pixels.
uint32_t levelsFor(const Setup& setup, bool diffusion) {
  uint32_t coarsest = setup.pyramid.coarsest;
  while (diffusion && setup.widestDeviation > 0 && coarsest > kFirstLevel + 2 &&
         setup.widestDeviation <= deviationWithin(coarsest - 2))
    coarsest -= 2;
  return coarsest;
}

}  // namespace

FrameFacts::FrameFacts(const Setup& setup, Findings& out)
    : Setup(setup),
      lights(setup, out),
      blocks(lights, rect),
      stages(setup, lights, blocks),
      coarsestLevel(levelsFor(setup, stages.diffusion)),
      constants(setup, lights, stages, blocks) {}

std::optional<FrameFacts> readFrame(const PellucidFrame* frame, Findings& out) {
  std::optional<FrameFacts> facts;
  Inputs inputs;
  if (!readInputs(frame, out, &inputs)) return facts;
  checkFields(inputs, out);
  if (!out.ok()) return facts;
  checkMaterials(inputs, out);
  checkShadowMaps(inputs, out);
  if (!out.ok()) return facts;
  const Setup setup(inputs);
  checkLights(setup, out);
  if (!out.ok()) return facts;
  facts.emplace(setup, out);
  checkGroups(*facts, out);
  if (!out.ok()) facts.reset();
  return facts;
}

}  // namespace pellucid
