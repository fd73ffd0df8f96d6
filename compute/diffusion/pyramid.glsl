// Writing the diffusion pyramid. Levels lie at FrameConstants::level in their images, see module/src/pyramid.h.
#ifndef PELLUCID_PYRAMID_GLSL
#define PELLUCID_PYRAMID_GLSL

#include "frame/bindings.glsl"
#include "diffusion/texel.glsl"

layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D levelsDestination;

ivec2 inAtlas(uint level, ivec2 texel) { return frame.level[level].xy + texel; }

void writeLevel(uint level, ivec2 texel, uvec4 value) { imageStore(levelsDestination, inAtlas(level, texel), value); }

#endif
