// Frame -> plan. Pure: no device, no allocation.
#include "frame.h"
#include "reuse.h"
#include "validate.h"

namespace pellucid {
namespace {

constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
constexpr uint64_t kUnknownDepthBytes = 4;  // the module does not know the format; 4 is the common one

struct Builder {
  const PellucidFrame& frame;
  const ConstantsLayout layout;
  const Rect rect;
  PellucidPlan& plan;

  bool wide() const { return frame.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT; }
  uint64_t pixels() const { return static_cast<uint64_t>(rect.width) * rect.height; }
  uint64_t colorBytes() const { return wide() ? 16 : 8; }

  void skip(const char* what, const char* reason) {
    for (uint32_t i = 0; i < plan.skipCount; ++i)
      if (plan.skips[i].what == what && plan.skips[i].reason == reason) {
        ++plan.skips[i].count;
        return;
      }
    if (plan.skipCount < PELLUCID_MAX_SKIPS) plan.skips[plan.skipCount++] = {what, reason, 1};
  }

  PellucidDispatch* dispatch(const char* name, uint32_t pipeline) {
    if (plan.dispatchCount == PELLUCID_MAX_DISPATCHES) return nullptr;
    PellucidDispatch& d = plan.dispatches[plan.dispatchCount];
    d.name = name;
    d.pipeline = pipeline;
    d.groups[0] = (rect.width + PELLUCID_GROUP_X - 1) / PELLUCID_GROUP_X;
    d.groups[1] = (rect.height + PELLUCID_GROUP_Y - 1) / PELLUCID_GROUP_Y;
    d.groups[2] = 1;
    // Every dispatch after the first reads what the one before wrote.
    // The first of a frame that reuses comes after the last frame's use of the history.
    d.barrierBefore = plan.dispatchCount > 0 || plan.history.valid ? 1 : 0;
    plan.barrierCount += d.barrierBefore;
    ++plan.dispatchCount;
    return &d;
  }

  static void bind(PellucidDispatch* d, uint32_t binding, VkDescriptorType type, uint32_t resource,
                   ConstantsLayout::Range range = {}) {
    d->bindings[d->bindingCount++] = {binding, type, resource, 0, range.offset, range.size};
  }
  void constants(PellucidDispatch* d, uint32_t binding, ConstantsLayout::Range range) const {
    const bool uniform = binding == PELLUCID_BINDING_FRAME;
    bind(d, binding, uniform ? VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER : VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
         PELLUCID_RESOURCE_CONSTANTS, range);
  }
  void image(PellucidDispatch* d, uint32_t binding, uint32_t resource, uint64_t bytes) const {
    bind(d, binding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, resource);
    d->modeledBytes += bytes * pixels();
  }
  // An input the frame may lack. The shader's flag keeps it unread, but every statically used binding
  // must hold a view: the front depth stands in.
  void optional(PellucidDispatch* d, uint32_t binding, const PellucidImage& view, uint32_t resource,
                uint64_t bytes) const {
    if (given(view)) return image(d, binding, resource, bytes);
    image(d, binding, PELLUCID_RESOURCE_FRONT_DEPTH, 0);
  }

  // Bindings that every pass has.
  void common(PellucidDispatch* d, uint32_t source, uint32_t destination) const {
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
    image(d, PELLUCID_BINDING_SOURCE, source, colorBytes());
    image(d, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
    const bool last = destination == PELLUCID_RESOURCE_OUTPUT;
    optional(d, PELLUCID_BINDING_ALBEDO, frame.albedo, PELLUCID_RESOURCE_ALBEDO, last ? 4 : 0);
    bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, destination);
    d->modeledBytes += colorBytes() * pixels();
  }

  bool translucency(const LightGroup& group, uint32_t source, uint32_t destination) {
    const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
    const uint32_t half = debug                     ? PELLUCID_PIPELINE_DEBUG_16F
                          : frame.gatherSamples > 0 ? PELLUCID_PIPELINE_GATHER_16F
                                                    : PELLUCID_PIPELINE_TRANSLUCENCY_16F;
    const uint32_t pipeline = half + (wide() ? 1 : 0);  // the 32F variant follows the 16F one
    PellucidDispatch* d = dispatch(debug ? "debug view" : "translucency", pipeline);
    if (!d) return false;
    d->pushConstants[0] = group.firstLight;
    d->pushConstants[1] = group.lightCount;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    if (destination == PELLUCID_RESOURCE_HISTORY && group.firstLight == 0)
      d->pushConstants[2] = PELLUCID_WRITE_STARTS;
    d->pushConstants[3] = frame.gatherSamples;
    common(d, source, destination);
    if (d->pushConstants[2] == PELLUCID_WRITE_STARTS)
      d->modeledBytes -= colorBytes() * pixels();  // what is there is not read
    constants(d, PELLUCID_BINDING_LIGHTS, layout.lights);
    constants(d, PELLUCID_BINDING_SHADOWS, layout.shadows);
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH,
             kUnknownDepthBytes);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 4);
    for (uint32_t slot = 0; slot < PELLUCID_SHADOW_IMAGE_COUNT; ++slot) {
      const bool used = slot < group.imageCount;
      image(d, PELLUCID_BINDING_SHADOW_IMAGES + slot,
            used ? kShadow0 + group.images[slot] : static_cast<uint32_t>(PELLUCID_RESOURCE_FRONT_DEPTH),
            used ? kUnknownDepthBytes : 0);
    }
    return true;
  }

  bool addHistory(uint32_t source, uint32_t destination) {
    PellucidDispatch* d = dispatch(
        "add history", wide() ? PELLUCID_PIPELINE_ADD_HISTORY_32F : PELLUCID_PIPELINE_ADD_HISTORY_16F);
    if (!d) return false;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    image(d, PELLUCID_BINDING_HISTORY, PELLUCID_RESOURCE_HISTORY, colorBytes());
    return true;
  }

  bool diffuse(const char* name, uint32_t x, uint32_t y, uint32_t source, uint32_t destination) {
    PellucidDispatch* d =
        dispatch(name, wide() ? PELLUCID_PIPELINE_DIFFUSE_32F : PELLUCID_PIPELINE_DIFFUSE_16F);
    if (!d) return false;
    d->pushConstants[0] = x;
    d->pushConstants[1] = y;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    constants(d, PELLUCID_BINDING_KERNELS, layout.kernels);
    return true;
  }
};

// What runs; shared by the plan and the image needs.
struct Stages {
  bool lights;  // the fused dispatches carry lights
  bool diffusion;
  uint32_t fused;  // fused dispatches
  bool history;    // these write the history, and one more adds it

  // That write a transient or the output.
  uint32_t writers() const { return (history ? 1 : fused) + (diffusion ? 2 : 0); }
};

Stages stagesOf(const PellucidFrame& frame) {
  const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
  Stages s{};
  if (frame.features & PELLUCID_FEATURE_TRANSLUCENCY || debug) s.fused = lightGroupCount(frame);
  s.lights = s.fused > 0;
  s.diffusion = frame.features & PELLUCID_FEATURE_DIFFUSION && !debug && anyMaterialDiffuses(frame);
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output.
  if (s.writers() == 0) s.fused = 1;
  s.history = keepsHistory(frame);
  return s;
}

bool build(const PellucidFrame& frame, const PellucidHistory& kept, PellucidPlan& plan) {
  Builder b{frame, constantsLayout(frame), renderRect(frame), plan};
  const Stages stages = stagesOf(frame);
  plan.activeLights = b.layout.lightCount;
  plan.constantsSize = b.layout.size;

  const ViewBounds view(frame);
  for (uint32_t i = 0; i < frame.lightCount; ++i)
    if (const char* reason = view.whySkipped(frame.lights[i])) b.skip("light", reason);
  if (!(frame.features & PELLUCID_FEATURE_TRANSLUCENCY))
    b.skip("translucency", "not among the features");
  else if (plan.activeLights == 0)
    b.skip("translucency", "no light can contribute");
  if (!(frame.features & PELLUCID_FEATURE_DIFFUSION))
    b.skip("diffusion", "not among the features");
  else if (frame.debugView != PELLUCID_DEBUG_NONE)
    b.skip("diffusion", "a debug view is written instead");
  else if (!stages.diffusion)
    b.skip("diffusion", "no material diffuses");

  const bool reused = stages.history && decideReuse(frame, kept, &plan.history);
  if (reused) b.skip("translucency", "reused from an earlier frame");

  // Images alternate between the two transients; the last write goes to the output.
  uint32_t source = PELLUCID_RESOURCE_IRRADIANCE, next = 0;
  uint32_t remaining = stages.writers();
  const auto destination = [&]() -> uint32_t {
    if (--remaining == 0) return PELLUCID_RESOURCE_OUTPUT;
    const uint32_t transient = kTransient0 + next;
    next ^= 1;
    return transient;
  };
  bool fits = true;
  const auto translucency = [&](const LightGroup& group) {
    const uint32_t to = destination();
    fits = fits && b.translucency(group, source, to);
    source = to;
  };
  const auto translucencies = [&] {
    if (stages.history) {
      if (!reused)
        forEachLightGroup(
            frame, [](const LightGroup&, const PellucidLight&) {},
            [&](const LightGroup& group) {
              fits = fits && b.translucency(group, PELLUCID_RESOURCE_HISTORY, PELLUCID_RESOURCE_HISTORY);
            });
      const uint32_t to = destination();
      fits = fits && b.addHistory(source, to);
      source = to;
    } else if (stages.lights)
      forEachLightGroup(
          frame, [](const LightGroup&, const PellucidLight&) {}, translucency);
    else if (stages.fused > 0)
      translucency(LightGroup{});
  };
  const auto diffusion = [&] {
    if (!stages.diffusion) return;
    for (const uint32_t vertical : {0u, 1u}) {
      const uint32_t to = destination();
      fits = fits && b.diffuse(vertical ? "diffuse vertically" : "diffuse horizontally", 1 - vertical,
                               vertical, source, to);
      source = to;
    }
  };
  // Gathered light has already spread on its way through; diffusing it again would spread it twice.
  if (frame.gatherSamples > 0) {
    diffusion();
    translucencies();
  } else {
    translucencies();
    diffusion();
  }
  return fits;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidBuildPlan(const PellucidFrame* frame, const PellucidPlan* previous,
                                            PellucidPlan* plan) {
  if (!plan) return PELLUCID_ERROR_INVALID_ARGUMENT;
  // The two plans may be one object.
  const PellucidHistory kept = previous ? previous->history : PellucidHistory{};
  *plan = PellucidPlan{};
  const PellucidResult result = checkFrame(frame, nullptr, nullptr);
  if (result != PELLUCID_OK) return result;
  if (!build(*frame, kept, *plan)) {
    *plan = PellucidPlan{};
    return PELLUCID_ERROR_CAPACITY;
  }
  return PELLUCID_OK;
}

extern "C" PellucidResult pellucidGetImageNeeds(const PellucidFrame* frame, uint32_t* count,
                                                PellucidImageNeed* needs) {
  if (!count) return PELLUCID_ERROR_INVALID_ARGUMENT;
  const PellucidResult result = checkFrame(frame, nullptr, nullptr);
  if (result != PELLUCID_OK) return result;
  const Stages stages = stagesOf(*frame);
  const uint32_t writers = stages.writers();
  const uint32_t room = *count;
  const uint32_t transients = writers - 1 < 2 ? writers - 1 : 2;
  *count = transients + (stages.history ? 1 : 0);
  const uint64_t texel = frame->outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8;
  const uint64_t bytes = texel * frame->imageExtent[0] * frame->imageExtent[1];
  // Frames that refresh a history have its dispatches in front of those that write transients.
  const uint32_t before = stages.history ? stages.fused : 0;
  for (uint32_t i = 0; needs && i < *count && i < room; ++i) {
    needs[i] = {frame->outputFormat, {frame->imageExtent[0], frame->imageExtent[1]}, 0, before, bytes, 0};
    if (i == transients) {
      needs[i].persistent = 1;
      continue;
    }
    // Writers 0 .. n - 2 write the transients in turn, so the last to write transient i has i's parity;
    // the dispatch after it reads.
    needs[i].firstDispatch = i;
    needs[i].lastDispatch = before + writers - 2 - ((writers - 2 - i) & 1u) + 1;
  }
  return PELLUCID_OK;
}

extern "C" uint32_t pellucidGetRequiredInputs(uint32_t features) {
  if ((features & (PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION)) == 0) return 0;
  return 1u << PELLUCID_RESOURCE_FRONT_DEPTH | 1u << PELLUCID_RESOURCE_IRRADIANCE |
         1u << PELLUCID_RESOURCE_MATERIAL | 1u << PELLUCID_RESOURCE_OUTPUT;
}
