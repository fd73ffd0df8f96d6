// Texels of the pyramid that a dispatch before this one wrote. With tile lists some groups did not run.
#include "frame/work_group.glsl"

// `list`: of this dispatch. All groups write levels 4 and 5; levels 2 and 3 are written near material, level 1 where there is
// some.
bool isWritten(uint list, uint level, ivec2 texel) {
  if (level > 3u || !readsUnwritten(list)) return true;
  return level == 1u ? isInCell(texel << level) : isNearMaterial(texel << level);
}

// A texel of level 1, 2 or 3, nothing where none was written.
uvec4 finerTexel(uint list, uint level, ivec2 texel) {
  return isWritten(list, level, texel) ? texelFetch(pyramidImage, inAtlas(level, texel), 0) : uvec4(0u);
}
