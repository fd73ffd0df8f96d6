// pellucid_fit: module/src/pyramid_energy_table.h from the filters of compute/shared/pellucid_filters.h.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <iterator>

#include "common/whole_file.h"
#include "fit/fit.h"

namespace {

using namespace pellucid;

// The file's numbers are rounded to this.
constexpr double kRounding = 1e-4;

// The file.
std::string textOf(const fit::EnergyTable& table) {
  std::string text =
      "// Cumulative weights of the pyramid's elements over the deviation of a Gaussian, fitted and written "
      "by `./run fit`;\n"
      "// docs/how-it-works.md, \"Fitted tables\". Each row: log2 of the first deviation, and samples "
      "EnergyFrom::kStep apart.\n"
      "#pragma once\n\n"
      "namespace pellucid {\n\n"
      "struct GaussianEnergy {\n"
      "  double first;\n"
      "  double samples[49];\n};\n\n"
      "// clang-format off\n"
      "constexpr GaussianEnergy kGaussianEnergy[] = {";
  for (const GaussianEnergy& row : table) {
    char number[32];
    std::snprintf(number, sizeof number, "\n  {%g, {", row.first);
    text += number;
    for (size_t k = 0; k < std::size(row.samples); ++k) {
      const char* const before = k == 0 ? "" : k % 10 == 0 ? ",\n    " : ", ";
      std::snprintf(number, sizeof number, "%s%.4f", before, row.samples[k]);
      text += number;
    }
    text += "}},";
  }
  return text + "\n};\n// clang-format on\n\n}  // namespace pellucid\n";
}

// The largest difference from the table that this was built with.
double largestDifference(const fit::EnergyTable& table) {
  double most = 0;
  for (size_t i = 0; i < table.size(); ++i) {
    most = std::max(most, std::abs(table[i].first - kGaussianEnergy[i].first));
    for (size_t k = 0; k < std::size(table[i].samples); ++k)
      most = std::max(most, std::abs(table[i].samples[k] - kGaussianEnergy[i].samples[k]));
  }
  return most;
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  bool check = false;
  CLI::App app(
      "Fits the weights of the diffusion pyramid's elements to Gaussians and prints the module's table.",
      "pellucid_fit");
  CLI::Option* update =
      app.add_option("--update", file, "write module/src/pyramid_energy_table.h, this file, instead");
  app.add_flag("--check", check, "compare with the table that this was built with instead; 1 if they differ")
      ->excludes(update);
  CLI11_PARSE(app, argc, argv);
  try {
    const fit::EnergyTable table = fit::fitEnergyTable();
    if (check) {
      const double difference = largestDifference(table);
      const bool same = difference <= 1.5 * kRounding;
      std::printf("largest difference from the module's table: %.4f%s\n", difference,
                  same ? "" : "; ./run fit rewrites it");
      return same ? 0 : 1;
    }
    if (file.empty())
      std::fputs(textOf(table).c_str(), stdout);
    else
      harness::writeWholeText(file, textOf(table));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_fit: %s\n", e.what());
    return 3;
  }
}
