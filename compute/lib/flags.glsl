// Needs FrameConstants frame in scope.
#ifndef PELLUCID_FLAGS_GLSL
#define PELLUCID_FLAGS_GLSL

#include "lib/common_case.glsl"
#include "shared/pellucid_shared.h"

bool hasFlag(uint flag) {
  uint flags = kDirectional ? (frame.flags.x & (PELLUCID_FLAG_ALBEDO | PELLUCID_FLAG_DIFFUSED)) | PELLUCID_FLAG_NORMAL : frame.flags.x;
  return (flags & flag) != 0u;
}

uint angleModel() { return kDirectional ? PELLUCID_SHADER_ANGLE_NORMAL : frame.flags.w; }

#endif
