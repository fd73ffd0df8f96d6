// --light of a model's captures, and --unit.
#pragma once

#include <string>

#include "raster/model.h"

namespace pellucid::harness {

inline constexpr const char* kBackLight = "back";
inline constexpr const char* kFrontLight = "front";
inline constexpr const char* kLightSyntax =
    "directional:X,Y,Z[:E], point:X,Y,Z[:I], spot:X,Y,Z[:I], sphere:X,Y,Z:RADIUS[:I], back or front";

// A light of the command line. X,Y,Z: direction of travel of a directional light, else the position in the
// file's world; spots look at the model's center. E: irradiance at normal incidence, I: intensity, both of
// KHR_lights_punctual; by default 1 arrives at the model's center. A sphere is a point light with a radius.
// "back" and "front": directional, from above, towards `camera` and away from it. Throws UsageError.
Light parseLight(const std::string& text, const Model& model, const ModelCamera& camera);

// Meters of "mm", "cm", "m" or a number. Throws UsageError.
double parseUnit(const std::string& text);

}  // namespace pellucid::harness
