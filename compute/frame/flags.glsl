// Frame-wide switches. Include it where FrameConstants frame is in scope.
#ifndef PELLUCID_FLAGS_GLSL
#define PELLUCID_FLAGS_GLSL

#include "shared/pellucid_shared.h"

// True in pipelines for the common frame of a gather: every light is directional with one map of device depth, the camera
// stores device depth, and normals are given. Compilers drop the rest.
layout(constant_id = PELLUCID_CONSTANT_DIRECTIONAL) const bool kDirectional = false;

bool hasFlag(uint flag) {
  const uint kOpen = PELLUCID_FLAG_BACK_DEPTH | PELLUCID_FLAG_BACK_VIEW_Z | PELLUCID_FLAG_DIFFUSED | PELLUCID_FLAG_THIN_WALLS;
  uint flags = frame.flags.x;
  if (kDirectional) flags = (flags & kOpen) | PELLUCID_FLAG_NORMAL;
  return (flags & flag) != 0u;
}

#endif
