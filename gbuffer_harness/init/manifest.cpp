#include "init/manifest.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <set>

#include "capture/manifest.h"
#include "capture/manifest_parts.h"
#include "common/error.h"
#include "reference/camera.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostMaterials = 1000;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

// Backgrounds of id passes: below 0, not finite, or the largest number of 32 bits.
bool isNoId(float value) { return !(value >= 0 && value < 4294967295.0f); }

// Builds the manifest buffer by buffer.
class Builder {
public:
  Builder(const std::vector<std::filesystem::path>& files, const std::filesystem::path& folder,
          const InitWords& words)
      : files_(files), folder_(folder), words_(words) {}

  GuessedManifest build();

private:
  Json sourceOf(Role role) const;
  std::string fileOf(const ChannelGroup& group) const;
  void say(Role role, const std::string& how);
  void doubt(const std::string& key, const std::string& sentence);
  void addDepths();
  void addIrradiance();
  std::optional<std::map<long, std::size_t>> storedIds(const Image& image) const;
  void mapGivenIds(const Image& image, Json& json);
  void mapFoundIds(const std::map<long, std::size_t>& stored, Json& json);
  void addMaterial();
  void addBlackness();
  std::vector<ChannelGroup> ofOneView(std::vector<ChannelGroup> groups);
  void addAttributes();
  bool isColor(Role role, const ChannelGroup& group);
  std::string colorsOf(Role role) const;
  std::string backs() const;
  void guessBuffers(const std::vector<ChannelGroup>& groups);
  std::vector<CameraSource> cameraSources() const;
  void nameUnused(const std::vector<ChannelGroup>& groups);
  void addCamera();
  void addMissing();
  Image read(Role role);
  DepthFacts depthFacts() const;

  const std::vector<std::filesystem::path>& files_;
  const std::filesystem::path& folder_;
  const InitWords& words_;
  std::map<Role, Guess> guesses_;
  std::map<Role, std::set<std::string>> colors_;  // sentences: groups that have the role's name and hold colors
  Image front_, irradiance_;
  std::vector<bool> isTranslucent_;  // of each pixel
  DepthFacts depth_;
  GuessedCamera camera_;
  int width_ = 0, height_ = 0;
  GuessedManifest result_;
};

Json Builder::sourceOf(Role role) const {
  const ChannelGroup& group = guesses_.at(role).group;
  Json json = {{"file", std::filesystem::proximate(group.file, folder_).generic_string()}};
  if (group.hasBeside) json["part"] = group.part;
  if (group.channels.size() == 1)
    json["channel"] = group.channels[0];
  else
    json["channels"] = group.channels;
  return json;
}

// Of files of one name in several folders, the path.
std::string Builder::fileOf(const ChannelGroup& group) const {
  const std::filesystem::path name = group.file.filename();
  const bool isOfSeveral = std::any_of(files_.begin(), files_.end(), [&](const std::filesystem::path& other) {
    return other != group.file && other.filename() == name;
  });
  return (isOfSeveral ? group.file : name).string();
}

void Builder::say(Role role, const std::string& how) {
  const Guess& guess = guesses_.at(role);
  std::string channels;
  for (const std::string& channel : guess.group.channels) channels += (channels.empty() ? "" : ",") + channel;
  result_.found.push_back(std::string(roleName(role)) + ": " + fileOf(guess.group) + " " +
                          channels + (how.empty() ? "" : ", " + how) + ": " + guess.why);
  if (!guess.doubt.empty()) doubt(roleName(role), guess.doubt);
}

// In the manifest, and among what would make the picture better.
void Builder::doubt(const std::string& key, const std::string& sentence) {
  result_.json["// " + key] = sentence;
  result_.missing.push_back(key + ": " + sentence);
}

Image Builder::read(Role role) {
  const ChannelGroup& group = guesses_.at(role).group;
  Image image = readGroup(group);
  if (width_ == 0) {
    width_ = image.width;
    height_ = image.height;
  }
  if (image.width != width_ || image.height != height_)
    throw InputError(group.file.string(), roleName(role),
                     std::to_string(image.width) + "x" + std::to_string(image.height) +
                         " pixels, but frontDepth has " + std::to_string(width_) + "x" +
                         std::to_string(height_));
  return image;
}

// Device depths lie within 0 .. 1 and are cleared to one of them; distances begin above 0 and mostly pass 1.
DepthFacts Builder::depthFacts() const {
  double least = INFINITY, most = 0, sum = 0;
  std::size_t zeros = 0, ones = 0, count = 0;
  for (const float value : front_.data) {
    if (!std::isfinite(value) || value >= kLeastNoDepth) continue;
    zeros += value == 0;
    ones += value == 1;
    if (!(value > 0)) continue;
    least = std::min(least, static_cast<double>(value));
    most = std::max(most, static_cast<double>(value));
    if (value == 1) continue;
    sum += static_cast<double>(value);
    ++count;
  }
  if (count == 0)
    throw InputError(guesses_.at(Role::FrontDepth).group.file.string(), "frontDepth",
                     std::any_of(front_.data.begin(), front_.data.end(), [](float v) { return v < 0; })
                         ? "no depth is above 0, but some are negative; negate view z, which is positive in "
                           "front of the eye"
                         : "no pixel holds a surface");
  DepthFacts facts;
  const bool couldBe = most <= 1;
  facts.isDevice = words_.deviceDepth.value_or(couldBe && (words_.camera.nearPlane || zeros + ones > 0));
  if (facts.isDevice && !couldBe)
    throw UsageError("--depth: depths up to " + number(most) + " are not the device's");
  facts.looksReversed =
      !facts.isDevice || (zeros != ones ? zeros > ones : sum < 0.5 * static_cast<double>(count));
  facts.nearest = least;
  return facts;
}

void Builder::addDepths() {
  front_ = read(Role::FrontDepth);
  depth_ = depthFacts();
  const char* const encoding = depth_.isDevice ? "device" : "viewZ";
  for (const Role role : {Role::FrontDepth, Role::BackDepth}) {
    if (!guesses_.count(role)) continue;
    // RenderMan's zback is the far end of a sample: of a surface that is the surface again.
    if (role == Role::BackDepth && read(role).data == front_.data) {
      result_.found.push_back("backDepth: " + guesses_.at(role).group.name +
                              " is the front depth again: not taken");
      guesses_.erase(role);
      continue;
    }
    Json json = sourceOf(role);
    json["encoding"] = encoding;
    result_.json["buffers"][roleName(role)] = json;
    say(role, encoding);
  }
  if (!depth_.isDevice)
    result_.json["// frontDepth"] =
        "planar distances along the view axis are assumed; distances along the ray have to be converted";
}

void Builder::addIrradiance() {
  Guess& guess = guesses_.at(Role::Irradiance);
  const bool hasAlbedo = guesses_.count(Role::Albedo) > 0;
  irradiance_ = read(Role::Irradiance);
  Json json = sourceOf(Role::Irradiance);
  const double scale = words_.irradianceScale.value_or(guess.scale);
  if (scale != 1) json["scale"] = scale;
  if (guess.includesAlbedo && hasAlbedo) json["includesAlbedo"] = true;
  if (guess.includesAlbedo && !hasAlbedo)
    guess.doubt =
        "the pass is light times the surface color: --albedo names the color's pass, which divides it";
  result_.json["buffers"]["irradiance"] = json;
  std::string how = scale != 1 ? "times " + number(scale) : "";
  if (json.contains("includesAlbedo")) how += std::string(how.empty() ? "" : ", ") + "divided by the albedo";
  say(Role::Irradiance, how);
  if (!hasAlbedo) return;
  read(Role::Albedo);
  result_.json["buffers"]["albedo"] = sourceOf(Role::Albedo);
  say(Role::Albedo, "");
}

// Stored values, and how many pixels hold each. Nothing: too many, or fractions.
std::optional<std::map<long, std::size_t>> Builder::storedIds(const Image& image) const {
  std::map<long, std::size_t> stored;
  for (const float value : image.data) {
    if (isNoId(value)) continue;
    if (value > static_cast<float>(kMaxStoredMaterial) || std::round(value) != value) return std::nullopt;
    ++stored[std::lround(value)];
    if (stored.size() > kMostMaterials) return std::nullopt;
  }
  return stored;
}

// The person's ids hold whatever else is stored: "*" of the map takes the rest.
void Builder::mapGivenIds(const Image& image, Json& json) {
  for (const int id : words_.materialIds)
    if (std::abs(static_cast<double>(id)) > kMaxStoredMaterial)
      throw UsageError("--material-id: " + std::to_string(id) + " is above " + std::to_string(kMaxStoredMaterial) +
                       ", up to which floats tell ids apart");
  for (const int id : words_.materialIds) json["map"][std::to_string(id)] = 1;
  json["map"]["*"] = 0;
  std::string values;
  for (const int id : words_.materialIds) {
    const auto pixels = std::count_if(image.data.begin(), image.data.end(), [&](float value) {
      return std::round(value) == static_cast<float>(id);
    });
    values += (values.empty() ? "" : ", ") + std::to_string(id) + " (" + std::to_string(pixels) + " pixels)";
    if (pixels > 0) continue;
    const auto [least, most] = std::minmax_element(image.data.begin(), image.data.end());
    doubt("material", "--material-id: no pixel holds " + std::to_string(id) + "; values lie within " +
                          number(static_cast<double>(*least)) + " .. " + number(static_cast<double>(*most)));
  }
  say(Role::Material, "translucent " + values);
}

void Builder::mapFoundIds(const std::map<long, std::size_t>& stored, Json& json) {
  std::string values;
  for (const auto& [value, pixels] : stored) {
    json["map"][std::to_string(value)] = value == 0 ? 0 : 1;
    values +=
        (values.empty() ? "" : ", ") + std::to_string(value) + " (" + std::to_string(pixels) + " pixels)";
  }
  json["map"]["*"] = 0;
  say(Role::Material, "values " + values);
  doubt("material",
        "every value above 0 is taken for translucent: " + values + "; --material-id names those that are");
}

void Builder::addMaterial() {
  Json json = {{"constant", {1}}};
  result_.json["buffers"]["material"] = json;
  isTranslucent_.assign(front_.pixels(), true);
  if (!guesses_.count(Role::Material)) {
    if (!words_.materialIds.empty())
      throw UsageError("--material-id: no channel has the name of an id pass; --material-index names it" + colorsOf(Role::Material));
    return doubt("material", "no channel says what is translucent: everything is" + colorsOf(Role::Material));
  }
  const Image image = read(Role::Material);
  const auto stored = storedIds(image);
  if (words_.materialIds.empty() && !stored)
    return doubt("material", "its values are no small whole numbers, so everything is taken for translucent. Bytes that were read as fractions need "
                             "\"scale\": 255 and a \"map\" in the buffer");
  json = sourceOf(Role::Material);
  words_.materialIds.empty() ? mapFoundIds(*stored, json) : mapGivenIds(image, json);
  result_.json["buffers"]["material"] = json;
  const auto isTranslucent = [&](float value) {
    const auto found = json["map"].find(std::isfinite(value) ? std::to_string(std::lround(value)) : "*");
    return found != json["map"].end() && *found == 1;  // "*" is 0
  };
  std::transform(image.data.begin(), image.data.end(), isTranslucent_.begin(), isTranslucent);
}

// Renderers keep the light of subsurface shaders apart from that of diffuse ones.
void Builder::addBlackness() {
  for (std::size_t i = 0; i < irradiance_.data.size(); ++i)
    if (isTranslucent_[i / 3] && irradiance_.data[i] != 0) return;
  doubt(
      "irradiance",
      "the pass is black wherever something is translucent: a renderer keeps the light of subsurface shaders "
      "in a pass of their own, which has diffused already; render the irradiance with diffuse shaders");
}

// A capture has one eye: of stereo files, the first that has a color.
std::vector<ChannelGroup> Builder::ofOneView(std::vector<ChannelGroup> groups) {
  std::string taken, left;
  for (const ChannelGroup& group : groups)
    if (taken.empty() && group.channels.size() == 3) taken = group.view;
  if (taken.empty()) return groups;
  std::erase_if(groups, [&](const ChannelGroup& group) {
    const bool isOther = !group.view.empty() && group.view != taken;
    if (isOther && left.find("\"" + group.view + "\"") == std::string::npos)
      left += " \"" + group.view + "\"";
    return isOther;
  });
  if (!left.empty()) result_.found.push_back("view: \"" + taken + "\" is taken; left out:" + left);
  return groups;
}

// Colors that are no linear Rec. 709.
void Builder::addAttributes() {
  for (const Role role : {Role::Irradiance, Role::Albedo}) {
    if (!guesses_.count(role)) continue;
    const ChannelGroup& group = guesses_.at(role).group;
    std::string said;
    for (const std::string& sentence : ExrFile(group.file).unusedAttributes(group.part))
      said += (said.empty() ? "" : "; ") + sentence;
    if (!said.empty()) doubt("colors of " + std::string(roleName(role)), said);
  }
}

void Builder::nameUnused(const std::vector<ChannelGroup>& groups) {
  std::string list;
  for (const ChannelGroup& group : groups) {
    const bool isUsed = std::any_of(guesses_.begin(), guesses_.end(), [&](const auto& guess) {
      const ChannelGroup& used = guess.second.group;
      return used.file == group.file && used.part == group.part &&
             used.channels.front() == group.channels.front();
    });
    if (!isUsed)
      list += (list.empty() ? "" : ", ") + fileOf(group) + " " + group.channels.front();
  }
  if (!list.empty()) result_.found.push_back("not used: " + list);
  for (const auto& [role, sentences] : colors_)
    for (const std::string& sentence : sentences) result_.found.push_back(std::string(roleName(role)) + ": not " + sentence);
}

void Builder::addCamera() {
  camera_ = guessCamera(cameraSources(), width_, height_, words_.camera, depth_);
  result_.json["camera"] = {{"clipFromView", camera_.clipFromView}, {"viewFromWorld", camera_.viewFromWorld}};
  result_.found.push_back("camera: the projection is that of " + camera_.why);
  std::string unknown;
  for (const std::string& sentence : camera_.unknown) unknown += (unknown.empty() ? "" : "; ") + sentence;
  if (!unknown.empty()) result_.json["// camera"] = "unknown: " + unknown;
}

// The most important come first.
void Builder::addMissing() {
  std::vector<std::string> doubts;
  std::swap(doubts, result_.missing);
  if (words_.lights.empty())
    doubt(
        "lights",
        "without a light nothing comes through: --light directional:X,Y,Z:E or point:X,Y,Z:I adds one, best "
        "with a \"shadowMap\"");
  if (!guesses_.count(Role::BackDepth))
    doubt(
        "backDepth",
        "without the depth of back faces, or a light's shadow map, nothing says how thick things are: render "
        "back faces alone");
  if (result_.json.contains("// metersPerUnit"))
    result_.missing.push_back("metersPerUnit: " + result_.json["// metersPerUnit"].get<std::string>());
  if (!camera_.isPlaced && !words_.lights.empty())
    result_.missing.push_back("camera: unknown: " + camera_.unknown.front());
  result_.missing.insert(result_.missing.end(), doubts.begin(), doubts.end());
}

// Samples of a number that a program saves as a color are equal, or the first has it and the others are 0.
bool Builder::isColor(Role role, const ChannelGroup& group) {
  const Image image = readGroup(group);
  bool areEqual = true, isFirst = true;
  for (std::size_t i = 0; i < image.data.size(); i += 3)
    for (std::size_t c = i + 1; c < i + 3; ++c) {
      // Lossy compression rounds each channel by itself.
      const float a = image.data[i], b = image.data[c];
      areEqual &= a == b || std::abs(a - b) <= 0.01f * std::max(std::abs(a), std::abs(b)) || (std::isnan(a) && std::isnan(b));
      isFirst &= b == 0;
    }
  if (areEqual || isFirst) return false;
  const std::string name = fileOf(group) + " " + (group.isNamed ? group.name : group.channels.front());
  colors_[role].insert(name + ": " + kIsColor + "; an option names one of " + group.channels[0] + ", " + group.channels[1] + ", " +
                       group.channels[2]);
  return true;
}

std::string Builder::colorsOf(Role role) const {
  std::string list;
  if (const auto found = colors_.find(role); found != colors_.end())
    for (const std::string& sentence : found->second) list += "; " + sentence;
  return list;
}

// A file's name may say back faces and mean a camera behind the body.
std::string Builder::backs() const {
  const auto back = guesses_.find(Role::BackDepth);
  if (back == guesses_.end()) return "";
  return "; " + fileOf(back->second.group) + " " + back->second.group.channels.front() + " is taken for the back depth";
}

void Builder::guessBuffers(const std::vector<ChannelGroup>& groups) {
  guesses_ = guessRoles(groups, words_.roles, [&](Role role, const ChannelGroup& group) { return isColor(role, group); });
  for (const Role role : {Role::FrontDepth, Role::Irradiance}) {
    if (guesses_.count(role)) continue;
    std::string list;
    for (const ChannelGroup& group : groups)
      list += (list.empty() ? "" : ", ") + group.name + " (" + group.channels.front() + ")";
    throw UsageError(std::string(role == Role::FrontDepth ? "--front-depth" : "--irradiance") +
                     ": no name is that of one; name a layer, a channel or a file of: " + list + backs() + colorsOf(role));
  }
}

// The color's file comes first, and files without a buffer last.
std::vector<CameraSource> Builder::cameraSources() const {
  std::vector<CameraSource> sources;
  const auto add = [&](const std::filesystem::path& file, int part, bool isUsed) {
    const auto is = [&](const CameraSource& other) { return other.file == file && (!isUsed || other.part == part); };
    if (std::none_of(sources.begin(), sources.end(), is)) sources.push_back({file, part, isUsed});
  };
  const auto addRole = [&](const auto& entry) { add(entry.second.group.file, entry.second.group.part, true); };
  addRole(*guesses_.find(Role::Irradiance));
  std::for_each(guesses_.begin(), guesses_.end(), addRole);
  for (const std::filesystem::path& file : files_) add(file, 0, false);
  return sources;
}

GuessedManifest Builder::build() {
  const std::vector<ChannelGroup> groups = ofOneView(survey(files_));
  guessBuffers(groups);
  const Guess& front = guesses_.at(Role::FrontDepth);
  const double meters = words_.metersPerUnit.value_or(front.metersPerUnit > 0 ? front.metersPerUnit : 1);
  result_.json["pellucid"] = 1;
  result_.json["metersPerUnit"] = meters;
  if (!words_.metersPerUnit && !(front.metersPerUnit > 0))
    result_.json["// metersPerUnit"] =
        "unknown, 1 m is taken: --unit says how long a unit is; a material is as translucent as its lengths say";
  result_.json["camera"] = nullptr;
  result_.json["buffers"] = Json::object();
  addDepths();
  addCamera();
  addIrradiance();
  addMaterial();
  addBlackness();
  addAttributes();
  nameUnused(groups);
  result_.json["lights"] = words_.lights;
  result_.json["materials"] = Json::array({materialJson(parseMaterial("--material", words_.material))});
  addMissing();
  return std::move(result_);
}

}  // namespace

GuessedManifest guessManifest(const std::vector<std::filesystem::path>& files,
                              const std::filesystem::path& folder, const InitWords& words) {
  return Builder(files, folder, words).build();
}

}  // namespace pellucid::harness
