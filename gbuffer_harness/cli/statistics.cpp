#include "cli/statistics.h"

#include <cstdio>

#include "replay/tile_map.h"

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

const char* gatheredText(uint32_t gathered) {
  return gathered == PELLUCID_GATHERED_SOME   ? "some"
         : gathered == PELLUCID_GATHERED_NONE ? "none was found"
                                              : "not decided by the device";
}

}  // namespace

std::string statisticsText(const PellucidPlan& plan, const PellucidStatistics& s) {
  std::string text = heading("statistics", "groups run");
  for (uint32_t i = 0; i < s.dispatchCount; ++i) text += row(plan.dispatches[i].name, s.dispatches[i]);
  text += heading("total", "run");
  if (s.tileLists) text += row("tiles with material", s.tiles);
  if (s.diffusion.most > 0) text += row("diffusion groups", s.diffusion);
  if (s.probes.most > 0) text += row("probe groups", s.probes);
  if (s.entryPoints.most > 0) text += row("entry point groups", s.entryPoints);
  if (!s.tileLists) text += "no tile lists: " + whyNoTileLists(plan) + "\n";
  text += std::string("gathered light: ") + gatheredText(s.gatheredLight) + "\n";
  return text + "lights that can contribute: " + std::to_string(s.activeLights) + "\n";
}

}  // namespace pellucid::harness
