#include "cli/plan_json.h"

#include <span>

#include <nlohmann/json.hpp>

namespace pellucid::harness {
namespace {

using Json = nlohmann::ordered_json;

const char* descriptorName(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "sampledImage";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storageImage";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "uniformBuffer";
    default:
      return "storageBuffer";
  }
}

std::string resourceName(std::uint32_t resource) {
  const std::string name = pellucidResourceName(resource);
  return resource < PELLUCID_RESOURCE_SHADOW0 ? name : name + std::to_string(resource - PELLUCID_RESOURCE_SHADOW0);
}

Json bindingJson(const PellucidBinding& b) {
  Json json = {{"binding", b.binding},
               {"name", pellucidBindingName(b.binding)},
               {"type", descriptorName(b.type)},
               {"writes", b.writes != 0},
               {"resource", resourceName(b.resource)}};
  if (b.size > 0) json.update({{"offset", b.offset}, {"size", b.size}});
  return json;
}

Json dispatchJson(const PellucidPlan& plan, std::uint32_t index) {
  const PellucidDispatch& d = plan.dispatches[index];
  Json json = {{"name", d.name}, {"pipeline", pellucidPipelineName(d.pipeline)}};
  if (d.indirect)
    json["indirect"] = {{"resource", "constants"}, {"offset", d.indirectOffset}};
  else
    json["groups"] = d.groups;
  if (d.barrierIndirect) json["barrierIndirect"] = true;
  json["barrierBefore"] = d.barrierBefore != 0;
  json["pushConstants"] = d.pushConstants;
  json["bindings"] = Json::array();
  PellucidBinding bindings[PELLUCID_MAX_BINDINGS];
  for (const PellucidBinding& b : std::span(bindings, pellucidGetBindings(&plan, index, bindings)))
    json["bindings"].push_back(bindingJson(b));
  return json;
}

}  // namespace

std::string planJson(const PellucidPlan& plan, int indent) {
  Json json = {{"dispatchCount", plan.dispatchCount}, {"barrierCount", plan.barrierCount},
               {"activeLights", plan.activeLights},   {"gatherSamples", plan.gatherSamples},
               {"constantsSize", plan.constantsSize}, {"listsOffset", plan.listsOffset}, {"inPlaceDispatches", plan.inPlaceDispatches},
               {"dispatches", Json::array()},         {"skips", Json::array()}};
  for (std::uint32_t i = 0; i < plan.dispatchCount; ++i) json["dispatches"].push_back(dispatchJson(plan, i));
  for (const PellucidSkip& s : std::span(plan.skips, plan.skipCount))
    json["skips"].push_back({{"what", s.what}, {"reason", s.reason}, {"count", s.count}});
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

}  // namespace pellucid::harness
