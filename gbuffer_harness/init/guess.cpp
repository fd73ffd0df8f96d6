#include "init/guess.h"

#include <algorithm>
#include <cctype>
#include <numbers>

#include "common/error.h"

namespace pellucid::harness {

namespace {

enum class Match { Is, Ends, Holds };

struct Name {
  Role role;
  Match match;
  const char* text;  // letters and digits in lower case
  const char* what;
  const char* doubt = "";
  double scale = 1;
  double metersPerUnit = 0;
};

constexpr double kPi = std::numbers::pi;
constexpr double kCentimeter = 0.01;

constexpr const char* kHasAlbedo =
    "if the pass is multiplied by the surface color, divide it by the albedo, or leave \"albedo\" out";
constexpr const char* kIsPicture =
    "a finished picture holds highlights and the surface color, too: render the irradiance instead";

// The first that fits a group wins; of several groups that of the earlier name.
const Name kNames[] = {
    {Role::BackDepth, Match::Holds, "backdepth", "a depth of back faces"},
    {Role::BackDepth, Match::Holds, "depthback", "a depth of back faces"},
    {Role::BackDepth, Match::Ends, "backz", "a depth of back faces"},
    {Role::BackDepth, Match::Ends, "zback", "a depth of back faces"},
    {Role::FrontDepth, Match::Ends, "frontz", "Pellucid's front depth"},
    {Role::FrontDepth, Match::Holds, "frontdepth", "Pellucid's front depth"},
    {Role::FrontDepth, Match::Holds, "scenedepth", "Unreal's scene depth, in centimeters", "", 1,
     kCentimeter},
    {Role::FrontDepth, Match::Holds, "cameradepth", "Unity's depth texture"},
    {Role::FrontDepth, Match::Ends, "depthz", "a depth pass of Blender"},
    {Role::FrontDepth, Match::Holds, "zdepth", "a depth pass of V-Ray"},
    {Role::FrontDepth, Match::Ends, "depth", "a depth pass"},
    {Role::FrontDepth, Match::Holds, "depth", "a depth"},
    {Role::FrontDepth, Match::Is, "z", "OpenEXR's own channel of depths"},
    {Role::FrontDepth, Match::Ends, "z", "OpenEXR's own channel of depths"},
    {Role::Irradiance, Match::Holds, "irradiance", "Pellucid's irradiance"},
    {Role::Irradiance, Match::Holds, "diffdir", "Blender's Diffuse Direct, which is E / pi", "", kPi},
    {Role::Irradiance, Match::Holds, "diffuselighting", "a pass of diffuse light", kHasAlbedo},
    {Role::Irradiance, Match::Holds, "lightingonly", "Unreal's view of light alone",
     "Unreal's Lighting Only has a gray albedo of .5 and is pre-exposed: set the scale", 2},
    {Role::Irradiance, Match::Holds, "vraylighting", "V-Ray's raw light times color", kHasAlbedo},
    {Role::Irradiance, Match::Holds, "rawlight", "V-Ray's raw light"},
    {Role::Irradiance, Match::Holds, "diffusedirect", "Arnold's direct diffuse light", kHasAlbedo},
    {Role::Irradiance, Match::Holds, "directdiffuse", "a pass of direct diffuse light", kHasAlbedo},
    {Role::Irradiance, Match::Holds, "diffuselight", "a pass of diffuse light", kHasAlbedo},
    {Role::Irradiance, Match::Holds, "lighting", "a pass of light", kHasAlbedo},
    {Role::Albedo, Match::Holds, "albedo", "an albedo"},
    {Role::Albedo, Match::Holds, "diffcol", "Blender's Diffuse Color"},
    {Role::Albedo, Match::Holds, "basecolor", "a base color"},
    {Role::Albedo, Match::Holds, "gbufferc", "Unreal's base color"},
    {Role::Albedo, Match::Holds, "diffusefilter", "V-Ray's diffuse color"},
    {Role::Albedo, Match::Holds, "diffusecolor", "a diffuse color"},
    {Role::Normal, Match::Is, "n", "a pass of normals"},
    {Role::Normal, Match::Ends, "normal", "a pass of normals"},
    {Role::Normal, Match::Ends, "normals", "a pass of normals"},
    {Role::Normal, Match::Holds, "gbuffera", "Unreal's normals"},
    {Role::Normal, Match::Holds, "normal", "normals"},
    {Role::Material, Match::Holds, "indexma", "Blender's Material Index"},
    {Role::Material, Match::Holds, "materialid", "a material's number"},
    {Role::Material, Match::Holds, "matid", "a material's number"},
    {Role::Material, Match::Ends, "material", "a material's number"},
    {Role::Material, Match::Holds, "shadingmodel", "Unreal's shading model"},
    {Role::Material, Match::Holds, "customstencil", "Unreal's custom stencil"},
    {Role::Material, Match::Holds, "indexob", "Blender's Object Index"},
    {Role::Material, Match::Holds, "objectid", "an object's number"},
    {Role::Material, Match::Holds, "stencil", "a stencil"},
    {Role::Material, Match::Is, "id", "a number"},
    {Role::Material, Match::Ends, "id", "a number"},
    // Only without any other irradiance.
    {Role::Irradiance, Match::Ends, "combined", "Blender's finished picture", kIsPicture},
    {Role::Irradiance, Match::Holds, "beauty", "a finished picture", kIsPicture},
    {Role::Irradiance, Match::Holds, "rgba", "a finished picture", kIsPicture},
    {Role::Irradiance, Match::Holds, "scenecolor", "a finished picture", kIsPicture},
    {Role::Irradiance, Match::Holds, "", "the only color that is left", kIsPicture},
};

std::string plain(const std::string& text) {
  std::string result;
  for (const unsigned char c : text)
    if (std::isalnum(c)) result += static_cast<char>(std::tolower(c));
  return result;
}

bool fits(const std::string& name, const Name& known) {
  switch (known.match) {
    case Match::Is:
      return name == known.text;
    case Match::Ends:
      return name.ends_with(known.text);
    case Match::Holds:
      return name.find(known.text) != std::string::npos;
  }
  return false;
}

// The role's buffer has three numbers a pixel.
bool isTriple(Role role) { return role == Role::Irradiance || role == Role::Normal || role == Role::Albedo; }

// A single number may be the first of a color: RenderDoc saves every texture as one.
bool hasShapeOf(Role role, const ChannelGroup& group) {
  return isTriple(role) ? group.channels.size() == 3 : group.channels.size() == 1 || !group.isNamed;
}

// Names by which a group may be known: its layer, and of single channels the whole name.
std::vector<std::string> namesOf(const ChannelGroup& group) {
  std::vector<std::string> names = {plain(group.name)};
  if (group.channels.size() == 1) {
    names.push_back(plain(group.channels[0]));
    names.push_back(plain(group.name + group.channels[0]));
  }
  return names;
}

Guess guessOf(const ChannelGroup& group, const Name& known) {
  Guess guess{group, std::string("its name is that of ") + known.what, known.doubt, known.scale,
              known.metersPerUnit};
  if (!isTriple(known.role)) guess.group.channels.resize(1);
  return guess;
}

bool isTaken(const std::map<Role, Guess>& guesses, const ChannelGroup& group) {
  return std::any_of(guesses.begin(), guesses.end(), [&](const auto& entry) {
    const ChannelGroup& other = entry.second.group;
    return other.file == group.file && other.part == group.part &&
           other.channels.front() == group.channels.front();
  });
}

}  // namespace

const char* roleName(Role role) {
  constexpr const char* kKeys[] = {"frontDepth", "backDepth", "irradiance", "normal", "albedo", "material"};
  return kKeys[static_cast<std::size_t>(role)];
}

std::map<Role, Guess> guessRoles(const std::vector<ChannelGroup>& groups,
                                 const std::map<Role, std::string>& given) {
  std::map<Role, Guess> guesses;
  for (const auto& entry : given) {
    const Role role = entry.first;  // no structured bindings: Clang 14 does not capture them
    const std::string& name = entry.second;
    const auto found = std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& group) {
      return hasShapeOf(role, group) && (group.name == name || group.channels.front() == name);
    });
    if (found == groups.end()) {
      std::string list;
      for (const ChannelGroup& group : groups)
        if (hasShapeOf(role, group)) list += (list.empty() ? "" : ", ") + group.name;
      throw UsageError(std::string(roleName(role)) + ": there is no \"" + name + "\" that fits; there are " +
                       list);
    }
    Guess guess = guessOf(*found, {role, Match::Is, "", ""});
    guess.why = "you named it";
    guesses[role] = guess;
  }
  for (const Name& known : kNames) {
    if (guesses.count(known.role)) continue;
    for (const ChannelGroup& group : groups) {
      if (!hasShapeOf(known.role, group) || isTaken(guesses, group)) continue;
      const std::vector<std::string> names = namesOf(group);
      if (std::none_of(names.begin(), names.end(), [&](const std::string& n) { return fits(n, known); }))
        continue;
      guesses[known.role] = guessOf(group, known);
      break;
    }
  }
  return guesses;
}

}  // namespace pellucid::harness
