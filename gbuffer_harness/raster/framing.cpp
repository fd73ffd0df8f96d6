#include "raster/framing.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "common/error.h"
#include "scene/turn.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr double kMargin = 1.05;
constexpr double kWidestHalfAngle = 75 * std::numbers::pi / 180;

// Calls visit(position) for the vertex of every index: vertices that no triangle uses do not count.
template <class Visit>
void forEachPosition(const Model& model, const Visit& visit) {
  for (const Part& part : model.parts)
    for (std::uint32_t i = 0; i < part.indexCount; ++i)
      visit(positionOf(model.vertices[model.indices[part.firstIndex + i]]));
}

template <class Visit>
void forEachPosition(const ModelPoints& model, const Visit& visit) {
  for (const Vector3& vertex : model.vertices) visit(toGlm(vertex));
}

// Extent of the model as a view sees it.
struct Extent {
  double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;  // planar distance
  double side = 0;                                                                // largest |x| or |y|
  double tangent = 0;  // largest |x| or |y| per planar distance; infinite when something is not in front
};

Extent extentIn(const ModelPoints& model, const Matrix& viewFromWorld) {
  const glm::dmat4 view = toGlm(viewFromWorld);
  Extent extent;
  forEachPosition(model, [&](const glm::dvec3& position) {
    const glm::dvec3 p = view * glm::dvec4(position, 1);
    const double side = std::max(std::abs(p.x), std::abs(p.y));
    extent.nearest = std::min(extent.nearest, -p.z);
    extent.farthest = std::max(extent.farthest, -p.z);
    extent.side = std::max(extent.side, side);
    extent.tangent =
        std::max(extent.tangent, p.z < 0 ? side / -p.z : std::numeric_limits<double>::infinity());
  });
  return extent;
}

// Clip planes around [nearest, farthest], also where the model is a plane that faces the view.
ClipRange clipAround(const Extent& extent, bool perspective) {
  const double slack = 1e-3 * std::max({extent.farthest - extent.nearest, extent.side, 1e-6});
  ClipRange range{extent.nearest - slack, extent.farthest + slack, true};
  // A light within the model still needs a near plane in front of it.
  if (perspective) range.nearPlane = std::max(range.nearPlane, 1e-3 * range.farPlane);
  return range;
}

std::optional<LightView> perspectiveView(const ModelPoints& model, const Light& light, const glm::dvec3& axis,
                                         double halfAngle) {
  LightView view;
  view.viewFromWorld = lookAt(light.position, fromGlm(toGlm(light.position) + axis), {0, 1, 0});
  const Extent extent = extentIn(model, view.viewFromWorld);
  halfAngle = std::min(halfAngle, std::atan(extent.tangent * kMargin));
  if (!(halfAngle > 0) || halfAngle > kWidestHalfAngle || !(extent.farthest > 0)) return std::nullopt;
  view.clipFromView = perspective(2 * halfAngle, 1, clipAround(extent, true));
  return view;
}

LightView parallelView(const ModelPoints& model, const Light& light) {
  const Bounds& bounds = model.bounds;
  LightView view;
  const glm::dvec3 axis = glm::normalize(toGlm(light.direction));
  view.viewFromWorld =
      lookAt(fromGlm(toGlm(bounds.center) - 2 * bounds.radius * axis), bounds.center, {0, 1, 0});
  const Extent extent = extentIn(model, view.viewFromWorld);
  const double size = 2 * kMargin * std::max(extent.side, 1e-3 * bounds.radius);
  view.clipFromView = orthographic(size, size, clipAround(extent, false));
  return view;
}

std::optional<LightView> singleView(const ModelPoints& model, const Light& light) {
  const Bounds& bounds = model.bounds;
  std::optional<LightView> view;
  const glm::dvec3 toCenter = toGlm(bounds.center) - toGlm(light.position);
  if (glm::length(toCenter) > bounds.radius)
    view = perspectiveView(model, light, glm::normalize(toCenter), std::numbers::pi / 2);
  if (light.type == PELLUCID_LIGHT_SPOT) {
    const std::optional<LightView> cone =
        perspectiveView(model, light, glm::normalize(toGlm(light.direction)), light.outerConeAngle * 1.001);
    // A larger scale is a narrower view.
    if (cone && (!view || cone->clipFromView[0] > view->clipFromView[0])) view = cone;
  }
  return view;
}

// Six faces, each a little wider than 90 degrees: a point on a seam must find its texel whichever way
// rounding puts it, and the irradiance pass moves points by up to 2.2 texels and blends the one beyond.
std::vector<LightView> cubeViews(const ModelPoints& model, const Light& light, int texels) {
  constexpr int kSeamTexels = 4;
  const double tangent = texels / std::max<double>(texels - 2 * kSeamTexels, 0.5 * texels);
  double farthest = 0;  // planar distance from the face that looks there
  forEachPosition(model, [&](const glm::dvec3& position) {
    const glm::dvec3 away = glm::abs(position - toGlm(light.position));
    farthest = std::max({farthest, away.x, away.y, away.z});
  });
  if (!(farthest > 0)) return {};
  // Reversed depth is a float: a near plane this close costs no precision.
  const ClipRange range{1e-4 * farthest, 1.001 * farthest, true};
  std::vector<LightView> views;
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {1.0, -1.0}) {
      glm::dvec3 target = toGlm(light.position);
      target[axis] += sign * farthest;
      views.push_back({perspective(2 * std::atan(tangent), 1, range),
                       lookAt(light.position, fromGlm(target), {0, 1, 0})});
    }
  return views;
}

}  // namespace

Bounds boundsOf(const Model& model) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  forEachPosition(model, [&](const glm::dvec3& position) {
    low = glm::min(low, position);
    high = glm::max(high, position);
  });
  if (!(low.x <= high.x)) throw InputError(model.name, "meshes", "there is no triangle to draw");
  const double radius = 0.5 * glm::length(high - low);
  return {fromGlm(0.5 * (low + high)), std::max(radius, 1e-6 * glm::length(high) + 1e-30)};
}

ModelPoints pointsOf(const Model& model) {
  ModelPoints points{{}, boundsOf(model)};
  std::vector<bool> isUsed(model.vertices.size());
  for (const Part& part : model.parts)
    for (std::uint32_t i = 0; i < part.indexCount; ++i) isUsed[model.indices[part.firstIndex + i]] = true;
  for (std::size_t i = 0; i < isUsed.size(); ++i)
    if (isUsed[i]) points.vertices.push_back(fromGlm(positionOf(model.vertices[i])));
  return points;
}

ModelCamera frameModel(const Model& model, const Vector3& toCamera, double verticalFov, double aspect,
                       bool orthographic, const std::vector<double>& turns) {
  const Bounds bounds = boundsOf(model);
  const double length = glm::length(toGlm(toCamera));
  if (!(length > 0) || !std::isfinite(length))
    throw InputError(model.name, "view", "the direction to the camera has no length");
  // Seen from the center first; backing off by d - what a vertex is nearer - brings it into view.
  const Matrix atCenter =
      lookAt(bounds.center, fromGlm(toGlm(bounds.center) - toGlm(toCamera) / length), {0, 1, 0});
  const double tangent = std::tan(verticalFov / 2);
  double away = 0, height = 0, nearest = -bounds.radius, farthest = bounds.radius;
  for (const double turn : turns) {
    const glm::dmat4 view = toGlm(turnedView(atCenter, bounds.center, turn));
    forEachPosition(model, [&](const glm::dvec3& position) {
      const glm::dvec3 p = view * glm::dvec4(position, 1);
      const double half = kMargin * std::max(std::abs(p.x) / aspect, std::abs(p.y));
      away = std::max(away, half / tangent + p.z);
      height = std::max(height, 2 * half);
      nearest = std::max(nearest, p.z);
      farthest = std::min(farthest, p.z);
    });
  }
  // A plane that faces the camera needs room between the clip planes too.
  const double slack = (kMargin - 1) * bounds.radius;
  away = std::max(away, nearest + 2 * slack);
  ModelCamera camera;
  camera.name = "auto";
  camera.viewFromWorld =
      lookAt(fromGlm(toGlm(bounds.center) + toGlm(toCamera) * (away / length)), bounds.center, {0, 1, 0});
  camera.orthographic = orthographic;
  camera.verticalFov = verticalFov;
  camera.height = std::max(height, slack);
  camera.range = {away - nearest - slack, away - farthest + slack, true};
  return camera;
}

std::vector<LightView> frameLight(const Model& model, const Light& light, PointMaps maps, int texels) {
  return frameLight(pointsOf(model), light, maps, texels);
}

std::vector<LightView> frameLight(const ModelPoints& model, const Light& light, PointMaps maps, int texels) {
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) return {parallelView(model, light)};
  const bool cube = maps == PointMaps::Six && light.type == PELLUCID_LIGHT_POINT;
  if (const auto view = cube ? std::nullopt : singleView(model, light)) return {*view};
  return maps == PointMaps::One ? std::vector<LightView>() : cubeViews(model, light, texels);
}

std::vector<LightView> frameCascades(const Bounds& bounds, const Light& light, const ModelCamera& camera,
                                     double aspect, int count, int texels) {
  constexpr double kBehind = 3;  // radii
  const glm::dvec3 center = toGlm(bounds.center), direction = glm::normalize(toGlm(light.direction));
  const Matrix fromLight = lookAt(fromGlm(center - 4 * bounds.radius * direction), bounds.center, {0, 1, 0});
  const glm::dmat4 worldFromCamera = glm::inverse(toGlm(camera.viewFromWorld));
  const double away = -(toGlm(camera.viewFromWorld) * glm::dvec4(center, 1)).z;
  const double first = std::max(away - bounds.radius, 0.02 * bounds.radius),
               last = std::max(away + bounds.radius, 2 * first);
  const double tangent = std::tan(camera.verticalFov / 2) * std::hypot(1, aspect);  // of the image's corner
  std::vector<LightView> views;
  for (int i = 0; i < count; ++i) {
    const double from = glm::mix(first, last, static_cast<double>(i) / count);
    const double to =
        i + 1 < count ? glm::mix(first, last, (i + 1.0) / count) : last + kBehind * bounds.radius;
    const double middle = (from + to) / 2, radius = std::hypot(to - middle, to * tangent);
    const double texel = 2 * radius / texels;
    const glm::dvec3 seen = toGlm(fromLight) * worldFromCamera * glm::dvec4(0, 0, -middle, 1);
    const glm::dvec3 place(glm::floor(glm::dvec2(seen) / texel) * texel, 0);
    views.push_back(
        {orthographic(2 * radius, 2 * radius, {0.1 * bounds.radius, (8 + kBehind) * bounds.radius, true}),
         fromGlm(glm::translate(glm::dmat4(1), -place) * toGlm(fromLight))});
  }
  return views;
}

}  // namespace pellucid::harness
