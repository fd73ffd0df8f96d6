#include "plan_translucency.h"

namespace pellucid {

namespace {

// All that a dispatch over all pixels reads to add a group's lights.
void addLights(PlanBuilder& b, PellucidDispatch* d, const LightGroup& group, uint32_t source,
               uint32_t destination) {
  const FrameFacts& f = b.facts;
  d->pushConstants[1] = group.lightCount;
  d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
  b.common(d, source, destination);
  if (destination == PELLUCID_RESOURCE_HISTORY && group.firstLight == 0) {
    d->pushConstants[2] = PELLUCID_WRITE_STARTS;
    d->modeledBytes -= b.colorBytes() * b.pixels();  // what is there is not read
  }
  const ConstantsLayout& layout = f.constants;
  b.constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
  b.optional(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 4);
  b.constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
  b.constants(d, PELLUCID_BINDING_SHADOWS, {layout.shadows.offset + group.shadowBytes, kShadowWindow});
  b.optional(d, PELLUCID_BINDING_BACK_DEPTH, PELLUCID_RESOURCE_BACK_DEPTH,
             f.needsChord ? kUnknownDepthBytes : 0);
  b.shadowImages(d, group, PELLUCID_SHADOW_IMAGE_COUNT);
}

}  // namespace

void addTranslucency(PlanBuilder& b, const LightGroup& group, uint32_t source, uint32_t destination) {
  const FrameFacts& f = b.facts;
  PellucidDispatch* d = f.debug() ? b.dispatch("debug view", Pipeline::DebugView)
                                  : b.dispatch("translucency", Pipeline::Translucency);
  d->pushConstants[0] = f.stages.walls > 0 ? PELLUCID_LIGHT_SOLIDS : PELLUCID_LIGHT_ALL;
  addLights(b, d, group, source, destination);
}

void addThinWalls(PlanBuilder& b, const LightGroup& group, uint32_t source, uint32_t destination) {
  PellucidDispatch* d = b.dispatch("thin walls", Pipeline::Translucency);
  d->pushConstants[0] = PELLUCID_LIGHT_WALLS;
  addLights(b, d, group, source, destination);
}

void addHistory(PlanBuilder& b, uint32_t source, uint32_t destination) {
  PellucidDispatch* d = b.dispatch("add history", Pipeline::AddHistory);
  d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
  b.common(d, source, destination);
  b.image(d, PELLUCID_BINDING_HISTORY, PELLUCID_RESOURCE_HISTORY, b.colorBytes());
}

}  // namespace pellucid
