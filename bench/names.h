// Names of the module's rows, by which tools/bench_tables.py finds them.
#pragma once

#include <cstdint>
#include <string>

namespace pellucid::bench {

inline const std::string kModule = "Pellucid";

// The samples of the module's whole frames; the second number is the default.
inline constexpr std::uint32_t kSamples[] = {0, 8, 16};

inline std::string nameOf(std::uint32_t samples) {
  return samples == kSamples[1] ? kModule : kModule + ", " + std::to_string(samples) + " samples";
}

}  // namespace pellucid::bench
