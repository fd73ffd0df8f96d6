/* The decisions of the device in a frame that it has finished: groups that ran, blocks with material.
 *
 * The indirect commands of a plan lie in the caller's constants slice, where the device counted. Reading them
 * costs the device nothing, and needs neither a buffer nor a stall:
 * - after pellucidRecordPlan, a barrier from PELLUCID_STAGES / PELLUCID_WRITES to VK_PIPELINE_STAGE_HOST_BIT
 * / VK_ACCESS_HOST_READ_BIT goes into the command buffer;
 * - the slice is read once the fence of that submission has signaled, which a ring of slices waits for
 * anyway, and before constants are written to the slice again. pellucid.h does not include this header.
 */
#ifndef PELLUCID_STATISTICS_H
#define PELLUCID_STATISTICS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PELLUCID_STATISTICS_BLOCK = 64 }; /* pixels a side of a block */

/* Workgroups of a dispatch, or of several. */
typedef struct PellucidGroups {
  uint64_t run;  /* how many ran, 0..most */
  uint64_t most; /* how many there may be; all of them run where the device does not decide */
} PellucidGroups;

/* Written by pellucidReadStatistics. */
typedef struct PellucidStatistics {
  uint32_t structSize;    /* sizeof(PellucidStatistics), written by pellucidInitStatistics */
  uint32_t dispatchCount; /* of dispatches, 0..PELLUCID_MAX_DISPATCHES */
  PellucidGroups dispatches[PELLUCID_MAX_DISPATCHES]; /* those of the plan, in its order */
  PellucidGroups blocks;      /* of PELLUCID_STATISTICS_BLOCK pixels a side, at multiples of that: those with material, of those
                                 that the rect touches. Without lists all, and those within 8 pixels of the rect; 0 of 0
                                 where nothing diffuses or is gathered */
  PellucidGroups entryPoints; /* groups of 16 x 16 entry points, of all maps; 0 of 0 without a gather */
  PellucidGroups probes;      /* groups of 8 x 8 cells of the gather; 0 of 0 without a gather */
  uint32_t lists;         /* 1: the device listed where material is; 0: passes ran over the whole rect */
  uint32_t activeLights;  /* PellucidPlan::activeLights: lights that can contribute */

} PellucidStatistics;

/* Zeros and the size, written into a struct of that many bytes. */
PELLUCID_API void pellucidInitStatisticsSized(PellucidStatistics* statistics, size_t structSize);
/* Zeros and the size. */
static inline void pellucidInitStatistics(PellucidStatistics* s) { pellucidInitStatisticsSized(s, sizeof *s); }

/* Reads what the device left in the slice of the last recording of `plan`. Pure. At most 12 bytes a dispatch are read, so that
 * the memory need not be HOST_CACHED. `mapped` and `size` of `constants` are used. `fn`, which may be NULL, gets a sentence for
 * each error; *statistics then stays as it was. Errors:
 * - INVALID_ARGUMENT: a null pointer, or a slice with more groups than there may be, which is another plan's;
 * - BUFFER_TOO_SMALL: constants->size is below plan->constantsSize;
 * - VERSION: a structSize that this library cannot write. */
PELLUCID_API PellucidResult pellucidReadStatistics(const PellucidPlan* plan, const PellucidConstantsSlice* constants,
                                                   PellucidStatistics* statistics, PellucidMessageFn fn, void* user);

#ifdef __cplusplus
}
#endif
#endif
