// Materials without thickness. Include it after declaring MaterialConstants materials[].
#ifndef PELLUCID_THIN_WALLS_GLSL
#define PELLUCID_THIN_WALLS_GLSL

#include "frame/flags.glsl"

// material: index + 1, as materialIndex has it and not 0. Frames without thin walls read nothing.
bool isThinWalled(uint material) { return hasFlag(PELLUCID_FLAG_THIN_WALLS) && materials[material - 1u].meta.z != 0u; }

#endif
