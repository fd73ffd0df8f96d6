// Checks of lights and their shadow maps: the errors of each, and warnings of what a picture would show.
#include <algorithm>
#include <cmath>

#include "domains.h"
#include "entry_points.h"
#include "frame.h"
#include "material/transmittance.h"

namespace pellucid {
namespace {

constexpr uint32_t kMostTexels = 65536;

constexpr double kRadian = 57.29577951308232;  // degrees
// Most degrees between a light and a map, or between both matrices of a map. Beyond, light comes from where it does not: a warning, as
// engines draw maps of a moving sun now and then. A wrong axis or sign is farther off.
constexpr double kMostDegrees = 5, kWrongAxis = 30;

// Row of a matrix without its translation.
glm::dvec3 rowOf(const glm::dmat4& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }

// 0 where a vector is 0.
double degreesBetween(const glm::dvec3& a, const glm::dvec3& b) {
  const double lengths = glm::length(a) * glm::length(b);
  return lengths > 0 ? kRadian * std::acos(std::clamp(glm::dot(a, b) / lengths, -1.0, 1.0)) : 0;
}

double degreesBetweenLines(const glm::dvec3& a, const glm::dvec3& b) {
  const double degrees = degreesBetween(a, b);
  return std::min(degrees, 180 - degrees);
}

// Refuses constant factors and numbers of steps that the caller has not turned into device depths.
void checkDeviceSteps(const PellucidShadowMap& s, const auto& field, Findings& out) {
  constexpr float kMostBias = 0.5F, kMostStep = 0.1F;  // of depths from 0 to 1; a step of 8 bits is .004
  if (s.encoding != PELLUCID_DEPTH_DEVICE) return;
  if (std::abs(s.options.depthBiasConstant) > kMostBias)
    out.error(field("options.depthBiasConstant"), "is ", s.options.depthBiasConstant,
              ", over half of the range of device depths; needs the constant factor times 2^-16 (D16) or 2^-24");
  if (s.options.depthStep > kMostStep)
    out.error(field("options.depthStep"), "is ", s.options.depthStep, "; needs the smallest difference of device depths, as 1/65535");
}

void checkShadowMap(const PellucidFrame& f, uint32_t index, Findings& out) {
  const PellucidShadowMap& s = f.shadowMaps[index];
  const auto field = [index](const char* name) { return Field("shadowMaps[", index, "].", name); };
  if (s.image >= f.shadowImageCount)
    out.error(field("image"), "is ", s.image, ", but there are ", f.shadowImageCount, " shadowImages");
  checkDomains(s, field(""), out);
  for (int i = 0; i < 2; ++i)
    if (s.options.offset[i] <= kMostTexels && s.extent[i] <= kMostTexels &&
        s.options.offset[i] + s.extent[i] > kMostTexels)
      out.error(field("options.offset"), "[", i, "] is ", s.options.offset[i], " with an extent of ",
                s.extent[i], "; the tile must end within ", kMostTexels, " texels");
  if (glm::determinant(toMatrix(s.clipFromWorld)) == 0)
    out.error(field("clipFromWorld"), "cannot be inverted");
  if (s.encoding != PELLUCID_DEPTH_DEVICE && !isRigid(toMatrix(s.options.viewFromWorld)))
    out.error(field("options.viewFromWorld"), "is not a rotation and translation, which this encoding needs");
  checkDeviceSteps(s, field, out);
  // A distance from the light has no axis.
  if (s.encoding == PELLUCID_DEPTH_VIEW_Z || (s.encoding == PELLUCID_DEPTH_DISTANCE && !isPerspective(s))) {
    // Depth grows along the view's z: device depth does in orthographic maps, clip w in perspective ones.
    const glm::dmat4 clip = toMatrix(s.clipFromWorld);
    const glm::dvec3 ahead = -rowOf(toMatrix(s.options.viewFromWorld), 2);
    const double apart = isPerspective(s) ? degreesBetween(ahead, rowOf(clip, 3)) : degreesBetweenLines(ahead, rowOf(clip, 2));
    if (apart > kMostDegrees)
      out.error(field("options.viewFromWorld"), "looks ", static_cast<float>(apart), " degrees off clipFromWorld: both belong to one camera at the light");
  }
  const auto checkBeside = [&](const char* name, uint32_t image) {
    if (image > f.shadowImageCount)
      out.error(field(name), "is ", image, " (an index plus 1), but there are ", f.shadowImageCount,
                " shadowImages");
    else if (image != 0 && image - 1 == s.image)
      out.error(field(name), "is ", image, " (an index plus 1), the map's own image");
  };
  checkBeside("options.exitImage", s.options.exitImage);
  checkBeside("options.casterMaterialImage", s.options.casterMaterialImage);
  if (s.options.exitImage != 0 && s.options.exitImage == s.options.casterMaterialImage)
    out.error(field("options.casterMaterialImage"), "is ", s.options.casterMaterialImage, ", the exitImage");
}

// All maps of a light hold the same faces.
void checkFaces(const PellucidFrame& f, uint32_t light, Findings& out) {
  const PellucidLight& l = f.lights[light];
  const PellucidShadowMap* maps = f.shadowMaps + l.firstShadowMap;
  for (uint32_t i = 1; i < l.shadowMapCount; ++i)
    if (maps[i].options.backFaces != maps[0].options.backFaces)
      out.error(Field("shadowMaps[", l.firstShadowMap + i, "].options.backFaces"), "is ",
                maps[i].options.backFaces, ", but that of the first map of lights[", light, "] is ",
                maps[0].options.backFaces);
}

// A light's own falloff.
void checkFalloff(const PellucidFrame& f, uint32_t index, Findings& out) {
  const PellucidLight& l = f.lights[index];
  const auto checkTable = [&](const char* name, uint32_t table) {
    const Field field("lights[", index, "].", name);
    if (table > f.options.lightTableCount)
      out.error(field, "is ", table, " (an index plus 1), but there are ", f.options.lightTableCount,
                " lightTables");
    else if (table > 0 && l.type == PELLUCID_LIGHT_DIRECTIONAL)
      out.error(field, "is ", table, ", but the light is directional");
  };
  checkTable("angleTable", l.angleTable);
  checkTable("distanceTable", l.distanceTable);
  if (l.distanceTable > 0 && l.range == 0)
    out.error(Field("lights[", index, "].range"), "is 0, but distanceTable is ", l.distanceTable);
}

// The light travels as its maps were drawn.
void checkDirection(const PellucidFrame& f, uint32_t index, Findings& out) {
  const PellucidLight& l = f.lights[index];
  if (l.type == PELLUCID_LIGHT_POINT || l.shadowMapCount == 0) return;
  const glm::dvec3 direction(l.direction[0], l.direction[1], l.direction[2]);
  bool seen = false;
  for (uint32_t i = l.firstShadowMap; i < l.firstShadowMap + l.shadowMapCount; ++i) {
    const PellucidShadowMap& s = f.shadowMaps[i];
    const glm::dmat4 clip = toMatrix(s.clipFromWorld);
    seen = seen || glm::dot(rowOf(clip, 3), direction) > 0;
    if (l.type != PELLUCID_LIGHT_DIRECTIONAL || isPerspective(s)) continue;
    // Clip x and y stay the same along a ray. A device depth may grow to either side.
    glm::dvec3 ray = glm::cross(rowOf(clip, 0), rowOf(clip, 1));
    double apart = degreesBetweenLines(ray, direction);
    if (s.encoding != PELLUCID_DEPTH_DEVICE && glm::dot(rowOf(toMatrix(s.options.viewFromWorld), 2), direction) > 0) apart = 180 - apart;
    const Field field("lights[", index, "].direction");
    if (apart > kWrongAxis)
      return out.error(field, "is ", static_cast<float>(apart), " degrees off the rays of shadowMaps[", i, "], by its matrices; light travels along direction");
    if (apart > kMostDegrees)
      out.warning(field, "is ", static_cast<float>(apart), " degrees off the rays of shadowMaps[", i, "], by its matrices: the map is of another moment");
  }
  if (l.type == PELLUCID_LIGHT_SPOT && !seen)
    out.error(Field("lights[", index, "].direction"), "points away from what the light's shadow maps show; light travels along direction");
}

void checkLight(const Setup& setup, uint32_t index, Findings& out) {
  const PellucidFrame& f = setup.frame;
  const PellucidLight& l = f.lights[index];
  const auto field = [index](const char* name) { return Field("lights[", index, "].", name); };
  checkDomains(l, field(""), out);
  if (l.type > PELLUCID_LIGHT_SPOT) return;
  const float length = std::hypot(l.direction[0], l.direction[1], l.direction[2]);
  if (hasDirection(l) && !(length > 0 && std::isfinite(length)))
    out.error(field("direction"), "has length ", length);
  checkFalloff(f, index, out);
  if (l.type == PELLUCID_LIGHT_SPOT &&
      !(l.innerConeAngle >= 0 && l.innerConeAngle < l.outerConeAngle && l.outerConeAngle <= 1.5707964f))
    out.error(field("outerConeAngle"), "is ", l.outerConeAngle, " with inner ", l.innerConeAngle,
              "; needs 0 <= inner < outer <= pi/2");
  if (l.shadowMapCount > PELLUCID_MAX_LIGHT_SHADOW_MAPS || l.firstShadowMap > f.shadowMapCount ||
      l.shadowMapCount > f.shadowMapCount - l.firstShadowMap) {
    out.error(field("shadowMapCount"), "is ", l.shadowMapCount, " from ", l.firstShadowMap, "; there are ",
              f.shadowMapCount, " and a light takes at most ",
              static_cast<int>(PELLUCID_MAX_LIGHT_SHADOW_MAPS));
    return;
  }
  checkFaces(f, index, out);
  LightGroup images;
  bool fits = true;
  for (uint32_t i = 0; i < l.shadowMapCount; ++i) {
    const PellucidShadowMap& s = f.shadowMaps[l.firstShadowMap + i];
    fits = fits && images.addImages(setup, l, s);
    const glm::dmat4 clip = toMatrix(s.clipFromWorld);
    const bool perspective = isPerspective(s);
    if (perspective == (l.type == PELLUCID_LIGHT_DIRECTIONAL))
      out.error(field("firstShadowMap"), "names a map with ",
                perspective ? "a perspective" : "an orthographic",
                perspective ? " clipFromWorld; draw a directional light's map again without the perspective (LiSPSM, trapezoid)"
                            : " clipFromWorld; draw the map of a point or spot light by a perspective from its position");
    else if (perspective) {
      const glm::dvec4 atLight = clip * glm::dvec4(l.position[0], l.position[1], l.position[2], 1);
      const double scale = std::abs(clip[0][3]) + std::abs(clip[1][3]) + std::abs(clip[2][3]);
      const double size = 1 + std::abs(l.position[0]) + std::abs(l.position[1]) + std::abs(l.position[2]);
      // 1e-4 of the light's distance from the origin: float matrices, not a different center.
      if (std::abs(atLight.w) > 1e-4 * scale * size)
        out.error(field("position"), "is not the center of its shadow map's projection; clip w there is ", atLight.w,
                  ". clipFromWorld is column-major");
    }
  }
  checkDirection(f, index, out);
  if (!fits)
    out.error(field("shadowMapCount"), "is ", l.shadowMapCount,
              ": their maps, exit depths and caster materials are more than the ",
              PELLUCID_SHADOW_IMAGE_COUNT, " images that a dispatch binds");
}

// Two lights may share a whole map.
bool overlap(const PellucidShadowMap& a, const PellucidShadowMap& b) {
  if (a.image != b.image || a.options.layer != b.options.layer) return false;
  for (int i = 0; i < 2; ++i)
    if (a.options.offset[i] + a.extent[i] <= b.options.offset[i] ||
        b.options.offset[i] + b.extent[i] <= a.options.offset[i])
      return false;
  return !std::equal(a.options.offset, a.options.offset + 2, b.options.offset) ||
         !std::equal(a.extent, a.extent + 2, b.extent) || !std::equal(a.clipFromWorld, a.clipFromWorld + 16, b.clipFromWorld);
}

void warnOfTiles(const PellucidFrame& f, Findings& out) {
  // Pairs: more maps than this would take longer than the frame.
  constexpr uint32_t kMostMaps = 1024;
  for (uint32_t i = 1; i < std::min(f.shadowMapCount, kMostMaps); ++i)
    for (uint32_t k = 0; k < i; ++k)
      if (overlap(f.shadowMaps[i], f.shadowMaps[k])) {
        out.warning(Field("shadowMaps[", i, "].options.offset"), "is ", f.shadowMaps[i].options.offset[0],
                    ", ", f.shadowMaps[i].options.offset[1], ": the tile overlaps that of shadowMaps[", k,
                    "] in the same image and layer");
        break;
      }
}

// Thickness and gather are resolved to a texel. A perspective map's texel depends on the distance.
void warnOfTexels(const FrameFacts& facts, uint32_t index, Findings& out) {
  constexpr float kMostLengths = 4;
  const PellucidFrame& f = facts.frame;
  const PellucidShadowMap& s = f.shadowMaps[index];
  if (isPerspective(s)) return;
  const double side = texelSide(s) * static_cast<double>(f.metersPerUnit) * 1000;
  for (uint32_t i = 0; i < f.materialCount; ++i) {
    const float length = diffusionLength(facts.frame.materials[i]);
    if (!(length > 0) || !(side > static_cast<double>(kMostLengths * length))) continue;
    out.warning(Field("shadowMaps[", index, "].extent"), "makes a texel ", static_cast<float>(side),
                " mm long, more than ", kMostLengths, " diffusion lengths of materials[", i, "], which are ",
                kMostLengths * length, " mm: thickness and gathered light are resolved to a texel");
    return;
  }
}

void warnOfShadowMaps(const FrameFacts& facts, Findings& out) {
  const PellucidFrame& f = facts.frame;
  warnOfTiles(f, out);
  for (uint32_t i = 0; i < std::min(facts.lights.lightCount, Lights::kMost); ++i) {
    const PellucidLight& l = facts.light(i);
    if (facts.holdsBackFaces(l))
      out.warning(Field("shadowMaps[", l.firstShadowMap, "].options.backFaces"), "is 1: lights[",
                  facts.lights.active[i], "] takes its thickness from backDepth and is not gathered; a map of front faces would be");
    for (uint32_t k = 0; k < l.shadowMapCount; ++k) {
      const uint32_t map = l.firstShadowMap + k;
      const PellucidShadowMap& s = f.shadowMaps[map];
      warnOfTexels(facts, map, out);
      if (s.options.depthBiasSlope != 0 && std::min(s.extent[0], s.extent[1]) < 2)
        out.warning(Field("shadowMaps[", map, "].options.depthBiasSlope"), "is ", s.options.depthBiasSlope,
                    ", but a tile of ", s.extent[0], " x ", s.extent[1],
                    " texels has no neighbors to take the slope from");
    }
  }
}

}  // namespace

void checkShadowMaps(const Inputs& inputs, Findings& out) {
  for (uint32_t i = 0; i < inputs.frame.shadowMapCount; ++i) checkShadowMap(inputs.frame, i, out);
}

void checkLights(const Setup& setup, Findings& out) {
  const PellucidFrame& f = setup.frame;
  for (uint32_t i = 0; i < f.lightCount; ++i) {
    checkLight(setup, i, out);
    const PellucidLight& l = f.lights[i];
    constexpr float kLargestHalf = 65504;
    const float arrives = l.intensity * std::max({l.color[0], l.color[1], l.color[2]}) * f.preExposure;
    if (l.type == PELLUCID_LIGHT_DIRECTIONAL && arrives > kLargestHalf)
      out.warning(Field("lights[", i, "].intensity"), "brings an irradiance of ", arrives,
                  " with preExposure ", f.preExposure, "; light above 65504 is cut");
  }
}

void checkGroups(const FrameFacts& facts, Findings& out) {
  const PellucidFrame& f = facts.frame;
  // Passes over blocks have a group for each, in x.
  constexpr uint32_t kMostBlocks = 65535;  // least maxComputeWorkGroupCount of devices
  if (facts.stages.diffusion && facts.blocks.count() > kMostBlocks)
    out.error("options.renderRect", "touches ", facts.blocks.count(), " blocks of ", PELLUCID_BLOCK, " x ", PELLUCID_BLOCK,
              " pixels; a dispatch has ", kMostBlocks, " groups at most: record parts");
  warnOfShadowMaps(facts, out);
  if (facts.lights.count > 1 && facts.debug() && f.options.debugView != PELLUCID_DEBUG_IRRADIANCE)
    out.error("options.debugView", "is ", f.options.debugView,
              ", which needs all lights in one dispatch; they use ", facts.lights.count);
}

}  // namespace pellucid
