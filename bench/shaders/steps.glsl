// What the separate steps share: the frame's constants and the group's shape.
#ifndef PELLUCID_STEPS_GLSL
#define PELLUCID_STEPS_GLSL

#include "lib/camera.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform Frame { FrameConstants frame; };

bool isOutside(ivec2 pixel) { return any(greaterThanEqual(pixel, ivec2(frame.rect.zw))); }

#endif
