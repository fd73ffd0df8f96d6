#include "stress/stress.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "common/error.h"

namespace pellucid::harness::stress {

namespace {

constexpr const char* kAccepted = "accepted";
constexpr const char* kValidation = "validation";

// Counts one value; true when it is a violation.
bool count(CheckResult& result, const StressFrame& frame, const Worst& worst,
           std::optional<double> tolerance) {
  CheckCount& c = frame.wild ? result.wild : result.tame;
  ++c.done;
  if (worst.value > c.worst.value) {
    c.worst = worst;
    c.worstFrame = frame.index;
  }
  const bool violated = tolerance && worst.value > *tolerance;
  c.violations += violated;
  return violated;
}

class Run {
public:
  Run(Renderer& renderer, const StressOptions& options, const StressEvents& events)
      : options_(options),
        events_(events),
        renderer_(renderer),
        recordingsBefore_(renderer.recordings()),
        pixelsBefore_(renderer.pixels()) {
    if (!options.only.empty()) requireCheck(options.only);
    result.device = renderer_.device().description();
    result.checks = {{kAccepted, {}, {}}, {kValidation, {}, {}}};
    for (const Check& check : checks()) result.checks.push_back({check.name, {}, {}});
    limits_ = options.limits;
    limits_.side =
        std::min(limits_.side, static_cast<int>(renderer_.device().properties().limits.maxImageDimension2D));
  }

  void runFrame(std::uint64_t index) {
    const StressFrame frame = randomFrame(options_.seed, index, pool_, limits_);
    std::vector<Violation> violations;
    const std::size_t messages = renderer_.device().validationMessages().size();
    try {
      Subject subject(renderer_, frame);
      count(result.checks[0], frame, {}, 0);
      std::size_t i = 1;
      for (const Check& check : checks()) {
        ++i;
        if (!options_.only.empty() && options_.only != check.name) continue;
        const std::optional<Worst> worst = check.run(subject);
        if (worst && count(result.checks[i], frame, *worst, frame.wild ? check.wild : check.tame))
          violations.push_back({check.name, *worst, ""});
      }
    } catch (const InputError& refused) {
      // Wild frames may be refused; an engine's may not.
      ++(frame.wild ? result.refusedWild : result.refusedTame);
      if (count(result.checks[0], frame, {1, -1, -1, -1},
                frame.wild ? std::nullopt : std::optional<double>(0)))
        violations.push_back({kAccepted, {1, -1, -1, -1}, refused.what()});
    }
    const std::vector<std::string> said = renderer_.device().validationMessages();
    const Worst worst{static_cast<double>(said.size() - messages), -1, -1, -1};
    if (options_.validate && count(result.checks[1], frame, worst, 0))
      violations.push_back({kValidation, worst, said.back()});
    if (!violations.empty() && events_.violated) events_.violated(frame, violations);
    ++result.frames;
    result.recordings = renderer_.recordings() - recordingsBefore_;
    result.pixels = renderer_.pixels() - pixelsBefore_;
  }

  StressResult result;

private:
  const StressOptions& options_;
  const StressEvents& events_;
  Renderer& renderer_;
  const std::uint64_t recordingsBefore_, pixelsBefore_;
  const MaterialPool pool_;
  FrameLimits limits_;
};

}  // namespace

void requireCheck(const std::string& name) {
  std::string known;
  for (const Check& check : checks()) {
    if (check.name == name) return;
    known += (known.empty() ? "" : ", ") + std::string(check.name);
  }
  throw UsageError("--only: \"" + name + "\" is not one of " + known);
}

std::uint64_t StressResult::violations() const {
  std::uint64_t sum = 0;
  for (const CheckResult& check : checks) sum += check.tame.violations + check.wild.violations;
  return sum;
}

StressResult runStress(Renderer& renderer, const StressOptions& options, const StressEvents& events) {
  Run run(renderer, options, events);
  const auto start = std::chrono::steady_clock::now();
  const auto seconds = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  for (std::uint64_t i = 0; options.frames ? i < *options.frames : seconds() < options.seconds; ++i) {
    if (events.started) events.started(options.first + i);
    run.runFrame(options.first + i);
    run.result.seconds = seconds();
    if (events.progressed) events.progressed(run.result);
  }
  return run.result;
}

}  // namespace pellucid::harness::stress
