#include "view/perception.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

namespace {

constexpr const char* kHeader = "participant,scene,red,green,blue,seconds";
constexpr std::size_t kFields = 6;

double parse(const std::string& where, const char* field, const std::string& text, double most) {
  const std::optional<double> value = numberIn<double>(text);
  if (!value || !(*value >= 0 && *value <= most))
    throw InputError(where, field, "\"" + text + "\" is not a number from 0 to " + std::to_string(most));
  return *value;
}

}  // namespace

std::vector<std::filesystem::path> readSceneList(const std::filesystem::path& list) {
  std::ifstream file(list);
  if (!file) throw InputError(list.string(), "", "cannot be read");
  std::vector<std::filesystem::path> scenes;
  for (std::string line; std::getline(file, line);)
    if (!line.empty() && line[0] != '#') scenes.push_back(list.parent_path() / line);
  if (scenes.empty()) throw InputError(list.string(), "", "names no capture");
  return scenes;
}

std::vector<PerceptionAnswer> readAnswers(const std::filesystem::path& csv) {
  std::vector<PerceptionAnswer> answers;
  if (!std::filesystem::exists(csv)) return answers;
  std::ifstream file(csv);
  std::string line;
  if (!std::getline(file, line) || line != kHeader)
    throw InputError(csv.string(), "", "does not begin with \"" + std::string(kHeader) + "\"");
  for (int number = 2; std::getline(file, line); ++number) {
    if (line.empty()) continue;
    const std::string where = csv.string() + ":" + std::to_string(number);
    std::vector<std::string> parts;
    std::istringstream fields(line);
    for (std::string part; std::getline(fields, part, ',');) parts.push_back(part);
    if (parts.size() != kFields) throw InputError(where, "", "\"" + line + "\" has not six fields");
    const char* const names[] = {"red", "green", "blue"};
    PerceptionAnswer answer{parts[0], parts[1], {}, parse(where, "seconds", parts[5], 1e6)};
    for (std::size_t c = 0; c < 3; ++c) answer.color[c] = parse(where, names[c], parts[2 + c], 1);
    answers.push_back(answer);
  }
  return answers;
}

void addAnswer(const std::filesystem::path& csv, const PerceptionAnswer& answer) {
  const bool isNew = !std::filesystem::exists(csv);
  std::ofstream file(csv, std::ios::app);
  if (isNew) file << kHeader << "\n";
  file << answer.participant << "," << answer.scene;
  for (const double c : answer.color) file << "," << c;
  file << "," << answer.seconds << "\n";
  if (!file.flush()) throw InputError(csv.string(), "", "cannot be written");
}

void requireNewParticipant(const std::filesystem::path& csv, const std::string& participant) {
  if (participant.empty() || participant.find_first_of(",\"\r\n") != std::string::npos)
    throw InputError("", "participant",
                     "\"" + participant + "\" is empty, or has a comma or a quotation mark");
  const std::vector<PerceptionAnswer> answers = readAnswers(csv);
  if (std::any_of(answers.begin(), answers.end(),
                  [&](const auto& a) { return a.participant == participant; }))
    throw InputError(csv.string(), "participant", "\"" + participant + "\" has answered already");
}

}  // namespace pellucid::harness
