// Writing the diffusion pyramid. All levels lie in one image, at FrameConstants::level.
#ifndef PELLUCID_PYRAMID_GLSL
#define PELLUCID_PYRAMID_GLSL

#include "frame/bindings.glsl"
#include "diffusion/texel.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D levelsDestination;

ivec2 inAtlas(uint level, ivec2 texel) { return frame.level[level].xy + texel; }

void writeLevel(uint level, ivec2 texel, uvec4 value) { imageStore(levelsDestination, inAtlas(level, texel), value); }

#endif
