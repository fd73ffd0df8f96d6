// Checks of shadow maps: the errors of each, and warnings of what a picture would show.
#include <algorithm>
#include <cmath>

#include "frame.h"
#include "shadow_map.h"
#include "validate.h"
#include "validate_shared.h"

namespace pellucid {
namespace {

constexpr uint32_t kMostTexels = 65536;

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
  if (finite(s.clipFromWorld, 16) && glm::determinant(toMatrix(s.clipFromWorld)) == 0)
    out.error(field("clipFromWorld"), "cannot be inverted");
  if (s.encoding != PELLUCID_DEPTH_DEVICE &&
      !(finite(s.options.viewFromWorld, 16) && rigid(toMatrix(s.options.viewFromWorld))))
    out.error(field("options.viewFromWorld"), "is not a rotation and translation, which this encoding needs");
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

bool overlap(const PellucidShadowMap& a, const PellucidShadowMap& b) {
  if (a.image != b.image || a.options.layer != b.options.layer) return false;
  for (int i = 0; i < 2; ++i)
    if (a.options.offset[i] + a.extent[i] <= b.options.offset[i] ||
        b.options.offset[i] + b.extent[i] <= a.options.offset[i])
      return false;
  // Two lights may share a whole map.
  return !std::equal(a.options.offset, a.options.offset + 2, b.options.offset) ||
         !std::equal(a.extent, a.extent + 2, b.extent);
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
  constexpr float kMostPaths = 4;
  const PellucidFrame& f = facts.frame;
  const PellucidShadowMap& s = f.shadowMaps[index];
  if (isPerspective(s)) return;
  const double side = texelSide(s) * static_cast<double>(f.metersPerUnit) * 1000;
  for (uint32_t i = 0; i < f.materialCount; ++i) {
    const float path = meanFreePath(facts.material(i));
    if (!(path > 0) || !(side > static_cast<double>(kMostPaths * path))) continue;
    out.warning(Field("shadowMaps[", index, "].extent"), "makes a texel ", static_cast<float>(side),
                " mm long, more than ", kMostPaths, " mean free paths of materials[", i, "], which are ",
                kMostPaths * path, " mm: thickness and gathered light are resolved to a texel");
    return;
  }
}

}  // namespace

void checkShadowMaps(const Inputs& inputs, Findings& out) {
  for (uint32_t i = 0; i < inputs.frame.shadowMapCount; ++i) checkShadowMap(inputs.frame, i, out);
}

void checkFaces(const Inputs& inputs, uint32_t light, Findings& out) {
  const PellucidLight& l = inputs.frame.lights[light];
  const PellucidShadowMap* maps = inputs.frame.shadowMaps + l.firstShadowMap;
  for (uint32_t i = 1; i < l.shadowMapCount; ++i)
    if (maps[i].options.backFaces != maps[0].options.backFaces)
      out.error(Field("shadowMaps[", l.firstShadowMap + i, "].options.backFaces"), "is ",
                maps[i].options.backFaces, ", but that of the first map of lights[", light, "] is ",
                maps[0].options.backFaces);
}

void warnOfShadowMaps(const FrameFacts& facts, Findings& out) {
  const PellucidFrame& f = facts.frame;
  warnOfTiles(f, out);
  for (uint32_t i = 0; i < std::min(facts.lights.lightCount, Lights::kMost); ++i) {
    const PellucidLight& l = facts.light(i);
    if (facts.holdsBackFaces(l))
      out.warning(Field("shadowMaps[", l.firstShadowMap, "].options.backFaces"), "is 1: lights[",
                  facts.lights.active[i], "] takes its thickness from backDepth and is not gathered");
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

}  // namespace pellucid
