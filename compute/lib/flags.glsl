// Needs FrameConstants frame in scope.
#ifndef PELLUCID_FLAGS_GLSL
#define PELLUCID_FLAGS_GLSL

#include "lib/common_case.glsl"
#include "shared/pellucid_shared.h"

bool hasFlag(uint flag) {
  uint flags = frame.flags.x;
  if (kDirectional) flags = (flags & (PELLUCID_FLAG_ALBEDO | PELLUCID_FLAG_DIFFUSED)) | PELLUCID_FLAG_NORMAL;
  return (flags & flag) != 0u;
}

#endif
