// Needs GL_EXT_spirv_intrinsics.
#ifndef PELLUCID_SATURATE_GLSL
#define PELLUCID_SATURATE_GLSL

// NClamp. What clamp() makes of NaN is left open.
spirv_instruction(set = "GLSL.std.450", id = 81) vec3 clampNumber(vec3 v, vec3 low, vec3 high);

// Between 0 and 1, 0 for NaN.
vec3 saturate(vec3 v) { return clampNumber(v, vec3(0.0), vec3(1.0)); }

#endif
