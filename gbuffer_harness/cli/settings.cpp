#include "cli/settings.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "capture/json_field.h"
#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {
namespace {

// By PellucidDebugView.
const std::vector<std::string> kDebugViews = {"", "thickness", "transmittance", "occlusion", "irradiance"};
static_assert(PELLUCID_DEBUG_THICKNESS == 1 && PELLUCID_DEBUG_TRANSMITTANCE == 2 &&
              PELLUCID_DEBUG_OCCLUSION == 3 && PELLUCID_DEBUG_IRRADIANCE == 4);

// As --set takes it: a string, a number, or an array's numbers with commas.
std::string valueText(const Field& field) {
  if (field.value().is_string()) return field.text();
  if (!field.value().is_array()) return field.number(), field.value().dump();
  std::string text;
  for (const Field& item : field.items()) {
    item.number();
    text.append(text.empty() ? "" : ",").append(item.value().dump());
  }
  return text;
}

std::vector<std::string> assignmentsIn(const std::string& path) {
  const nlohmann::json json = readJson(path);
  const Field root(path, json);
  if (!json.is_object()) root.fail("is not an object of settings");
  std::vector<std::string> assignments;
  for (const auto& [key, field] : root.members()) {
    const auto known = [&name = key](const Setting& setting) { return setting.key == name; };
    if (std::none_of(settingsTable().begin(), settingsTable().end(), known))
      field.fail("is not a key of --set");
    assignments.push_back(key + "=" + valueText(field));
  }
  return assignments;
}

}  // namespace

std::vector<std::string> SettingsOptions::assignments() const {
  std::vector<std::string> all;
  for (const std::string& s : set) {
    if (s.empty() || s.front() != '@') {
      all.push_back(s);
      continue;
    }
    const std::vector<std::string> read = assignmentsIn(s.substr(1));
    all.insert(all.end(), read.begin(), read.end());
  }
  return all;
}

void SettingsOptions::addTo(const Command& command) {
  std::string help = "key=value, or @FILE with a JSON object of them, repeatable:";
  for (const Setting& setting : settingsTable()) help.append(" ").append(syntaxOf(setting)).append(";");
  command.option("--mode", mode, "physical (default) or thesis: Whelan 2009's; --set changes either");
  command.option("--set", set, help);
  command.option("--debug", debug,
                 "write an intermediate: thickness (mm), transmittance, occlusion, irradiance");
}

ReplaySettings SettingsOptions::parse() const {
  ReplaySettings settings;
  settings.translucency.gatherSamples = kDefaultGatherSamples;
  if (mode == "thesis")
    settings = thesisSettings();
  else if (mode != "physical")
    throw UsageError("--mode: \"" + mode + "\" is not one of physical, thesis");
  settings.preExposure = 0;  // captures of physical units are brighter than halves hold
  if (!debug.empty()) {
    const auto found = std::find(kDebugViews.begin(), kDebugViews.end(), debug);
    if (found == kDebugViews.end())
      throw UsageError("--debug: \"" + debug + "\" is not one of irradiance, occlusion, thickness, transmittance");
    settings.debugView = static_cast<PellucidDebugView>(found - kDebugViews.begin());
  }
  for (const std::string& assignment : assignments()) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw UsageError("--set: \"" + assignment + "\" is not key=value");
    const std::string key = assignment.substr(0, equals);
    const Setting& setting = findSetting("--set", key);
    setting.set(settings, parseValues(setting, "--set " + key, assignment.substr(equals + 1)));
  }
  return settings;
}

std::string settingsJson(const ReplaySettings& settings) {
  nlohmann::ordered_json json;
  for (const Setting& setting : settingsTable()) {
    const Setting::Values values = setting.get(settings);
    if (!setting.names.empty())
      json[setting.key] = namesOf(setting, values);
    else if (setting.kind == Setting::Kind::Whole && values.size() == 1)
      json[setting.key] = static_cast<std::uint32_t>(values[0]);
    else if (setting.kind == Setting::Kind::Whole)
      json[setting.key] = std::vector<std::uint32_t>(values.begin(), values.end());
    else if (values.size() == 1 && !setting.anyCount)
      json[setting.key] = values[0];
    else if (!values.empty())
      json[setting.key] = values;
  }
  return json.dump(2) + "\n";
}

std::string debugOption(const ReplaySettings& settings) { return kDebugViews.at(settings.debugView); }

std::string SettingsOptions::text() const {
  std::string all = "mode=" + mode;
  for (const std::string& s : assignments()) all += " " + s;
  return all;
}

bool isCaptureFile(const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  return extension == ".exr" || extension == ".json";
}

void requireExr(const std::string& option, const std::filesystem::path& path) {
  const std::string extension = lower(path.extension().string());
  if (!extension.empty() && extension != ".exr")
    throw UsageError(option + ": \"" + path.string() + "\" is written as EXR and cannot be called " +
                     extension);
}

}  // namespace pellucid::harness
