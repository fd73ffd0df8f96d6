/* A frame budget: which frame.gatherSamples and frame.reuse hold a frame time (Whelan 2009, 6.2.5). Needs no Vulkan. */
#ifndef PELLUCID_BUDGET_H
#define PELLUCID_BUDGET_H

#include <stdint.h>

#include "pellucid_result.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A setting that holds a frame time, and what it was decided from. `gatherSamples` is frame.gatherSamples, to
 * which the caller may add settings that it can lower (resolution, lights); `reuse` asks for reuse of results
 * between frames, frame.reuse. */
typedef struct PellucidBudgetState {
  uint32_t gatherSamples; /* 16 best, 8, 4, 0 cheapest */
  uint32_t reuse;   /* 1: reuse; given up last when there is room again */
  uint32_t overFrames, underFrames;   /* on end above the budget; on end with room for more */
  uint32_t settleFrames;              /* times of the setting before that may still arrive */
  uint32_t waitFrames;                /* of room before a better setting is tried */
  uint32_t raised, heldFrames;        /* 1: the last change was upwards; frames since */
  float raisedMs;                     /* time before the last step upwards; 0: no step to compare with */
  uint32_t easierFrames;              /* on end well below raisedMs after that step failed */
} PellucidBudgetState;

PELLUCID_API void pellucidInitBudgetState(PellucidBudgetState* state); /* 16 samples, no reuse */

/* One frame's time, ms, against the budget (Whelan 2009, 6.2.5). Pure. Goes one setting down (reuse first,
 * then samples) after 3 frames on end above the budget, so a setting that fits is reached within 20 frames;
 * one up after waitFrames at most 70 % of it. An upward step that does not hold doubles the wait, until
 * 30 frames on end take 70 % of the time from before it. Times that are negative or not finite, and
 * budgets that are not > 0, change nothing. A damaged state goes on from the nearest valid one. */
PELLUCID_API void pellucidStepBudget(PellucidBudgetState* state, float measuredMs, float budgetMs);

#ifdef __cplusplus
}
#endif
#endif
