// Factors of a light, as PellucidLightTable has them.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace pellucid::harness {

// at: 0..1, between the first entry and the last. table: two entries or more.
inline double factorAt(const std::vector<double>& table, double at) {
  const double place = at * static_cast<double>(table.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(place), table.size() - 2);
  return std::lerp(table[below], table[below + 1], place - static_cast<double>(below));
}

}  // namespace pellucid::harness
