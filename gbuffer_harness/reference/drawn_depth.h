// The depth of the surface that was drawn into a shadow map, without the biases that the drawing added.
#pragma once

#include <functional>

#include "capture/capture.h"

namespace pellucid::harness::reference {

// In units of the stored depth.
struct DrawnDepth {
  double depth;
  double uncertain;  // how far it may be off
};

// Depth of a texel that stores a surface. `holds`: true for a stored depth of a surface.
DrawnDepth drawnDepth(const ShadowMap& map, int x, int y, const std::function<bool(float)>& holds);

}  // namespace pellucid::harness::reference
