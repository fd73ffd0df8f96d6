// Projection matrix -> what the shaders need. Pure, double inside.
#pragma once

#include <glm/glm.hpp>

#include "shared/pellucid_shared.h"

namespace pellucid {

// The depth and w rows of a projection that has no skew between depth and x, y:
// device depth = (A p + B) / (C p + D) with p the planar distance in front of the eye, >= 0.
struct DepthRange {
  double a, b, c, d;
  double forward;  // sign of view z in front of the eye: -1 right-handed, +1 left-handed
  bool perspective;
  double nothing;  // device depth of the far plane: where a cleared buffer holds nothing
};

// What is wrong with a projection, or nullptr; `range` is written only when nothing is.
const char* readDepthRange(const glm::dmat4& clipFromView, DepthRange* range);

// `clipFromView` must have passed readDepthRange. `first`: what the image's first pixel is called.
shared::Camera makeCamera(const glm::dmat4& clipFromView, const DepthRange& range, glm::uvec2 extent,
                          double metersPerUnit, glm::ivec2 first = {0, 0});

// Shorter side of an orthographic camera's pixel on a facing surface, scene units. All that is tilted has a longer one. 0: a perspective
// camera.
double pixelSide(const glm::dmat4& clipFromView, const DepthRange& range, glm::uvec2 extent);

glm::dmat4 toMatrix(const float (&columns)[16]);
inline glm::dvec3 toVector(const float (&v)[3]) { return {v[0], v[1], v[2]}; }

// An affine transform of a rotation, without scale, and a translation; false for NaN.
bool isRigid(const glm::dmat4& m);

}  // namespace pellucid
