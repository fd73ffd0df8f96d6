// Checks or rewrites the tables of a document that are made from the code:
//   pellucid_readme_tables --check|--update FILE TABLE
// TABLE: inputs, README.md; features, docs/performance.md; errors, docs/accuracy.md; domains,
// docs/materials.md, what values fields may have; stress, CONTRIBUTING.md, what must hold for random frames;
// constants, docs/how-it-works.md, the constants that were measured; gltf, docs/captures.md, fields of glTF.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <stdexcept>
#include <string>
#include <vector>

#include "diffusion_error_table.h"
#include "domains.h"
#include "frame_fixture.h"
#include "generated_block.h"
#include "gltf/fields.h"
#include "pellucid/pellucid.h"
#include "stress/checks.h"

namespace {

std::string imagesTable() {
  struct Row {
    uint32_t resource;
    const char* content;
    const char* without;  // what a frame without the image lacks; empty: the image is required
  };
  const Row rows[] = {
      {PELLUCID_RESOURCE_FRONT_DEPTH, "device depth or view z (planar distance) of the visible surface", ""},
      {PELLUCID_RESOURCE_BACK_DEPTH, "the same, of the nearest back face behind that surface; or the thickness there, mm",
       "light from lights without a shadow map, from maps of back faces, `options.ambient` and "
       "`hiddenIrradiance` does not come through; with a gather, thin parts return as much light as "
       "thick ones"},
      {PELLUCID_RESOURCE_IRRADIANCE,
       "linear irradiance E times `frame.preExposure`; an image of E / pi has `preExposure` 1 / pi", ""},
      {PELLUCID_RESOURCE_HIDDEN_IRRADIANCE,
       "irradiance, from light probes, of the hidden face at `backDepth`",
       "`options.ambient` lights the hidden faces, and nothing shadows it"},
      {PELLUCID_RESOURCE_ALBEDO, "color that multiplies the light after scattering",
       "the output is not multiplied"},
      {PELLUCID_RESOURCE_MATERIAL, "unsigned integer: 0 for no material, i for `materials[i - 1]`", ""},
      {PELLUCID_RESOURCE_MOTION, "motion vectors of `reuse` ACCUMULATE, without jitter",
       "noise of bodies that move or turn is not averaged over frames"},
      {PELLUCID_RESOURCE_OUTPUT,
       "storage image, rgba16f, rgba32f or rg11b10f; may be the irradiance image; only pixels with "
       "a material are written",
       ""},
  };
  std::string table = "| image | content | required | without it |\n|-|-|-|-|\n";
  for (const Row& row : rows)
    table += std::string("| `") + pellucidResourceName(row.resource) + "` | " + row.content + " | " +
             (*row.without ? "no" : "yes") + " | " + row.without + " |\n";
  return table;
}

std::string featuresTable() {
  pellucid::test::Frame example(0);  // one light without a shadow map
  PellucidFrame &f = example.frame, defaults;
  pellucidInitFrame(&defaults);
  f.options = defaults.options;
  f.imageExtent[0] = 3840;
  f.imageExtent[1] = 2160;
  struct Row {
    const char* name;
    uint32_t features, lights;
  };
  const Row rows[] = {
      {"translucency + diffusion (default)", PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION, 1},
      {"translucency", PELLUCID_FEATURE_TRANSLUCENCY, 1},
      {"diffusion", PELLUCID_FEATURE_DIFFUSION, 1},
      {"both, no light that contributes", PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION, 0}};
  std::string table = "| features | dispatches | barriers | transients, bytes a pixel |\n|-|-|-|-|\n";
  for (const Row& row : rows) {
    f.options.features = row.features;
    f.lightCount = row.lights;
    static PellucidPlan plan;
    PellucidImageNeed needs[PELLUCID_MAX_TRANSIENTS];
    uint32_t transients = PELLUCID_MAX_TRANSIENTS;
    if (pellucidBuildPlan(&f, nullptr, &plan) != PELLUCID_OK ||
        pellucidGetImageNeeds(&f, &transients, needs) != PELLUCID_OK)
      return "the example frame is not valid\n";
    uint64_t scratch = 0;
    for (uint32_t i = 0; i < transients; ++i) scratch += needs[i].bytes;
    table += std::string("| ") + row.name + " | " + std::to_string(plan.dispatchCount) + " | " +
             std::to_string(plan.barrierCount) + " | " +
             std::to_string((scratch + 3840u * 2160u / 2) / (3840u * 2160u)) + " |\n";
  }
  return table;
}

// Errors as the module states them.
std::string errorsTable() {
  std::string table = "| radius | relative RMSE |\n|-|-|\n";
  char text[48];
  for (size_t i = 0; i < std::size(pellucid::kErrorRadii); ++i) {
    std::snprintf(text, sizeof text, "| %g px | %.4f |\n", static_cast<double>(pellucid::kErrorRadii[i]),
                  static_cast<double>(pellucid::kWorstError[i]));
    table += text;
  }
  return table;
}

template <class Struct>
void addDomains(const char* name, std::string* table) {
  char text[96];
  for (const pellucid::FloatDomain& d : pellucid::domainsOf<Struct>().floats) {
    std::snprintf(text, sizeof text, "%c%g, %g]", d.leastIsOut ? '(' : '[', static_cast<double>(d.least),
                  static_cast<double>(d.most));
    *table += std::string("| `") + name + "` | `" + d.field + "` | " + text + " | " +
              (d.where ? d.where : "always") + " |\n";
  }
  for (const pellucid::IntegerDomain& d : pellucid::domainsOf<Struct>().integers) {
    std::snprintf(text, sizeof text, "%u..%u", d.least, d.most);
    *table += std::string("| `") + name + "` | `" + d.field + "` | " + text + " | always |\n";
  }
}

std::string domainsTable() {
  std::string table = "| struct | field | domain | read |\n|-|-|-|-|\n";
  addDomains<PellucidFrame>("PellucidFrame", &table);
  addDomains<PellucidThesisOptions>("PellucidThesisOptions", &table);
  addDomains<PellucidMaterial>("PellucidMaterial", &table);
  addDomains<PellucidLight>("PellucidLight", &table);
  addDomains<PellucidLightTable>("PellucidLightTable", &table);
  addDomains<PellucidShadowMap>("PellucidShadowMap", &table);
  return table;
}

std::string stressTable() {
  std::string table = "| check | must hold | frames | tame | wild | reason |\n|-|-|-|-|-|-|\n";
  char tame[32], wild[32];
  for (const pellucid::harness::stress::Check& c : pellucid::harness::stress::checks()) {
    std::snprintf(tame, sizeof tame, "%g", c.tame);
    std::snprintf(wild, sizeof wild, "%g", c.wild.value_or(0));
    table += std::string("| `") + c.name + "` | " + c.what + " | " + c.frames + " | " + tame + " | " +
             (c.wild ? wild : "measured") + " | " + c.reason + " |\n";
  }
  return table;
}

// ---- Measured constants: those whose comment has "Measured: ", up to the comment's end or a period

// Fitted numbers make a method hard to trust beyond the frames that they were fitted to.
constexpr std::ptrdiff_t kMostMeasured = 25;

struct MeasuredConstant {
  std::string name, value, basis;
};

// Adds the measured constants of a file. A comment stands before its constant or on the constant's line.
std::vector<MeasuredConstant> measuredIn(const std::filesystem::path& file) {
  static const std::regex constant(
      R"(^\s*(?:#define (\w+) (.+?)|(?:static )?const(?:expr)? \w+ (\w+) = (.+?);)\s*$)");
  static const std::regex basis(R"(Measured: (.*?)(?:\.(?: .*)?)?$)");
  std::vector<MeasuredConstant> found;
  std::ifstream in(file);
  std::string comment, line;
  while (std::getline(in, line)) {
    const size_t slashes = line.find("//");
    const std::string code = line.substr(0, slashes);
    if (slashes != std::string::npos)
      comment += (comment.empty() ? "" : " ") + line.substr(std::min(slashes + 3, line.size()));
    if (code.find_first_not_of(' ') == std::string::npos && slashes != std::string::npos) continue;
    if (code.starts_with("#ifndef")) continue;  // a constant that the build may set
    std::smatch match, measured;
    if (std::regex_search(comment, measured, basis)) {
      if (!std::regex_match(code, match, constant))
        throw std::runtime_error(file.string() + ": no constant follows \"" + comment + '"');
      const int name = match[1].matched ? 1 : 3;
      found.push_back({match[name], match[name + 1], measured[1]});
    }
    comment.clear();
  }
  return found;
}

std::string constantsTable() {
  namespace fs = std::filesystem;
  const fs::path root = PELLUCID_SOURCE_DIR;
  std::vector<fs::path> files;
  for (const char* folder : {"compute", "module/src"})
    for (const auto& entry : fs::recursive_directory_iterator(root / folder))
      if (entry.is_regular_file()) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string table = "| constant | value | file | measured on |\n|-|-|-|-|\n";
  std::ptrdiff_t values = 0;
  for (const fs::path& file : files)
    for (const MeasuredConstant& c : measuredIn(file)) {
      values += 1 + std::count(c.value.begin(), c.value.end(), ',');
      table += "| `" + c.name + "` | " + c.value + " | `" + fs::relative(file, root).generic_string() +
               "` | " + c.basis + " |\n";
    }
  if (values > kMostMeasured)
    throw std::runtime_error(std::to_string(values) + " values are measured, more than " +
                             std::to_string(kMostMeasured) + ": derive some or drop them");
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  struct Table {
    const char* name;
    std::string (*make)();
  };
  constexpr Table tables[] = {{"inputs", imagesTable},
                              {"features", featuresTable},
                              {"errors", errorsTable},
                              {"domains", domainsTable},
                              {"stress", stressTable},
                              {"constants", constantsTable},
                              {"gltf", pellucid::harness::gltfTable}};
  if (argc == 4)
    for (const Table& table : tables)
      if (table.name == std::string(argv[3])) try {
          return generatedBlock(argc - 1, argv + 1, table.name, table.make());
        } catch (const std::exception& e) {
          std::fprintf(stderr, "%s\n", e.what());
          return 1;
        }
  std::fputs(
      "usage: pellucid_readme_tables --check|--update FILE "
      "inputs|features|errors|domains|stress|constants|gltf\n",
      stderr);
  return 2;
}
