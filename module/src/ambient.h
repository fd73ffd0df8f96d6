// Light from all around, by nine spherical harmonics of its radiance.
#pragma once

#include <array>
#include <glm/glm.hpp>

#include "screen.h"

namespace pellucid {

constexpr uint32_t kAmbientCoefficients = 27;  // of PellucidFrameOptions::ambient

// Ambient light takes a place among the lights of dispatches: one of this type, which no caller can name. Its
// intensity is 0 where the frame has none.
PellucidLight ambientLight(const PellucidFrame& frame);
inline bool isAmbient(const PellucidLight& light) { return light.type == PELLUCID_SHADER_LIGHT_AMBIENT; }

// Per channel the form whose value at (n, 1) is the irradiance, times pre-exposure, of a face of normal n in
// view space.
std::array<glm::mat4, 3> ambientIrradiance(const Inputs& inputs, const Screen& screen);

}  // namespace pellucid
