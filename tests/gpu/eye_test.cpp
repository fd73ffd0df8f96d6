// `pellucid evaluate` and `pellucid flicker` as a person runs them.
#include <nlohmann/json.hpp>

#include "cli_fixture.h"

namespace {

using namespace pellucid::test;
using Json = nlohmann::json;

TEST_F(Cli, EvaluateFindsNothingInItsOwnTruth) {
  // A checkered plane, and as its truth what the module makes of it, which samples of no light do not change.
  // Seen as the procedural scene has it, but for its camera: any orthographic one will do, as the truth is
  // made with the same.
  expect(0, "capture --procedural checker --size 40x40 -o " + path("c.exr"), "");
  const Json plane = Json::parse(R"({"pellucid": 1, "metersPerUnit": 0.001,
    "camera": {"clipFromView": [0.1, 0, 0, 0, 0, -0.1, 0, 0, 0, 0, -0.001, 0, 0, 0, 0, 1],
               "viewFromWorld": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
    "buffers": {"frontDepth": {"constant": [100], "encoding": "viewZ"}, "material": {"constant": [1]},
                "irradiance": {"file": "c.exr", "channels": ["irradiance.R", "irradiance.G", "irradiance.B"]}},
    "lights": [], "materials": [{"preset": "skin1"}]})");
  for (const bool same : {true, false}) {
    const std::string truth = same ? "truth.exr" : "irradiance.exr";
    Json manifest = plane;
    std::ofstream(path("m.json")) << manifest.dump();
    expect(0, "replay " + path("m.json") + " -o " + path(truth) + (same ? "" : " --set features=none"),
           "wrote");
    manifest["truth"] = {{"file", truth}, {"channels", {"R", "G", "B"}}};
    std::ofstream(path("m.json")) << manifest.dump();

    const Outcome outcome = run("evaluate " + path("m.json") + " --rows samples");
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    for (const char* samples : {"0", "8", "16"}) {
      const std::string row = std::string(" | ") + samples + " samples | ";
      const std::size_t errors = outcome.text.find(row), eye = outcome.text.rfind(row);
      ASSERT_LT(errors, eye) << outcome.text;
      EXPECT_EQ(outcome.text.substr(errors).starts_with(row + "0.000 0.000 0.000 | +0 +0 +0 %"), same) << outcome.text;
      const std::string line = outcome.text.substr(eye, outcome.text.find('\n', eye) - eye);
      EXPECT_EQ(line.ends_with(" | 0 | 0.000 0.000 0.000 | 0.000 | 0.000 | 0.000 |"), same) << line;
    }
  }
}

TEST_F(Cli, FlickerOfPixelsByThemselves) {
  // What comes through a pixel is its own: moved, only the rounding of rays is left, at most one step of the
  // output's half floats, .001. Lights that turn change what comes through, and the limit says so.
  const Outcome outcome =
      run("flicker --procedural ear --size 48x40 --shadow-size 64 --pixels 1,-4 --set features=translucency "
          "--limit worst=0.01 --json");
  EXPECT_EQ(outcome.code, 1) << outcome.text;
  EXPECT_NE(outcome.text.find("worst of R lights turned by 0.5 degrees is"), std::string::npos)
      << outcome.text;
  const std::size_t begin = outcome.text.find("{\n"), end = outcome.text.rfind("}\n");
  const Json changes = Json::parse(outcome.text.substr(begin, end + 1 - begin))["changes"];
  ASSERT_EQ(changes.size(), 4u);
  EXPECT_EQ(changes[1]["change"], "moved by -4 pixels");
  EXPECT_EQ(changes[3]["change"], "lights turned by 0.5 degrees, irradiance");
  for (int c = 0; c < 3; ++c) {
    EXPECT_LE(changes[0]["worst"][c].get<double>(), 0.002);
    EXPECT_LE(changes[1]["worst"][c].get<double>(), 0.002);
    EXPECT_GT(changes[2]["worst"][c].get<double>(), 0.01);
  }
  EXPECT_GT(changes[0]["pixels"], 500);
  EXPECT_TRUE(changes[2].contains("spots"));
  EXPECT_FALSE(changes[0].contains("spots") || changes[3].contains("spots"));
}

}  // namespace
