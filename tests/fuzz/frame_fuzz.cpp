// Validation, plan, needs, constants, recording and JSON of any frame.
#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "fuzz/frame_input.h"
#include "fuzz/targets.h"
#include "null_device.h"

namespace pellucid::fuzz {

namespace {

using test::NullCommands;
using test::NullDevice;

PellucidContext* makeContext(VkImageViewType shadowViewType) {
  static NullDevice& device = *new NullDevice;  // as contexts live as long as the process
  PellucidContextDesc desc = device.desc();
  desc.options.shadowViewType = shadowViewType;
  desc.options.lightTables = 1;
  desc.options.outputFormat = VK_FORMAT_UNDEFINED;  // frames have several
  PellucidContext* made = nullptr;
  require(pellucidCreateContext(&desc, &made) == PELLUCID_OK, "the null device has a context");
  return made;
}

// Maps in layers need a context whose shadow images are arrays. An array context needs a shadow image.
const PellucidContext* contextFor(const PellucidFrame& frame) {
  static const PellucidContext* const flat = makeContext(VK_IMAGE_VIEW_TYPE_2D);
  static const PellucidContext* const layered = makeContext(VK_IMAGE_VIEW_TYPE_2D_ARRAY);
  const std::span maps(frame.shadowMaps, frame.shadowMaps ? frame.shadowMapCount : 0);
  const bool hasLayers =
      std::any_of(maps.begin(), maps.end(), [](const PellucidShadowMap& map) { return map.options.layer > 0; });
  return hasLayers ? layered : flat;
}

struct Findings {
  uint32_t errors = 0;
  static void add(void* user, PellucidSeverity severity, const char* field, const char* message) {
    require(field && *field && message && *message, "a finding has a field and a sentence");
    static_cast<Findings*>(user)->errors += severity == PELLUCID_SEVERITY_ERROR;
  }
};

PellucidResult validate(const PellucidFrame& frame) {
  Findings findings;
  const PellucidResult result = pellucidValidateFrame(&frame, Findings::add, &findings);
  require((result == PELLUCID_OK) == (findings.errors == 0), "validation fails exactly with a finding");
  return result;
}

void checkPlan(const PellucidPlan& plan) {
  require(plan.dispatchCount <= PELLUCID_MAX_DISPATCHES && plan.skipCount <= PELLUCID_MAX_SKIPS,
          "counts of a plan are within its arrays");
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    PellucidBinding bindings[PELLUCID_MAX_BINDINGS];
    require(d.name && d.pipeline < pellucidGetPipelineCount() && pellucidGetBindings(&plan, i, bindings) > 0,
            "a dispatch has a name, a pipeline and bindings");
  }
}

void checkNeeds(const PellucidFrame& frame, bool hasPlan) {
  uint32_t count = 0;
  if (pellucidGetImageNeeds(&frame, &count, nullptr) != PELLUCID_OK) return;
  require(count <= PELLUCID_MAX_TRANSIENTS + 1, "needs are the transients and the history");
  std::vector<PellucidImageNeed> needs(count);
  // The number is known where there is no plan for want of capacity, and no more.
  PellucidImageNeed none;
  const PellucidResult result = pellucidGetImageNeeds(&frame, &count, needs.empty() ? &none : needs.data());
  require(result == (hasPlan ? PELLUCID_OK : PELLUCID_ERROR_CAPACITY) && count == needs.size(),
          "needs are as many as said, of frames with a plan");
  if (result != PELLUCID_OK) return;
  for (const PellucidImageNeed& need : needs)
    require(need.extent[0] > 0 && need.extent[1] > 0 && need.format != VK_FORMAT_UNDEFINED,
            "an image has a size and a format");
}

// Writes the constants into memory of exactly the size that the plan asks for, and records.
PellucidResult record(const PellucidPlan& plan, const PellucidFrame& frame, VkDeviceSize size) {
  // Not a vector: 256-byte alignment, and ends where it ends.
  const std::unique_ptr<unsigned char[]> memory(new unsigned char[size]);
  NullCommands commands;
  commands.sliceOffset = 512;
  commands.sliceSize = size;
  const PellucidConstantsSlice slice{reinterpret_cast<VkBuffer>(uintptr_t{1}), commands.sliceOffset, size,
                                     memory.get()};
  const PellucidResult written =
      pellucidWriteConstants(&plan, &frame, memory.get(), static_cast<size_t>(size));
  if (written != PELLUCID_OK) return written;
  const PellucidResult result = pellucidRecordPlan(contextFor(frame), commands.handle(), &plan, &frame, &slice);
  require(commands.problem.empty(), commands.problem);
  require(commands.dispatches == (result == PELLUCID_OK ? plan.dispatchCount : 0),
          "a recording has all dispatches of the plan, or none");
  require(result != PELLUCID_OK || commands.barriers == plan.barrierCount,
          "a recording has the plan's barriers");
  return result;
}

}  // namespace

bool fuzzFrame(std::span<const uint8_t> bytes) {
  const size_t edits = bytes.size() / FrameInput::kEditBytes;
  const FrameInput input(bytes, edits);
  const PellucidFrame& frame = input.frame;
  // The frame before, whose plan this one goes on with: as the input was some edits ago.
  const FrameInput before(bytes, edits > 0 ? input.choice % edits : 0);
  const auto plan = std::make_unique<PellucidPlan>(), last = std::make_unique<PellucidPlan>();
  const bool hasLast = pellucidBuildPlan(&before.frame, nullptr, last.get()) == PELLUCID_OK;

  const PellucidResult valid = validate(frame);
  const PellucidResult planned = pellucidBuildPlan(&frame, hasLast ? last.get() : nullptr, plan.get());
  require((planned == PELLUCID_ERROR_CAPACITY) == (valid == PELLUCID_ERROR_CAPACITY),
          "validation and plan agree about the capacity");
  require(valid != PELLUCID_OK || planned == PELLUCID_OK, "a valid frame has a plan");
  require(planned == PELLUCID_OK || valid == planned, "a frame without a plan is refused the same way");
  checkNeeds(frame, valid != PELLUCID_ERROR_CAPACITY);
  if (hasLast && last->dispatchCount > 0) {
    // A plan of another frame is refused, or there is no difference that matters.
    const PellucidResult result = record(*last, frame, last->constantsSize);
    require(result != PELLUCID_ERROR_BUFFER_TOO_SMALL, "the slice is as large as the plan asks for");
  }
  if (planned != PELLUCID_OK) return false;
  checkPlan(*plan);
  const PellucidResult recorded = record(*plan, frame, plan->constantsSize);
  require(valid != PELLUCID_OK || recorded == PELLUCID_OK, "a valid frame is recorded");
  if (plan->constantsSize > 0 && valid == PELLUCID_OK)
    require(record(*plan, frame, plan->constantsSize - 1) == PELLUCID_ERROR_BUFFER_TOO_SMALL,
            "a slice that is too small is refused");
  return valid == PELLUCID_OK;
}

}  // namespace pellucid::fuzz
