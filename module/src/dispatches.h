// What each dispatch of a plan runs and binds, in the order in which it is asked for.
#pragma once

#include <algorithm>

#include "entry_points.h"
#include "frame.h"
#include "pipelines.h"
#include "pyramid.h"
#include "quality.h"

namespace pellucid {

inline constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
inline constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
inline constexpr uint64_t kTexelBytes = 16;  // of the pyramid, as packed by compute/diffusion/texel.glsl
inline constexpr uint64_t kUnknownDepthBytes = 4;  // the module does not know the format; 4 is the common one

struct Builder {
  const PellucidFrame& frame;
  const ConstantsLayout layout;
  const Rect rect;
  const uint32_t colorTransients;
  const bool keepsProbes, overlaps;
  const bool skipsLight;  // of the gather's dispatches those that the GPU finds nothing to do for are empty
  PellucidPlan& plan;
  bool alongside = false;  // dispatches run beside the one before, with which they share nothing

  bool wide() const { return isWide(frame); }
  uint64_t pixels() const { return static_cast<uint64_t>(rect.width) * rect.height; }
  uint32_t pyramidImage() const { return kTransient0 + colorTransients; }
  // What probes find; the entry points of the maps and, in their place, what the spatial filter makes of the
  // probes. Entry points lie where the pyramid was unless both are in use at once.
  uint32_t probesImage() const { return pyramidImage() + 1; }
  uint32_t entriesImage() const { return overlaps ? pyramidImage() + 2 : pyramidImage(); }
  uint32_t filteredImage() const {
    return keepsProbes ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : entriesImage();
  }
  uint64_t colorBytes() const { return wide() ? 16 : 8; }

  void skip(const char* what, const char* reason) {
    for (uint32_t i = 0; i < plan.skipCount; ++i)
      if (plan.skips[i].what == what && plan.skips[i].reason == reason) {
        ++plan.skips[i].count;
        return;
      }
    if (plan.skipCount < PELLUCID_MAX_SKIPS) plan.skips[plan.skipCount++] = {what, reason, 1};
  }

  PellucidDispatch* dispatch(const char* name, Pipeline pipeline) {
    if (plan.dispatchCount == PELLUCID_MAX_DISPATCHES) return nullptr;
    PellucidDispatch& d = plan.dispatches[plan.dispatchCount];
    d.name = name;
    d.pipeline = static_cast<uint32_t>(pipeline);
    groups(&d, rect.width, rect.height, PELLUCID_GROUP_X);
    // Every dispatch after the first reads what the one before wrote, unless it runs beside that.
    // The first of a frame that reuses comes after the last frame's use of the history.
    d.barrierBefore = !alongside && (plan.dispatchCount > 0 || plan.history.valid) ? 1 : 0;
    plan.barrierCount += d.barrierBefore;
    ++plan.dispatchCount;
    return &d;
  }

  // `columns`, `rows`: of what one group makes.
  static void groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t columns, uint32_t rows) {
    d->groups[0] = (width + columns - 1) / columns;
    d->groups[1] = (height + rows - 1) / rows;
    d->groups[2] = 1;
  }
  static void groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t tile) {
    groups(d, width, height, tile, tile);
  }

  // Of PELLUCID_TILE columns, from even pixels on.
  void tiles(PellucidDispatch* d) const {
    groups(d, rect.width + (rect.x & 1), rect.height + (rect.y & 1), PELLUCID_TILE);
  }

  static void bind(PellucidDispatch* d, uint32_t binding, VkDescriptorType type, uint32_t resource,
                   ConstantsLayout::Range range = {}) {
    d->bindings[d->bindingCount++] = {binding, type, resource, 0, range.offset, range.size};
  }
  void constants(PellucidDispatch* d, uint32_t binding, ConstantsLayout::Range range) const {
    const bool uniform = binding <= PELLUCID_BINDING_SHADOWS;
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

  // What every pass over pixels reads.
  void pixelInputs(PellucidDispatch* d, uint32_t source) const {
    image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
    image(d, PELLUCID_BINDING_SOURCE, source, colorBytes());
    image(d, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
  }
  // Bindings of every pass that writes colors.
  void common(PellucidDispatch* d, uint32_t source, uint32_t destination) const {
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    pixelInputs(d, source);
    const bool last = destination == PELLUCID_RESOURCE_OUTPUT;
    optional(d, PELLUCID_BINDING_ALBEDO, frame.albedo, PELLUCID_RESOURCE_ALBEDO, last ? 4 : 0);
    bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, destination);
    d->modeledBytes += colorBytes() * pixels();
  }

  // Cells of the gather that the rect touches.
  struct Cells {
    uint32_t width, height;
  };
  Cells cells() const {
    const uint32_t side = gatherSpacing(frame);
    const auto count = [side](uint32_t first, uint32_t pixels) {
      return (first + pixels - 1) / side - first / side + 1;
    };
    return {count(rect.x, rect.width), count(rect.y, rect.height)};
  }

  static uint64_t entryBytes(const LightGroup& group) {
    return kTexelBytes * group.entryColumns * group.entryRows;
  }

  bool entryPoints(const LightGroup& group) {
    PellucidDispatch* d = dispatch("entry points", Pipeline::EntryPoints);
    if (!d) return false;
    groups(d, group.entryWidth, group.entryHeight, PELLUCID_ENTRY_POINTS_GROUP);
    d->groups[2] = group.shadowCount;
    d->pushConstants[1] = group.entryColumns | group.entryRows << 16;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    constants(d, PELLUCID_BINDING_ENTRY_MAPS,
              {layout.entryMaps.offset + group.entryMapBytes,
               group.shadowCount * sizeof(shared::EntryMapConstants)});
    image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
    image(d, PELLUCID_BINDING_MATERIAL, PELLUCID_RESOURCE_MATERIAL, 1);
    shadowImages(d, group);
    bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, entriesImage());
    d->modeledBytes += entryBytes(group);
    return true;
  }

  // Runs if earlier dispatches say so at `offset` of shared::GatherDispatches. They are done before the first
  // of these.
  void indirect(PellucidDispatch* d, size_t offset) const {
    const auto isIndirect = [](const PellucidDispatch& other) { return other.indirect != 0; };
    if (std::none_of(plan.dispatches, d, isIndirect)) {
      PellucidDispatch* waits = d;
      while (waits > plan.dispatches && !waits->barrierBefore) --waits;
      waits->barrierIndirect = 1;
    }
    d->indirect = 1;
    d->indirectResource = PELLUCID_RESOURCE_CONSTANTS;
    d->indirectOffset = layout.gatherDispatches.offset + offset;
  }

  // `adds`: to what probes found in an earlier dispatch.
  bool probes(const LightGroup& group, bool adds) {
    PellucidDispatch* d = dispatch("probes", Pipeline::Probes);
    if (!d) return false;
    const Cells size = cells();
    groups(d, size.width, size.height, PELLUCID_PROBES_GROUP);
    d->pushConstants[0] = gatherSpacing(frame);
    d->pushConstants[1] = group.gathered;
    d->pushConstants[2] = group.entryColumns | group.entryRows << 16 | (adds ? 1u << 31 : 0);
    d->pushConstants[3] = gatherSamples(frame);
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    bind(d, PELLUCID_BINDING_FRONT_DEPTH, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_FRONT_DEPTH);
    bind(d, PELLUCID_BINDING_MATERIAL, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_MATERIAL);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 0);
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH, 0);
    bind(d, PELLUCID_BINDING_ENTRY_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, entriesImage());
    bind(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, probesImage());
    constants(d, PELLUCID_BINDING_GATHER_DISPATCHES, layout.gatherDispatches);
    // Of each cell one pixel's depth, material and normal.
    constexpr uint64_t kCellBytes = kUnknownDepthBytes + 1 + 4 + kTexelBytes;
    d->modeledBytes = entryBytes(group) + (kCellBytes + (adds ? kTexelBytes : 0)) * size.width * size.height;
    return true;
  }

  bool filterProbes() {
    PellucidDispatch* d = dispatch("filter probes", Pipeline::FilterProbes);
    if (!d) return false;
    const Cells size = cells();
    groups(d, size.width, size.height, PELLUCID_FILTER_GROUP);
    d->pushConstants[0] = gatherSpacing(frame);
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    bind(d, PELLUCID_BINDING_ENTRY_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, probesImage());
    bind(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, filteredImage());
    d->modeledBytes = 2 * kTexelBytes * size.width * size.height;
    if (skipsLight) indirect(d, offsetof(shared::GatherDispatches, share));
    return true;
  }

  // What probes have after the spatial filter.
  void readsProbes(PellucidDispatch* d, uint32_t binding, VkDescriptorType type) const {
    bind(d, binding, type, filteredImage());
    d->modeledBytes += kTexelBytes * cells().width * cells().height;
  }

  void shadowImages(PellucidDispatch* d, const LightGroup& group) const {
    for (uint32_t slot = 0; slot < PELLUCID_SHADOW_IMAGE_COUNT; ++slot) {
      const bool used = slot < group.imageCount;
      image(d, PELLUCID_BINDING_SHADOW_IMAGES + slot,
            used ? kShadow0 + group.images[slot] : static_cast<uint32_t>(PELLUCID_RESOURCE_FRONT_DEPTH),
            used ? kUnknownDepthBytes : 0);
    }
  }

  bool translucency(const LightGroup& group, uint32_t source, uint32_t destination) {
    const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
    const bool gathered = group.gathered > 0 && !debug;
    PellucidDispatch* d = debug      ? dispatch("debug view", Pipeline::DebugView)
                          : gathered ? dispatch("add gathered", Pipeline::AddGathered)
                                     : dispatch("translucency", Pipeline::Translucency);
    if (!d) return false;
    if (gathered) {
      // Tiles are the image's.
      constexpr uint32_t kTile = 2 * PELLUCID_GATHER_GROUP;
      groups(d, rect.x % kTile + rect.width, rect.y % kTile + rect.height, kTile);
      d->pushConstants[0] = gatherSpacing(frame);
      readsProbes(d, PELLUCID_BINDING_PROBES, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
      d->pushConstants[3] = group.gathered;
    } else {
      tiles(d);
    }
    d->pushConstants[1] = group.lightCount;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    if (destination == PELLUCID_RESOURCE_HISTORY && group.firstLight == 0) {
      d->pushConstants[2] = PELLUCID_WRITE_STARTS;
      d->modeledBytes -= colorBytes() * pixels();  // what is there is not read
    }
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 4);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_SHADOWS, {layout.shadows.offset + group.shadowBytes, kShadowWindow});
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH,
             needsChord(frame) ? kUnknownDepthBytes : 0);
    // Lights that are gathered from have been.
    shadowImages(d, group.gathered > 0 ? LightGroup{} : group);
    return true;
  }

  bool addHistory(uint32_t source, uint32_t destination) {
    PellucidDispatch* d = dispatch("add history", Pipeline::AddHistory);
    if (!d) return false;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    image(d, PELLUCID_BINDING_HISTORY, PELLUCID_RESOURCE_HISTORY, colorBytes());
    return true;
  }

  void levelGroups(PellucidDispatch* d, uint32_t level, uint32_t tile) const {
    const PyramidPlace place = placeOf(frame, level);
    groups(d, static_cast<uint32_t>(place.rect.width), static_cast<uint32_t>(place.rect.height), tile);
  }

  // Texels of a level that the rect needs.
  uint64_t texels(uint32_t level) const {
    const PyramidPlace place = placeOf(frame, level);
    return static_cast<uint64_t>(place.rect.width) * static_cast<uint64_t>(place.rect.height);
  }

  // A level is read or written once.
  void levelTraffic(PellucidDispatch* d, uint32_t level) const {
    d->modeledBytes += kTexelBytes * texels(level);
  }
  void readsPyramid(PellucidDispatch* d) const {
    bind(d, PELLUCID_BINDING_PYRAMID, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pyramidImage());
  }
  void writesPyramid(PellucidDispatch* d) const {
    bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, pyramidImage());
  }

  // Level 1 from the pixels of an image, which are copied on the way if `copy` is another one.
  bool baseLevel(uint32_t source, uint32_t copy) {
    const bool copies = copy != source;
    PellucidDispatch* d = dispatch("base level", Pipeline::BaseLevel);
    if (!d) return false;
    d->pushConstants[0] = copies;
    tiles(d);
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    levelTraffic(d, kFirstLevel);
    pixelInputs(d, source);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 4);
    // The output stands in where nothing is copied.
    bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE,
         copies ? copy : static_cast<uint32_t>(PELLUCID_RESOURCE_OUTPUT));
    if (copies) d->modeledBytes += colorBytes() * pixels();
    return true;
  }

  // The two levels after `finer`.
  bool downsample(uint32_t finer) {
    PellucidDispatch* d = dispatch("downsample", Pipeline::Downsample);
    if (!d) return false;
    levelGroups(d, finer + 2, PELLUCID_DOWNSAMPLE_TILE);
    d->pushConstants[0] = finer;
    d->pushConstants[1] = 16;  // texels under a texel
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    readsPyramid(d);
    for (uint32_t level = finer; level <= finer + 2; ++level) levelTraffic(d, level);
    return true;
  }

  // Levels 6 and 7 are made on the way.
  bool upsample(uint32_t coarsest) {
    PellucidDispatch* d = dispatch("upsample", Pipeline::Upsample);
    if (!d) return false;
    // Groups start at texels 32 k - 1, in y 16 k - 1.
    const PyramidPlace place = placeOf(frame, 2);
    const auto across = [](int32_t first, int32_t texels, int32_t side) {
      return static_cast<uint32_t>((first + texels) / side - (first + 1) / side + 1);
    };
    d->groups[0] = across(place.rect.x, place.rect.width, 2 * PELLUCID_UPSAMPLE_GROUP);
    d->groups[1] = across(place.rect.y, place.rect.height, PELLUCID_UPSAMPLE_GROUP);
    d->pushConstants[0] = coarsest;
    d->pushConstants[1] = 16;  // texels under a texel
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_KERNELS, layout.kernels);
    writesPyramid(d);
    readsPyramid(d);
    for (uint32_t level = 2; level <= std::min(coarsest, 5u); ++level) levelTraffic(d, level);
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    return true;
  }

  // `addsProbes`: what points of the gather share is added.
  bool diffuse(uint32_t source, uint32_t destination, bool addsProbes) {
    const bool fine = hasFineFilter(plan.quality);
    const Pipeline pipeline = fine ? (addsProbes ? Pipeline::DiffuseGathered : Pipeline::Diffuse)
                                   : (addsProbes ? Pipeline::DiffuseCoarseGathered : Pipeline::DiffuseCoarse);
    // With the gather both are in the plan, and one of them runs.
    PellucidDispatch* d =
        dispatch(skipsLight && !addsProbes ? "diffuse, none gathered" : "diffuse", pipeline);
    if (!d) return false;
    // Groups start at texels of level 2, whose rect has a border of one.
    const PyramidPlace place = placeOf(frame, 2);
    const auto across = [](int32_t texels, uint32_t side) {
      return (static_cast<uint32_t>(texels) - 2 + side - 1) / side;
    };
    d->groups[0] =
        across(place.rect.width, fine ? PELLUCID_DIFFUSE_TEXELS_X : PELLUCID_DIFFUSE_COARSE_TEXELS_X);
    d->groups[1] = across(place.rect.height, PELLUCID_DIFFUSE_TEXELS_Y);
    d->pushConstants[1] = 1;  // texels to each side of an edge's that its pixels look at
    d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    readsPyramid(d);
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    if (addsProbes)
      readsProbes(d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
    else  // stands in
      bind(d, PELLUCID_BINDING_FILTERED_PROBES, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pyramidImage());
    if (!skipsLight) return true;
    if (!addsProbes) d->modeledBytes = 0;  // one of the two runs
    indirect(d, addsProbes ? offsetof(shared::GatherDispatches, light)
                           : offsetof(shared::GatherDispatches, noLight));
    return true;
  }
};

}  // namespace pellucid
