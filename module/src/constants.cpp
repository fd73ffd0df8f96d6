// The constants slice: where parts lie, and the bytes of frame, lights, shadow maps, materials, kernels.
#include "constants.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/packing.hpp>

#include "domains.h"
#include "entry_points.h"
#include "frame.h"
#include "material/tables.h"
#include "plan.h"

namespace pellucid {

// ---- Layout

ConstantsLayout::ConstantsLayout(const Setup& setup, const Lights& all, const Stages& stages,
                                 const Blocks& blocks) {
  const LightGroup& last = all.last;
  const auto place = [this](VkDeviceSize* offset, VkDeviceSize bytes) {
    *offset = size;
    size += aligned(bytes);
  };
  place(&frame, sizeof(shared::FrameConstants));
  // The last group's window reaches as far as the first one's.
  place(&lights, last.lightBytes + kLightWindow);
  place(&shadows, last.shadowBytes + kShadowWindow);
  place(&materials, setup.frame.materialCount * sizeof(shared::MaterialConstants));
  place(&kernels, setup.frame.materialCount * sizeof(shared::KernelConstants));
  if (setup.gathers) {
    place(&gatherMaps, last.gatherMapBytes + kGatherMapWindow);
    place(&entryMaps, last.entryMapBytes + kEntryMapWindow);
  }
  lists = size;
  if (stages.diffusion)
    place(&lists, sizeof(shared::BlockLists) + blocks.listWords() * sizeof(uint32_t));
}

namespace {

// A plan holds no more groups of lights than dispatches.
VkDeviceSize mostConstants(VkDeviceSize materials, VkDeviceSize lights, VkDeviceSize maps) {
  const VkDeviceSize groups = std::clamp(lights, VkDeviceSize{1}, VkDeviceSize{PELLUCID_MAX_DISPATCHES});
  // The bytes that a range holds of the groups before the last one, each rounded up, and the last one's
  // window.
  const auto grouped = [groups](VkDeviceSize bytes, VkDeviceSize window) {
    return aligned(bytes + (groups - 1) * (aligned(1) - 1) + window);
  };
  return aligned(sizeof(shared::FrameConstants)) + aligned(materials * sizeof(shared::MaterialConstants)) +
         aligned(materials * sizeof(shared::KernelConstants)) +
         grouped(lights * sizeof(shared::LightConstants), kLightWindow) +
         grouped(maps * sizeof(shared::ShadowConstants), kShadowWindow) +
         grouped(maps * sizeof(shared::GatherMapConstants), kGatherMapWindow) +
         grouped(maps * sizeof(shared::EntryMapConstants), kEntryMapWindow) +
         aligned(sizeof(shared::BlockLists) + listWords(PELLUCID_LISTED_BLOCKS, maps) * sizeof(uint32_t));
}

// ---- Bytes

static_assert(PELLUCID_SHADER_LIGHT_DIRECTIONAL == PELLUCID_LIGHT_DIRECTIONAL);
static_assert(PELLUCID_SHADER_LIGHT_SPOT == PELLUCID_LIGHT_SPOT);
static_assert(PELLUCID_SHADER_DEPTH_DEVICE == PELLUCID_DEPTH_DEVICE);
static_assert(PELLUCID_SHADER_DEPTH_VIEW_Z == PELLUCID_DEPTH_VIEW_Z);
static_assert(PELLUCID_SHADER_DEPTH_DISTANCE == PELLUCID_DEPTH_DISTANCE);
static_assert(PELLUCID_SHADER_ANGLE_NORMAL == PELLUCID_ANGLE_NORMAL);
static_assert(PELLUCID_SHADER_ANGLE_COSINE == PELLUCID_ANGLE_COSINE);
static_assert(PELLUCID_SHADER_ANGLE_INVERSE_COSINE == PELLUCID_ANGLE_INVERSE_COSINE);
static_assert(PELLUCID_SHADER_ANGLE_POLYNOMIAL == PELLUCID_ANGLE_POLYNOMIAL);
static_assert(PELLUCID_SHADER_DEBUG_THICKNESS == PELLUCID_DEBUG_THICKNESS);
static_assert(PELLUCID_SHADER_DEBUG_TRANSMITTANCE == PELLUCID_DEBUG_TRANSMITTANCE);
static_assert(PELLUCID_SHADER_DEBUG_OCCLUSION == PELLUCID_DEBUG_OCCLUSION);
static_assert(PELLUCID_CONSTANT_LIGHT_TABLES == PELLUCID_SPECIALIZATION_LIGHT_TABLES);
static_assert(PELLUCID_CONSTANT_USES == PELLUCID_SPECIALIZATION_USES);
static_assert(PELLUCID_SHADER_USE_THIN_WALLS == PELLUCID_USE_THIN_WALLS);
static_assert(PELLUCID_SHADER_USE_AMBIENT == PELLUCID_USE_AMBIENT);
static_assert(PELLUCID_SHADER_USE_THESIS == PELLUCID_USE_THESIS);
static_assert(PELLUCID_LIGHT_TABLES == PELLUCID_MAX_LIGHT_TABLES);
static_assert(PELLUCID_LIGHT_ENTRIES == PELLUCID_LIGHT_TABLE_ENTRIES);
static_assert(PELLUCID_GAUSSIANS == PELLUCID_MAX_GAUSSIANS);
static_assert(PELLUCID_MAX_LIGHT_SHADOW_MAPS <= PELLUCID_SHADOW_IMAGE_COUNT);

glm::vec4 rgb(const float (&v)[3], float w = 0) { return {v[0], v[1], v[2], w}; }

// Per channel the form whose value at (n, 1) is the irradiance, times pre-exposure, of a face of normal n in
// view space. Ramamoorthi & Hanrahan 2001, equations 11 and 12.
std::array<glm::mat4, 3> ambientIrradiance(const Setup& setup) {
  std::array<glm::mat4, 3> result{};
  if (!setup.frame.options.ambient) return result;
  constexpr double c1 = 0.42904276540489, c2 = 0.51166335397324, c3 = 0.74312386836844, c4 = 0.88622692545276,
                   c5 = 0.24770795612281;
  const glm::dmat4 rotation(glm::dmat3(setup.viewFromWorld));
  for (size_t c = 0; c < 3; ++c) {
    double l[9];
    for (size_t i = 0; i < 9; ++i)
      l[i] = static_cast<double>(setup.frame.options.ambient[3 * i + c]) *
             static_cast<double>(setup.frame.preExposure);
    const glm::dmat4 world(c1 * l[8], c1 * l[4], c1 * l[7], c2 * l[3],   //
                           c1 * l[4], -c1 * l[8], c1 * l[5], c2 * l[1],  //
                           c1 * l[7], c1 * l[5], c3 * l[6], c2 * l[2],   //
                           c2 * l[3], c2 * l[1], c2 * l[2], c4 * l[0] - c5 * l[6]);
    result[c] = glm::mat4(rotation * world * glm::transpose(rotation));
  }
  return result;
}

// As of probe_light.glsl.
int patternOfCell(glm::ivec2 cell) {
  constexpr int kCount = PELLUCID_PATTERNS;
  const int pattern = (cell.x % kCount + PELLUCID_PATTERNS_A_ROW * (cell.y % kCount)) % kCount;
  return pattern < 0 ? pattern + kCount : pattern;
}

shared::FrameConstants frameConstants(const FrameFacts& facts, const PlanState& state) {
  const PellucidFrame& f = facts.frame;
  shared::FrameConstants c{};
  c.camera = facts.camera;
  const shared::Camera& camera = c.camera;
  const auto along = [](const glm::vec4& ray) {
    const glm::vec2 step = glm::vec2(ray.x + ray.z, ray.y + ray.w);  // at distance 1, as anywhere
    return glm::length(step) > 0 ? glm::normalize(step) : glm::vec2(0);
  };
  const glm::vec2 column = along(camera.rayX), row = along(camera.rayY);
  const auto facing = [&](const glm::vec4& ray) {
    return glm::vec2(glm::dot(glm::vec2(ray.x, ray.y), column), glm::dot(glm::vec2(ray.x, ray.y), row));
  };
  c.facingRay[0] = {facing(camera.rayBase), facing(camera.rayX)};
  c.facingRay[1] = {facing(camera.rayY), 0, 0};
  c.axes = {column, row};
  const std::array<glm::mat4, 3> ambient = ambientIrradiance(facts);
  std::copy(ambient.begin(), ambient.end(), c.ambient);
  const Rect& r = facts.rect;
  c.rect = {r.x, r.y, r.x + r.width, r.y + r.height};
  c.lattice = {facts.lattice.first, patternOfCell(facts.lattice.period / static_cast<int>(facts.gatherSpacing)), 0};
  if (facts.stages.accumulates) {
    // Frames by turns have the upper and the lower half, and each cell takes all patterns in as many frames.
    const int half = static_cast<int>(parts(facts.lattice.extent.y, facts.gatherSpacing));
    const int age = static_cast<int>(state.history.age % (2 * PELLUCID_PATTERNS)), odd = age % 2;
    constexpr int kPatternStep = 50;  // turns then step by .28 of a turn, and places in a ring by .39 of the ring
    c.lattice.z = (c.lattice.z + kPatternStep * age) % PELLUCID_PATTERNS;
    c.lattice.w = odd * half;
    c.kept = {state.kept.first[0], state.kept.first[1], (1 - odd) * half, 0};
    c.motion = {f.options.motionScale[0] * static_cast<float>(f.imageExtent[0]),
                f.options.motionScale[1] * static_cast<float>(f.imageExtent[1]),
                state.kept.valid != 0 ? f.preExposure / state.kept.preExposure : 0, 0};
  }
  const PellucidThesisOptions& t = facts.thesis;
  uint32_t flags = 0;
  for (const ImageField& image : kImageFields)
    if (given(f.*image.field)) flags |= image.flag;
  if (f.options.frontDepthEncoding == PELLUCID_DEPTH_VIEW_Z) flags |= PELLUCID_FLAG_FRONT_VIEW_Z;
  if (f.options.backDepthEncoding == PELLUCID_DEPTH_VIEW_Z) flags |= PELLUCID_FLAG_BACK_VIEW_Z;
  if (f.options.backDepthEncoding == PELLUCID_DEPTH_THICKNESS) flags |= PELLUCID_FLAG_BACK_THICKNESS;
  if (f.options.cameraThickness == 1) flags |= PELLUCID_FLAG_CAMERA_THICKNESS;
  if (t.constantViewDirection) flags |= PELLUCID_FLAG_CONSTANT_VIEW;
  if (t.chordThickness) flags |= PELLUCID_FLAG_CHORD_THICKNESS;
  if (facts.lights.needsChord) flags |= PELLUCID_FLAG_CHORD;
  if (facts.diffuses) flags |= PELLUCID_FLAG_DIFFUSED;
  if (facts.diffuses && facts.stages.gathered > 0) flags |= PELLUCID_FLAG_BODIES;
  if (facts.wide) flags |= PELLUCID_FLAG_WIDE_OUTPUT;
  if (f.options.outputFormat == VK_FORMAT_B10G11R11_UFLOAT_PACK32) flags |= PELLUCID_FLAG_PACKED_OUTPUT;
  if (f.options.addToOutput == 1) flags |= PELLUCID_FLAG_ADDS;
  if (facts.thinWalls) flags |= PELLUCID_FLAG_THIN_WALLS;
  c.flags = {flags, f.materialCount, f.options.debugView, t.angleModel};
  const float* p = t.anglePolynomial;
  c.anglePolynomial = {p[0], p[1], p[2], p[3]};
  c.marks = {t.materialMarkBit, f.options.materialShift, facts.materialBits() & ~t.materialMarkBit, 0};
  c.filterAndLimit = rgb(t.transmittanceFilter, t.maximumThickness > 0 ? t.maximumThickness : INFINITY);
  for (uint32_t level = kFirstLevel; level <= PELLUCID_LAST_LEVEL; ++level) {
    const PyramidPlace& place = facts.pyramid.levels[level];
    c.level[level] = {place.column - place.rect.x, -place.rect.y, 0, 0};
  }
  const PyramidPlace& second = facts.pyramid.levels[2];
  c.level[0] = {-second.rect.x, -second.rect.y, facts.pyramid.sharesColumn - second.rect.x, -second.rect.y};
  const Blocks& blocks = facts.blocks;
  c.blocks = {blocks.columns, blocks.rows, blocks.listWord(), facts.stages.lists};
  return c;
}

glm::dvec3 travel(const PellucidLight& l) { return glm::normalize(toVector(l.direction)); }

shared::LightConstants lightConstants(const FrameFacts& f, const PellucidLight& l, uint32_t firstShadow) {
  const glm::dmat4& viewFromWorld = f.viewFromWorld;
  shared::LightConstants c{};
  c.meta = {l.type, firstShadow, l.shadowMapCount, f.holdsBackFaces(l) ? 1 : 0};
  if (isAmbient(l)) return c;
  // Below the largest float, as light at a point has it in the shaders.
  for (int i = 0; i < 3; ++i)
    c.radiance[i] = static_cast<float>(
        std::min(static_cast<double>(l.color[i]) * l.intensity * f.frame.preExposure, 1e30));
  if (l.type != PELLUCID_LIGHT_DIRECTIONAL) {
    const glm::dvec4 position(l.position[0], l.position[1], l.position[2], 1);
    c.position = glm::vec4(glm::vec3(viewFromWorld * position), l.range > 0 ? 1 / l.range : 0);
  }
  if (hasDirection(l)) c.direction = glm::vec4(glm::dmat3(viewFromWorld) * travel(l), 0);
  if (l.distanceTable > 0) std::swap(c.position.w, c.direction.w);
  c.radiance.w = static_cast<float>(l.angleTable * (PELLUCID_LIGHT_TABLES + 1) + l.distanceTable);
  if (l.type == PELLUCID_LIGHT_SPOT) {
    // KHR_lights_punctual, "Inner and Outer Cone Angles". Its guard of .001 would darken spots of less than 2.6 degrees.
    const double inner = std::cos(static_cast<double>(l.innerConeAngle));
    const double outer = std::cos(static_cast<double>(l.outerConeAngle));
    const double scale = 1 / std::max(1e-6, inner - outer);
    c.cone.x = static_cast<float>(scale);
    c.cone.y = static_cast<float>(-outer * scale);
  }
  // A light whose minimum dot is -1 was skipped: nothing comes through, and the quotient would be 0/0.
  const double m = f.minimumDot(l);
  c.cone.z = static_cast<float>(m > -1 ? 1 / (m + 1) : 0);
  c.cone.w = static_cast<float>(m > -1 ? m / (m + 1) : 0);
  return c;
}

uint32_t bitsOf(float value) {
  uint32_t bits;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

// The map's layer of an image, as the shaders' shadowTexel takes them.
uint32_t placeOf(const LightGroup& group, const PellucidShadowMap& map, uint32_t image) {
  return group.slot(image) | map.options.layer << 8;
}

glm::uvec4 occluderConstants(const FrameFacts& f, const PellucidShadowMap& s, const PellucidLight& l,
                             const LightGroup& group) {
  const float scale = s.options.casterMaterialScale == 0 ? 255.0f : s.options.casterMaterialScale;
  return {group.readsExit(f, l, s) ? placeOf(group, s, s.options.exitImage - 1) + 1 : 0,
          group.readsCaster(s) ? placeOf(group, s, s.options.casterMaterialImage - 1) + 1 : 0, bitsOf(scale),
          s.options.offset[0] | s.options.offset[1] << 16};
}

shared::ShadowConstants shadowConstants(const FrameFacts& f, const PellucidShadowMap& s,
                                        const PellucidLight& l, const glm::dmat4& worldFromView,
                                        const LightGroup& group) {
  shared::ShadowConstants c{};
  const glm::dmat4 clipFromWorld = toMatrix(s.clipFromWorld);
  c.clipFromView = glm::mat4(clipFromWorld * worldFromView);
  const bool perspective = l.type != PELLUCID_LIGHT_DIRECTIONAL;
  // The distance from a directional light is measured like its planar depth.
  const uint32_t encoding = !perspective && s.encoding == PELLUCID_DEPTH_DISTANCE
                                ? static_cast<uint32_t>(PELLUCID_DEPTH_VIEW_Z)
                                : s.encoding;
  const glm::dvec4 zRow(clipFromWorld[0][2], clipFromWorld[1][2], clipFromWorld[2][2], clipFromWorld[3][2]);
  double depthScale = 1;
  if (encoding == PELLUCID_DEPTH_VIEW_Z) {
    const glm::dmat4 planar = toMatrix(s.options.viewFromWorld) * worldFromView;
    c.planar = -glm::vec4(planar[0][2], planar[1][2], planar[2][2], planar[3][2]);
    if (!perspective) {
      const glm::dmat4 view = toMatrix(s.options.viewFromWorld);
      depthScale = 1 / -glm::dot(glm::dvec3(view[0][2], view[1][2], view[2][2]), travel(l));
    }
  } else if (perspective) {
    depthScale = glm::dot(zRow, glm::dvec4(l.position[0], l.position[1], l.position[2], 1));
  } else {
    depthScale = 1 / glm::dot(glm::dvec3(zRow), travel(l));
  }
  c.depth = {static_cast<float>(depthScale), static_cast<float>(texelSide(s)),
             static_cast<float>(s.extent[0]), static_cast<float>(s.extent[1])};
  c.offsets = {s.options.depthBiasConstant, s.options.depthBiasSlope, s.options.offsetLength,
               s.options.depthStep};
  // A cleared device-depth map holds its far plane: depth grows away from the light, or is reversed.
  const bool forward = perspective ? depthScale < 0 : depthScale > 0;
  c.meta = {placeOf(group, s, s.image), encoding, perspective ? 1u : 0u, bitsOf(forward ? 1.0f : 0.0f)};
  c.occluder = occluderConstants(f, s, l, group);
  return c;
}

shared::MaterialConstants materialConstants(const FrameFacts& f, const PellucidMaterial& m, shared::MaterialConstants c) {
  if (!f.gathers && !(f.lights.ambient.intensity > 0)) c.gather = {};
  if (!f.stages.lights) c.inverseReflectance.w = c.transmittance4.w = 0;  // of one thickness a pixel
  // Without diffusion nothing of it is corrected.
  if (f.diffusedCount(m) == 0) {
    c.gather.body = glm::vec4(0);
    c.gather.profile = glm::vec4(0, 0, 0, c.gather.profile.w);
  }
  return c;
}

template <class T>
void put(void* slice, VkDeviceSize offset, const T& value) {
  std::memcpy(static_cast<char*>(slice) + offset, &value, sizeof value);
}

void putLightTables(const FrameFacts& f, void* mapped) {
  for (uint32_t table = 0; table < f.frame.options.lightTableCount; ++table) {
    std::array<uint32_t, PELLUCID_LIGHT_ENTRIES / 2> halves;
    const float* factor = f.frame.options.lightTables[table].factor;
    for (size_t i = 0; i < halves.size(); ++i)
      halves[i] = glm::packHalf2x16({factor[2 * i], factor[2 * i + 1]});
    put(mapped, f.constants.frame + offsetof(shared::FrameConstants, lightTables) + table * sizeof halves,
        halves);
  }
}

// Lights, their shadow maps and what the gather knows of these.
void putLights(const FrameFacts& f, void* mapped) {
  const ConstantsLayout& layout = f.constants;
  const glm::dmat4 worldFromView = glm::inverse(f.viewFromWorld);
  for (const LightGroup& group : f.lights.list()) {
    uint32_t shadow = 0, row = 0;  // of the group, so far
    for (uint32_t i = 0; i < group.lightCount; ++i) {
      const PellucidLight& l = f.light(group.firstLight + i);
      put(mapped, layout.lights + group.lightBytes + i * sizeof(shared::LightConstants),
          lightConstants(f, l, shadow));
      for (uint32_t k = 0; k < l.shadowMapCount; ++k, ++shadow) {
        const PellucidShadowMap& s = f.frame.shadowMaps[l.firstShadowMap + k];
        const shared::ShadowConstants constants = shadowConstants(f, s, l, worldFromView, group);
        put(mapped, layout.shadows + group.shadowBytes + shadow * sizeof constants, constants);
        if (!f.isGathered(l)) continue;
        const EntryExtent extent = entryExtent(f, l, k);
        const EntryConstants entry = entryConstants(s, l, constants, f.viewFromWorld, extent, row, i);
        row += wholeGroups(extent.height);
        put(mapped, layout.gatherMaps + group.gatherMapBytes + shadow * sizeof entry.gather, entry.gather);
        put(mapped, layout.entryMaps + group.entryMapBytes + shadow * sizeof entry.map, entry.map);
      }
    }
  }
}

// The lists are empty, and their commands have the groups of the plan's dispatches. `reach`: of probes, mm.
shared::BlockLists blockLists(const FrameFacts& f, const PellucidPlan& plan, float reach) {
  shared::BlockLists c{};
  c.maps = {f.blocks.maps, f.gatherSpacing, 0, 0};
  c.reach.x = reach / (1000 * f.frame.metersPerUnit);
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (!d.indirect) continue;
    const VkDeviceSize list = (d.indirectOffset - f.constants.lists) / sizeof(shared::ListCommand);
    // A plan of another frame may have them anywhere.
    if (list < PELLUCID_LISTS) c.commands[list].groups = {0, d.groups[1], d.groups[2], d.groups[0]};
  }
  return c;
}

PellucidResult writeConstants(const FrameFacts& f, const PellucidPlan& plan, void* mapped, size_t size) {
  const ConstantsLayout& layout = f.constants;
  if (layout.size != plan.constantsSize || f.lights.lightCount != plan.activeLights)
    return PELLUCID_ERROR_INVALID_ARGUMENT;
  if (size < layout.size) return PELLUCID_ERROR_BUFFER_TOO_SMALL;

  // Windows and lists are longer than what the shaders read of them, which is written.
  put(mapped, layout.frame, frameConstants(f, stateOf(plan)));
  putLightTables(f, mapped);
  putLights(f, mapped);
  float reach = 0;
  for (uint32_t i = 0; i < f.frame.materialCount; ++i) {
    const PellucidMaterial& m = f.frame.materials[i];
    MaterialTables tables = tablesOf(m);
    if (f.gathers && m.thinWalled == 0)
      reach = std::max(reach, gatherReach(tables.constants.gather, f.gatherSamples));
    put(mapped, layout.materials + i * sizeof(shared::MaterialConstants), materialConstants(f, m, tables.constants));
    if (f.diffusedCount(m) == 0) tables.kernel = {};
    put(mapped, layout.kernels + i * sizeof(shared::KernelConstants), tables.kernel);
  }
  if (f.stages.diffusion) {
    put(mapped, layout.lists, blockLists(f, plan, reach));
    std::memset(static_cast<char*>(mapped) + layout.lists + sizeof(shared::BlockLists), 0, f.blocks.listWords() * sizeof(uint32_t));
  }
  return PELLUCID_OK;
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame,
                                                 void* mapped, size_t size) {
  if (!plan || !mapped) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Findings silent;
  const auto facts = readFrame(frame, silent);
  return facts ? writeConstants(*facts, *plan, mapped, size) : silent.result();
}

extern "C" VkDeviceSize pellucidGetConstantsSize(uint32_t materialCount, uint32_t lightCount,
                                                 uint32_t shadowMapCount) {
  // Ambient light is one more.
  return mostConstants(materialCount, VkDeviceSize{lightCount} + 1, shadowMapCount);
}
