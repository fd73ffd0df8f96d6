// Contents of EXR files that nobody described.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/exr.h"

namespace pellucid::harness {

// Channels of one layer.
struct ChannelGroup {
  std::filesystem::path file;
  int part = 0;
  std::string name;      // of the layer; else of the part, or of the file without extension
  bool isNamed = false;  // by a layer
  // Full names: of a color R, G, B, of a vector X, Y, Z, else of each channel by itself.
  std::vector<std::string> channels;
};

// The groups of all files, of which none is empty. Alpha is left out, and so are Cryptomatte's. Throws
// InputError.
std::vector<ChannelGroup> survey(const std::vector<std::filesystem::path>& files);

// The channels of a group as one image. Throws InputError.
Image readGroup(const ChannelGroup& group);

}  // namespace pellucid::harness
