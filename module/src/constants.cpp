// The bytes of the constants slice: frame, lights, shadow maps, materials, kernels.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "constants.h"
#include "domains.h"
#include "entry_points.h"
#include "gather.h"
#include "material_tables.h"
#include "minimum_dot.h"
#include "shadow_map.h"
#include "transmittance.h"

namespace pellucid {
namespace {

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
static_assert(PELLUCID_SHADER_NORMALS_SNORM == PELLUCID_NORMALS_SNORM);
static_assert(PELLUCID_SHADER_NORMALS_UNORM == PELLUCID_NORMALS_UNORM);
static_assert(PELLUCID_SHADER_NORMALS_OCTAHEDRAL == PELLUCID_NORMALS_OCTAHEDRAL);
static_assert(PELLUCID_SHADER_NORMALS_OCTAHEDRAL_UNORM == PELLUCID_NORMALS_OCTAHEDRAL_UNORM);
static_assert(PELLUCID_CONSTANT_NORMALS == PELLUCID_SPECIALIZATION_NORMALS);
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

shared::FrameConstants frameConstants(const FrameFacts& facts) {
  const PellucidFrame& f = facts.frame;
  shared::FrameConstants c{};
  c.camera = facts.camera;
  c.viewFromNormal = f.options.normalsInViewSpace ? glm::mat4(1) : glm::mat4(glm::mat3(facts.viewFromWorld));
  const glm::mat3 normalFromView = glm::transpose(glm::mat3(c.viewFromNormal));
  const shared::Camera& camera = c.camera;
  c.normalRay[0] = {normalFromView * glm::vec3(camera.rayBase.x, camera.rayBase.y, camera.range.x), 0};
  c.normalRay[1] = {normalFromView * glm::vec3(camera.rayX.x, camera.rayX.y, 0), 0};
  c.normalRay[2] = {normalFromView * glm::vec3(camera.rayY.x, camera.rayY.y, 0), 0};
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
  const std::array<glm::mat4, 3> ambient = ambientIrradiance(facts, facts);
  std::copy(ambient.begin(), ambient.end(), c.ambient);
  const Rect& r = facts.rect;
  c.rect = {r.x, r.y, r.x + r.width, r.y + r.height};
  const PellucidThesisOptions& t = facts.thesis;
  uint32_t flags = 0;
  for (const ImageField& image : kImageFields)
    if (given(f.*image.field)) flags |= image.flag;
  if (f.options.frontDepthEncoding == PELLUCID_DEPTH_VIEW_Z) flags |= PELLUCID_FLAG_FRONT_VIEW_Z;
  if (f.options.backDepthEncoding == PELLUCID_DEPTH_VIEW_Z) flags |= PELLUCID_FLAG_BACK_VIEW_Z;
  if (f.options.cameraThickness == 1) flags |= PELLUCID_FLAG_CAMERA_THICKNESS;
  if (t.constantViewDirection) flags |= PELLUCID_FLAG_CONSTANT_VIEW;
  if (t.chordThickness) flags |= PELLUCID_FLAG_CHORD_THICKNESS;
  if (facts.lights.needsChord) flags |= PELLUCID_FLAG_CHORD;
  if (facts.diffuses) flags |= PELLUCID_FLAG_DIFFUSED;
  if (facts.diffuses && facts.stages.gathered > 0) flags |= PELLUCID_FLAG_BODIES;
  if (facts.wide) flags |= PELLUCID_FLAG_WIDE_OUTPUT;
  if (f.options.addToOutput == 1) flags |= PELLUCID_FLAG_ADDS;
  if (facts.thinWalls) flags |= PELLUCID_FLAG_THIN_WALLS;
  c.flags = {flags, f.materialCount, f.options.debugView, t.angleModel};
  const float* p = t.anglePolynomial;
  c.anglePolynomial = {p[0], p[1], p[2], p[3]};
  c.marks = {t.materialMarkBit, f.options.materialShift, facts.materialBits() & ~t.materialMarkBit, 0};
  c.filterAndLimit = rgb(t.transmittanceFilter, t.maximumThickness > 0 ? t.maximumThickness : INFINITY);
  for (uint32_t level = kFirstLevel; level <= PELLUCID_LAST_LEVEL; ++level) {
    const PyramidPlace& place = facts.pyramid.levels[level];
    c.level[level] = {place.x - place.rect.x, place.y - place.rect.y, 0, 0};
  }
  const PyramidPlace& second = facts.pyramid.levels[2];
  c.level[0] = {-second.rect.x, -second.rect.y, facts.pyramid.sharesColumn - second.rect.x, -second.rect.y};
  const Blocks& blocks = facts.blocks;
  c.blocks = {blocks.columns, blocks.rows, blocks.listWord(), facts.stages.lists};
  return c;
}

glm::dvec3 travel(const PellucidLight& l) {
  return glm::normalize(glm::dvec3(l.direction[0], l.direction[1], l.direction[2]));
}

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
    // KHR_lights_punctual, "Inner and Outer Cone Angles"; 0.001 is its own guard.
    const double inner = std::cos(static_cast<double>(l.innerConeAngle));
    const double outer = std::cos(static_cast<double>(l.outerConeAngle));
    const double scale = 1 / std::max(0.001, inner - outer);
    c.cone.x = static_cast<float>(scale);
    c.cone.y = static_cast<float>(-outer * scale);
  }
  // A light whose minimum dot is -1 was skipped: nothing comes through, and the quotient would be 0/0.
  const double m = minimumDotOf(f.thesis, l);
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
  return {group.readsExit(f, f, l, s) ? placeOf(group, s, s.options.exitImage - 1) + 1 : 0,
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

shared::MaterialConstants materialConstants(const FrameFacts& f, const MaterialTables& tables) {
  const PellucidMaterial& m = tables.material;
  shared::MaterialConstants c{};
  c.meta = {m.transmittanceModel, m.gaussianCount, m.thinWalled, 0};
  const auto exponent = static_cast<float>(gaussianExponent(m.transmittanceModel));
  const bool canGather = canBeGathered(m.transmittanceModel) && m.thinWalled == 0;
  if (f.gathers || f.lights.ambient.intensity > 0) c.gather = tables.gather;
  // Without diffusion nothing of it is corrected.
  if (f.diffusedCount(m) == 0) {
    c.gather.body = glm::vec4(0);
    c.gather.profile = glm::vec4(0, 0, 0, c.gather.profile.w);
  }
  // From other models the ambient light takes nothing from visible faces.
  for (glm::vec4& reflectance : c.gather.reflectance)
    if (!canGather) reflectance.x = 1;
  if (f.stages.lights) {  // one thickness a pixel
    c.inverseReflectance.w = static_cast<float>(1 / static_cast<double>(tables.halfThickness));
    c.transmittance4.w = tables.opaqueThickness;
  }
  for (int channel = 0; channel < 3; ++channel) {
    const std::array<float, 5> t = shaderParameters(m, channel);
    c.transmittance[channel] = {t[0], t[1], t[2], t[3]};
    c.transmittance4[channel] = t[4];
    c.inverseReflectance[channel] = 1 / m.reflectance[channel];
    for (uint32_t i = 0; i < m.gaussianCount; ++i) {
      c.gaussianFalloff[i][channel] = exponent / m.gaussianVariance[channel][i];
      c.gaussianWeight[i][channel] = m.gaussianWeight[channel][i];
    }
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
    put(mapped,
        f.constants.frame.offset + offsetof(shared::FrameConstants, lightTables) + table * sizeof halves,
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
      put(mapped, layout.lights.offset + group.lightBytes + i * sizeof(shared::LightConstants),
          lightConstants(f, l, shadow));
      for (uint32_t k = 0; k < l.shadowMapCount; ++k, ++shadow) {
        const PellucidShadowMap& s = f.frame.shadowMaps[l.firstShadowMap + k];
        const shared::ShadowConstants constants = shadowConstants(f, s, l, worldFromView, group);
        put(mapped, layout.shadows.offset + group.shadowBytes + shadow * sizeof constants, constants);
        if (!f.isGathered(l)) continue;
        const EntryExtent extent = entryExtent(f, f, l, k);
        const EntryConstants entry = entryConstants(s, l, constants, f.viewFromWorld, extent, row, i);
        row += entryGroups(extent.height);
        put(mapped, layout.gatherMaps.offset + group.gatherMapBytes + shadow * sizeof entry.gather,
            entry.gather);
        put(mapped, layout.entryMaps.offset + group.entryMapBytes + shadow * sizeof entry.map, entry.map);
      }
    }
  }
}

// The lists are empty, and their commands have the groups of the plan's dispatches. `reach`: of probes, mm.
shared::BlockLists blockLists(const FrameFacts& f, const PellucidPlan& plan, float reach) {
  shared::BlockLists c{};
  c.maps.x = f.blocks.maps;
  c.reach.x = reach / (1000 * f.frame.metersPerUnit);
  for (uint32_t i = 0; i < plan.dispatchCount; ++i) {
    const PellucidDispatch& d = plan.dispatches[i];
    if (!d.indirect) continue;
    const VkDeviceSize list = (d.indirectOffset - f.constants.lists.offset) / sizeof(glm::uvec4);
    // A plan of another frame may have them anywhere.
    if (list < PELLUCID_LISTS) c.commands[list] = {0, d.groups[1], d.groups[2], d.groups[0]};
  }
  return c;
}

}  // namespace

PellucidResult writeConstants(const FrameFacts& f, const PellucidPlan& plan, void* mapped, size_t size) {
  const ConstantsLayout& layout = f.constants;
  if (layout.size != plan.constantsSize || f.lights.lightCount != plan.activeLights)
    return PELLUCID_ERROR_INVALID_ARGUMENT;
  if (size < layout.size) return PELLUCID_ERROR_BUFFER_TOO_SMALL;

  // Windows and lists are longer than what the shaders read of them, which is written.
  put(mapped, layout.frame.offset, frameConstants(f));
  putLightTables(f, mapped);
  putLights(f, mapped);
  float reach = 0;
  for (uint32_t i = 0; i < f.frame.materialCount; ++i) {
    MaterialTables tables;
    if (f.frame.options.materialTables)
      std::memcpy(&tables, f.frame.options.materialTables[i].words, sizeof tables);
    else
      makeTables(f.material(i), &tables);
    put(mapped, layout.materials.offset + i * sizeof(shared::MaterialConstants),
        materialConstants(f, tables));
    if (f.diffusedCount(tables.material) == 0) tables.kernel = {};
    put(mapped, layout.kernels.offset + i * sizeof(shared::KernelConstants), tables.kernel);
    if (f.gathers && tables.material.thinWalled == 0)
      reach = std::max(reach, gatherReach(tables.gather, f.gatherSamples));
  }
  if (f.stages.diffusion) put(mapped, layout.lists.offset, blockLists(f, plan, reach));
  return PELLUCID_OK;
}

}  // namespace pellucid

using namespace pellucid;

extern "C" PellucidResult pellucidWriteConstants(const PellucidPlan* plan, const PellucidFrame* frame,
                                                 void* mapped, size_t size) {
  if (!plan || !mapped) return PELLUCID_ERROR_INVALID_ARGUMENT;
  Findings silent(nullptr, nullptr);
  return readFrame(frame, silent,
                   [&](const FrameFacts& facts) { return writeConstants(facts, *plan, mapped, size); });
}
