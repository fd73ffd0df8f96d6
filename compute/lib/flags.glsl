// Needs FrameConstants frame in scope.
#ifndef PELLUCID_FLAGS_GLSL
#define PELLUCID_FLAGS_GLSL

#include "lib/common_case.glsl"
#include "shared/pellucid_shared.h"

bool hasFlag(uint flag) {
  uint flags = frame.flags.x;
  const uint kOpen = PELLUCID_FLAG_ALBEDO | PELLUCID_FLAG_DIFFUSED | PELLUCID_FLAG_BACK_DEPTH | PELLUCID_FLAG_BACK_VIEW_Z;
  if (kDirectional) flags = (flags & kOpen) | PELLUCID_FLAG_NORMAL;
  return (flags & flag) != 0u;
}

#endif
