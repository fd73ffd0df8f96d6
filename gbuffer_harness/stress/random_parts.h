// The parts that random_frame.cpp makes frames of.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "stress/random_frame.h"

namespace pellucid::harness::stress {

// A camera and what its images are made from.
struct View {
  int width, height;
  bool perspective;
  double sign;            // of view z in front of the eye
  double fx, fy, ox, oy;  // ndc = f x / p + o, or f x + o; p: planar distance
  double a, b;            // device depth is (a p + b) / p, or a p + b
  double near, far;       // far may be infinite
  double distance;        // of what it looks at, planar
  double pixel;           // side of a pixel there, scene units
  double mm;              // of a scene unit
  glm::dmat4 worldFromView;
  std::vector<double> planar;  // of each pixel's surface; 0: nothing there; what depth images hold may differ

  glm::dvec3 point(double x, double y, double p) const;  // view space, of the center of pixel x, y
  // View space, unit, towards the eye: from the points of the pixels beside one that has a surface.
  glm::dvec3 normal(int x, int y) const;
  double deviceDepth(double p) const { return perspective ? a + b / p : a * p + b; }
};

View randomView(Random& random, bool wild, const FrameLimits& limits, Capture& capture);

// View::planar, depths, material, irradiance and albedo. `materials`: how many there are.
void addRandomImages(Random& random, bool wild, View& view, int materials, Capture& capture);

void addRandomLights(Random& random, bool wild, const View& view, Capture& capture);

// A value that breaks things: NaN, infinities, the largest and least floats and halves, zeros.
float badFloat(Random& random);

}  // namespace pellucid::harness::stress
