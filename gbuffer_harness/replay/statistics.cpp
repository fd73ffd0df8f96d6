#include "replay/statistics.h"

#include <cstring>
#include <span>
#include <string_view>

namespace pellucid::harness {
namespace {

Groups groupsOf(const PellucidDispatch& d, const void* constants) {
  const std::uint64_t most = std::uint64_t{d.groups[0]} * d.groups[1] * d.groups[2];
  if (!d.indirect) return {most, most};
  std::uint32_t words[5];  // as PellucidDispatch::indirectOffset says
  std::memcpy(words, static_cast<const char*>(constants) + d.indirectOffset, sizeof words);
  return {std::uint64_t{words[4]} * words[1] * words[2], most};
}

void add(Groups& all, const Groups& groups) {
  all.run += groups.run;
  all.most += groups.most;
}

}  // namespace

Statistics readStatistics(const PellucidPlan& plan, const void* constants) {
  Statistics s;
  for (const PellucidDispatch& d : std::span(plan.dispatches, plan.dispatchCount)) {
    const Groups groups = s.dispatches.emplace_back(groupsOf(d, constants));
    const std::string_view pipeline = pellucidPipelineName(d.pipeline);
    if (pipeline == "diffuse") {
      const std::uint64_t groupsOfBlock = d.groups[1];
      s.blocks = {groups.run / groupsOfBlock, groups.most / groupsOfBlock};
      s.lists = d.indirect;
    } else if (pipeline == "entry_points") {
      add(s.entryPoints, groups);
    } else if (pipeline == "probes") {
      add(s.probes, groups);
    }
  }
  return s;
}

}  // namespace pellucid::harness
