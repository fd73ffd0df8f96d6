#include "plan_tiles.h"

namespace pellucid {
namespace {

void bindLists(PlanBuilder& b, PellucidDispatch* d) {
  const ConstantsLayout& layout = b.facts.constants;
  b.constants(d, PELLUCID_BINDING_FRAME, layout.frame);
  b.bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, b.tilesImage());
  b.constants(d, PELLUCID_BINDING_TILE_COMMANDS, layout.tileCommands);
}

void findCells(PlanBuilder& b, bool gathers) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* find = b.dispatch("find cells", Pipeline::FindCells);
  find->groups[0] = f.tiles.blocks[0];
  find->groups[1] = f.tiles.blocks[1];
  find->pushConstants[0] = gathers;  // entry points depend on distances
  bindLists(b, find);
  b.image(find, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
  b.image(find, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH,
          gathers ? kUnknownDepthBytes : 0);
}

}  // namespace

void addTileLists(PlanBuilder& b) {
  const FrameFacts& f = b.facts;
  const bool gathers = f.stages.gathered > 0;
  if (f.frame.indirectDispatches == PELLUCID_INDIRECT_MATERIAL) findCells(b, gathers);
  PellucidDispatch* list = b.dispatch("list groups", Pipeline::ListGroups);
  b.decides();
  list->groups[0] = f.tiles.groups;
  list->groups[1] = 1;
  bindLists(b, list);
  // Without a gather it reads none: the lights' window is as large.
  const ConstantsLayout& layout = f.constants;
  b.constants(list, PELLUCID_BINDING_GATHER_MAPS,
              {gathers ? layout.gatherMaps.offset : layout.shadows.offset, kGatherMapWindow});
}

}  // namespace pellucid
