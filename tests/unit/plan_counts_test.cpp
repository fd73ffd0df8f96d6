// Counts of dispatches, barriers and images of plans, for every feature, number of lights and gather, against
// a golden file: what an edit makes frames cost more.
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "frame_fixture.h"

namespace {

using pellucid::test::Frame;

constexpr const char* kFile = PELLUCID_SOURCE_DIR "/tests/golden/plan_counts.json";
constexpr const char* kUpdate = "PELLUCID_UPDATE_GOLDEN=1 ./run test -R PlanCounts";

struct Choice {
  const char* name;
  uint32_t value;
};
constexpr uint32_t kBoth = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
const Choice kFeatures[] = {{"none", 0},
                            {"translucency", PELLUCID_FEATURE_TRANSLUCENCY},
                            {"diffusion", PELLUCID_FEATURE_DIFFUSION},
                            {"both", kBoth}};
struct Way {
  const char* name;
  uint32_t debugView, gatherSamples, indirectDispatches;
};
const Way kWays[] = {{"", PELLUCID_DEBUG_NONE, 0, 0},
                     {" debug view", PELLUCID_DEBUG_THICKNESS, 0, 0},
                     {" gather", PELLUCID_DEBUG_NONE, 8, 0},
                     {" gather, indirect", PELLUCID_DEBUG_NONE, 8, 1}};
// value: lights with a shadow map each; 0: one without.
const Choice kLights[] = {{"1 light without a map", 0}, {"1 light", 1}, {"9 lights", 9}};

nlohmann::json countsOf(const Frame& f) {
  const PellucidPlan plan = f.plan();
  uint32_t transients = 0;
  EXPECT_EQ(pellucidGetImageNeeds(&f.frame, &transients, nullptr), PELLUCID_OK);
  return {{"dispatches", plan.dispatchCount}, {"barriers", plan.barrierCount}, {"transients", transients}};
}

nlohmann::json allCounts() {
  nlohmann::json all;
  for (const Choice& lights : kLights) {
    Frame f(lights.value);
    for (const Choice& features : kFeatures)
      for (const Way& way : kWays) {
        // Debug views need all lights in one dispatch, which binds eight maps.
        if (way.debugView != PELLUCID_DEBUG_NONE && lights.value > 8) continue;
        if (way.gatherSamples > 0 && features.value != kBoth) continue;
        f.frame.options.features = features.value;
        f.frame.options.debugView = way.debugView;
        f.frame.options.gatherSamples = way.gatherSamples;
        f.frame.options.indirectDispatches = way.indirectDispatches;
        for (const float distance : {0.0f, 1000.0f})  // at which all radii are small
          if (distance == 0 || features.value == kBoth) {
            f.frame.options.nearestDistance = distance;
            all[std::string(features.name) + way.name + ", " + lights.name +
                (distance > 0 ? ", far away" : "")] = countsOf(f);
          }
      }
  }
  return all;
}

TEST(PlanCounts, AreThoseOfTheGoldenFile) {
  const nlohmann::json counts = allCounts();
  if (std::getenv("PELLUCID_UPDATE_GOLDEN")) {
    // One plan a line, so that a change shows as the lines of the plans it changes.
    std::string text = "{";
    for (const auto& [name, value] : counts.items())
      text += (text.size() > 1 ? ",\n " : "\n ") + nlohmann::json(name).dump() + ": " + value.dump();
    std::ofstream file(kFile);
    file << text << "\n}\n";
    ASSERT_TRUE(file.flush()) << kFile;
    GTEST_SKIP() << "rewrote " << kFile;
  }
  std::ifstream file(kFile);
  const nlohmann::json golden = nlohmann::json::parse(file, nullptr, false);
  ASSERT_TRUE(golden.is_object()) << kFile << " is not JSON; to write it: " << kUpdate;
  for (const auto& [name, value] : counts.items()) {
    ASSERT_TRUE(golden.contains(name))
        << kFile << " lacks the plan of \"" << name << "\"; to add it: " << kUpdate;
    EXPECT_EQ(value, golden[name]) << "the plan of \"" << name << "\" costs something else than " << kFile
                                   << " says. If that is meant: " << kUpdate;
  }
  EXPECT_EQ(golden.size(), counts.size()) << "plans that no longer exist; to drop them: " << kUpdate;
}

}  // namespace
