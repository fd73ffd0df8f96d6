// Contents of EXR files that nobody described, and guesses which channels are the buffers of a capture.
#pragma once

#include <filesystem>
#include <map>
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

enum class Role { FrontDepth, BackDepth, Irradiance, Normal, Albedo, Material };

inline constexpr Role kRoles[] = {Role::FrontDepth, Role::BackDepth, Role::Irradiance,
                                  Role::Normal,     Role::Albedo,    Role::Material};

// The key of a manifest's "buffers".
const char* roleName(Role role);

struct Guess {
  ChannelGroup group;  // its first channel, of depths and materials
  std::string why;     // a sentence's end: "its name is that of ..."
  std::string doubt;   // what it would take to be sure; empty: nothing
  double scale = 1;
  bool includesAlbedo = false;
  double metersPerUnit = 0;  // 0: the name says nothing
};

// By names that Blender, Arnold, Nuke, V-Ray, Unreal, Unity, RenderDoc and this program use. `given`: the
// person's own, layer, channel, or file without extension. Throws UsageError for one that is not there.
std::map<Role, Guess> guessRoles(const std::vector<ChannelGroup>& groups,
                                 const std::map<Role, std::string>& given);

}  // namespace pellucid::harness
