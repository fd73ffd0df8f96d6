#include "views.h"

#include "constants.h"
#include "plan_state.h"
#include "rect.h"
#include "validate.h"

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

// Refuses frames without what the plan uses, as a plan of another frame has it.
void checkPlan(const PellucidContext& c, const PellucidPlan& plan, const FrameFacts& facts, Findings& out) {
  const FrameHash now = hashOf(facts), then = stateOf(plan).frame;
  for (size_t i = 0; i < now.size(); ++i)
    if (now[i] != then[i])
      return out.error("plan", "was made from another frame, whose ", nameOf(static_cast<FramePart>(i)),
                       " differs");
  if (c.desc.outputFormat != VK_FORMAT_UNDEFINED && c.desc.outputFormat != facts.frame.outputFormat)
    return out.error("outputFormat",
                     "is not PellucidContextDesc::outputFormat, which the context writes alone");
  if (facts.frame.lightTableCount > 0 && !c.desc.lightTables)
    return out.error(
        "lightTableCount",
        "is above 0, but PellucidContextDesc::lightTables is 0: the pipelines do not look for any");
  for (uint32_t i = 0; i < facts.frame.shadowMapCount; ++i)
    if (const uint32_t layer = facts.frame.shadowMaps[i].layer;
        layer != 0 && c.desc.shadowViewType != VK_IMAGE_VIEW_TYPE_2D_ARRAY)
      return out.error(Field("shadowMaps[", i, "].layer"), "is ", layer,
                       ", but PellucidContextDesc::shadowViewType is 2D");
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (d.pipeline >= allPasses().size() || c.pipelines[d.pipeline] == VK_NULL_HANDLE)
      return out.error(
          "plan", "needs pipeline ", pellucidPipelineName(d.pipeline),
          c.desc.deferPipelines
              ? ", which pellucidCreatePipelines has not made or PellucidContextDesc::uses leaves out"
              : ", which PellucidContextDesc::uses leaves out");
    for (uint32_t b = 0; b < d.bindingCount; ++b) {
      const uint32_t resource = d.bindings[b].resource;
      const bool shadow = d.bindings[b].binding >= PELLUCID_BINDING_SHADOW_IMAGES;
      if (resource == PELLUCID_RESOURCE_FRONT_DEPTH && shadow &&
          c.desc.shadowViewType == VK_IMAGE_VIEW_TYPE_2D_ARRAY)
        return out.error("shadowImages",
                         "has no view, but PellucidContextDesc::shadowViewType is 2D_ARRAY, and passes bind "
                         "one such view even where no light has a map");
      if (resource != PELLUCID_RESOURCE_CONSTANTS && !given(imageOf(facts.frame, resource)))
        return out.error("plan",
                         "uses an image that the frame has no view of: it was made from another frame");
    }
  }
}

// Bits 1 << PellucidResource of the images that a plan binds, without shadow images, which nothing writes.
struct BoundImages {
  uint32_t all = 0, written = 0;

  explicit BoundImages(const PellucidPlan& plan) {
    for (uint32_t i = 0; i < plan.dispatchCount; ++i)
      for (uint32_t b = 0; b < plan.dispatches[i].bindingCount; ++b) {
        const PellucidBinding& binding = plan.dispatches[i].bindings[b];
        if (binding.resource >= PELLUCID_RESOURCE_SHADOW0 || binding.resource == PELLUCID_RESOURCE_CONSTANTS)
          continue;
        all |= 1u << binding.resource;
        if (binding.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE) written |= 1u << binding.resource;
      }
  }
};

// The frame's field of a resource below PELLUCID_RESOURCE_SHADOW0.
Field fieldOf(uint32_t resource) {
  const uint32_t transient = resource - PELLUCID_RESOURCE_TRANSIENT0;
  return transient < PELLUCID_MAX_TRANSIENTS ? Field("transients[", transient, "]")
                                             : Field(pellucidResourceName(resource));
}

bool isOfScreen(uint32_t resource) { return resource <= PELLUCID_RESOURCE_OUTPUT; }

// Pixels of screen-sized images outside the rect are neither read nor written.
bool rectsMeet(const PellucidFrame& a, const PellucidFrame& b) {
  const Rect r = renderRect(a), s = renderRect(b);
  return r.x < s.x + s.width && s.x < r.x + r.width && r.y < s.y + s.height && s.y < r.y + r.height;
}

// Refuses an image that one of the views writes and the other uses at the same time. Views were checked, so
// frames have all images that plans bind.
void checkImages(const PellucidView& view, const PellucidView& other, uint32_t otherIndex, Findings& out) {
  const BoundImages bound(*view.plan), otherBound(*other.plan);
  const bool meet = rectsMeet(*view.frame, *other.frame);
  for (uint32_t a = 0; bound.all >> a != 0; ++a)
    for (uint32_t b = 0; bound.all >> a & 1 && otherBound.all >> b != 0; ++b) {
      const bool written = (bound.written >> a | otherBound.written >> b) & 1;
      if (!(otherBound.all >> b & 1) || !written || (!meet && isOfScreen(a) && isOfScreen(b))) continue;
      if (imageOf(*view.frame, a).view == imageOf(*other.frame, b).view)
        return out.error(fieldOf(a), "is views[", otherIndex, "].", fieldOf(b),
                         ", too; what a view writes, no other view of the recording uses");
    }
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
  else if (overlap(reinterpret_cast<uintptr_t>(a.mapped), aSize, reinterpret_cast<uintptr_t>(b.mapped),
                   bSize))
    out.error("constants.mapped", "overlaps the bytes of views[", otherIndex, "].constants.mapped");
}

PellucidResult prepareView(const PellucidContext& c, std::span<const PellucidView> views, uint32_t index,
                           Findings& out) {
  const PellucidView& view = views[index];
  if (!view.plan) out.error("plan", "is NULL");
  if (!view.frame) out.error("frame", "is NULL");
  if (!view.constants)
    out.error("constants", "is NULL");
  else if (view.constants->offset % 256 != 0 || !view.constants->buffer)
    out.error("constants", "needs a buffer and an offset that is a multiple of 256");
  if (out.result() != PELLUCID_OK) return out.result();
  return readFrame(view.frame, out, [&](const FrameFacts& facts) {
    checkViews(facts, out);
    if (out.result() == PELLUCID_OK) checkPlan(c, *view.plan, facts, out);
    const PellucidConstantsSlice& slice = *view.constants;
    if (out.result() != PELLUCID_OK) return out.result();
    if (c.desc.descriptorPools && !facts.frame.descriptorPool)
      out.error("descriptorPool", "is NULL, but PellucidContextDesc::descriptorPools is 1");
    else if (slice.size < view.plan->constantsSize)
      out.fail(PELLUCID_ERROR_BUFFER_TOO_SMALL, "constants.size", "is ", slice.size, "; the plan needs ",
               view.plan->constantsSize);
    else if (!slice.mapped)
      out.error("constants.mapped", "is NULL");
    for (uint32_t other = 0; other < index && out.result() == PELLUCID_OK; ++other) {
      checkImages(view, views[other], other, out);
      checkSlices(view, views[other], other, out);
      // Frames of views before this one were read, so that they have the field.
      if (c.desc.descriptorPools && views[other].frame->descriptorPool == facts.frame.descriptorPool)
        out.error("descriptorPool", "is views[", other, "].descriptorPool, too");
    }
    if (out.result() != PELLUCID_OK) return out.result();
    if (c.desc.descriptorPools) c.vk.vkResetDescriptorPool(c.device, facts.frame.descriptorPool, 0);
    return writeConstants(facts, *view.plan, slice.mapped, static_cast<size_t>(slice.size));
  });
}

}  // namespace

PellucidResult prepareViews(const PellucidContext& context, std::span<const PellucidView> views, bool named) {
  for (uint32_t i = 0; i < views.size(); ++i) {
    ViewErrors errors{context, named ? Field("views[", i, "].") : Field("")};
    Findings out(&ViewErrors::pass, &errors);
    if (const PellucidResult result = prepareView(context, views, i, out); result != PELLUCID_OK)
      return result;
  }
  return PELLUCID_OK;
}

}  // namespace pellucid
