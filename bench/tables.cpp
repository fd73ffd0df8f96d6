// Prints the documentation's tables of measured times from the results of a run, or checks or rewrites them
// in a file:
//   pellucid_bench_tables RESULTS.json[,RESULTS.json...] TABLE [--check | --update FILE]
// The tables headline and samples join two files.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "common/parse.h"

#include "generated_block.h"
#include "table_text.h"

namespace {

using namespace pellucid::bench;

const Json& row(const Json& results, const std::string& section, const std::string& name) {
  for (const Json& r : results.at("results"))
    if (r.at("section") == section && r.at("name") == name) return r;
  throw InputError("", "results", "no \"" + name + "\" in section \"" + section + "\"");
}

std::string timesAndError(const Json& r) {
  // Differences of times may round to -0.
  const double us = std::round(r.at("us").get<double>()) + 0.0;
  std::string cells = format(" %.0f us | %.3g |", us, r.at("floor_ratio").get<double>());
  const auto error = r.find("relative_rmse");
  return cells + (error == r.end() || error->is_null() ? " |" : format(" %.2g |", error->get<double>()));
}

std::string measured(const Json& results) {
  struct Row {
    const char* label;
    const char* section;
    const char* name;
  };
  const char* const module = "module, 100 % covered";
  const char* const diffusion = "diffusion; error: from brute force";
  const char* const gather = "gather, added to the frame; error: from all texels";
  const Row rows[] = {
      {"whole frame, 0 samples", module, "whole frame"},
      {"the same, radii not known, as through a perspective camera", "module, radii not known",
       "whole frame"},
      {"the same, a quarter covered", "module, 25 % covered", "whole frame"},
      {"fused translucency dispatch alone", "fused dispatch", "1 lights, 1 maps"},
      {"diffusion alone", diffusion, "Pellucid"},
      {"Separable (Jimenez et al. 2015), 11 taps", diffusion, "Separable 2015, 11 taps"},
      {"Gaussian sum (d'Eon & Luebke 2007, Jimenez et al. 2009)", diffusion, "Gaussian sum 2009, 6 x 7"},
      {"Burley disk (Golubev 2018), 20 samples", diffusion, "Burley disk 2018, 20 samples"},
      {"80 samples", diffusion, "Burley disk 2018, 80 samples"},
      {"gather of transmitted light, 8 samples, added to the frame", gather, "8 samples"},
      {"the same where nothing is transmitted", gather, "8 samples, nothing transmitted"},
  };
  std::string table = format("%s; %d x %d, radius %g pixels, floor %.1f us:\n\n", runOf(results).c_str(),
                             results.at("width").get<int>(), results.at("height").get<int>(),
                             results.at("radius_pixels").get<double>(), results.at("floor_us").get<double>());
  table += "| | time | x | error |\n|-|-|-|-|\n";
  for (const Row& r : rows)
    table += std::string("| ") + r.label + " |" + timesAndError(row(results, r.section, r.name)) + "\n";
  return table;
}

template <std::string (*make)(const Json&)>
std::string ofOne(const std::vector<Json>& runs) {
  return make(runs.front());
}

struct Table {
  const char* name;
  std::string (*make)(const std::vector<Json>& runs);
};

constexpr Table kTables[] = {{"measured", ofOne<measured>},         {"frames", ofOne<framesTable>},
                             {"frame_host", ofOne<frameHostTable>}, {"context", ofOne<contextTable>},
                             {"truth", ofOne<truthTable>},          {"engine", ofOne<engineTable>},
                             {"headline", headlineTable},           {"samples", samplesTable}};

}  // namespace

int main(int argc, char** argv) {
  const std::string name = argc > 2 ? argv[2] : "";
  const auto table =
      std::find_if(std::begin(kTables), std::end(kTables), [&](const Table& t) { return t.name == name; });
  if (table == std::end(kTables)) {
    std::string names;
    for (const Table& t : kTables) {
      if (!names.empty()) names += "|";
      names += t.name;
    }
    std::fprintf(stderr, "usage: pellucid_bench_tables RESULTS.json[,...] %s [--check|--update FILE]\n",
                 names.c_str());
    return 2;
  }
  try {
    std::vector<Json> runs;
    for (const std::string& path : pellucid::harness::split(argv[1], ',')) {
      std::ifstream file(path);
      runs.push_back(Json::parse(file));
    }
    return generatedBlock(argc - 3, argv + 3, name, table->make(runs));
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s: %s\n", argv[1], e.what());
    return 1;
  }
}
