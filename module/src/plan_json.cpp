// Plan -> JSON.
#include "findings.h"
#include "plan.h"

using namespace pellucid;

namespace {

const char* descriptorName(VkDescriptorType type) {
  switch (type) {
    case VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE:
      return "sampledImage";
    case VK_DESCRIPTOR_TYPE_STORAGE_IMAGE:
      return "storageImage";
    case VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER:
      return "uniformBuffer";
    case VK_DESCRIPTOR_TYPE_STORAGE_BUFFER:
      return "storageBuffer";
    default:
      return "other";
  }
}

void resource(Text& out, uint32_t id) {
  out << "\"" << pellucidResourceName(id);
  if (id >= PELLUCID_RESOURCE_SHADOW0) out << (id - PELLUCID_RESOURCE_SHADOW0);
  out << "\"";
}

void dispatch(Text& out, const PellucidPlan& plan, const PellucidDispatch& d) {
  out << "{\"name\":\"" << d.name << "\",\"pipeline\":\"" << pellucidPipelineName(d.pipeline) << "\",";
  if (d.indirect) {
    out << "\"indirect\":{\"resource\":\"constants\",\"offset\":" << d.indirectOffset << "},";
  } else {
    out << "\"groups\":[" << d.groups[0] << "," << d.groups[1] << "," << d.groups[2] << "],";
  }
  if (d.barrierIndirect) out << "\"barrierIndirect\":true,";
  out << "\"barrierBefore\":" << (d.barrierBefore ? "true" : "false") << ",\"pushConstants\":[";
  for (std::size_t i = 0; i < std::size(d.pushConstants); ++i) out << (i ? "," : "") << d.pushConstants[i];
  out << "],\"bindings\":[";
  const BoundList bound = boundBy(plan, d);
  for (const PellucidBinding& b : bound) {
    out << (&b != bound.begin() ? "," : "") << "{\"binding\":" << b.binding << ",\"name\":\""
        << pellucidBindingName(b.binding) << "\",\"type\":\"" << descriptorName(b.type) << "\",\"resource\":";
    resource(out, b.resource);
    if (b.size > 0) out << ",\"offset\":" << b.offset << ",\"size\":" << b.size;
    out << "}";
  }
  out << "]}";
}

}  // namespace

extern "C" PellucidResult pellucidPlanToJson(const PellucidPlan* plan, char* text, size_t* size) {
  if (!plan || !size) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Text out(text, *size);
  out << "{\"dispatchCount\":" << plan->dispatchCount << ",\"barrierCount\":" << plan->barrierCount
      << ",\"activeLights\":" << plan->activeLights << ",\"gatherSamples\":" << plan->gatherSamples
      << ",\"largestRadius\":" << plan->largestRadius << ",\"constantsSize\":" << plan->constantsSize
      << ",\"dispatches\":[";
  for (uint32_t i = 0; i < plan->dispatchCount; ++i) {
    if (i) out << ",";
    dispatch(out, *plan, plan->dispatches[i]);
  }
  out << "],\"skips\":[";
  for (uint32_t i = 0; i < plan->skipCount; ++i)
    out << (i ? "," : "") << "{\"what\":\"" << plan->skips[i].what << "\",\"reason\":\""
        << plan->skips[i].reason << "\",\"count\":" << plan->skips[i].count << "}";
  out << "]}";
  const bool fits = !text || *size >= out.needed();
  *size = out.needed();
  return fits ? PELLUCID_OK : PELLUCID_ERROR_BUFFER_TOO_SMALL;
}
