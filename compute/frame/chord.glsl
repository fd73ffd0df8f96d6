// Camera-space chord of a pixel, from the depths as they are stored.
#ifndef PELLUCID_CHORD_GLSL
#define PELLUCID_CHORD_GLSL

#include "frame/frame.glsl"
#include "lib/thickness.glsl"

// Planar distance of the back surface, -1 where there is none.
float backDistanceOf(float stored) {
  stored = decodeDepth(stored);
  return hasFlag(PELLUCID_FLAG_BACK_VIEW_Z) ? planarDistanceViewZ(stored) : planarDistance(frame.camera, stored);
}

// Scene units along the view ray; -1 where no back face is behind the front one. `front`: planar distance of
// `frontStored`.
float chordOf(ViewRay ray, float front, float frontStored, float backStored) {
  float back = backDistanceOf(backStored);
  bool device = !hasFlag(PELLUCID_FLAG_BACK_VIEW_Z) && !hasFlag(PELLUCID_FLAG_FRONT_VIEW_Z);
  float difference =
      device ? planarDifference(frame.camera, decodeDepth(backStored), decodeDepth(frontStored)) : back - front;
  return back > 0.0 ? chord(difference, ray) : -1.0;
}

#endif
