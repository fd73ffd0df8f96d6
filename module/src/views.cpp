// Views before they are recorded: what is refused.
#include "context.h"
#include "plan.h"

namespace pellucid {
namespace {

// A view's errors on their way to the context's message.
struct ViewErrors {
  const PellucidContext& context;
  Field prefix;

  // A PellucidMessageFn. Warnings are validation's.
  static void pass(void* user, PellucidSeverity severity, const char* field, const char* message) {
    const auto& [context, prefix] = *static_cast<const ViewErrors*>(user);
    if (severity == PELLUCID_SEVERITY_ERROR && context.desc.message)
      context.desc.message(context.desc.messageUser, severity, Field(prefix, field), message);
  }
};

Field fieldOf(uint32_t resource) {
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  if (transient < PELLUCID_MAX_TRANSIENTS) return Field("transients[", transient, "]");
  if (resource >= kShadow0) return Field("shadowImages[", resource - kShadow0, "]");
  if (resource == PELLUCID_RESOURCE_HISTORY) return Field("options.history");
  return Field(pellucidResourceName(resource));
}

// The name of the lowest PellucidUse bit of a pass.
const char* useOf(uint32_t uses) {
  if (uses & PELLUCID_USE_TRANSLUCENCY) return "PELLUCID_USE_TRANSLUCENCY";
  if (uses & PELLUCID_USE_GATHER) return "PELLUCID_USE_GATHER";
  if (uses & PELLUCID_USE_DIFFUSION) return "PELLUCID_USE_DIFFUSION";
  return uses & PELLUCID_USE_REUSE ? "PELLUCID_USE_REUSE" : "PELLUCID_USE_DEBUG_VIEWS";
}

// Refuses plans that ask for another context.
void checkContext(const PellucidContext& c, const PellucidPlan& plan, Findings& out) {
  if (plan.dispatchCount > PELLUCID_MAX_DISPATCHES)
    return out.error("plan", "has ", plan.dispatchCount, " dispatches; needs at most ", static_cast<int>(PELLUCID_MAX_DISPATCHES));
  const PlanState state = stateOf(plan);
  if (c.desc.options.outputFormat != VK_FORMAT_UNDEFINED && c.desc.options.outputFormat != state.outputFormat)
    return out.error("options.outputFormat",
                     "is not PellucidContextOptions::outputFormat, which the context writes alone");
  if (state.lightTables > 0 && !c.desc.options.lightTables)
    return out.error(
        "options.lightTableCount",
        "is above 0, but PellucidContextOptions::lightTables is 0: the pipelines do not look for any");
  constexpr std::pair<uint32_t, const char*> kOptions[] = {
      {PELLUCID_USE_THIN_WALLS, "PELLUCID_USE_THIN_WALLS: a material is thin-walled"},
      {PELLUCID_USE_AMBIENT, "PELLUCID_USE_AMBIENT: hiddenIrradiance or options.ambient holds light"},
      {PELLUCID_USE_THESIS, "PELLUCID_USE_THESIS: an angle or transmittance model is one of Whelan 2009"}};
  for (const auto& [use, why] : kOptions)
    if (c.desc.options.uses != 0 && (state.options & use & ~c.desc.options.uses) != 0)
      return out.error("plan", "needs PellucidContextOptions::uses with ", why);
  if (state.layeredMap > 0 && c.desc.options.shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY)
    return out.error(Field("shadowMaps[", state.layeredMap - 1, "].options.layer"), "is ", state.layer,
                     ", but PellucidContextOptions::shadowViewType is 2D");
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const uint32_t pipeline = plan.dispatches[i].pipeline;
    if (pipeline >= allPasses().size()) return out.error("plan", "needs pipeline ", pellucidPipelineName(pipeline));
    const uint32_t lacks = c.desc.options.uses != 0 ? allPasses()[pipeline]->uses & ~c.desc.options.uses : 0;
    if (lacks != 0)
      return out.error("plan", "needs PellucidContextOptions::uses with ", useOf(lacks), " for its dispatch \"", plan.dispatches[i].name, "\"");
  }
}

// Refuses frames that lack an image of the plan's.
void checkBound(const PellucidContext& c, const PellucidPlan& plan, const PellucidFrame& frame,
                Findings& out) {
  for (uint32_t i = 0; i < plan.dispatchCount; ++i)
    for (const PellucidBinding& b : boundBy(plan, plan.dispatches[i])) {
      const uint32_t resource = b.resource;
      if (resource == PELLUCID_RESOURCE_FRONT_DEPTH && b.binding >= PELLUCID_BINDING_SHADOW_IMAGES &&
          c.desc.options.shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY)
        return out.error(
            "shadowImages",
            "has no view, but PellucidContextOptions::shadowViewType is 2D_ARRAY, and passes bind "
            "one such view even where no light has a map");
      if (resource == PELLUCID_RESOURCE_CONSTANTS) continue;
      if (const PellucidImage* image = imageOf(frame, resource); !image || !given(*image))
        return out.error(fieldOf(resource), "has no view, but the plan binds it");
    }
  if (stateOf(plan).separate && given(frame.output) && frame.output.view == frame.irradiance.view)
    out.error("output", "is the irradiance's view, but the plan was made for two images");
}

// Bits 1 << PellucidResource of the images that a plan binds, without shadow images, which nothing writes.
struct BoundImages {
  uint32_t all = 0, written = 0;

  explicit BoundImages(const PellucidPlan& plan) {
    for (uint32_t i = 0; i < plan.dispatchCount; ++i)
      for (const PellucidBinding& binding : boundBy(plan, plan.dispatches[i])) {
        if (binding.resource >= kShadow0 || binding.resource == PELLUCID_RESOURCE_CONSTANTS) continue;
        all |= 1u << binding.resource;
        if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) written |= 1u << binding.resource;
      }
  }
};

bool isOfScreen(uint32_t resource) { return resource <= PELLUCID_RESOURCE_OUTPUT; }

// Pixels of screen-sized images outside the rect are neither read nor written.
bool rectsMeet(const PellucidPlan& a, const PellucidPlan& b) {
  const Rect r = stateOf(a).rect, s = stateOf(b).rect;
  return r.x < s.x + s.width && s.x < r.x + r.width && r.y < s.y + s.height && s.y < r.y + r.height;
}

// Refuses an image that one of the views writes and the other uses at the same time. Views were checked, so
// frames have all images that plans bind.
void checkImages(const PellucidView& view, const PellucidView& other, uint32_t otherIndex, Findings& out) {
  const BoundImages bound(*view.plan), otherBound(*other.plan);
  const bool meet = rectsMeet(*view.plan, *other.plan);
  for (uint32_t a = 0; bound.all >> a != 0; ++a)
    for (uint32_t b = 0; bound.all >> a & 1 && otherBound.all >> b != 0; ++b) {
      const bool written = (bound.written >> a | otherBound.written >> b) & 1;
      if (!(otherBound.all >> b & 1) || !written || (!meet && isOfScreen(a) && isOfScreen(b))) continue;
      if (imageOf(*view.frame, a)->view == imageOf(*other.frame, b)->view)
        return out.error(fieldOf(a), "is views[", otherIndex, "].", fieldOf(b),
                         ", too; what a view writes, no other view of the recording uses");
    }
}

// Calls each(i, resource) for shadowImages[i] of one frame that the other view writes as `resource`.
template <class Each>
void forWrittenMaps(const PellucidFrame& frame, const PellucidView& writer, Each&& each) {
  const uint32_t written = BoundImages(*writer.plan).written;
  for (uint32_t i = 0; i < frame.shadowImageCount; ++i)
    for (uint32_t b = 0; given(frame.shadowImages[i]) && written >> b != 0; ++b)
      if ((written >> b & 1) != 0 && imageOf(*writer.frame, b)->view == frame.shadowImages[i].view) each(i, b);
}

// Refuses shadow images of one view that the other writes.
void checkShadowImages(const PellucidView& view, const PellucidView& other, uint32_t otherIndex, Findings& out) {
  constexpr const char* kWhy = ", too; what a view writes, no other view of the recording uses";
  forWrittenMaps(*view.frame, other, [&](uint32_t i, uint32_t resource) {
    out.error(Field("shadowImages[", i, "]"), "is views[", otherIndex, "].", fieldOf(resource), kWhy);
  });
  forWrittenMaps(*other.frame, view, [&](uint32_t i, uint32_t resource) {
    out.error(fieldOf(resource), "is views[", otherIndex, "].shadowImages[", i, "]", kWhy);
  });
}

bool overlap(uint64_t a, uint64_t aSize, uint64_t b, uint64_t bSize) {
  return a < b + bSize && b < a + aSize;
}

void checkSlices(const PellucidView& view, const PellucidView& other, uint32_t otherIndex, Findings& out) {
  const PellucidConstantsSlice &a = *view.constants, &b = *other.constants;
  const uint64_t aSize = view.plan->constantsSize, bSize = other.plan->constantsSize;
  if (a.buffer == b.buffer && overlap(a.offset, aSize, b.offset, bSize))
    out.error("constants.offset", "is ", a.offset, " for ", aSize, " bytes, which overlap those of views[",
              otherIndex, "], ", bSize, " from ", b.offset, " of the same buffer");
  else if (a.mapped && b.mapped &&
           overlap(reinterpret_cast<uintptr_t>(a.mapped), aSize, reinterpret_cast<uintptr_t>(b.mapped),
                   bSize))
    out.error("constants.mapped", "overlaps the bytes of views[", otherIndex, "].constants.mapped");
}

void checkView(const PellucidContext& c, std::span<const PellucidView> views, uint32_t index, Findings& out) {
  const PellucidView& view = views[index];
  if (!view.plan) out.error("plan", "is NULL");
  if (!view.frame) out.error("frame", "is NULL");
  if (!view.constants)
    out.error("constants", "is NULL");
  else if (view.constants->offset % kSlotBytes != 0 || !view.constants->buffer)
    out.error("constants", "needs a buffer and an offset that is a multiple of 256");
  if (!out.ok()) return;
  checkContext(c, *view.plan, out);
  if (out.ok()) checkBound(c, *view.plan, *view.frame, out);
  if (!out.ok()) return;
  if (c.desc.options.descriptorPools && !view.frame->options.descriptorPool)
    out.error("options.descriptorPool", "is NULL, but PellucidContextOptions::descriptorPools is 1");
  else if (view.constants->size < view.plan->constantsSize)
    out.fail(PELLUCID_ERROR_BUFFER_TOO_SMALL, "constants.size", "is ", view.constants->size,
             "; the plan needs ", view.plan->constantsSize);
  for (uint32_t other = 0; other < index && out.ok(); ++other) {
    checkImages(view, views[other], other, out);
    checkShadowImages(view, views[other], other, out);
    checkSlices(view, views[other], other, out);
    if (c.desc.options.descriptorPools && views[other].frame->options.descriptorPool == view.frame->options.descriptorPool)
      out.error("options.descriptorPool", "is views[", other, "].options.descriptorPool, too");
  }
}

}  // namespace

PellucidResult checkViews(const PellucidContext& context, std::span<const PellucidView> views, bool named) {
  for (uint32_t i = 0; i < views.size(); ++i) {
    ViewErrors errors{context, named ? Field("views[", i, "].") : Field("")};
    Findings out(&ViewErrors::pass, &errors);
    checkView(context, views, i, out);
    if (!out.ok()) return out.result();
  }
  return PELLUCID_OK;
}

}  // namespace pellucid
