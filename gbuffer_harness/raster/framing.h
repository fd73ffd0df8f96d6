// Cameras and shadow-map projections that fit a model.
#pragma once

#include <optional>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

// Sphere around the box of all vertices that parts use. Throws InputError when there is no triangle.
struct Bounds {
  Vector3 center;
  double radius;  // > 0
};
Bounds boundsOf(const Model& model);

// A camera that sees the whole model from the direction `toCamera` (any length > 0) with a margin of 5 %.
// verticalFov: radians, (0, pi); an orthographic camera takes only its size from it. aspect: width / height.
// It sees the whole model also after turnedView() by each of `turns` (radians) about the model's center.
ModelCamera frameModel(const Model& model, const Vector3& toCamera, double verticalFov, double aspect,
                       bool orthographic, const std::vector<double>& turns = {0});

// A light's projection: reversed-Z, square.
struct LightView {
  Matrix clipFromView, viewFromWorld;
};

// Directional: the box of the model. Point: one perspective around the whole model, which is impossible
// when the light stands within or close to it. Spot: its cone or the model, whichever is narrower. Empty
// when the view would have to be wider than 150 degrees.
std::optional<LightView> frameLight(const Model& model, const Light& light);

}  // namespace pellucid::harness
