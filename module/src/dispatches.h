// What each dispatch of a plan runs and binds, in the order in which it is asked for.
#pragma once

#include <algorithm>

#include "frame.h"
#include "pyramid.h"
#include "quality.h"
#include "records.h"

namespace pellucid {

inline constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
inline constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
inline constexpr uint64_t kTexelBytes = 16;        // of the pyramid, as packed by compute/lib/pyramid.glsl
inline constexpr uint64_t kUnknownDepthBytes = 4;  // the module does not know the format; 4 is the common one

struct Builder {
  const PellucidFrame& frame;
  const ConstantsLayout layout;
  const Rect rect;
  const uint32_t colorTransients;
  const bool keepsPoints, overlaps;
  const bool skipsLight;  // of the gather's dispatches those that the GPU finds nothing to do for are empty
  PellucidPlan& plan;
  bool alongside = false;  // dispatches run beside the one before, with which they share nothing

  bool wide() const { return frame.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT; }
  uint64_t pixels() const { return static_cast<uint64_t>(rect.width) * rect.height; }
  uint32_t pyramidImage() const { return kTransient0 + colorTransients; }
  // What points of the gather find; the records of the maps and, in their place, what points share. Records
  // lie where the pyramid was unless both are in use at once.
  uint32_t pointsImage() const { return pyramidImage() + 1; }
  uint32_t recordsImage() const { return overlaps ? pyramidImage() + 2 : pyramidImage(); }
  uint32_t sharedImage() const {
    return keepsPoints ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : recordsImage();
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

  PellucidDispatch* dispatch(const char* name, uint32_t pipeline) {
    if (plan.dispatchCount == PELLUCID_MAX_DISPATCHES) return nullptr;
    PellucidDispatch& d = plan.dispatches[plan.dispatchCount];
    d.name = name;
    d.pipeline = pipeline;
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
  void tiles(PellucidDispatch* d, uint32_t rows = PELLUCID_TILE) const {
    groups(d, rect.width + (rect.x & 1), rect.height + (rect.y & 1), PELLUCID_TILE, rows);
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

  // What compute/lib/common_case.glsl takes for granted besides the lights.
  bool directionalFrame() const {
    bool exponentials = true;
    for (uint32_t i = 0; i < frame.materialCount; ++i)
      exponentials = exponentials && frame.materials[i].transmittanceModel == PELLUCID_TRANSMITTANCE_EXP2;
    return exponentials && given(frame.normal) && frame.frontDepthEncoding == PELLUCID_DEPTH_DEVICE &&
           frame.thicknessSource == PELLUCID_THICKNESS_LIGHT && frame.angleModel == PELLUCID_ANGLE_NORMAL &&
           frame.constantViewDirection == 0;
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

  static uint64_t recordBytes(const LightGroup& group) {
    return kTexelBytes * group.recordColumns * group.recordRows;
  }

  bool records(const LightGroup& group) {
    const bool directional =
        group.gatheredDirectional && directionalFrame() && group.shadowCount <= PELLUCID_RECORD_MAPS;
    PellucidDispatch* d =
        dispatch("gather records", !directional             ? PELLUCID_PIPELINE_GATHER_RECORDS
                                   : group.shadowCount == 1 ? PELLUCID_PIPELINE_GATHER_RECORDS_ONE_MAP
                                                            : PELLUCID_PIPELINE_GATHER_RECORDS_DIRECTIONAL);
    if (!d) return false;
    groups(d, group.recordWidth, group.recordHeight, PELLUCID_RECORDS_GROUP);
    d->groups[2] = group.shadowCount;
    d->pushConstants[1] = group.recordColumns | group.recordRows << 16;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    const VkDeviceSize maps = layout.recordMaps.offset + group.recordMapBytes;
    if (directional) {
      constants(d, PELLUCID_BINDING_DIRECTIONAL_RECORD_MAPS, {maps, kRecordMapWindow});
    } else {
      constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
      constants(d, PELLUCID_BINDING_RECORD_MAPS,
                {maps, group.shadowCount * sizeof(shared::RecordMapConstants)});
    }
    image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
    shadowImages(d, group);
    bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, recordsImage());
    d->modeledBytes += recordBytes(group);
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

  // `adds`: to what points found in an earlier dispatch.
  bool points(const LightGroup& group, bool adds) {
    const bool directional = group.gatheredDirectional && directionalFrame();
    PellucidDispatch* d = dispatch("gather points", directional ? PELLUCID_PIPELINE_GATHER_POINTS_DIRECTIONAL
                                                                : PELLUCID_PIPELINE_GATHER_POINTS);
    if (!d) return false;
    const Cells size = cells();
    groups(d, size.width, size.height, PELLUCID_POINTS_GROUP);
    d->pushConstants[0] = gatherSpacing(frame);
    d->pushConstants[1] = group.gathered;
    d->pushConstants[2] = group.recordColumns | group.recordRows << 16 | (adds ? 1u << 31 : 0);
    d->pushConstants[3] = frame.gatherSamples;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    bind(d, PELLUCID_BINDING_FRONT_DEPTH, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_FRONT_DEPTH);
    bind(d, PELLUCID_BINDING_MATERIAL, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_MATERIAL);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 0);
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH, 0);
    bind(d, PELLUCID_BINDING_RECORDS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, recordsImage());
    bind(d, PELLUCID_BINDING_POINTS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, pointsImage());
    constants(d, PELLUCID_BINDING_GATHER_DISPATCHES, layout.gatherDispatches);
    // Of each cell one pixel's depth, material and normal.
    constexpr uint64_t kCellBytes = kUnknownDepthBytes + 1 + 4 + kTexelBytes;
    d->modeledBytes = recordBytes(group) + (kCellBytes + (adds ? kTexelBytes : 0)) * size.width * size.height;
    return true;
  }

  bool share() {
    PellucidDispatch* d = dispatch("gather share", PELLUCID_PIPELINE_GATHER_SHARE);
    if (!d) return false;
    const Cells size = cells();
    groups(d, size.width, size.height, PELLUCID_SHARE_GROUP);
    d->pushConstants[0] = gatherSpacing(frame);
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    bind(d, PELLUCID_BINDING_RECORDS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pointsImage());
    bind(d, PELLUCID_BINDING_POINTS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sharedImage());
    d->modeledBytes = 2 * kTexelBytes * size.width * size.height;
    if (skipsLight) indirect(d, offsetof(shared::GatherDispatches, share));
    return true;
  }

  // What points share.
  void readsPoints(PellucidDispatch* d, uint32_t binding, VkDescriptorType type) const {
    bind(d, binding, type, sharedImage());
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

  // What the fused dispatches have in common. `quads`: the pyramid's level 1 is written too.
  void fused(PellucidDispatch* d, const LightGroup& group, uint32_t source, uint32_t destination,
             bool quads) const {
    if (quads) {
      writesPyramid(d);
      levelTraffic(d, kFirstLevel);
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
  }

  bool directional(const LightGroup& group, uint32_t source, uint32_t destination, bool quads) {
    const uint32_t half = quads ? PELLUCID_PIPELINE_DIRECTIONAL_QUADS_16F : PELLUCID_PIPELINE_DIRECTIONAL_16F;
    PellucidDispatch* d = dispatch("translucency", half + (wide() ? 1 : 0));  // the 32F variant follows
    if (!d) return false;
    tiles(d, PELLUCID_DIRECTIONAL_ROWS);
    fused(d, group, source, destination, quads);
    constants(d, PELLUCID_BINDING_LIGHTS,
              {layout.directional.offset + group.index * kDirectionalWindow, kDirectionalWindow});
    image(d, PELLUCID_BINDING_SHADOW_IMAGES, kShadow0 + group.images[0], kUnknownDepthBytes);
    return true;
  }

  bool translucency(const LightGroup& group, uint32_t source, uint32_t destination, bool quads) {
    const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
    if (!debug && group.lightCount == 1 && group.gathered == 0 && group.directional && directionalFrame())
      return directional(group, source, destination, quads);
    const uint32_t half = debug                ? PELLUCID_PIPELINE_DEBUG_16F
                          : group.gathered > 0 ? PELLUCID_PIPELINE_GATHER_16F
                          : quads              ? PELLUCID_PIPELINE_TRANSLUCENCY_QUADS_16F
                                               : PELLUCID_PIPELINE_TRANSLUCENCY_16F;
    const uint32_t pipeline = half + (wide() ? 1 : 0);
    PellucidDispatch* d = dispatch(debug ? "debug view" : "translucency", pipeline);
    if (!d) return false;
    if (half == PELLUCID_PIPELINE_GATHER_16F) {
      // Tiles are the image's.
      constexpr uint32_t kTile = 2 * PELLUCID_GATHER_GROUP;
      groups(d, rect.x % kTile + rect.width, rect.y % kTile + rect.height, kTile);
      d->pushConstants[0] = gatherSpacing(frame);
      readsPoints(d, PELLUCID_BINDING_POINTS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE);
      d->pushConstants[3] = group.gathered;
    } else {
      tiles(d);
    }
    fused(d, group, source, destination, quads);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_SHADOWS, {layout.shadows.offset + group.shadowBytes, kShadowWindow});
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH,
             needsChord(frame) ? kUnknownDepthBytes : 0);
    // Lights that are gathered from have been.
    shadowImages(d, group.gathered > 0 ? LightGroup{} : group);
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
  bool quads(uint32_t source, uint32_t copy) {
    const bool copies = copy != source;
    PellucidDispatch* d = dispatch("quads", !copies  ? PELLUCID_PIPELINE_QUADS
                                            : wide() ? PELLUCID_PIPELINE_QUADS_AND_COPY_32F
                                                     : PELLUCID_PIPELINE_QUADS_AND_COPY_16F);
    if (!d) return false;
    tiles(d);
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    levelTraffic(d, kFirstLevel);
    pixelInputs(d, source);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 4);
    if (copies) {
      bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, copy);
      d->modeledBytes += colorBytes() * pixels();
    }
    return true;
  }

  // The `levels` after `finer`: 2, or 4 after level 1, the last two of them by groups of their own from
  // boxes.
  bool reduce(uint32_t finer, uint32_t levels) {
    PellucidDispatch* d = dispatch("reduce", sumsEdges()       ? PELLUCID_PIPELINE_REDUCE_FOR_EDGES
                                             : sumsEdgesFast() ? PELLUCID_PIPELINE_REDUCE_FOR_SUMS
                                                               : PELLUCID_PIPELINE_REDUCE_LEVELS);
    if (!d) return false;
    // Groups of boxes, whose columns and number the shader is told, lie in rows before the others, of whose
    // rows it is told.
    uint32_t boxGroups = 0;
    if (levels == 4) {
      levelGroups(d, finer + 4, PELLUCID_REDUCE_TILE);
      boxGroups = d->groups[0] * d->groups[1];
      d->pushConstants[2] = d->groups[0] | boxGroups << 16;
    }
    levelGroups(d, finer + 2, PELLUCID_REDUCE_TILE);
    d->pushConstants[0] = finer;
    d->pushConstants[1] = 16;  // texels under a texel
    d->pushConstants[3] = d->groups[1];
    d->groups[1] += (boxGroups + d->groups[0] - 1) / d->groups[0];
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    readsPyramid(d);
    for (uint32_t level = finer; level <= finer + levels; ++level) levelTraffic(d, level);
    if (boxGroups > 0) levelTraffic(d, finer);  // is read twice
    return true;
  }

  // `reduces`: it makes levels 6 and 7 from level 5. Where edges are summed fast that is done beside it, from
  // `source` to `destination`.
  bool resolve(uint32_t coarsest, bool reduces, uint32_t source, uint32_t destination) {
    const bool sums = sumsEdgesFast();
    const uint32_t pipeline = sums && reduces ? PELLUCID_PIPELINE_REDUCE_RESOLVE_AND_SUM_16F
                              : sums          ? PELLUCID_PIPELINE_RESOLVE_AND_SUM_16F
                              : reduces       ? PELLUCID_PIPELINE_REDUCE_AND_RESOLVE
                              : sumsEdges()   ? PELLUCID_PIPELINE_RESOLVE_FOR_EDGES
                                              : PELLUCID_PIPELINE_RESOLVE_LEVELS;
    PellucidDispatch* d = dispatch("resolve", pipeline + (sums && wide() ? 1 : 0));
    if (!d) return false;
    // Groups start at texels 32 k - 1, in y 16 k - 1.
    const PyramidPlace place = placeOf(frame, 2);
    const auto across = [](int32_t first, int32_t texels, int32_t side) {
      return static_cast<uint32_t>((first + texels) / side - (first + 1) / side + 1);
    };
    d->groups[0] = across(place.rect.x, place.rect.width, 2 * PELLUCID_RESOLVE_GROUP);
    d->groups[1] = across(place.rect.y, place.rect.height, PELLUCID_RESOLVE_GROUP);
    d->pushConstants[0] = coarsest;
    d->pushConstants[1] = 16;  // texels under a texel
    if (sums) {
      // In rows after the others, of which the shader is told.
      const uint32_t tiles = fastEdgesTiles(), ofGroup = fastEdgesTilesOfGroup();
      const uint32_t columns = d->groups[0] * ofGroup, rows = (tiles + columns - 1) / columns;
      d->pushConstants[2] = d->groups[1] | ofGroup << 16;
      d->groups[1] += rows;
      d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
      common(d, source, destination);
      image(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 0);
      // The plan does not know how many edges there are: what says so is all that is read anywhere.
      d->modeledBytes = kTexelBytes * texels(2);
    } else {
      constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    }
    constants(d, PELLUCID_BINDING_KERNELS, layout.kernels);
    writesPyramid(d);
    readsPyramid(d);
    for (uint32_t level = 2; level <= (reduces ? 5 : coarsest); ++level) levelTraffic(d, level);
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    return true;
  }

  // Tiles of the image of which pixels from `first` on have some.
  static uint32_t tilesAcross(uint32_t first, uint32_t pixels, uint32_t side) {
    return (first + pixels - 1) / side - first / side + 1;
  }

  // Where edges are summed fast.
  uint32_t fastEdgesTiles() const {
    return tilesAcross(rect.x, rect.width, PELLUCID_EDGES_GROUP) *
           tilesAcross(rect.y, rect.height, PELLUCID_EDGES_GROUP);
  }

  // A group costs some time though it finds nothing to sum, on software devices much, while large devices
  // that run a few hundred at a time wait for the last ones where there are as few: as many tiles as leave a
  // thousand groups.
  uint32_t fastEdgesTilesOfGroup() const {
    constexpr uint32_t kGroups = 1024, kLeast = 4;
    return std::clamp(fastEdgesTiles() / kGroups, kLeast, static_cast<uint32_t>(PELLUCID_FAST_EDGES_TILES));
  }

  // Of levels up to `coarsest`, from them and the pixels, when they have been resolved. Those of the last one
  // are made where they are summed.
  bool clusters(uint32_t coarsest, uint32_t source) {
    PellucidDispatch* d = dispatch("clusters", PELLUCID_PIPELINE_CLUSTERS);
    if (!d) return false;
    constexpr uint32_t kSide = 4 * PELLUCID_CLUSTERS_GROUP;  // pixels
    d->groups[0] = tilesAcross(rect.x, rect.width, kSide);
    d->groups[1] = tilesAcross(rect.y, rect.height, kSide);
    d->pushConstants[0] = coarsest;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    readsPyramid(d);
    pixelInputs(d, source);
    image(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 0);
    // The plan does not know how much is tilted, of which pixels are read and level 1 is written.
    d->modeledBytes = 0;
    for (uint32_t level = 1; level <= std::min(coarsest, PELLUCID_LAST_LEVEL - 1u); ++level)
      levelTraffic(d, level);
    return true;
  }

  bool sumsEdgesFast() const { return pellucid::sumsEdgesFast(frame, plan.quality); }
  bool sumsEdges() const { return pellucid::sumsEdges(frame, plan.quality); }

  // After the one of all other pixels, with the same arguments.
  bool diffuseEdges(uint32_t coarsest, uint32_t source, uint32_t destination, bool addsPoints) {
    const uint32_t half =
        addsPoints ? PELLUCID_PIPELINE_DIFFUSE_EDGES_GATHER_16F : PELLUCID_PIPELINE_DIFFUSE_EDGES_16F;
    PellucidDispatch* d = dispatch("diffuse edges", half + (wide() ? 1 : 0));
    if (!d) return false;
    const PyramidPlace place = placeOf(frame, 2);  // with a border of one
    groups(d, static_cast<uint32_t>(place.rect.width) - 2, static_cast<uint32_t>(place.rect.height) - 2,
           PELLUCID_EDGES_GROUP / 4);
    d->pushConstants[0] = coarsest;
    d->groups[1] = (d->groups[1] + PELLUCID_EDGES_TILES - 1) / PELLUCID_EDGES_TILES;
    d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    constants(d, PELLUCID_BINDING_KERNELS, layout.kernels);
    image(d, PELLUCID_BINDING_NORMAL, PELLUCID_RESOURCE_NORMAL, 0);
    readsPyramid(d);
    if (addsPoints) readsPoints(d, PELLUCID_BINDING_SHARED_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
    // The plan does not know how many edges there are: whether a texel is one is all that is read anywhere.
    d->modeledBytes = kTexelBytes * texels(2);
    return true;
  }

  // `addsPoints`: what points of the gather share is added.
  bool diffuse(uint32_t source, uint32_t destination, bool addsPoints) {
    // In the order of FineFilters.
    struct Variant {
      uint32_t without, with;  // points
      uint32_t columns;        // texels of a group
    };
    constexpr Variant kVariants[] = {
        {PELLUCID_PIPELINE_DIFFUSE_COARSE_16F, PELLUCID_PIPELINE_DIFFUSE_COARSE_GATHER_16F,
         PELLUCID_DIFFUSE_COARSE_TEXELS_X},
        {PELLUCID_PIPELINE_DIFFUSE_16F, PELLUCID_PIPELINE_DIFFUSE_GATHER_16F, PELLUCID_DIFFUSE_TEXELS_X},
        {PELLUCID_PIPELINE_DIFFUSE_PLANES_16F, PELLUCID_PIPELINE_DIFFUSE_PLANES_GATHER_16F,
         PELLUCID_DIFFUSE_PLANES_TEXELS_X}};
    const Variant& variant = kVariants[static_cast<size_t>(fineFilters(frame, plan.quality))];
    const uint32_t half = addsPoints ? variant.with : variant.without;
    // With the gather both are in the plan, and one of them runs.
    PellucidDispatch* d =
        dispatch(skipsLight && !addsPoints ? "diffuse, none gathered" : "diffuse", half + (wide() ? 1 : 0));
    if (!d) return false;
    // Groups start at texels of level 2, whose rect has a border of one.
    const PyramidPlace place = placeOf(frame, 2);
    const auto across = [](int32_t texels, uint32_t side) {
      return (static_cast<uint32_t>(texels) - 2 + side - 1) / side;
    };
    d->groups[0] = across(place.rect.width, variant.columns);
    d->groups[1] = across(place.rect.height, PELLUCID_DIFFUSE_TEXELS_Y);
    // Texels to each side of an edge's that its pixels look at; pixels of a column of a texel at the rect's
    // border.
    d->pushConstants[1] = sumsEdges() ? 4 : 1;
    d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    readsPyramid(d);
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    if (addsPoints) readsPoints(d, PELLUCID_BINDING_SHARED_POINTS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE);
    if (!skipsLight) return true;
    if (!addsPoints) d->modeledBytes = 0;  // one of the two runs
    indirect(d, addsPoints ? offsetof(shared::GatherDispatches, light)
                           : offsetof(shared::GatherDispatches, noLight));
    return true;
  }
};

}  // namespace pellucid
