/* The decisions of the device in a frame that it has finished: groups that ran, tiles with material, gathered
 * light.
 *
 * The indirect commands of a plan lie in the caller's constants slice, where the device counted. Reading them
 * costs the device nothing, and needs neither a buffer nor a stall:
 * - after pellucidRecordPlan, a barrier from PELLUCID_STAGES / PELLUCID_WRITES to VK_PIPELINE_STAGE_HOST_BIT
 * / VK_ACCESS_HOST_READ_BIT goes into the command buffer;
 * - the slice is read once the fence of that submission has signaled, which a ring of slices waits for
 * anyway, and before the slice is recorded again. pellucid.h does not include this header.
 */
#ifndef PELLUCID_STATISTICS_H
#define PELLUCID_STATISTICS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { PELLUCID_STATISTICS_TILE = 16 }; /* pixels a side of a tile */

/* The gather of a frame as the device decided about it. */
typedef enum PellucidGatheredLight {
  PELLUCID_GATHERED_UNKNOWN = 0, /* nothing is gathered, or the passes after the probes run in any case */
  PELLUCID_GATHERED_NONE = 1,    /* no probe found light: spatial filter and addition did not run */
  PELLUCID_GATHERED_SOME = 2     /* a probe found light */
} PellucidGatheredLight;

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
  PellucidGroups tiles;       /* of PELLUCID_STATISTICS_TILE pixels a side, from an even pixel on: those with material, of
                                 those that the rect touches. Without tileLists all; 0 of 0 where nothing diffuses */
  PellucidGroups diffusion;   /* groups of the diffusion's last dispatch, with gathered light or without */
  PellucidGroups entryPoints; /* groups of 16 x 16 entry points, of all maps; 0 of 0 without a gather */
  PellucidGroups probes;      /* groups of 8 x 8 cells of the gather; 0 of 0 without a gather */
  uint32_t tileLists;     /* 1: the device listed where material is; 0: passes ran over the whole rect */
  uint32_t gatheredLight; /* PellucidGatheredLight */
  uint32_t activeLights;  /* PellucidPlan::activeLights: lights that can contribute */
  uint32_t reserved;      /* 0 */
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
