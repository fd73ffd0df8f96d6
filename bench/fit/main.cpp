// pellucid_fit: module/src/pyramid_energy_table.h from the filters of compute/shared/pellucid_filters.h.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "common/error.h"
#include "fit/energy_table.h"

namespace {

using namespace pellucid::fit;

// The file's numbers are rounded to this.
constexpr double kRounding = 1e-4;

void printErrors(const EnergyTable& built, const EnergyTable& fitted) {
  const std::vector<GaussianErrors> ofBuilt = errorsOf(built), ofFitted = errorsOf(fitted);
  std::printf("| deviation, pixels | built table | fitted table | no penalty |\n|-|-|-|-|\n");
  for (size_t i = 0; i < ofBuilt.size(); ++i)
    std::printf("| %.3f | %.4f | %.4f | %.4f |\n", ofBuilt[i].deviation, ofBuilt[i].table, ofFitted[i].table,
                ofFitted[i].unconstrained);
}

}  // namespace

int main(int argc, char** argv) {
  std::string file;
  bool check = false, errors = false;
  CLI::App app(
      "Fits the weights of the diffusion pyramid's elements to Gaussians and prints the module's table.",
      "pellucid_fit");
  CLI::Option* update =
      app.add_option("--update", file, "write module/src/pyramid_energy_table.h, this file, instead");
  app.add_flag("--check", check, "compare with the table that this was built with instead; 1 if they differ")
      ->excludes(update);
  app.add_flag("--errors", errors,
               "print the objective instead: relative RMSE of Gaussians near straight edges")
      ->excludes(update)
      ->excludes("--check");
  CLI11_PARSE(app, argc, argv);
  try {
    const EnergyTable table = fitEnergyTable(), built = builtEnergyTable();
    if (errors) {
      printErrors(built, table);
    } else if (check) {
      const double difference = largestDifference(table, built);
      const bool same = difference <= 1.5 * kRounding;
      std::printf("largest difference from the module's table: %.4f%s\n", difference,
                  same ? "" : "; ./run fit rewrites it");
      return same ? 0 : 1;
    } else if (file.empty()) {
      std::fputs(textOf(table).c_str(), stdout);
    } else {
      std::ofstream out(file);
      out << textOf(table);
      if (!out.flush()) throw pellucid::harness::InputError(file, "", "cannot be written");
    }
  } catch (const std::exception& e) {
    std::fprintf(stderr, "pellucid_fit: %s\n", e.what());
    return 3;
  }
}
