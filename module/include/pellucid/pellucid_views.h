/* Several views in one recording: the eyes of a stereo frame, parts of a split screen, layers of a multiview
 * G-buffer.
 *
 * Each view is a frame of its own, with a plan made from it. Recorded one after the other, each plan waits at
 * its barriers while most of the device is idle; recorded together, the plans share their barriers, and
 * between two barriers the dispatches of all views run side by side. The results have the same bits either
 * way.
 */
#ifndef PELLUCID_VIEWS_H
#define PELLUCID_VIEWS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One view of a recording. The three may differ from view to view in anything: sizes, features, materials,
 * lights. */
typedef struct PellucidView {
  const PellucidPlan* plan;   /* made from `frame`; with reuse, from this view's previous plan */
  const PellucidFrame* frame; /* with image views; a layer of an array is a 2D view of that layer alone */
  const PellucidConstantsSlice* constants; /* of this view, with the constants of its plan */
} PellucidView;

/* pellucidRecordPlan for several views at once: records the dispatches of all plans with as many barriers as the
 * plan with the most has. Stages, accesses and what is left changed are those of
 * pellucidRecordPlan. 0 views: nothing is recorded.
 *
 * No other view of the recording uses an image that one view writes: each has transients, a history and a
 * slice of its own, and transients of two views must not alias. Outputs, and inputs that are written in
 * place, may be one image where the frames' renderRects have no pixel in common. All other inputs may be
 * shared.
 *
 * PELLUCID_ERROR_INVALID_ARGUMENT for one image view that breaks this rule, and for slices of one buffer, or
 * mapped addresses, that overlap in what the plans need of them. Handles are compared: two image views of one
 * image, and memory that aliases, go unnoticed. Every other error is one of pellucidRecordPlan. The message's
 * field names the view: "views[1].output". After an error nothing is recorded. */
PELLUCID_API PellucidResult pellucidRecordViews(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                                uint32_t viewCount, const PellucidView* views);

#ifdef __cplusplus
}
#endif
#endif
