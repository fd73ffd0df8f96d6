// Renders of Blender's Cycles as captures: docs/captures.md has the recipe.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace pellucid::harness {

// E of Cycles' "Diffuse Direct" pass: radiance divided by the diffuse color, of a Lambert surface E / pi.
inline constexpr double kIrradiancePerDiffDir = 3.14159265358979323846;

// Manifest (version 1) of the multilayer EXR `exr`, whose camera, lights and materials stand in the JSON
// `scene` of tools/blender_export.py. Files are relative to the EXR. The irradiance is the Diffuse
// Direct pass times kIrradiancePerDiffDir. Throws InputError naming file, field and value: passes that the
// EXR lacks, lights that are neither sun, point nor spot.
nlohmann::json blenderManifest(const std::filesystem::path& exr, const std::filesystem::path& scene,
                               const std::string& sceneText);

}  // namespace pellucid::harness
