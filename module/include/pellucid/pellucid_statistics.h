/* Statistics: the decisions of the device in a finished frame, as workgroups that ran and blocks with material. pellucid.h does not
 * include this header.
 *
 * The device writes the indirect commands of a plan into the caller's constants slice. The host reads them there, without a further
 * buffer or stall:
 * - Record a barrier after pellucidRecordPlan, from PELLUCID_STAGES / PELLUCID_WRITES to VK_PIPELINE_STAGE_HOST_BIT /
 *   VK_ACCESS_HOST_READ_BIT.
 * - Read the slice after the submission's fence has signaled, and before the next pellucidWriteConstants into the slice.
 */
#ifndef PELLUCID_STATISTICS_H
#define PELLUCID_STATISTICS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Pixels a side of a block. */
enum { PELLUCID_STATISTICS_BLOCK = 64 };

/* Workgroups of one or several dispatches. */
typedef struct PellucidGroups {
  /* Workgroups that ran, 0..most. */
  uint64_t run;
  /* Largest possible number of workgroups. All of them run if the device does not decide. */
  uint64_t most;
} PellucidGroups;

/* Statistics of a frame. pellucidReadStatistics writes them. */
typedef struct PellucidStatistics {
  /* sizeof(PellucidStatistics). pellucidInitStatistics writes it. */
  uint32_t structSize;
  /* Dispatches of the plan, 0..PELLUCID_MAX_DISPATCHES. */
  uint32_t dispatchCount;
  /* Workgroups of each dispatch, in the order of the plan. */
  PellucidGroups dispatches[PELLUCID_MAX_DISPATCHES];
  /* Blocks at multiples of PELLUCID_STATISTICS_BLOCK pixels. run: blocks with material. most: blocks that the rect touches. With
   * lists 0 both count all blocks within 8 pixels of the rect. Both are 0 if nothing diffuses or is gathered. */
  PellucidGroups blocks;
  /* Groups of 16 x 16 entry points of all maps. Both are 0 without a gather. */
  PellucidGroups entryPoints;
  /* Groups of 8 x 8 cells of the gather. Both are 0 without a gather. */
  PellucidGroups probes;
  /* 1: the device listed the blocks with material. 0: passes ran over the whole rect. */
  uint32_t lists;
  /* PellucidPlan::activeLights: lights that can contribute. */
  uint32_t activeLights;
} PellucidStatistics;

/* Writes zeros into a struct of structSize bytes, and then its structSize. */
PELLUCID_API void pellucidInitStatisticsSized(PellucidStatistics* statistics, size_t structSize);
/* Writes zeros and the struct's size. */
static inline void pellucidInitStatistics(PellucidStatistics* s) { pellucidInitStatisticsSized(s, sizeof *s); }

/* Reads the statistics of the last recording of `plan` from the slice. The function is pure. It reads at most 12 bytes a dispatch, so
 * the memory need not be HOST_CACHED. Of `constants` it takes `mapped` and `size`. `fn` (optional) gets a sentence for each error, and
 * *statistics then does not change. Errors:
 * - INVALID_ARGUMENT: a null pointer, or a slice with impossible numbers of groups, because another plan wrote it;
 * - BUFFER_TOO_SMALL: constants->size is below plan->constantsSize;
 * - VERSION: the library cannot write a struct of this structSize. */
PELLUCID_API PellucidResult pellucidReadStatistics(const PellucidPlan* plan, const PellucidConstantsSlice* constants,
                                                   PellucidStatistics* statistics, PellucidMessageFn fn, void* user);

#ifdef __cplusplus
}
#endif
#endif
