#include "turntable_shares.h"

#include <cmath>
#include <iterator>
#include <optional>

namespace pellucid::bench {

TurntableShares turntableShares(const std::vector<TurntableFrame>& frames) {
  TurntableShares shares;
  const double one = 1.0 / static_cast<double>(frames.size());
  for (const TurntableFrame& frame : frames) shares.necessary += frame.necessary ? one : 0;
  for (std::size_t i = 0; i < std::size(kCoherence); ++i) {
    // Frames without light that comes through keep nothing, so that the first one after them is computed.
    std::optional<double> kept, keptOfBoth;
    for (const TurntableFrame& frame : frames) {
      if (!kept || std::abs(frame.cosine - *kept) > kCoherence[i]) {
        shares.coherent[i] += one;
        kept = frame.cosine;
      }
      if (!frame.necessary) keptOfBoth.reset();
      if (frame.necessary && (!keptOfBoth || std::abs(frame.cosine - *keptOfBoth) > kCoherence[i])) {
        shares.both[i] += one;
        keptOfBoth = frame.cosine;
      }
    }
  }
  return shares;
}

}  // namespace pellucid::bench
