// Sound files, for the targets to read and for seeds to damage.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace pellucid::fuzz {

// Writes render.exr into the folder and returns the scene that belongs beside it.
nlohmann::json writeBlenderFiles(const std::filesystem::path& folder);

std::string soundCapture();  // a native capture: an EXR file with its manifest inside
std::string soundTiles();    // an EXR file of tiles and mip levels
std::string soundGlb();      // with a texture, a light, a camera and a medium

}  // namespace pellucid::fuzz
