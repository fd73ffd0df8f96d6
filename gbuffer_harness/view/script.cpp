#include "view/script.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "capture/manifest_parts.h"
#include "common/error.h"
#include "common/parse.h"
#include "replay/settings.h"

namespace pellucid::harness {

namespace {

const std::map<std::string, std::size_t> kArguments = {
    {"move", 2},   {"material", 1},   {"press", 1}, {"release", 1}, {"wheel", 1},
    {"resize", 2}, {"set", 1},        {"show", 1},  {"split", 2},   {"exposure", 1},
    {"save", 1},   {"screenshot", 1}, {"turn", 2}};

const std::vector<std::string> kButtons = {"left", "middle", "right", "shift", "w", "a", "s", "d", "e", "q"};

[[noreturn]] void fail(const ScriptLine& line, const std::string& sentence) {
  throw InputError(line.where, line.command, sentence);
}

float parse(const ScriptLine& line, const std::string& text) {
  const std::optional<float> value = numberIn<float>(text);
  if (!value) fail(line, "\"" + text + "\" is not a number");
  return *value;
}

Shown shownOf(const ScriptLine& line, std::string name) {
  std::replace(name.begin(), name.end(), '-', ' ');
  const std::vector<std::string>& names = shownNames();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) fail(line, "there is no \"" + name + "\" to show");
  return static_cast<Shown>(found - names.begin());
}

void set(const ScriptLine& line, ReplaySettings& settings) {
  const std::string& text = line.arguments[0];
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos) fail(line, "\"" + text + "\" is not NAME=VALUE");
  try {
    const std::string key = text.substr(0, equals);
    const Setting& setting = findSetting("set", key);
    const Setting::Values values = parseValues(setting, key, text.substr(equals + 1));
    ReplaySettings nearest = settings;
    assignNearest(setting, nearest, values);
    if (!setting.label.empty() && setting.get(nearest) != values)
      fail(line, "\"" + text + "\" is not what the panel allows");
    setting.set(settings, values);
  } catch (const UsageError& error) {
    fail(line, error.what());
  }
}

}  // namespace

std::vector<ScriptLine> readScript(const std::filesystem::path& path) {
  std::ifstream file(path);
  if (!file) throw InputError(path.string(), "", "cannot be read");
  std::vector<ScriptLine> lines;
  std::string text;
  for (int number = 1; std::getline(file, text); ++number) {
    std::istringstream words(text);
    ScriptLine line;
    line.where = path.string() + ":" + std::to_string(number);
    std::string frame;
    if (!(words >> frame) || frame[0] == '#') continue;
    line.command = "frame";
    const float parsed = parse(line, frame);
    if (parsed < 1 || parsed > 1e6f || parsed != std::floor(parsed))
      fail(line, "\"" + frame + "\" is not a frame");
    line.frame = static_cast<int>(parsed);
    if (!lines.empty() && line.frame < lines.back().frame)
      fail(line, frame + " comes after " + std::to_string(lines.back().frame));
    words >> line.command;
    std::string argument;
    while (words >> argument) line.arguments.push_back(argument);
    const auto known = kArguments.find(line.command);
    if (known == kArguments.end()) fail(line, "is no command");
    if (known->second != line.arguments.size())
      fail(line, "needs " + std::to_string(known->second) + " arguments, has " +
                     std::to_string(line.arguments.size()));
    if ((line.command == "press" || line.command == "release") &&
        std::find(kButtons.begin(), kButtons.end(), line.arguments[0]) == kButtons.end())
      fail(line, "\"" + line.arguments[0] + "\" is no button or key");
    lines.push_back(std::move(line));
  }
  return lines;
}

bool applyToState(const ScriptLine& line, ViewState& state, Changes& changes) {
  if (line.command == "set") {
    set(line, state.settings);
    changes.frame = true;
  } else if (line.command == "material") {
    if (state.materials.empty()) fail(line, "the scene has no material");
    state.materials[static_cast<std::size_t>(state.selectedMaterial)] =
        parseMaterial(line.where + ": material", line.arguments[0]);
    changes.materials = true;
  } else if (line.command == "show") {
    state.display.split = false;
    state.display.shown = shownOf(line, line.arguments[0]);
    changes.shown = true;
  } else if (line.command == "split") {
    state.display.split = true;
    state.display.left = shownOf(line, line.arguments[0]);
    state.display.splitAt = std::clamp(numberOf(line, 1), 0.0f, 1.0f);
    changes.shown = true;
  } else if (line.command == "exposure") {
    state.display.exposure = std::max(numberOf(line, 0), 0.0f);
    changes.shown = true;
  } else {
    return false;
  }
  return true;
}

float numberOf(const ScriptLine& line, std::size_t argument) { return parse(line, line.arguments[argument]); }

}  // namespace pellucid::harness
