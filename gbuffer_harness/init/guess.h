// Guesses which channels of foreign files are the buffers of a capture.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "init/survey.h"

namespace pellucid::harness {

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
