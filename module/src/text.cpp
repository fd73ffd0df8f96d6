#include "text.h"

#include <array>

#include "images.h"

namespace pellucid {

Text& Text::operator<<(std::string_view s) {
  for (char c : s) {
    if (size_ + 1 < capacity_) {
      buffer_[size_] = c;
      buffer_[size_ + 1] = '\0';
    }
    ++size_;
  }
  return *this;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" const char* pellucidResultName(PellucidResult result) {
  switch (result) {
    case PELLUCID_OK:
      return "PELLUCID_OK";
    case PELLUCID_ERROR_INVALID_ARGUMENT:
      return "PELLUCID_ERROR_INVALID_ARGUMENT";
    case PELLUCID_ERROR_VERSION:
      return "PELLUCID_ERROR_VERSION";
    case PELLUCID_ERROR_MISSING_FEATURE:
      return "PELLUCID_ERROR_MISSING_FEATURE";
    case PELLUCID_ERROR_OUT_OF_MEMORY:
      return "PELLUCID_ERROR_OUT_OF_MEMORY";
    case PELLUCID_ERROR_VULKAN:
      return "PELLUCID_ERROR_VULKAN";
    case PELLUCID_ERROR_CAPACITY:
      return "PELLUCID_ERROR_CAPACITY";
    case PELLUCID_ERROR_BUFFER_TOO_SMALL:
      return "PELLUCID_ERROR_BUFFER_TOO_SMALL";
    default:
      return "unknown result";
  }
}

extern "C" const char* pellucidResourceName(uint32_t resource) {
  for (const ImageField& image : kImageFields)
    if (image.resource == resource) return image.name;
  static constexpr const char* kTransients[] = {"transient0", "transient1", "transient2", "transient3",
                                                "transient4", "transient5", "transient6", "transient7"};
  static_assert(std::size(kTransients) == PELLUCID_MAX_TRANSIENTS);
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  if (transient < PELLUCID_MAX_TRANSIENTS) return kTransients[transient];
  if (resource == PELLUCID_RESOURCE_CONSTANTS) return "constants";
  if (resource == PELLUCID_RESOURCE_HISTORY) return "history";
  return resource >= PELLUCID_RESOURCE_SHADOW0 ? "shadowImage" : "unknown resource";
}

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

void dispatch(Text& out, const PellucidDispatch& d) {
  out << "{\"name\":\"" << d.name << "\",\"pipeline\":\"" << pellucidPipelineName(d.pipeline) << "\",";
  if (d.indirect) {
    out << "\"indirect\":{\"resource\":";
    resource(out, d.indirectResource);
    out << ",\"offset\":" << d.indirectOffset << "},";
  } else {
    out << "\"groups\":[" << d.groups[0] << "," << d.groups[1] << "," << d.groups[2] << "],";
  }
  if (d.barrierIndirect) out << "\"barrierIndirect\":true,";
  out << "\"barrierBefore\":" << (d.barrierBefore ? "true" : "false") << ",\"pushConstants\":[";
  for (std::size_t i = 0; i < std::size(d.pushConstants); ++i) out << (i ? "," : "") << d.pushConstants[i];
  out << "],\"bindings\":[";
  for (uint32_t i = 0; i < d.bindingCount; ++i) {
    const PellucidBinding& b = d.bindings[i];
    out << (i ? "," : "") << "{\"binding\":" << b.binding << ",\"name\":\"" << pellucidBindingName(b.binding)
        << "\",\"type\":\"" << descriptorName(b.type) << "\",\"resource\":";
    resource(out, b.resource);
    if (b.size > 0) out << ",\"offset\":" << b.offset << ",\"size\":" << b.size;
    if (b.level > 0) out << ",\"level\":" << b.level;
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
    dispatch(out, plan->dispatches[i]);
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
