// Frame -> plan. Pure: no device, no allocation.
#include <algorithm>

#include "frame.h"
#include "pyramid.h"
#include "quality.h"
#include "records.h"
#include "reuse.h"
#include "validate.h"

namespace pellucid {
namespace {

constexpr uint32_t kShadow0 = PELLUCID_RESOURCE_SHADOW0;
constexpr uint32_t kTransient0 = PELLUCID_RESOURCE_TRANSIENT0;
constexpr uint64_t kTexelBytes = 16;        // of the pyramid, as packed by compute/lib/pyramid.glsl
constexpr uint64_t kUnknownDepthBytes = 4;  // the module does not know the format; 4 is the common one

struct Builder {
  const PellucidFrame& frame;
  const ConstantsLayout layout;
  const Rect rect;
  const uint32_t colorTransients;
  const bool keepsPoints, overlaps;
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
    // Every dispatch after the first reads what the one before wrote.
    // The first of a frame that reuses comes after the last frame's use of the history.
    d.barrierBefore = !alongside && (plan.dispatchCount > 0 || plan.history.valid) ? 1 : 0;
    plan.barrierCount += d.barrierBefore;
    ++plan.dispatchCount;
    return &d;
  }

  // `tile`: side of the square that one group makes.
  static void groups(PellucidDispatch* d, uint32_t width, uint32_t height, uint32_t tile) {
    d->groups[0] = (width + tile - 1) / tile;
    d->groups[1] = (height + tile - 1) / tile;
    d->groups[2] = 1;
  }

  // Of four pixels an invocation, from even ones on.
  void tiles(PellucidDispatch* d) const {
    groups(d, rect.width + (rect.x & 1), rect.height + (rect.y & 1), 2 * PELLUCID_GROUP_X);
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
    const bool directional = group.gatheredDirectional && directionalFrame();
    PellucidDispatch* d =
        dispatch("gather records", directional ? PELLUCID_PIPELINE_GATHER_RECORDS_DIRECTIONAL
                                               : PELLUCID_PIPELINE_GATHER_RECORDS);
    if (!d) return false;
    groups(d, group.recordColumns, group.recordRows, PELLUCID_RECORDS_GROUP);
    d->pushConstants[0] = group.shadowCount;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    constants(d, PELLUCID_BINDING_RECORD_MAPS,
              {layout.recordMaps.offset + group.recordMapBytes,
               group.shadowCount * sizeof(shared::RecordMapConstants)});
    image(d, PELLUCID_BINDING_FRONT_DEPTH, PELLUCID_RESOURCE_FRONT_DEPTH, kUnknownDepthBytes);
    shadowImages(d, group);
    bind(d, PELLUCID_BINDING_LEVELS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, recordsImage());
    d->modeledBytes += recordBytes(group);
    return true;
  }

  // `adds`: to what points found in an earlier dispatch.
  bool points(const LightGroup& group, bool adds) {
    const bool directional = group.gatheredDirectional && directionalFrame();
    PellucidDispatch* d = dispatch("gather points", directional ? PELLUCID_PIPELINE_GATHER_POINTS_DIRECTIONAL
                                                                : PELLUCID_PIPELINE_GATHER_POINTS);
    if (!d) return false;
    const Cells size = cells();
    groups(d, size.width, size.height, PELLUCID_RECORDS_GROUP);
    d->pushConstants[0] = gatherSpacing(frame);
    d->pushConstants[1] = group.gathered;
    d->pushConstants[2] = adds;
    d->pushConstants[3] = frame.gatherSamples;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_GATHER_MAPS,
              {layout.gatherMaps.offset + group.gatherMapBytes, kGatherMapWindow});
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    bind(d, PELLUCID_BINDING_FRONT_DEPTH, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_FRONT_DEPTH);
    bind(d, PELLUCID_BINDING_MATERIAL, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, PELLUCID_RESOURCE_MATERIAL);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 0);
    bind(d, PELLUCID_BINDING_RECORDS, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, recordsImage());
    bind(d, PELLUCID_BINDING_POINTS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, pointsImage());
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
    return true;
  }

  void shadowImages(PellucidDispatch* d, const LightGroup& group) const {
    for (uint32_t slot = 0; slot < PELLUCID_SHADOW_IMAGE_COUNT; ++slot) {
      const bool used = slot < group.imageCount;
      image(d, PELLUCID_BINDING_SHADOW_IMAGES + slot,
            used ? kShadow0 + group.images[slot] : static_cast<uint32_t>(PELLUCID_RESOURCE_FRONT_DEPTH),
            used ? kUnknownDepthBytes : 0);
    }
  }

  // `quads`: the pyramid's level 1 is written too.
  bool translucency(const LightGroup& group, uint32_t source, uint32_t destination, bool quads) {
    const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
    const bool directional = group.lightCount == 1 && group.directional && directionalFrame();
    const uint32_t half = debug                  ? PELLUCID_PIPELINE_DEBUG_16F
                          : group.gathered > 0   ? PELLUCID_PIPELINE_GATHER_16F
                          : directional && quads ? PELLUCID_PIPELINE_DIRECTIONAL_QUADS_16F
                          : directional          ? PELLUCID_PIPELINE_DIRECTIONAL_16F
                          : quads                ? PELLUCID_PIPELINE_TRANSLUCENCY_QUADS_16F
                                                 : PELLUCID_PIPELINE_TRANSLUCENCY_16F;
    const uint32_t pipeline = half + (wide() ? 1 : 0);  // the 32F variant follows the 16F one
    PellucidDispatch* d = dispatch(debug ? "debug view" : "translucency", pipeline);
    if (!d) return false;
    if (half == PELLUCID_PIPELINE_GATHER_16F) {
      // Tiles are the image's.
      constexpr uint32_t kTile = 2 * PELLUCID_GATHER_GROUP;
      groups(d, rect.x % kTile + rect.width, rect.y % kTile + rect.height, kTile);
      d->pushConstants[0] = gatherSpacing(frame);
      d->pushConstants[3] = group.gathered;
      bind(d, PELLUCID_BINDING_POINTS, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, sharedImage());
      d->modeledBytes += kTexelBytes * cells().width * cells().height;
    } else {
      tiles(d);
    }
    if (quads) {
      writesPyramid(d);
      writesLevel(d, kFirstLevel);
    }
    d->pushConstants[1] = group.lightCount;
    d->pushConstants[2] = destination == PELLUCID_RESOURCE_OUTPUT;
    if (destination == PELLUCID_RESOURCE_HISTORY && group.firstLight == 0)
      d->pushConstants[2] = PELLUCID_WRITE_STARTS;
    common(d, source, destination);
    if (d->pushConstants[2] == PELLUCID_WRITE_STARTS)
      d->modeledBytes -= colorBytes() * pixels();  // what is there is not read
    constants(d, PELLUCID_BINDING_LIGHTS, {layout.lights.offset + group.lightBytes, kLightWindow});
    constants(d, PELLUCID_BINDING_SHADOWS, {layout.shadows.offset + group.shadowBytes, kShadowWindow});
    constants(d, PELLUCID_BINDING_MATERIALS, layout.materials);
    optional(d, PELLUCID_BINDING_BACK_DEPTH, frame.backDepth, PELLUCID_RESOURCE_BACK_DEPTH,
             needsChord(frame) ? kUnknownDepthBytes : 0);
    optional(d, PELLUCID_BINDING_NORMAL, frame.normal, PELLUCID_RESOURCE_NORMAL, 4);
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

  void writesLevel(PellucidDispatch* d, uint32_t level) const {
    d->modeledBytes += kTexelBytes * texels(level);
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
    writesLevel(d, kFirstLevel);
    pixelInputs(d, source);
    if (copies) {
      bind(d, PELLUCID_BINDING_DESTINATION, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, copy);
      d->modeledBytes += colorBytes() * pixels();
    }
    return true;
  }

  bool reduce(uint32_t finer) {
    PellucidDispatch* d = dispatch("reduce", PELLUCID_PIPELINE_REDUCE_LEVELS);
    if (!d) return false;
    levelGroups(d, finer + 2, PELLUCID_REDUCE_TILE);
    d->pushConstants[0] = finer;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    writesPyramid(d);
    bind(d, PELLUCID_BINDING_PYRAMID, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pyramidImage());
    for (uint32_t level = finer; level <= finer + 2; ++level) writesLevel(d, level);
    return true;
  }

  bool resolve(uint32_t coarsest) {
    PellucidDispatch* d = dispatch("resolve", PELLUCID_PIPELINE_RESOLVE_LEVELS);
    if (!d) return false;
    levelGroups(d, 2, PELLUCID_RESOLVE_TILE);
    d->pushConstants[0] = coarsest;
    constants(d, PELLUCID_BINDING_FRAME, layout.frame);
    constants(d, PELLUCID_BINDING_KERNELS, layout.kernels);
    writesPyramid(d);
    bind(d, PELLUCID_BINDING_PYRAMID, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pyramidImage());
    for (uint32_t level = 2; level <= coarsest; ++level) writesLevel(d, level);
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    return true;
  }

  bool diffuse(uint32_t source, uint32_t destination) {
    const bool coarse = plan.quality == 0;
    const uint32_t half = coarse ? PELLUCID_PIPELINE_DIFFUSE_COARSE_16F : PELLUCID_PIPELINE_DIFFUSE_16F;
    PellucidDispatch* d = dispatch("diffuse", half + (wide() ? 1 : 0));
    if (!d) return false;
    // Groups start at texels of level 2, whose rect has a border of one.
    const PyramidPlace place = placeOf(frame, 2);
    const auto across = [](int32_t texels, uint32_t side) {
      return (static_cast<uint32_t>(texels) - 2 + side - 1) / side;
    };
    d->groups[0] =
        across(place.rect.width, coarse ? PELLUCID_DIFFUSE_COARSE_TEXELS_X : PELLUCID_DIFFUSE_TEXELS_X);
    d->groups[1] = across(place.rect.height, PELLUCID_DIFFUSE_TEXELS_Y);
    d->pushConstants[1] = source < kTransient0;  // the passes write nothing that would have to be sanitized
    d->pushConstants[3] = destination == PELLUCID_RESOURCE_OUTPUT;
    common(d, source, destination);
    bind(d, PELLUCID_BINDING_PYRAMID, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, pyramidImage());
    d->modeledBytes += 2 * kTexelBytes * texels(2);
    return true;
  }
};

// What runs.
struct Stages {
  bool lights;  // the fused dispatches carry lights
  bool diffusion;
  uint32_t fused;    // fused dispatches
  bool history;      // these write the history, and one more adds it
  bool keepsPoints;  // the history is what the gather's points share: these read it
  // The diffusion is all there is: it copies the irradiance before it writes the output, which may be the
  // same image and whose pixels read their neighbors.
  bool copies;
  bool fusesQuads;     // the last fused dispatch makes the pyramid's level 1 of what it writes
  LightGroups groups;  // of lights
  bool overlaps;  // the gather runs beside the diffusion, which it does not wait for, with images of its own

  // Dispatches that write a color transient or the output.
  uint32_t writers() const { return (history ? 1 : fused) + (diffusion ? 1 : 0) + (copies ? 1 : 0); }
  uint32_t colorTransients() const { return std::min(writers() - 1, 2u); }
  // Of packed texels: the pyramid; what the gather's points find; records, if they do not lie where the
  // pyramid was.
  uint32_t texelTransients() const { return groups.gathered > 0 ? (overlaps ? 3 : 2) : diffusion ? 1 : 0; }
};

Stages stagesOf(const PellucidFrame& frame) {
  const bool debug = frame.debugView != PELLUCID_DEBUG_NONE;
  Stages s{};
  if (frame.features & PELLUCID_FEATURE_TRANSLUCENCY || debug) s.groups = lightGroups(frame);
  s.fused = s.groups.fused();
  s.lights = s.fused > 0;
  s.diffusion = frame.features & PELLUCID_FEATURE_DIFFUSION && !debug && anyMaterialDiffuses(frame);
  s.copies = s.diffusion && !s.lights;
  // Without diffusion the fused pass still has to bring irradiance (times albedo) to the output.
  if (s.writers() == 0) s.fused = 1;
  s.keepsPoints = keepsPoints(frame);
  s.history = keepsHistory(frame) && !s.keepsPoints;
  s.fusesQuads = s.diffusion && s.lights && !s.history && frame.gatherSamples == 0;
  // More would be more transients than there are.
  s.overlaps = s.diffusion && s.groups.gathered == 1 && s.colorTransients() == 1 && !s.history;
  return s;
}

bool build(const PellucidFrame& frame, const PellucidHistory& kept, PellucidPlan& plan) {
  const Stages stages = stagesOf(frame);
  Builder b{frame,
            constantsLayout(frame),
            renderRect(frame),
            stages.colorTransients(),
            stages.keepsPoints,
            stages.overlaps,
            plan};
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

  uint32_t coarsest = coarsestLevel(frame);
  if (stages.diffusion) {
    const DiffusionReach reach = diffusionReach(frame);
    plan.largestRadius = static_cast<float>(reach.radius);
    plan.quality = frame.quality;
    if (frame.targetError > 0 && !qualityFor(frame.targetError, reach.radius, &plan.quality))
      b.skip("targetError", "no quality is that exact");
    for (uint32_t i = 0; i < frame.materialCount; ++i)
      if (reach.pixelsPerMm * widestDeviation(frame.materials[i]) > levelDeviation(coarsest))
        b.skip("diffusion radius", "wider than the pyramid holds");
    while (reach.deviation > 0 && coarsest > kFirstLevel + 2 &&
           reach.deviation <= deviationWithin(coarsest - 2))
      coarsest -= 2;
  }

  const bool reused = (stages.history || stages.keepsPoints) && decideReuse(frame, kept, &plan.history);
  if (reused) b.skip(stages.keepsPoints ? "gather" : "translucency", "reused from an earlier frame");

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
  uint32_t left = stages.fused;
  const auto translucency = [&](const LightGroup& group) {
    const uint32_t to = destination();
    fits = fits && b.translucency(group, source, to, stages.fusesQuads && --left == 0);
    source = to;
  };
  const auto forEachFused = [&](auto&& fused) {
    uint32_t index = 0;
    forEachLightGroup(
        frame, [](const LightGroup&, const PellucidLight&) {},
        [&](const LightGroup& group) {
          const bool gathers = group.gathered > 0 && !reused && !stages.overlaps;
          if (gathers) fits = fits && b.records(group) && b.points(group, index > 0);
          if (++index < stages.groups.gathered) return;
          if (gathers) fits = fits && b.share();
          fused(group);
        });
  };
  const auto translucencies = [&] {
    if (stages.history) {
      if (!reused)
        forEachFused([&](const LightGroup& group) {
          fits = fits && b.translucency(group, PELLUCID_RESOURCE_HISTORY, PELLUCID_RESOURCE_HISTORY, false);
        });
      const uint32_t to = destination();
      fits = fits && b.addHistory(source, to);
      source = to;
    } else if (stages.lights)
      forEachFused(translucency);
    else if (stages.fused > 0)
      translucency(LightGroup{});
  };
  const auto diffusion = [&] {
    if (!stages.diffusion) return;
    LightGroup gathered;
    if (stages.overlaps && !reused)
      forEachLightGroup(
          frame, [](const LightGroup&, const PellucidLight&) {},
          [&](const LightGroup& group) {
            if (group.gathered > 0) gathered = group;
          });
    // Records, points and sharing, each beside a dispatch of the diffusion.
    uint32_t step = 0;
    const auto alongside = [&] {
      if (gathered.gathered == 0 || step == 3) return;
      b.alongside = true;
      fits = fits && (step == 0 ? b.records(gathered) : step == 1 ? b.points(gathered, false) : b.share());
      b.alongside = false;
      ++step;
    };
    const uint32_t copy = stages.copies ? destination() : source;
    if (!stages.fusesQuads) fits = fits && b.quads(source, copy);
    alongside();
    source = copy;
    for (uint32_t finer = kFirstLevel; finer < coarsest; finer += 2) {
      fits = fits && b.reduce(finer);
      alongside();
    }
    fits = fits && b.resolve(coarsest);
    alongside();
    const uint32_t to = destination();
    fits = fits && b.diffuse(source, to);
    source = to;
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
  const uint32_t colors = stages.colorTransients(), transients = colors + stages.texelTransients();
  const uint32_t room = *count;
  *count = transients + (stages.history || stages.keepsPoints ? 1 : 0);
  if (!needs) return PELLUCID_OK;  // validation asks for the number in every frame
  // Without a plan before it, that of a frame that refreshes a history: every image is in use.
  PellucidPlan plan{};
  if (!build(*frame, {}, plan)) return PELLUCID_ERROR_CAPACITY;
  const uint64_t colorBytes = frame->outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT ? 16 : 8;
  for (uint32_t i = 0; i < *count && i < room; ++i) {
    const bool persistent = i == transients, texels = !persistent && i >= colors;
    PyramidExtent size{frame->imageExtent[0], frame->imageExtent[1]};
    const uint32_t texel = i - colors;  // the pyramid, points, records
    const bool kept = persistent && stages.keepsPoints;
    if (texels || kept)
      size = texels && texel == 0 && stages.diffusion ? pyramidExtent(*frame) : PyramidExtent{1, 1};
    const bool records = texels && stages.groups.gathered > 0 && texel == (stages.overlaps ? 2u : 0u);
    if (kept || records || (texels && texel == 1)) {
      const uint32_t side = gatherSpacing(*frame);
      const auto fit = [&](uint32_t* most, uint32_t pixels, uint32_t ofMaps) {
        *most = std::max({*most, (pixels - 1) / side + 1, records ? ofMaps : 0});
      };
      fit(&size.width, frame->imageExtent[0], stages.groups.recordColumns);
      fit(&size.height, frame->imageExtent[1], stages.groups.recordRows);
    }
    PellucidImageNeed& need = needs[i];
    need = {};
    need.format = texels || kept ? VK_FORMAT_R32G32B32A32_UINT : frame->outputFormat;
    need.extent[0] = size.width;
    need.extent[1] = size.height;
    need.bytes = (texels || kept ? kTexelBytes : colorBytes) * size.width * size.height;
    need.persistent = persistent;
    const uint32_t resource = persistent ? static_cast<uint32_t>(PELLUCID_RESOURCE_HISTORY) : kTransient0 + i;
    need.firstDispatch = UINT32_MAX;
    for (uint32_t d = 0; d < plan.dispatchCount; ++d)
      for (uint32_t b = 0; b < plan.dispatches[d].bindingCount; ++b)
        if (plan.dispatches[d].bindings[b].resource == resource) {
          need.firstDispatch = std::min(need.firstDispatch, d);
          need.lastDispatch = d;
        }
    // Frames that reuse the history lack the dispatches that refresh it.
    const uint32_t refreshing = stages.keepsPoints ? stages.groups.gatherDispatches()
                                : stages.history   ? stages.fused
                                                   : 0;
    need.firstDispatch -= std::min(need.firstDispatch, refreshing);
  }
  return PELLUCID_OK;
}

extern "C" uint32_t pellucidGetRequiredInputs(uint32_t features) {
  if ((features & (PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION)) == 0) return 0;
  return 1u << PELLUCID_RESOURCE_FRONT_DEPTH | 1u << PELLUCID_RESOURCE_IRRADIANCE |
         1u << PELLUCID_RESOURCE_MATERIAL | 1u << PELLUCID_RESOURCE_OUTPUT;
}
