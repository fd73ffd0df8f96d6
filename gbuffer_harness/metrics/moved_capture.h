// One frame seen a few pixels to the side.
#pragma once

#include "capture/capture.h"

namespace pellucid::harness {

// The capture as a camera sees it whose picture lies (shiftX, shiftY) pixels further to the right and down:
// every image of the view moves by whole pixels, and so does the center of clipFromView (a lens shift, which
// keeps each pixel's ray in orthographic and perspective views alike). So a result that is not the same but
// moved is the module's doing. A rim of `rim` pixels of the unmoved capture is emptied first, so that every
// move by up to that many pixels shows the same content; what moves in is empty. Without the truth. Throws
// InputError unless |shiftX| and |shiftY| are at most rim, and rim less than half of each side.
Capture movedCapture(const Capture& capture, int shiftX, int shiftY, int rim);

}  // namespace pellucid::harness
