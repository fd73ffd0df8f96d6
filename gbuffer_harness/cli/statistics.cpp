#include "cli/statistics.h"

#include <cstdio>

#include "replay/block_map.h"

namespace pellucid::harness {
namespace {

std::string row(const char* name, const PellucidGroups& groups) {
  char line[128];
  const double part =
      groups.most > 0 ? 100 * static_cast<double>(groups.run) / static_cast<double>(groups.most) : 0;
  std::snprintf(line, sizeof line, "%-22s %12llu %12llu %6.1f\n", name,
                static_cast<unsigned long long>(groups.run), static_cast<unsigned long long>(groups.most),
                part);
  return line;
}

std::string heading(const char* first, const char* run) {
  char line[128];
  std::snprintf(line, sizeof line, "%-22s %12s %12s %6s\n", first, run, "of most", "%");
  return line;
}

}  // namespace

std::string statisticsText(const PellucidPlan& plan, const PellucidStatistics& s) {
  std::string text = heading("statistics", "groups run");
  for (uint32_t i = 0; i < s.dispatchCount; ++i) text += row(plan.dispatches[i].name, s.dispatches[i]);
  text += heading("total", "run");
  if (s.lists) text += row("blocks with material", s.blocks);
  if (s.probes.most > 0) text += row("probe groups", s.probes);
  if (s.entryPoints.most > 0) text += row("entry point groups", s.entryPoints);
  if (!s.lists) text += "no lists of blocks: " + whyNoLists(plan) + "\n";
  return text + "lights that can contribute: " + std::to_string(s.activeLights) + "\n";
}

}  // namespace pellucid::harness
