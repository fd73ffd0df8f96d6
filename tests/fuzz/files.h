// Sound files, for the targets to read and for seeds to damage.
#pragma once

#include <string>

namespace pellucid::fuzz {

std::string soundCapture();  // a native capture: an EXR file with its manifest inside
std::string soundTiles();    // an EXR file of tiles and mip levels
std::string soundGlb();      // with a texture, a light, a camera and a medium

}  // namespace pellucid::fuzz
