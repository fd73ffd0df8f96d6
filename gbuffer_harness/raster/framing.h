// Cameras and shadow-map projections that fit a model.
#pragma once

#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// Sphere around the box of all vertices that parts use. Throws InputError when there is no triangle.
struct Bounds {
  Vector3 center;
  double radius;  // > 0
};
Bounds boundsOf(const Model& model);

// Bounds that framing needs of a model, for lights that are framed again and again.
struct ModelPoints {
  std::vector<Vector3> vertices;  // that parts use, each once
  Bounds bounds;
};
ModelPoints pointsOf(const Model& model);  // throws as boundsOf()

// A camera that sees the whole model from the direction `toCamera` (any length > 0) with a margin of 5 %.
// verticalFov: radians, (0, pi); an orthographic camera takes only its size from it. aspect: width / height.
// It sees the whole model also after turnedView() by each of `turns` (radians) about the model's center.
ModelCamera frameModel(const Model& model, const Vector3& toCamera, double verticalFov, double aspect,
                       bool orthographic, const std::vector<double>& turns = {0});

// A light's projection: reversed-Z, square.
struct LightView {
  Matrix clipFromView, viewFromWorld;
};

// Shadow maps of a light that has a position.
enum class PointMaps {
  Auto,  // one where one suffices, else six
  One,   // one, or none where one view would have to be wider than 150 degrees
  Six    // of point lights: the faces of a cube; spots as Auto
};

// Views whose maps together hold all of the model that the light can reach. Directional: the box of the
// model. Point: a perspective around the whole model, which is impossible when the light stands within or
// close to it. Spot: its cone or the model, whichever is narrower. Six: along +x, -x, +y, -y, +z and -z of
// the world. texels: across one map, > 0.
std::vector<LightView> frameLight(const ModelPoints& model, const Light& light, PointMaps maps, int texels);
std::vector<LightView> frameLight(const Model& model, const Light& light, PointMaps maps, int texels);

// Views of a directional light that hold slices of what a perspective camera sees, the nearest first. Their
// sizes stay while the camera turns, and places move by whole texels, so that edges of shadows stand still.
// covered: planar distances from the first to the last slice, all as deep. aspect: width / height. texels:
// across one map. Casters and receivers are within `bounds`, and up to 3 radii behind it.
std::vector<LightView> frameCascades(const Bounds& bounds, const Light& light, const ModelCamera& camera,
                                     double aspect, int count, int texels);

}  // namespace pellucid::harness
