// All materials of a frame together: which kinds there are, and how far the widest one diffuses.
#pragma once

#include "screen.h"

namespace pellucid {

// Reach of all materials that diffuse, at options.nearestDistance; all 0 where that does not say how large a
// pixel is.
struct DiffusionReach {
  double pixelsPerMm = 0;
  double radius = 0;     // pixels; the largest PellucidMaterial::radius
  double deviation = 0;  // pixels; standard deviation of the widest Gaussian
};

struct Materials {
  Materials(const Inputs& inputs, const Screen& screen);

  bool diffuses = false;                   // a material does
  bool thinWalls = false, solids = false;  // a material is thin-walled; one is not
  DiffusionReach reach;
};

// Standard deviation of a material's widest Gaussian, mm; 0 if it has none.
double widestDeviation(const PellucidMaterial& material);

}  // namespace pellucid
