#include "init/manifest.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <iterator>
#include <map>
#include <numbers>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

namespace {

// Takes the channels of these components out of `components`, when all are there.
std::vector<std::string> take(std::map<std::string, std::string>& components, const char* wanted) {
  std::vector<std::string> result;
  for (const char* c = wanted; *c; ++c) {
    const auto found = components.find(std::string(1, *c));
    if (found == components.end()) return {};
    result.push_back(found->second);
  }
  for (const char* c = wanted; *c; ++c) components.erase(std::string(1, *c));
  return result;
}

// Some programs write the components of colors out.
std::string componentOf(const std::string& name) {
  const std::string component = lower(name);
  for (const char* color : {"red", "green", "blue", "alpha"})
    if (component == color) return component.substr(0, 1);
  return component;
}

// depth.0001: the frame's number says nothing of the content.
std::string withoutFrame(const std::string& stem) {
  const std::size_t end = stem.find_last_not_of("0123456789");
  return end != std::string::npos && end > 0 && end + 1 < stem.size() && std::string(". _-").find(stem[end]) != std::string::npos
             ? stem.substr(0, end)
             : stem;
}

void addPart(const std::filesystem::path& path, const ExrFile& file, int part,
             std::vector<ChannelGroup>& groups) {
  if (lower(file.partName(part)).find("crypto") != std::string::npos) return;
  std::map<std::string, std::map<std::string, std::string>> layers;  // component, in lower case -> channel
  for (const std::string& channel : file.channels(part)) {
    const std::size_t dot = channel.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : channel.substr(0, dot);
    if (lower(layer).find("crypto") != std::string::npos) continue;
    layers[layer][componentOf(channel.substr(dot + 1))] = channel;
  }
  for (auto& [layer, components] : layers) {
    ChannelGroup group{path, part, layer, !layer.empty(), file.viewOf(part, components.begin()->second), file.partCount() > 1, {}};
    if (layer.empty()) group.name = file.partCount() > 1 ? file.partName(part) : withoutFrame(path.stem().string());
    const auto add = [&](std::vector<std::string> channels) {
      if (channels.empty()) return;
      group.channels = std::move(channels);
      groups.push_back(group);
    };
    for (const char* wanted : {"rgb", "xyz"}) add(take(components, wanted));
    components.erase("a");
    for (const auto& [component, channel] : components) add({channel});
  }
}

}  // namespace

std::vector<ChannelGroup> survey(const std::vector<std::filesystem::path>& files) {
  std::vector<ChannelGroup> groups;
  for (const std::filesystem::path& path : files) {
    const ExrFile file(path);
    for (int part = 0; part < file.partCount(); ++part) addPart(path, file, part, groups);
  }
  return groups;
}

Image readGroup(const ChannelGroup& group) {
  Image image;
  image.channels = static_cast<int>(group.channels.size());
  std::vector<ExrPlane> planes;
  for (std::size_t i = 0; i < group.channels.size(); ++i)
    planes.push_back({group.channels[i], &image, static_cast<int>(i), 0});
  ExrFile(group.file).read(group.part, ExrWindow::Display, planes);
  return image;
}

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
  bool includesAlbedo = false;
  const char* beside = "";  // of a group that must be there, too
};

constexpr double kPi = std::numbers::pi;
constexpr double kCentimeter = 0.01;

constexpr const char* kIsPicture =
    "a finished picture holds highlights and the surface color, too: render the irradiance instead";

// Light that surfaces reflect is albedo E / pi. Passes before the albedo hold E / pi, others the product.
constexpr Name raw(const char* text, const char* what) {
  return {Role::Irradiance, Match::Holds, text, what, "", kPi};
}
// Blender 5 names its pass as Arnold does, but keeps the color in a pass of another name.
constexpr Name kBlendersDirect = {Role::Irradiance,
                                  Match::Holds,
                                  "diffusedirect",
                                  "Blender's Diffuse Direct, which is E / pi",
                                  "",
                                  kPi,
                                  0,
                                  false,
                                  "diffusecolor"};
constexpr Name product(Match match, const char* text, const char* what, const char* beside = "") {
  return {Role::Irradiance, match, text, what, "", kPi, 0, true, beside};
}

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
    {Role::FrontDepth, Match::Holds, "worlddepth", "a world depth of Unreal's render queue, in centimeters", "", 1,
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
    kBlendersDirect,
    raw("rawtotallight", "V-Ray's raw light, direct and indirect, which is E / pi"),
    raw("rawlight", "V-Ray's raw direct light, which is E / pi"),
    raw("totaldiffuselightingraw", "Redshift's raw diffuse light, direct and indirect, which is E / pi"),
    raw("diffuselightingraw", "Redshift's raw direct diffuse light, which is E / pi"),
    {Role::Irradiance, Match::Holds, "lightingonly", "Unreal's view of light alone",
     "Unreal's Lighting Only has a gray albedo of .5 and is pre-exposed: set the scale", 2},
    product(Match::Holds, "totallight", "V-Ray's light times color, direct and indirect"),
    product(Match::Holds, "totaldiffuselight", "a pass of diffuse light, direct and indirect"),
    product(Match::Holds, "vraylighting", "V-Ray's light times color"),
    product(Match::Is, "diffuse", "Arnold's diffuse light, direct and indirect", "diffusealbedo"),
    product(Match::Holds, "diffuselighting", "a pass of diffuse light"),
    product(Match::Holds, "diffusedirect", "Arnold's direct diffuse light"),
    product(Match::Holds, "directdiffuse", "a pass of direct diffuse light"),
    product(Match::Holds, "diffuselight", "a pass of diffuse light"),
    product(Match::Holds, "lighting", "a pass of light"),
    {Role::Albedo, Match::Holds, "diffusealbedo", "Arnold's diffuse albedo"},
    {Role::Albedo, Match::Holds, "albedo", "an albedo"},
    {Role::Albedo, Match::Holds, "diffcol", "Blender's Diffuse Color"},
    {Role::Albedo, Match::Holds, "basecolor", "a base color"},
    {Role::Albedo, Match::Holds, "gbufferc", "Unreal's base color"},
    {Role::Albedo, Match::Holds, "diffusefilter", "V-Ray's diffuse color"},
    {Role::Albedo, Match::Holds, "diffusecolor", "a diffuse color"},
    {Role::Albedo, Match::Is, "diffuse", "V-Ray's diffuse color"},
    {Role::Material, Match::Holds, "indexma", "Blender's Material Index"},
    {Role::Material, Match::Holds, "materialindex", "Blender's Material Index"},
    {Role::Material, Match::Holds, "materialid", "a material's number"},
    {Role::Material, Match::Holds, "matid", "a material's number"},
    {Role::Material, Match::Holds, "mtlid", "V-Ray's number of a material"},
    {Role::Material, Match::Ends, "material", "a material's number"},
    {Role::Material, Match::Holds, "shadingmodel", "Unreal's shading model"},
    {Role::Material, Match::Holds, "customstencil", "Unreal's custom stencil"},
    {Role::Material, Match::Holds, "indexob", "Blender's Object Index"},
    {Role::Material, Match::Holds, "objectindex", "Blender's Object Index"},
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
bool isTriple(Role role) { return role == Role::Irradiance || role == Role::Albedo; }

// A single number may be the first of a color: RenderDoc saves every texture as one, and V-Ray, Redshift, Octane and Corona their
// depths and ids.
bool hasShapeOf(Role role, const ChannelGroup& group) {
  if (isTriple(role)) return group.channels.size() == 3;
  const std::string name = plain(group.name);
  const bool isNumber = role == Role::Material ? name.ends_with("id") : name.find("depth") != std::string::npos || name.ends_with("z");
  return group.channels.size() == 1 || !group.isNamed || isNumber;
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

bool holdsAny(const std::string& name, std::initializer_list<const char*> parts) {
  return std::any_of(parts.begin(), parts.end(), [&](const char* part) { return name.find(part) != std::string::npos; });
}

// True of passes that have the name of a role and other content: a denoiser's guides, and mist, which grows from 0 to 1.
bool isNoRole(const std::string& name) { return holdsAny(name, {"denois", "mist"}); }

// True of places, normals and motion, and of passes of other light, whose names hold the names of diffuse passes, too.
bool isNoDiffuseLight(const std::string& name) {
  return name == "n" || name == "nn" || name == "p" || name == "uv" ||
         holdsAny(name, {"normal", "gbuffera", "position", "motion", "velocity", "specular", "reflect", "refract", "indirect",
                         "volume", "transl", "transmi", "sss", "subsurface"});
}

bool hasName(const ChannelGroup& group, const Name& known) {
  const std::vector<std::string> names = namesOf(group);
  if (isNoRole(names[0]) || (names.size() > 1 && isNoRole(names[1]))) return false;
  if (known.role == Role::Irradiance && isNoDiffuseLight(names[0])) return false;
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) { return fits(name, known); });
}

bool hasNameOf(const ChannelGroup& group, const Name& known, const std::vector<ChannelGroup>& groups) {
  const auto isBeside = [&](const ChannelGroup& other) {
    return plain(other.name).find(known.beside) != std::string::npos;
  };
  return hasName(group, known) && std::any_of(groups.begin(), groups.end(), isBeside);
}

Guess guessOf(const ChannelGroup& group, const Name& known) {
  Guess guess{group,
              std::string("its name is that of ") + known.what,
              known.doubt,
              known.scale,
              known.includesAlbedo,
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

// The view layer that a program writes before the pass: "Char" of Char.Depth, and of Char.Depth.left in the view "left".
std::string layerOf(const ChannelGroup& group) {
  std::string name = group.name;
  if (!group.view.empty() && name.ends_with("." + group.view)) name.resize(name.size() - group.view.size() - 1);
  const std::size_t dot = name.rfind('.');
  return dot == std::string::npos ? "" : name.substr(0, dot);
}

// Buffers of other view layers than the irradiance's give way to those of its layer.
void takeOneLayer(const std::vector<ChannelGroup>& groups, const std::map<Role, std::string>& given,
                  std::map<Role, Guess>& guesses) {
  const auto light = guesses.find(Role::Irradiance);
  if (light == guesses.end() || layerOf(light->second.group).empty()) return;
  const std::string layer = layerOf(light->second.group);
  for (auto& entry : guesses) {
    const Role role = entry.first;
    Guess& guess = entry.second;
    if (given.count(role) || layerOf(guess.group).empty() || layerOf(guess.group) == layer) continue;
    guess.doubt = "is of the layer \"" + layerOf(guess.group) + "\", but the irradiance of \"" + layer + "\"";
    for (const Name& known : kNames) {
      const auto found = std::find_if(groups.begin(), groups.end(), [&](const ChannelGroup& group) {
        return layerOf(group) == layer && hasShapeOf(role, group) && hasNameOf(group, known, groups);
      });
      if (known.role != role || found == groups.end()) continue;
      guess = guessOf(*found, known);
      break;
    }
  }
}

}  // namespace

const char* roleName(Role role) {
  constexpr const char* kKeys[] = {"frontDepth", "backDepth", "irradiance", "albedo", "material"};
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
    // Its name still says what the numbers are.
    const auto known = std::find_if(std::begin(kNames), std::end(kNames), [&](const Name& candidate) {
      return candidate.role == role && hasNameOf(*found, candidate, groups);
    });
    if (known != std::end(kNames)) {
      guess.scale = known->scale;
      guess.includesAlbedo = known->includesAlbedo;
      guess.metersPerUnit = known->metersPerUnit;
    }
    guesses[role] = guess;
  }
  for (const Name& known : kNames) {
    if (guesses.count(known.role)) continue;
    for (const ChannelGroup& group : groups) {
      if (!hasShapeOf(known.role, group) || isTaken(guesses, group)) continue;
      if (!hasNameOf(group, known, groups)) continue;
      Guess& guess = guesses[known.role] = guessOf(group, known);
      // Light groups share the name, and each has a part of the light.
      for (const ChannelGroup& other : groups)
        if (known.role == Role::Irradiance && *known.text && &other != &group && hasShapeOf(known.role, other) &&
            layerOf(other) == layerOf(group) && hasNameOf(other, known, groups))
          guess.doubt = "\"" + other.name + "\" has the same name: if each holds a part of the light, render their sum";
      break;
    }
  }
  takeOneLayer(groups, given, guesses);
  return guesses;
}

}  // namespace pellucid::harness
