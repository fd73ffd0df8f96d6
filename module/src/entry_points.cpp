#include "entry_points.h"

#include <algorithm>
#include <cmath>

namespace pellucid {
namespace {

// Row of a matrix without its translation.
glm::dvec3 linear(const glm::dmat4& m, int row) { return {m[0][row], m[1][row], m[2][row]}; }

}  // namespace

bool isPerspective(const PellucidShadowMap& map) {
  const float* clip = map.clipFromWorld;
  return clip[3] != 0 || clip[7] != 0 || clip[11] != 0;
}

double texelSide(const PellucidShadowMap& map) {
  const glm::dmat4 clip = toMatrix(map.clipFromWorld);
  const bool perspective = isPerspective(map);
  const glm::dvec3 w = linear(clip, 3);
  double side = 0;
  for (int i = 0; i < 2; ++i) {
    // An axis that is off center leans along the view; that does not make texels smaller.
    const glm::dvec3 row = linear(clip, i),
                     across = perspective ? row - w * (glm::dot(row, w) / glm::dot(w, w)) : row;
    // The matrix may have any factor.
    const double one = perspective ? glm::length(w) : std::abs(clip[3][3]);
    side = std::max(side, 2 * one / (glm::length(across) * map.extent[i]));
  }
  return side;
}

EntryExtent entryExtent(const Setup& setup, const PellucidLight& light, uint32_t map) {
  const PellucidShadowMap* maps = setup.frame.shadowMaps + light.firstShadowMap;
  const PellucidShadowMap* end = maps + light.shadowMapCount;
  const auto fits = [&](uint32_t side) {
    uint64_t rows = 0;
    for (const PellucidShadowMap* m = maps; m < end; ++m) {
      if (parts(m->extent[0], side) > kEntryColumns || parts(m->extent[1], side) > kEntryColumns)
        return false;
      rows += wholeGroups(parts(m->extent[1], side));
    }
    return rows <= kEntryRows;
  };
  const auto isFineEnough = [&](uint32_t side) {
    return std::all_of(maps, end, [&](const PellucidShadowMap& m) {
      return !isPerspective(m) && std::min(m.extent[0], m.extent[1]) / side >= kLeastEntries &&
             side * texelSide(m) <= static_cast<double>(setup.longestEntrySide);
    });
  };
  uint32_t side = 1;
  while (!fits(side) || isFineEnough(2 * side)) side *= 2;
  return {parts(maps[map].extent[0], side), parts(maps[map].extent[1], side), side};
}

EntryConstants entryConstants(const PellucidShadowMap& s, const PellucidLight& l,
                              const shared::ShadowConstants& shadow, const glm::dmat4& viewFromWorld,
                              EntryExtent extent, uint32_t row, uint32_t lightIndex) {
  const bool perspective = l.type != PELLUCID_LIGHT_DIRECTIONAL;
  const uint32_t encoding = shadow.meta.y;
  glm::dmat4 clip = toMatrix(s.clipFromWorld) * glm::inverse(viewFromWorld);
  if (!perspective) clip /= clip[3][3];
  const glm::dvec2 texels(s.extent[0], s.extent[1]), entries = texels / static_cast<double>(extent.side);
  const glm::dvec3 x = linear(clip, 0), y = linear(clip, 1), z = linear(clip, 2), w = linear(clip, 3);
  const glm::dvec3 planar(shadow.planar);
  EntryConstants c{};
  const auto projected = [&](int axis) {
    const glm::dvec4 full(axis == 0 ? x : y, clip[3][axis]);
    // ndc -1..1 to entries 0..; an orthographic map's w is 1.
    return glm::vec4(0.5 * entries[axis] * (full + glm::dvec4(w, clip[3][3])));
  };
  c.gather.column = projected(0);
  c.gather.row = projected(1);
  c.gather.place = {0, row, extent.width, extent.height};

  // Rows that say which ray a point is on; their inverse gives the ray's points.
  const glm::dvec2 step = 2.0 / texels;
  shared::EntryMapConstants& r = c.map;
  glm::dvec3 origin, stepX, stepY;
  const auto affine = [&](const glm::dvec3& of, double first, double scale) {
    r.origin = glm::vec4(origin, scale * (glm::dot(of, origin) + first));
    r.stepX = glm::vec4(stepX, scale * glm::dot(of, stepX));
    r.stepY = glm::vec4(stepY, scale * glm::dot(of, stepY));
  };
  if (perspective) {
    const glm::dvec4 position(l.position[0], l.position[1], l.position[2], 1);
    const glm::dvec3 source(viewFromWorld * position);
    const glm::dmat3 g = glm::inverse(glm::transpose(glm::dmat3(x, y, w)));
    stepX = step.x * g[0];
    stepY = step.y * g[1];
    origin = g[2] - g[0] - g[1];
    affine(encoding == PELLUCID_DEPTH_VIEW_Z ? planar : z, 0, 1);
    r.ray = glm::vec4(source, glm::dot(z, source) + clip[3][2]);
    c.gather.depth = glm::vec4(w, clip[3][3]);
  } else {
    const glm::dvec3 toLight = -glm::dmat3(viewFromWorld) * glm::normalize(toVector(l.direction));
    const glm::dmat3 g = glm::inverse(glm::transpose(glm::dmat3(x, y, toLight)));
    stepX = step.x * g[0];
    stepY = step.y * g[1];
    origin = -g[0] * (1 + clip[3][0]) - g[1] * (1 + clip[3][1]);
    const bool device = encoding == PELLUCID_DEPTH_DEVICE;
    const glm::dvec3 of = device ? z : planar;
    const double scale = 1 / glm::dot(of, g[2]);
    affine(of, device ? clip[3][2] : static_cast<double>(shadow.planar.w), -scale);
    r.ray = glm::vec4(g[2], scale);
    c.gather.depth = glm::vec4(toLight, 0);
    r.toLight = c.gather.depth;
  }
  r.meta = shadow.meta;
  r.occluder = shadow.occluder;
  c.gather.stepX = glm::vec4(glm::vec3(stepX) * static_cast<float>(extent.side), perspective ? 1 : 0);
  c.gather.stepY = glm::vec4(glm::vec3(stepY) * static_cast<float>(extent.side), 0);
  r.map = {s.extent[0], s.extent[1], extent.side, lightIndex};
  // The camera may miss a texel's point by the slope of the surface within half a texel and the pixel.
  r.seen = {static_cast<float>(0.5 * std::sqrt(glm::length(stepX) * glm::length(stepY))), 0, 0, 0};
  r.offsets = shadow.offsets;
  return c;
}

}  // namespace pellucid
