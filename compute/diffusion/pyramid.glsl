// Images of the diffusion pyramid. Levels lie at FrameConstants::level in them, see module/src/pyramid.h.
#include "frame/bindings.glsl"
#include "diffusion/texel.glsl"

layout(set = 0, binding = PELLUCID_BINDING_PYRAMID) uniform utexture2D pyramidImage; // of what the pass reads
layout(set = 0, binding = PELLUCID_BINDING_LEVELS, rgba32ui) uniform writeonly uimage2D levelsDestination;

ivec2 inAtlas(uint level, ivec2 texel) { return frame.level[level].xy + texel; }

void writeLevel(uint level, ivec2 texel, uvec4 value) { imageStore(levelsDestination, inAtlas(level, texel), value); }
