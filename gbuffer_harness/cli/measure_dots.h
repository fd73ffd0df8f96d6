// How the minimum dots of PellucidFrame::minimumDotTable are measured from pictures.
#pragma once

#include <functional>
#include <vector>

#include "scene/camera.h"

namespace pellucid::harness {

// The turn of MINIMUM_DOT_AZIMUTH.
struct DotTable {
  int entries = 36;                          // 1..360
  Vector3 face = {0, 0, 1}, up = {0, 1, 0};  // world, not parallel
};

// World directions from the object to the light of each entry, unit.
std::vector<Vector3> lightDirections(const DotTable& table);

struct Swing {
  int steps = 18;           // from beside the light to opposite it
  double threshold = 0.25;  // of the most light of all
};

// Light that comes through, from views of the object from `toEye` while it is lit from `toLight` (unit).
using LightThrough = std::function<double(const Vector3& toLight, const Vector3& toEye)>;

// Entries in [-1, 0], of four decimals. For each light the eye swings from 90 degrees beside it, where the
// dot is the largest that a table holds, to opposite it, both ways round about `up`. The entry is the cosine
// between eye and light at which, on either way, more than `threshold` of the most light of all entries and
// steps comes through for the first time, linear in the cosine between two steps; -1 where it never does.
std::vector<double> measureMinimumDots(const DotTable& table, const Swing& swing,
                                       const LightThrough& through);

}  // namespace pellucid::harness
