// Passes as the API describes their pipelines.
#include <algorithm>
#include <bit>

#include "pass.h"

namespace pellucid {

uint32_t mostBindings(VkDescriptorType type) {
  uint32_t most = 0;
  for (const Pass* pass : allPasses()) {
    uint32_t count = 0;
    forEach(pass->bindings(), [&](const Binding& b) { count += b.type == type; });
    most = std::max(most, count);
  }
  return most;
}

uint32_t mostBindings() {
  uint32_t most = 0;
  for (const Pass* pass : allPasses())
    most = std::max(most, static_cast<uint32_t>(std::popcount(pass->bindings())));
  return most;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" uint32_t pellucidGetPipelineCount(void) { return static_cast<uint32_t>(allPasses().size()); }

extern "C" const char* pellucidPipelineName(uint32_t pipeline) {
  return pipeline < allPasses().size() ? allPasses()[pipeline]->pipeline : "unknown pipeline";
}

extern "C" const char* pellucidBindingName(uint32_t binding) {
  return binding < kBindings.size() ? kBindings[binding].name : "unknown binding";
}

extern "C" PellucidResult pellucidGetShader(uint32_t pipeline, VkImageViewType shadowViewType,
                                            PellucidShader* shader) {
  const bool known = shadowViewType == VK_IMAGE_VIEW_TYPE_2D || shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY;
  if (pipeline >= allPasses().size() || !known || !shader) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const Pass& pass = *allPasses()[pipeline];
  const std::span<const uint32_t> words = pass.wordsFor(shadowViewType);
  *shader = {words.data(), words.size(), static_cast<uint32_t>(pass.constants.size()), pass.constants.data()};
  return PELLUCID_OK;
}
