// Constants slice -> statistics. Pure: no device, no allocation.
#include "pellucid/pellucid_statistics.h"

#include "findings.h"
#include "pass.h"
#include "shared/pellucid_shared.h"
#include "struct_size.h"

namespace pellucid {
namespace {

// Other headers' structs are longer, or end before fields that come after these.
constexpr size_t kLeastStatistics = sizeof(PellucidStatistics);
static_assert(offsetof(PellucidStatistics, activeLights) + sizeof(uint32_t) == sizeof(PellucidStatistics));
static_assert(PELLUCID_STATISTICS_BLOCK == PELLUCID_BLOCK);
static_assert(PELLUCID_ENTRY_POINTS_GROUP == 16 && PELLUCID_PROBES_GROUP == 8);  // as the header says

void add(PellucidGroups* all, const PellucidGroups& groups) {
  all->run += groups.run;
  all->most += groups.most;
}

// Groups of a dispatch; an error where the slice cannot be one of the plan.
PellucidGroups groupsOf(const PellucidPlan& plan, uint32_t index, const PellucidConstantsSlice& slice,
                        Findings& out) {
  const PellucidDispatch& d = plan.dispatches[index];
  const uint64_t most = uint64_t{d.groups[0]} * d.groups[1] * d.groups[2];
  if (!d.indirect) return {most, most};
  shared::ListCommand command;
  if (d.indirectOffset > plan.constantsSize || plan.constantsSize - d.indirectOffset < sizeof command) {
    out.error(Field("plan.dispatches[", index, "].indirectOffset"), "is ", d.indirectOffset,
              ", beyond the plan's ", plan.constantsSize, " bytes of constants");
    return {};
  }
  std::memcpy(&command, static_cast<const char*>(slice.mapped) + d.indirectOffset, sizeof command);
  const glm::uvec3 ran(command.ran.x, command.groups.y, command.groups.z);
  if (ran.x > d.groups[0] || ran.y > d.groups[1] || ran.z > d.groups[2])
    out.error("constants.mapped", "has ", ran.x, " x ", ran.y, " x ", ran.z, " groups of \"", d.name,
              "\", which are at most ", d.groups[0], " x ", d.groups[1], " x ", d.groups[2],
              ": it is not the slice of a recording of this plan");
  return {uint64_t{ran.x} * ran.y * ran.z, most};
}

// Adds a dispatch to the totals of its pass.
void count(const PellucidDispatch& d, const PellucidGroups& groups, PellucidStatistics* s) {
  if (d.pipeline >= allPasses().size()) return;
  switch (allPasses()[d.pipeline]->counted) {
    case Counted::Blocks: {
      const uint64_t parts = d.groups[1];
      s->blocks = {groups.run / parts, groups.most / parts};
      s->lists = d.indirect;
      break;
    }
    case Counted::EntryPoints:
      add(&s->entryPoints, groups);
      break;
    case Counted::Probes:
      add(&s->probes, groups);
      break;
    case Counted::Nothing:
      break;
  }
}

}  // namespace
}  // namespace pellucid

using namespace pellucid;

extern "C" void pellucidInitStatisticsSized(PellucidStatistics* statistics, size_t structSize) {
  writeStruct(statistics, structSize, PellucidStatistics{});
}

extern "C" PellucidResult pellucidReadStatistics(const PellucidPlan* plan,
                                                 const PellucidConstantsSlice* constants,
                                                 PellucidStatistics* statistics, PellucidMessageFn fn,
                                                 void* user) {
  Findings out(fn, user);
  if (!plan) out.error("plan", "is NULL");
  if (!constants)
    out.error("constants", "is NULL");
  else if (!constants->mapped)
    out.error("constants.mapped", "is NULL");
  if (!statistics) out.error("statistics", "is NULL");
  if (!out.ok()) return out.result();
  if (!isStructSize<PellucidStatistics>(statistics->structSize, kLeastStatistics))
    out.fail(PELLUCID_ERROR_VERSION, "statistics.structSize", "is ", statistics->structSize,
             "; this library writes ", kLeastStatistics, " to ", kLargestStruct,
             " bytes (call pellucidInitStatistics)");
  else if (plan->dispatchCount > PELLUCID_MAX_DISPATCHES)
    out.error("plan.dispatchCount", "is ", plan->dispatchCount, ", more than ",
              static_cast<int>(PELLUCID_MAX_DISPATCHES));
  else if (constants->size < plan->constantsSize)
    out.fail(PELLUCID_ERROR_BUFFER_TOO_SMALL, "constants.size", "is ", constants->size, "; the plan has ",
             plan->constantsSize, " bytes");
  if (!out.ok()) return out.result();

  PellucidStatistics s{};
  s.dispatchCount = plan->dispatchCount;
  s.activeLights = plan->activeLights;
  for (uint32_t i = 0; i < plan->dispatchCount; ++i) {
    s.dispatches[i] = groupsOf(*plan, i, *constants, out);
    count(plan->dispatches[i], s.dispatches[i], &s);
  }
  if (!out.ok()) return out.result();
  writeStruct(statistics, statistics->structSize, s);
  return PELLUCID_OK;
}
