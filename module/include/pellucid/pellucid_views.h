/* Several views in one recording: the eyes of a stereo frame, parts of a split screen, layers of a multiview
 * G-buffer.
 *
 * Each view is a frame with its own plan. If plans are recorded one after the other, much of the device is idle
 * at each barrier. If they are recorded together, the plans share their barriers: between two barriers the
 * dispatches of all views run side by side. Both ways give the same bits.
 */
#ifndef PELLUCID_VIEWS_H
#define PELLUCID_VIEWS_H

#include "pellucid.h"

#ifdef __cplusplus
extern "C" {
#endif

/* One view of a recording. Sizes, features, materials and lights may differ from view to view. */
typedef struct PellucidView {
  /* Made from `frame` and, with reuse, from the previous plan of this view. */
  const PellucidPlan* plan;
  /* With image views. A layer of an array is a 2D view of this layer alone. */
  const PellucidFrame* frame;
  /* The view's own slice, with the constants of `plan`. */
  const PellucidConstantsSlice* constants;
} PellucidView;

/* Records the dispatches of all views' plans, with as many barriers as the plan with the most barriers has. Stages,
 * accesses and state are as pellucidRecordPlan says. 0 views: nothing is recorded.
 *
 * Two views must not share an image that one of them writes. Each view has its own transients, history and
 * slice, and transients of two views must not alias. Outputs may be one image if the frames' renderRects have no
 * pixel in common, even if this image is also the irradiance. Views may share all other inputs.
 *
 * Errors are those of pellucidRecordPlan. An image view that two views share against these rules is an
 * INVALID_ARGUMENT. Slices that overlap in one buffer or in mapped addresses are one, too. The function compares
 * handles, and does not notice two image views of one image, or memory that aliases. The message's field names the view: "views[1].output".
 * After an error nothing is recorded, but for OUT_OF_MEMORY and VULKAN: reset the command buffer then. */
PELLUCID_API PellucidResult pellucidRecordViews(const PellucidContext* context, VkCommandBuffer commandBuffer,
                                                uint32_t viewCount, const PellucidView* views);

#ifdef __cplusplus
}
#endif
#endif
