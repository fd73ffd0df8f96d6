// How often a turntable's translucency has to be computed.
#pragma once

#include <vector>

namespace pellucid::bench {

// Shares of the frames in which light that comes through has to be computed.
struct TurntableShares {
  double necessary = 0;         // light can come through (4.7.1)
  double coherent[2] = {0, 0};  // the cosine of camera and light changed by more than kCoherence (4.7.5)
  double both[2] = {0, 0};      // and light can come through
};
inline constexpr double kCoherence[] = {0.005, 0.01};

// A frame's cosine between the camera's axis and the direction to the light, and whether light can come
// through.
struct TurntableFrame {
  double cosine;
  bool necessary;
};
TurntableShares turntableShares(const std::vector<TurntableFrame>& frames);

}  // namespace pellucid::bench
