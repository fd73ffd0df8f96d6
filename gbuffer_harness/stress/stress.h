// Random frames through the module and its checks, until time or frames are over.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "stress/checks.h"

namespace pellucid::harness::stress {

struct StressOptions {
  std::uint64_t seed = 1, first = 0;
  std::optional<std::uint64_t> frames;
  double seconds = 60;  // without `frames`
  FrameLimits limits;
  std::string only;       // a check's name; empty: all
  bool validate = false;  // messages of the renderer's validation are violations
};

// Counts of tame frames or of wild ones.
struct CheckCount {
  std::uint64_t done = 0, violations = 0;
  Worst worst;
  std::uint64_t worstFrame = 0;
};

struct CheckResult {
  std::string name;
  CheckCount tame, wild;
};

struct Violation {
  std::string check;
  Worst worst;
  std::string sentence;  // what else is to say; may be empty
};

struct StressResult {
  std::string device;
  std::uint64_t frames = 0, recordings = 0, pixels = 0;
  std::uint64_t refusedTame = 0, refusedWild = 0;
  double seconds = 0;
  std::vector<CheckResult> checks;  // first of what the module refuses and what validation says

  std::uint64_t violations() const;
};

// Functions that are called after a frame; each may be empty.
struct StressEvents {
  std::function<void(std::uint64_t frame)> started;                                 // before the frame is made
  std::function<void(const StressFrame&, const std::vector<Violation>&)> violated;  // where it violates checks
  std::function<void(const StressResult&)> progressed;                              // with what there is so far
};

// Throws UsageError for a check that there is not.
void requireCheck(const std::string& name);

// Throws as requireCheck does.
StressResult runStress(Renderer& renderer, const StressOptions& options, const StressEvents& events);

}  // namespace pellucid::harness::stress
