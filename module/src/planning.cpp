// The API's functions that need no device: each reads the caller's frame once and asks for one result.
#include "needs.h"
#include "plan.h"
#include "plan_state.h"
#include "validate.h"

using namespace pellucid;

extern "C" PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous,
                                            PellucidPlan* plan) {
  if (!plan) return PELLUCID_ERROR_INVALID_ARGUMENT;
  // The two plans may be one object.
  const History kept = previous ? stateOf(*previous).history : History{};
  *plan = PellucidPlan{};
  Findings silent(nullptr, nullptr);
  return readFrame(frame, silent, [&](const FrameFacts& facts) { return buildPlan(facts, kept, plan); });
}

extern "C" PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count,
                                                PellucidImageNeed* needs) {
  if (!count) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Findings silent(nullptr, nullptr);
  return readFrame(frame, silent, [&](const FrameFacts& facts) { return imageNeeds(facts, count, needs); });
}

extern "C" uint32_t pellucidGetRequiredInputs(uint32_t features) {
  uint32_t images = 0;
  if ((features & (PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION)) == 0) return images;
  for (const ImageField& image : kImageFields)
    if (image.required) images |= 1u << image.resource;
  return images;
}

namespace {

// Lights, from the first one on, whose shadow images the dispatches of a plan can bind; one more does not
// fit. Those of all lights do not.
uint32_t lightsThatFit(PellucidFrame frame) {
  PellucidPlan plan;
  uint32_t fit = 0, tooMany = frame.lightCount;
  while (tooMany - fit > 1) {  // halved: each try costs lights times materials
    frame.lightCount = fit + (tooMany - fit) / 2;
    const bool fits = pellucidBuildPlan(&frame, nullptr, &plan) != PELLUCID_ERROR_CAPACITY;
    (fits ? fit : tooMany) = frame.lightCount;
  }
  return fit;
}

}  // namespace

extern "C" PellucidResult pellucidValidateFrame(const PellucidFrame* frame, PellucidMessageFn fn,
                                                void* user) {
  Findings out(fn, user);
  return readFrame(frame, out, [&](const FrameFacts& facts) {
    // The plan says what fits into it.
    PellucidPlan plan{};
    if (!addPasses(facts, false, &plan))
      out.fail(PELLUCID_ERROR_CAPACITY, "shadowImages", "of all ", facts.frame.lightCount,
               " lights are more than the plan's ", static_cast<int>(PELLUCID_MAX_DISPATCHES),
               " dispatches can bind; those of the first ", lightsThatFit(facts.frame), " lights fit");
    else
      checkViews(facts, out);
    return out.result();
  });
}
