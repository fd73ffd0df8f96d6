// Names of results and resources.
#include <array>

#include "images.h"

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
