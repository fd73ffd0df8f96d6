// The viewer's camera under the mouse and the keys. World is right-handed, y up; angles are radians.
#pragma once

#include "raster/model.h"

namespace pellucid::harness {

struct ViewCamera {
  ModelCamera lens;           // what the rasterizer draws with
  Vector3 pivot = {0, 0, 0};  // world; orbiting goes round it, zooming towards it

  Vector3 eye() const;                // world
  Vector3 right() const, up() const;  // world, unit
  Vector3 back() const;               // world, unit; from what is seen towards the eye
};

// Round the pivot: `yaw` about the vertical, counterclockwise from above, then `pitch` upwards, to 89 degrees
// of elevation at most.
void orbit(ViewCamera& camera, double yaw, double pitch);

// Turns the head: `yaw` to the left, `pitch` upwards, to 89 degrees at most. The pivot stays ahead.
void look(ViewCamera& camera, double yaw, double pitch);

// Steps to the right, up and ahead, scene units. The pivot goes along.
void walk(ViewCamera& camera, const Vector3& step);

// Multiplies the distance to the pivot, or the height of an orthographic view, by `factor` > 0.
void zoom(ViewCamera& camera, double factor);

// Clip planes around a sphere, scene units, near enough for a camera within it.
void fitRange(ViewCamera& camera, const Vector3& center, double radius);

// `vector` turned about `axis` (any length > 0), counterclockwise where the axis points at the viewer.
Vector3 turned(const Vector3& vector, const Vector3& axis, double angle);

}  // namespace pellucid::harness
