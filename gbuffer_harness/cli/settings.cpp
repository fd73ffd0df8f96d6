#include "cli/settings.h"

#include <charconv>
#include <functional>
#include <map>

#include "common/error.h"

namespace pellucid::harness {
namespace {

template <class T>
using Names = std::map<std::string, T>;

const Names<PellucidDebugView> kDebugViews = {{"thickness", PELLUCID_DEBUG_THICKNESS},
                                              {"transmittance", PELLUCID_DEBUG_TRANSMITTANCE},
                                              {"occlusion", PELLUCID_DEBUG_OCCLUSION},
                                              {"irradiance", PELLUCID_DEBUG_IRRADIANCE}};
const Names<uint32_t> kFeatures = {
    {"none", 0}, {"translucency", PELLUCID_FEATURE_TRANSLUCENCY}, {"diffusion", PELLUCID_FEATURE_DIFFUSION}};
const Names<PellucidThicknessSource> kThickness = {{"light", PELLUCID_THICKNESS_LIGHT},
                                                   {"camera", PELLUCID_THICKNESS_CAMERA}};
const Names<VkFormat> kFormats = {{"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT},
                                  {"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT}};
const Names<bool> kBooleans = {{"0", false}, {"1", true}};

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts(1);
  for (char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

template <class T>
T lookUp(const Names<T>& names, const std::string& key, const std::string& value) {
  if (const auto found = names.find(value); found != names.end()) return found->second;
  std::string known;
  for (const auto& [name, unused] : names) known += (known.empty() ? "" : ", ") + name;
  throw UsageError(key + ": \"" + value + "\" is not one of " + known);
}

uint32_t number(const std::string& key, const std::string& text) {
  uint32_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw UsageError(key + ": \"" + text + "\" is not a whole number");
  return value;
}

using Setter = std::function<void(const std::string& key, const std::string& value, ReplaySettings&)>;

const std::map<std::string, Setter> kKeys = {
    {"features",
     [](const std::string& key, const std::string& value, ReplaySettings& s) {
       s.features = 0;
       for (const std::string& name : split(value, ',')) s.features |= lookUp(kFeatures, key, name);
     }},
    {"thickness", [](const std::string& key, const std::string& value,
                     ReplaySettings& s) { s.thicknessSource = lookUp(kThickness, key, value); }},
    {"format", [](const std::string& key, const std::string& value,
                  ReplaySettings& s) { s.outputFormat = lookUp(kFormats, key, value); }},
    {"alias", [](const std::string& key, const std::string& value,
                 ReplaySettings& s) { s.aliasOutput = lookUp(kBooleans, key, value); }},
    {"rect",
     [](const std::string& key, const std::string& value, ReplaySettings& s) {
       const std::vector<std::string> parts = split(value, ',');
       if (parts.size() != 4) throw UsageError(key + ": \"" + value + "\" is not x,y,width,height");
       for (size_t i = 0; i < 4; ++i) s.renderRect[i] = number(key, parts[i]);
     }},
};

}  // namespace

void SettingsOptions::addTo(CLI::App& command) {
  command.add_option(
      "--set", set,
      "key=value, repeatable: features=translucency,diffusion; thickness=light|camera (of lights "
      "with a shadow map); format=rgba16f|rgba32f; rect=x,y,width,height; alias=0|1 (output is the "
      "irradiance image)");
  command.add_option("--debug", debug,
                     "write an intermediate: thickness (mm), transmittance, occlusion, irradiance");
}

ReplaySettings SettingsOptions::parse() const {
  ReplaySettings settings;
  if (!debug.empty()) settings.debugView = lookUp(kDebugViews, "--debug", debug);
  for (const std::string& assignment : set) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw UsageError("--set: \"" + assignment + "\" is not key=value");
    const std::string key = assignment.substr(0, equals);
    const auto found = kKeys.find(key);
    if (found == kKeys.end()) {
      std::string known;
      for (const auto& [name, unused] : kKeys) known += (known.empty() ? "" : ", ") + name;
      throw UsageError("--set: unknown key \"" + key + "\"; there are " + known);
    }
    found->second("--set " + key, assignment.substr(equals + 1), settings);
  }
  return settings;
}

}  // namespace pellucid::harness
