#include "init/manifest.h"

#include <algorithm>
#include <initializer_list>
#include <iterator>
#include <map>
#include <numbers>

#include "common/error.h"
#include "init/sides.h"

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

// Of a file with the name "topaz", not every channel is a depth.
bool isOnlyStem(const ChannelGroup& group, const std::string& name, const Name& known) {
  return known.match == Match::Ends && known.text == std::string("z") && !group.isNamed && group.channels.size() == 1 &&
         name == plain(group.name) && name != "z" && wordsOf(group.name).back() != "z";
}

bool hasName(const ChannelGroup& group, const Name& known) {
  const std::vector<std::string> names = namesOf(group);
  if (isNoRole(names[0]) || (names.size() > 1 && isNoRole(names[1]))) return false;
  // A file may be called after its body: sss_irradiance.
  if (known.role == Role::Irradiance && isNoDiffuseLight(names[0]) && (group.isNamed || names[0].find("irradiance") == std::string::npos)) return false;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return fits(name, known) && !isOnlyStem(group, name, known); });
}

bool hasNameOf(const ChannelGroup& group, const Name& known, const std::vector<ChannelGroup>& groups) {
  const auto isBeside = [&](const ChannelGroup& other) {
    return plain(other.name).find(known.beside) != std::string::npos;
  };
  return hasName(group, known) && !(isDepth(known.role) && isOfVector(group, groups)) &&
         std::any_of(groups.begin(), groups.end(), isBeside);
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

bool isSame(const ChannelGroup& a, const ChannelGroup& b) {
  return a.file == b.file && a.part == b.part && a.channels.front() == b.channels.front();
}

bool isOfOneFile(const ChannelGroup& a, const ChannelGroup& b) { return a.file == b.file && a.part == b.part; }

bool areOfSeveral(const std::vector<ChannelGroup>& groups) {
  return std::any_of(groups.begin(), groups.end(), [&](const ChannelGroup& group) { return !isOfOneFile(group, groups.front()); });
}

// Buffers of a frame of back faces are no others' but the back depth's.
class Guesser {
public:
  Guesser(const std::vector<ChannelGroup>& groups, const IsColor& isColor) : groups_(groups), isColor_(isColor), sides_(groups) {
    prefer([&](const ChannelGroup& group) { return sides_.ofFile(group) != Side::Back; });
    prefer([&](const ChannelGroup& group) { return sides_.ofFile(group) == Side::Front; });
  }

  std::map<Role, Guess> guess(const std::map<Role, std::string>& given);

private:
  template <class Is>
  void prefer(const Is& is) {
    std::stable_partition(groups_.begin(), groups_.end(), is);
  }
  bool hasShape(Role role, const ChannelGroup& group) const;
  bool isBack(Role role, const ChannelGroup& group) const;
  bool isTaken(const ChannelGroup& group) const;
  bool isNumber(Role role, const ChannelGroup& group);
  bool couldBe(Role role, const ChannelGroup& group, const Name& known);
  template <class Accept>
  std::optional<Guess> find(Role role, Role named, const Accept& accept);
  bool isNameOf(Role role, const ChannelGroup& group) const;
  std::vector<ChannelGroup> fitting(Role role, const std::string& name, bool& isFile) const;
  std::string listOf(const std::vector<ChannelGroup>& groups) const;
  ChannelGroup chosen(Role role, const std::string& name) const;
  void addGiven(Role role, const std::string& name);
  void addFront();
  void addBack();
  void addOthers(bool takesBacks);
  void takeOneLayer();
  void nameOthers();

  std::vector<ChannelGroup> groups_;  // those that are preferred come first
  const IsColor& isColor_;
  const Sides sides_;
  std::map<Role, std::string> given_;
  std::map<Role, Guess> guesses_;
  std::vector<ChannelGroup> colors_;  // whose names are those of numbers
};

// In a file of more channels, its name says nothing of its color.
bool Guesser::hasShape(Role role, const ChannelGroup& group) const {
  const auto isBeside = [&](const ChannelGroup& other) { return isOfOneFile(group, other) && !isSame(group, other); };
  return hasShapeOf(role, group) && (isTriple(role) || group.isNamed || group.channels.size() == 1 ||
                                     std::none_of(groups_.begin(), groups_.end(), isBeside));
}

// A file of back depth that only a person or its name tells from one of front depth is all of back faces.
bool Guesser::isBack(Role role, const ChannelGroup& group) const {
  if (sides_.of(role, group) == Side::Back) return true;
  const auto back = guesses_.find(Role::BackDepth), front = guesses_.find(Role::FrontDepth);
  return !isDepth(role) && back != guesses_.end() && front != guesses_.end() && isOfOneFile(group, back->second.group) &&
         !isOfOneFile(group, front->second.group) && !isNameOf(Role::BackDepth, back->second.group) &&
         isNameOf(Role::FrontDepth, back->second.group);
}

bool Guesser::isTaken(const ChannelGroup& group) const {
  return std::any_of(guesses_.begin(), guesses_.end(), [&](const auto& entry) { return isSame(entry.second.group, group); }) ||
         std::any_of(colors_.begin(), colors_.end(), [&](const ChannelGroup& color) { return isSame(color, group); });
}

// Colored ids, and depths beside normals, have the names of numbers.
bool Guesser::isNumber(Role role, const ChannelGroup& group) {
  if (isTriple(role) || group.channels.size() != 3 || !isColor_ || !isColor_(role, group)) return true;
  colors_.push_back(group);
  return false;
}

bool Guesser::couldBe(Role role, const ChannelGroup& group, const Name& known) {
  return hasShape(role, group) && !isTaken(group) && hasNameOf(group, known, groups_) && isNumber(role, group);
}

// The first that has a name of the role `named`.
template <class Accept>
std::optional<Guess> Guesser::find(Role role, Role named, const Accept& accept) {
  for (const Name& known : kNames)
    for (const ChannelGroup& group : groups_)
      if (known.role == named && accept(group) && couldBe(role, group, known)) return guessOf(group, known);
  return std::nullopt;
}

bool Guesser::isNameOf(Role role, const ChannelGroup& group) const {
  return std::any_of(std::begin(kNames), std::end(kNames),
                     [&](const Name& known) { return known.role == role && hasNameOf(group, known, groups_); });
}

std::string Guesser::listOf(const std::vector<ChannelGroup>& groups) const {
  std::string list;
  for (const ChannelGroup& group : groups) list += (list.empty() ? "" : ", ") + labelOf(group, groups_);
  return list;
}

// Of equal names, a render of back faces has the back depth, and no other buffer.
std::vector<ChannelGroup> Guesser::fitting(Role role, const std::string& name, bool& isFile) const {
  Named named = groupsNamed(name, role, groups_);
  std::vector<ChannelGroup>& groups = named.groups;
  std::erase_if(groups, [&](const ChannelGroup& group) {
    return !hasShape(role, group) && (isTriple(role) || group.channels.size() != 1);
  });
  const auto isOther = [&](const ChannelGroup& group) { return isBack(role, group) != (role == Role::BackDepth); };
  if (areOfSeveral(groups) && !std::all_of(groups.begin(), groups.end(), isOther)) std::erase_if(groups, isOther);
  isFile = named.isFile;
  return groups;
}

ChannelGroup Guesser::chosen(Role role, const std::string& name) const {
  bool isFile = false;
  std::vector<ChannelGroup> groups = fitting(role, name, isFile);
  const std::string start = std::string(roleName(role)) + ": ";
  if (groups.empty()) {
    std::vector<ChannelGroup> all = groups_;
    std::erase_if(all, [&](const ChannelGroup& group) { return !hasShape(role, group); });
    throw UsageError(start + "there is no \"" + name + "\" that fits; there are " + listOf(all));
  }
  if (areOfSeveral(groups)) throw UsageError(start + "several have the name \"" + name + "\"; name one of " + listOf(groups));
  const auto hasName = [&](const ChannelGroup& group) {
    return isNameOf(role, group) || (role == Role::BackDepth && isNameOf(Role::FrontDepth, group));
  };
  const auto found = std::find_if(groups.begin(), groups.end(), hasName);
  if (found != groups.end()) return *found;
  if (isFile && groups.size() > 1) throw UsageError(start + "\"" + name + "\" has several; name one of " + listOf(groups));
  return groups.front();
}

void Guesser::addGiven(Role role, const std::string& name) {
  const ChannelGroup group = chosen(role, name);
  if (!isNumber(role, group))
    throw UsageError(std::string(roleName(role)) + ": " + group.file.string() + " " + group.name + ": " + kIsColor +
                     "; name one of " + group.channels[0] + ", " + group.channels[1] + ", " + group.channels[2]);
  Guess guess = guessOf(group, {role, Match::Is, "", ""});
  guess.why = "you named it";
  // Its name still says what the numbers are.
  const auto known = std::find_if(std::begin(kNames), std::end(kNames), [&](const Name& candidate) {
    return candidate.role == role && hasNameOf(group, candidate, groups_);
  });
  if (known != std::end(kNames)) {
    guess.scale = known->scale;
    guess.includesAlbedo = known->includesAlbedo;
    guess.metersPerUnit = known->metersPerUnit;
  }
  guesses_[role] = guess;
}

// A lone hero_back.exr with Z has a front depth.
void Guesser::addFront() {
  const auto isOfBacks = [&](const ChannelGroup& group) { return isBack(Role::FrontDepth, group); };
  auto found = find(Role::FrontDepth, Role::FrontDepth, [&](const ChannelGroup& group) {
    return !isOfBacks(group) && !isNameOf(Role::BackDepth, group);
  });
  if (!found && sides_.areAllBack())
    found = find(Role::FrontDepth, Role::FrontDepth,
                 [&](const ChannelGroup& group) { return !group.isNamed || !isNameOf(Role::BackDepth, group); });
  if (found) guesses_[Role::FrontDepth] = *found;
}

void Guesser::addBack() {
  auto found = find(Role::BackDepth, Role::BackDepth, [](const ChannelGroup&) { return true; });
  if (!found) {
    found = find(Role::BackDepth, Role::FrontDepth, [&](const ChannelGroup& group) { return isBack(Role::BackDepth, group); });
    if (found) found->why += ", in what is named after back faces";
  }
  if (found) guesses_[Role::BackDepth] = *found;
}

// In the order of names: pictures come last.
void Guesser::addOthers(bool takesBacks) {
  for (const Name& known : kNames) {
    if (isDepth(known.role) || guesses_.count(known.role)) continue;
    for (const ChannelGroup& group : groups_) {
      if ((!takesBacks && isBack(known.role, group)) || !couldBe(known.role, group, known)) continue;
      Guess& guess = guesses_[known.role] = guessOf(group, known);
      if (takesBacks) guess.doubt = "\"" + labelOf(group, groups_) + "\" is of a file of back faces: name the pass of front faces";
      // Light groups share the name, and each has a part of the light.
      for (const ChannelGroup& other : groups_)
        if (known.role == Role::Irradiance && *known.text && !isSame(other, group) && !isBack(known.role, other) &&
            hasShape(known.role, other) && layerOf(other) == layerOf(group) && hasNameOf(other, known, groups_))
          guess.doubt = "\"" + labelOf(other, groups_) + "\" has the same name: if each holds a part of the light, render their sum";
      break;
    }
  }
}

// Buffers of other view layers than the irradiance's give way to those of its layer.
void Guesser::takeOneLayer() {
  const auto light = guesses_.find(Role::Irradiance);
  if (light == guesses_.end() || layerOf(light->second.group).empty()) return;
  const std::string layer = layerOf(light->second.group);
  for (auto& entry : guesses_) {
    const Role role = entry.first;
    Guess& guess = entry.second;
    const std::string other = layerOf(guess.group);
    const bool isBackLayer = role == Role::BackDepth && isBack(role, guess.group);
    if (given_.count(role) || isBackLayer || other.empty() || other == layer) continue;
    guess.doubt = "is of the layer \"" + other + "\", but the irradiance of \"" + layer + "\"";
    const auto found = find(role, role, [&](const ChannelGroup& group) {
      return layerOf(group) == layer && isBack(role, group) == (role == Role::BackDepth);
    });
    if (found) guess = *found;
  }
}

// Another file's depth of the same name may be that of back faces.
void Guesser::nameOthers() {
  const auto front = guesses_.find(Role::FrontDepth);
  if (front == guesses_.end() || given_.count(Role::FrontDepth) || guesses_.count(Role::BackDepth)) return;
  std::string& doubt = front->second.doubt;
  for (const ChannelGroup& other : groups_)
    if (doubt.empty() && !isOfOneFile(other, front->second.group) && isNameOf(Role::FrontDepth, other) &&
        hasShape(Role::FrontDepth, other) && !isTaken(other) && isNumber(Role::FrontDepth, other))
      doubt = "\"" + labelOf(other, groups_) + "\" may be another depth: --back-depth names it, if it is of back faces";
}

std::map<Role, Guess> Guesser::guess(const std::map<Role, std::string>& given) {
  given_ = given;
  for (const auto& [role, name] : given) addGiven(role, name);
  if (!guesses_.count(Role::FrontDepth)) addFront();
  if (!guesses_.count(Role::BackDepth)) addBack();
  // Of equal names, those of one render belong together.
  if (const auto front = guesses_.find(Role::FrontDepth); front != guesses_.end()) {
    const std::filesystem::path file = front->second.group.file;
    prefer([&](const ChannelGroup& group) { return group.file == file; });
  }
  addOthers(false);
  addOthers(true);
  takeOneLayer();
  nameOthers();
  return std::move(guesses_);
}

}  // namespace

const char* roleName(Role role) {
  constexpr const char* kKeys[] = {"frontDepth", "backDepth", "irradiance", "albedo", "material"};
  return kKeys[static_cast<std::size_t>(role)];
}

std::map<Role, Guess> guessRoles(const std::vector<ChannelGroup>& groups, const std::map<Role, std::string>& given,
                                 const IsColor& isColor) {
  return Guesser(groups, isColor).guess(given);
}

}  // namespace pellucid::harness
