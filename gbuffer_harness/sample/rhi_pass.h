// A plan through an RHI: all of it. Copy the file, and let your own RHI's calls take the place of Rhi's:
// docs/integration.md, "Through an RHI". tests/gpu/vulkan_rhi.h is an Rhi of Vulkan.
#pragma once

#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "pellucid/pellucid.h"

namespace pellucid::sample {

// The handles that your RHI has for a texture and a buffer. PellucidImage::view carries the texture's, cast
// to this type.
using RhiTexture = VkImageView;
using RhiBuffer = VkBuffer;

struct RhiPipeline {
  virtual ~RhiPipeline() = default;
};

// A member of a binding set: a texture, or a range of a buffer in bytes.
struct RhiItem {
  uint32_t slot;
  VkDescriptorType type;
  RhiTexture texture;
  RhiBuffer buffer;
  VkDeviceSize offset, size;
};

// A texture has one state. A buffer may have two at once, which Direct3D 12 does not allow.
enum RhiState : uint32_t { kRhiSampled = 1, kRhiStored = 2, kRhiCommands = 4 };

// The calls of an RHI that a plan needs, on one command list. No barrier is automatic.
class Rhi {
public:
  virtual ~Rhi() = default;
  // `slots`: the layout of the pipeline's one binding set.
  virtual std::unique_ptr<RhiPipeline> createPipeline(std::span<const uint32_t> spirv,
                                                      std::span<const PellucidSpecialization> constants,
                                                      std::span<const PellucidBinding> slots,
                                                      uint32_t pushConstantBytes) = 0;
  // Sets the state from the next commitBarriers() on. A change from Stored to Stored also needs a barrier.
  virtual void setState(RhiTexture texture, RhiState state) = 0;
  virtual void setState(RhiBuffer buffer, uint32_t states) = 0;
  virtual void commitBarriers() = 0;
  virtual void bind(const RhiPipeline& pipeline, std::span<const RhiItem> items,
                    std::span<const uint32_t> pushConstants) = 0;
  virtual void dispatch(const uint32_t (&groups)[3]) = 0;
  virtual void dispatchIndirect(RhiBuffer buffer, VkDeviceSize offset) = 0;
};

// The constants of a plan: bytes 0 to listsOffset of what pellucidWriteConstants wrote, and the rest, which
// dispatches write.
struct RhiConstants {
  RhiBuffer constants, lists;
};

class RhiPass {
public:
  // Makes the pipelines of options.uses, at any time before the first plan. `options`: what pellucidInitContextDesc writes into
  // desc.options, then changes. Its uses cover all frames: nothing compares THIN_WALLS, AMBIENT, THESIS, formats and light tables
  // with plans.
  RhiPass(Rhi& rhi, const PellucidContextOptions& options)
      : rhi_(rhi), pipelines_(pellucidGetPipelineCount()) {
    for (uint32_t i = 0; i < pipelines_.size(); ++i) createPipeline(i, options);
  }

  // Records the plan. Images of `frame` have the RHI's textures; their layouts are not read.
  void record(const PellucidPlan& plan, const PellucidFrame& frame, const RhiConstants& buffers) {
    if (plan.inPlaceDispatches > 0) throw std::invalid_argument("a dispatch samples and stores one texture");
    uint32_t end = 0;
    for (uint32_t first = 0; first < plan.dispatchCount; first = end) {
      // Dispatches between two barriers of the plan share states, so that they run side by side.
      for (end = first + 1; end < plan.dispatchCount && !plan.dispatches[end].barrierBefore;) ++end;
      setStates(plan, first, end, frame, buffers);
      rhi_.commitBarriers();
      for (uint32_t i = first; i < end; ++i) recordDispatch(plan, i, frame, buffers);
    }
  }

private:
  void createPipeline(uint32_t index, const PellucidContextOptions& options) {
    PellucidShader shader;
    require(pellucidGetShader(index, options.shadowViewType, options.outputFormat, nullptr, &shader));
    if (options.uses != 0 && (shader.uses & ~options.uses) != 0) return;
    std::vector<uint32_t> words(shader.wordCount);
    require(pellucidGetShader(index, options.shadowViewType, options.outputFormat, words.data(), &shader));
    std::vector<PellucidSpecialization> constants(shader.constants, shader.constants + shader.constantCount);
    constants.push_back({PELLUCID_SPECIALIZATION_LIGHT_TABLES, options.lightTables});
    constants.push_back({PELLUCID_SPECIALIZATION_USES, options.uses != 0 ? options.uses : UINT32_MAX});
    PellucidBinding slots[PELLUCID_MAX_BINDINGS];
    const uint32_t count = pellucidGetPipelineBindings(index, slots);
    pipelines_[index] = rhi_.createPipeline({shader.words, shader.wordCount}, constants, {slots, count},
                                            PELLUCID_PUSH_CONSTANT_BYTES);
  }

  void setStates(const PellucidPlan& plan, uint32_t first, uint32_t end, const PellucidFrame& frame,
                 const RhiConstants& buffers) {
    uint32_t lists = 0;
    for (uint32_t i = first; i < end; ++i) {
      if (plan.dispatches[i].indirect) lists |= kRhiCommands;
      for (const PellucidBinding& b : bindings(plan, i))
        if (b.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE || b.type == VK_DESCRIPTOR_TYPE_STORAGE_IMAGE)
          rhi_.setState(texture(frame, b.resource),
                        b.type == VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE ? kRhiSampled : kRhiStored);
        else if (b.writes)
          lists |= kRhiStored;
    }
    if (lists != 0) rhi_.setState(buffers.lists, lists);
    rhi_.setState(buffers.constants, kRhiSampled);  // after the engine's copy
  }

  void recordDispatch(const PellucidPlan& plan, uint32_t index, const PellucidFrame& frame,
                      const RhiConstants& buffers) {
    const PellucidDispatch& d = plan.dispatches[index];
    std::vector<RhiItem> items;
    for (const PellucidBinding& b : bindings(plan, index))
      if (b.resource != PELLUCID_RESOURCE_CONSTANTS)
        items.push_back({b.binding, b.type, texture(frame, b.resource), {}, 0, 0});
      else if (b.writes)
        items.push_back({b.binding, b.type, {}, buffers.lists, b.offset - plan.listsOffset, b.size});
      else
        items.push_back({b.binding, b.type, {}, buffers.constants, b.offset, b.size});
    if (!pipelines_[d.pipeline])
      throw std::invalid_argument(std::string(d.name) + " needs a use that the pass lacks");
    rhi_.bind(*pipelines_[d.pipeline], items, d.pushConstants);
    if (d.indirect)
      rhi_.dispatchIndirect(buffers.lists, d.indirectOffset - plan.listsOffset);
    else
      rhi_.dispatch(d.groups);
  }

  static std::vector<PellucidBinding> bindings(const PellucidPlan& plan, uint32_t dispatch) {
    std::vector<PellucidBinding> all(PELLUCID_MAX_BINDINGS);
    all.resize(pellucidGetBindings(&plan, dispatch, all.data()));
    return all;
  }

  static RhiTexture texture(const PellucidFrame& frame, uint32_t resource) {
    const PellucidImage* image = pellucidGetImage(&frame, resource);
    if (!image) throw std::invalid_argument("the plan is of another frame");
    return image->view;
  }

  static void require(PellucidResult result) {
    if (result != PELLUCID_OK) throw std::invalid_argument(pellucidResultName(result));
  }

  Rhi& rhi_;
  std::vector<std::unique_ptr<RhiPipeline>>
      pipelines_;  // by PellucidDispatch::pipeline; null: not among the uses
};

}  // namespace pellucid::sample
