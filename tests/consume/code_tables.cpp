// Prints a table of the documents that is made from the code (tools/code_tables.py):
//   pellucid_code_tables TABLE
#include <cstdio>
#include <iterator>
#include <string>

#include "diffusion_error_table.h"
#include "domains.h"
#include "frame_fixture.h"
#include "gltf/fields.h"
#include "pellucid/pellucid.h"
#include "stress/checks.h"

namespace {

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

}  // namespace

int main(int argc, char** argv) {
  struct Table {
    const char* name;
    std::string (*make)();
  };
  constexpr Table tables[] = {{"features", featuresTable},
                              {"errors", errorsTable},
                              {"domains", domainsTable},
                              {"stress", stressTable},
                              {"gltf", pellucid::harness::gltfTable}};
  for (const Table& table : tables)
    if (argc == 2 && table.name == std::string(argv[1])) return std::fputs(table.make().c_str(), stdout) < 0;
  std::fputs("usage: pellucid_code_tables features|errors|domains|stress|gltf\n", stderr);
  return 2;
}
