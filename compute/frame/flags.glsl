// Frame-wide switches. Include it where FrameConstants frame is in scope.
#ifndef PELLUCID_FLAGS_GLSL
#define PELLUCID_FLAGS_GLSL

#include "shared/pellucid_shared.h"

bool hasFlag(uint flag) { return (frame.flags.x & flag) != 0u; }

#endif
