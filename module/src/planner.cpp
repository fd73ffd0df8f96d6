#include "planner.h"

#include <algorithm>
#include <cstddef>

namespace pellucid {

// ---- A step

Step::Step(Planner& planner, const Pass& pass, PellucidDispatch& d) : planner_(planner), pass_(pass), d_(d) {
  forEach(pass.bindings(), [&](const Binding& b) {
    if (b.type == kSampled || b.type == kStored) image(b.number, planner.inputOf(b.number));
  });
  const ConstantsLayout& layout = planner.facts.constants;
  constants(PELLUCID_BINDING_FRAME, layout.frame);
  constants(PELLUCID_BINDING_MATERIALS, layout.materials);
  constants(PELLUCID_BINDING_KERNELS, layout.kernels);
  constants(PELLUCID_BINDING_LISTS, layout.lists);
}

void Step::constants(uint32_t binding, VkDeviceSize offset) {
  if (has(pass_.bindings(), binding))
    d_.slots[slotOf(pass_, binding)] = static_cast<uint16_t>(offset / kSlotBytes);
}

Step& Step::image(uint32_t binding, uint32_t resource) {
  if (binding < PELLUCID_BINDING_SHADOW_IMAGES && has(pass_.bindings(), binding))
    d_.slots[slotOf(pass_, binding)] = static_cast<uint16_t>(resource);
  return *this;
}

Step& Step::image(uint32_t binding, const MadeImage& made) { return image(binding, planner_.resource(made)); }

Step& Step::standIn(uint32_t binding, uint32_t resource) {
  planner_.standIns_[static_cast<size_t>(&d_ - planner_.plan_.dispatches)] |= bindings(binding);
  return image(binding, resource);
}

Step& Step::colors(uint32_t source, uint32_t destination) {
  if (destination == PELLUCID_RESOURCE_OUTPUT && planner_.facts.frame.options.addToOutput == 1)
    image(PELLUCID_BINDING_HELD, PELLUCID_RESOURCE_OUTPUT);
  return image(PELLUCID_BINDING_SOURCE, source).image(PELLUCID_BINDING_DESTINATION, destination);
}

Step& Step::lights(const LightGroup& group) {
  const FrameFacts& f = planner_.facts;
  const ConstantsLayout& layout = f.constants;
  constants(PELLUCID_BINDING_LIGHTS, layout.lights + group.lightBytes);
  constants(PELLUCID_BINDING_SHADOWS, layout.shadows + group.shadowBytes);
  // A frame without a gather has no such maps, and a window of as many bytes.
  constants(PELLUCID_BINDING_GATHER_MAPS,
            f.gathers ? layout.gatherMaps + group.gatherMapBytes : layout.shadows);
  constants(PELLUCID_BINDING_ENTRY_MAPS, layout.entryMaps + group.entryMapBytes);
  if (!has(pass_.bindings(), PELLUCID_BINDING_SHADOW_IMAGES)) return *this;
  // The first image stands in where the group has none.
  const bool some = f.frame.shadowImageCount > 0;
  planner_.addShadowImages(d_, group.imageCount > 0 ? std::span(group.images.data(), group.imageCount)
                                                    : std::span(group.images.data(), some ? 1 : 0));
  return *this;
}

Step& Step::groups(uint32_t x, uint32_t y, uint32_t z) {
  d_.groups[0] = x;
  d_.groups[1] = y;
  d_.groups[2] = z;
  return *this;
}

Step& Step::tiles(uint32_t side) {
  const Rect& rect = planner_.facts.rect;
  return groups(parts(rect.width, side), parts(rect.height, side));
}

Step& Step::blocks(uint32_t which, uint32_t parts) {
  const FrameFacts& f = planner_.facts;
  const bool holdsMaterial =
      which == PELLUCID_LIST_PROBES || which == PELLUCID_LIST_FILTER || which == PELLUCID_LIST_DIFFUSE;
  return groups(f.stages.lists && holdsMaterial ? f.blocks.touched : f.blocks.count(), parts).list(which);
}

Step& Step::list(uint32_t which) {
  if (!planner_.facts.stages.lists) return *this;
  d_.indirect = 1;
  d_.indirectOffset = static_cast<uint32_t>(
      planner_.facts.constants.lists + offsetof(shared::BlockLists, commands) + which * sizeof(shared::ListCommand));
  return *this;
}

// ---- The plan

uint32_t Planner::resource(const MadeImage& image) const {
  uint32_t resource = kTransient0;
  for (const MadeImage* other : transientImages()) {
    if (other == &image) break;
    resource += other->made(facts);
  }
  return resource;
}

// The caller's image of a binding of that name. A flag keeps inputs unread that the frame lacks, but bindings hold a view: the
// front depth stands in.
uint32_t Planner::inputOf(uint32_t binding) const {
  for (const ImageField& image : kImageFields)
    if (image.binding == binding && (image.required || given(facts.frame.*image.field) ||
                                     (binding == PELLUCID_BINDING_MOTION && facts.stages.accumulates)))
      return image.resource;
  return PELLUCID_RESOURCE_FRONT_DEPTH;
}

Step Planner::add(const Pass& pass, const char* name) {
  if (plan_.dispatchCount == PELLUCID_MAX_DISPATCHES) {
    fits_ = false;  // nobody runs the plan: the last dispatch makes room
    --plan_.dispatchCount;
  }
  PellucidDispatch& d = plan_.dispatches[plan_.dispatchCount++];
  d = {};
  d.name = name;
  const auto passes = allPasses();
  d.pipeline = static_cast<uint8_t>(std::find(passes.begin(), passes.end(), &pass) - passes.begin());
  return {*this, pass, d};
}

void Planner::addShadowImages(PellucidDispatch& d, std::span<const uint32_t> images) {
  // At most 8 a dispatch: that of entry points, with 12, comes with one of probes, which has none.
  if (shadowImages_ + images.size() > PELLUCID_PLAN_SHADOW_IMAGES) {
    fits_ = false;
    return;
  }
  // The last first image is 255: an empty list may begin behind it, and is not read.
  static_assert(PELLUCID_PLAN_SHADOW_IMAGES <= 256);
  d.firstShadowImage = static_cast<uint8_t>(shadowImages_);
  d.shadowImageCount = static_cast<uint8_t>(images.size());
  std::copy(images.begin(), images.end(), plan_.shadowImages + shadowImages_);
  shadowImages_ += d.shadowImageCount;
}

Planner::Access Planner::accessOf(const Pass& pass, const PellucidDispatch& d, BindingSet unused) const {
  Access access;
  if (d.indirect) access.reads = kLists;
  forEach(pass.bindings() & ~unused, [&](const Binding& b) {
    const bool image = b.type == kSampled || b.type == kStored;
    if (b.number >= PELLUCID_BINDING_SHADOW_IMAGES || (!image && b.number != PELLUCID_BINDING_LISTS)) return;
    uint32_t bits = image ? 1u << d.slots[slotOf(pass, b.number)] : kLists;
    // The two may be one image.
    constexpr uint32_t kInPlace = 1u << PELLUCID_RESOURCE_OUTPUT | 1u << PELLUCID_RESOURCE_IRRADIANCE;
    if ((bits & kInPlace) != 0 && !facts.separate()) bits = kInPlace;
    (has(pass.writes, b.number) ? access.writes : access.reads) |= bits;
  });
  return access;
}

bool Planner::finish() {
  if (!fits_) return false;
  const uint32_t count = plan_.dispatchCount;
  std::array<Access, PELLUCID_MAX_DISPATCHES> access;
  std::array<uint32_t, PELLUCID_MAX_DISPATCHES> wave{};
  // Wave that the commands of later dispatches are read in first. The first dispatch that writes lists makes them, the last one empties
  // them.
  uint32_t commands = 0;
  for (uint32_t i = 0; i < count; ++i) {
    const PellucidDispatch& d = plan_.dispatches[i];
    const Pass& pass = *allPasses()[d.pipeline];
    const Access bound = accessOf(pass, d, 0);
    // An API with one state an image refuses stand-ins, too.
    plan_.inPlaceDispatches += (bound.reads & bound.writes & ~kLists) != 0;
    access[i] = standIns_[i] == 0 ? bound : accessOf(pass, d, standIns_[i]);
    for (uint32_t k = 0; k < i; ++k)
      if (access[i].conflicts(access[k])) wave[i] = std::max(wave[i], wave[k] + 1);
    if (commands == 0 && (access[i].writes & 1u << PELLUCID_RESOURCE_CONSTANTS) != 0) commands = wave[i] + 1;
  }
  // Stable, so that the dispatches of a wave keep the order of the data flow.
  for (uint32_t i = 1; i < count; ++i)
    for (uint32_t k = i; k > 0 && wave[k] < wave[k - 1]; --k) {
      std::swap(wave[k], wave[k - 1]);
      std::swap(plan_.dispatches[k], plan_.dispatches[k - 1]);
    }
  for (uint32_t i = 0; i < count; ++i) {
    PellucidDispatch& d = plan_.dispatches[i];
    // The first wave of a frame that reuses comes after the last frame's use of the history.
    d.barrierBefore = i == 0 ? facts.stages.keepsHistory : wave[i] > wave[i - 1];
    // One barrier makes commands visible to all dispatches that follow; more would cost 2 us each.
    d.barrierIndirect = d.barrierBefore && facts.stages.lists && wave[i] == commands;
    plan_.barrierCount += d.barrierBefore;
  }
  return true;
}

// ---- What a step has packed

namespace {

// Bytes that passes see of the constants from a binding's offset on. Those of uniforms are whole steps of 256, which some devices and RHIs
// ask for: ConstantsLayout has room.
VkDeviceSize windowOf(const PellucidPlan& plan, const PlanState& state, uint32_t binding,
                      VkDeviceSize offset) {
  switch (binding) {
    case PELLUCID_BINDING_FRAME:
      return aligned(sizeof(shared::FrameConstants));
    case PELLUCID_BINDING_LIGHTS:
      return aligned(kLightWindow);
    case PELLUCID_BINDING_SHADOWS:
      return aligned(kShadowWindow);
    case PELLUCID_BINDING_GATHER_MAPS:
      return aligned(kGatherMapWindow);
    case PELLUCID_BINDING_ENTRY_MAPS:
      return kEntryMapWindow;
    case PELLUCID_BINDING_MATERIALS:
      return state.materials * sizeof(shared::MaterialConstants);
    case PELLUCID_BINDING_KERNELS:
      return state.materials * sizeof(shared::KernelConstants);
    default:  // lists
      return plan.constantsSize - offset;
  }
}

}  // namespace

BoundList boundBy(const PellucidPlan& plan, const PellucidDispatch& d) {
  BoundList bound;
  if (d.pipeline >= allPasses().size()) return bound;
  const PlanState state = stateOf(plan);
  const uint32_t first = std::min<uint32_t>(d.firstShadowImage, PELLUCID_PLAN_SHADOW_IMAGES);
  const uint32_t imageCount = std::min<uint32_t>(d.shadowImageCount, PELLUCID_PLAN_SHADOW_IMAGES - first);
  uint32_t slot = 0;
  forEach(allPasses()[d.pipeline]->bindings(), [&](const Binding& b) {
    PellucidBinding& to = bound.list[bound.count++];
    to = bindingOf(*allPasses()[d.pipeline], b);
    if (b.number >= PELLUCID_BINDING_SHADOW_IMAGES) {
      // Slots that are not read hold a view of the type that shadow images have, as far as the frame has one.
      const uint32_t image = b.number - PELLUCID_BINDING_SHADOW_IMAGES;
      if (imageCount > 0)
        to.resource = kShadow0 + plan.shadowImages[first + (image < imageCount ? image : 0)];
    } else if (b.type == kUniforms || b.type == kStorage) {
      to.resource = PELLUCID_RESOURCE_CONSTANTS;
      to.offset = d.slots[slot++] * kSlotBytes;
      to.size = windowOf(plan, state, b.number, to.offset);
    } else {
      to.resource = d.slots[slot++];
    }
  });
  return bound;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" const PellucidImage* pellucidGetImage(const PellucidFrame* frame, uint32_t resource) {
  return frame ? imageOf(*frame, resource) : nullptr;
}

extern "C" uint32_t pellucidGetBindings(const PellucidPlan* plan, uint32_t dispatch,
                                        PellucidBinding* bindings) {
  if (!plan || !bindings || dispatch >= plan->dispatchCount || dispatch >= PELLUCID_MAX_DISPATCHES) return 0;
  const BoundList bound = boundBy(*plan, plan->dispatches[dispatch]);
  std::copy(bound.begin(), bound.end(), bindings);
  return bound.count;
}
