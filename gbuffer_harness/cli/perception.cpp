// `pellucid perception`: what a perception test's answers say.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "cli/commands.h"
#include "common/error.h"
#include "metrics/anova.h"
#include "view/perception.h"

namespace pellucid::harness {

namespace {

struct Answers {
  std::vector<std::string> scenes;  // in the order of the file
  Cells colors;                     // [channel][scene][participant]
};

// Every participant at every scene, once.
Answers sorted(const std::string& file) {
  const std::vector<PerceptionAnswer> rows = readAnswers(file);
  if (rows.empty()) throw InputError(file, "", "has no answers");
  Answers answers;
  std::vector<std::string> participants;
  std::map<std::pair<std::string, std::string>, PerceptionAnswer> byBoth;
  const auto note = [](std::vector<std::string>& names, const std::string& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (const PerceptionAnswer& row : rows) {
    note(answers.scenes, row.scene);
    note(participants, row.participant);
    if (!byBoth.emplace(std::pair(row.participant, row.scene), row).second)
      throw InputError(file, "participant",
                       "\"" + row.participant + "\" has answered scene \"" + row.scene + "\" twice");
  }
  if (participants.size() < 2 || answers.scenes.size() < 2)
    throw InputError(file, "",
                     "an analysis needs two participants and two scenes; there are " +
                         std::to_string(participants.size()) + " and " +
                         std::to_string(answers.scenes.size()));
  answers.colors.assign(3, std::vector<std::vector<double>>(answers.scenes.size()));
  for (std::size_t j = 0; j < answers.scenes.size(); ++j)
    for (const std::string& participant : participants) {
      const auto found = byBoth.find({participant, answers.scenes[j]});
      if (found == byBoth.end())
        throw InputError(file, "participant",
                         "\"" + participant + "\" has not answered scene \"" + answers.scenes[j] + "\"");
      for (std::size_t c = 0; c < 3; ++c) answers.colors[c][j].push_back(found->second.color[c]);
    }
  return answers;
}

struct Moments {
  double mean, standardError;
};

Moments momentsOf(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  double mean = 0, squares = 0;
  for (const double v : values) mean += v / n;
  for (const double v : values) squares += (v - mean) * (v - mean);
  return {mean, n > 1 ? std::sqrt(squares / (n - 1) / n) : 0};
}

void printSource(const char* name, const VarianceSource& s) {
  std::printf("%-16s %12.5g %8g %10.4g %10.3g %s\n", name, s.sumOfSquares, s.degrees, s.f, s.p,
              significance(s.p).c_str());
}

void perception(const std::string& file) {
  const Answers answers = sorted(file);
  const std::size_t participants = answers.colors[0][0].size();
  // Red is the largest by construction of the question; the thesis compares green and blue.
  const Cells pair = {answers.colors[1], answers.colors[2]};
  const Anova anova = twoWayAnova(pair);
  const std::vector<CellComparison> comparisons = compareLevels(pair, 0, 1, anova);
  std::printf("%zu participants\n%-24s %22s %22s %22s\n", participants, "scene: mean, st. error", "red",
              "green", "blue");
  for (std::size_t j = 0; j < answers.scenes.size(); ++j) {
    std::printf("%-24s", answers.scenes[j].c_str());
    for (std::size_t c = 0; c < 3; ++c) {
      const Moments m = momentsOf(answers.colors[c][j]);
      std::printf(" %13.4f %8.4f", m.mean, m.standardError);
    }
    std::printf("\n");
  }
  std::printf("\nanalysis of variance, green and blue\n%-16s %12s %8s %10s %10s\n", "", "squares", "degrees",
              "F", "P");
  printSource("channel", anova.first);
  printSource("scene", anova.second);
  printSource("interaction", anova.interaction);
  std::printf("%-16s %12.5g %8g\n", "residual", anova.residual.sumOfSquares, anova.residual.degrees);
  std::printf("\ngreen against blue, Bonferroni's comparisons\n%-24s %12s %10s %10s\n", "scene", "difference",
              "t", "P");
  for (std::size_t j = 0; j < answers.scenes.size(); ++j)
    std::printf("%-24s %12.4f %10.3f %10.3g %s\n", answers.scenes[j].c_str(), comparisons[j].difference,
                comparisons[j].t, comparisons[j].p, significance(comparisons[j].p).c_str());
}

}  // namespace

void addPerceptionCommand(const Command& app) {
  const auto file = std::make_shared<std::string>();
  const Command command = app.subcommand(
      "perception", "Means, analysis of variance and comparisons of the answers of `view --perception`");
  command.option("answers", *file, "CSV of participant,scene,red,green,blue,seconds").required();
  command.run([file] {
    if (!std::filesystem::exists(*file)) throw InputError(*file, "", "cannot be read");
    perception(*file);
  });
}

}  // namespace pellucid::harness
