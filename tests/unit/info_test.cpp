// `pellucid info` on a capture whose every number is known.
#include <gtest/gtest.h>

#include <algorithm>

#include "capture/write.h"
#include "cli/commands.h"
#include "scene/scene.h"
#include "unit/capture_samples.h"
#include "unit/run_command.h"

namespace pellucid::harness {
namespace {

using nlohmann::json;

class InfoCommand : public testing::Test {
protected:
  std::string run(const std::string& flag = "") {
    writeText(directory / "m.json", manifest.dump());
    return runOn(directory / "m.json", flag);
  }
  static std::string runOn(const std::filesystem::path& capture, const std::string& flag) {
    return runCommand(addInfoCommand, {"info", capture.string(), flag});
  }
  json info() { return json::parse(run("--json")); }
  static json warningsOf(const std::filesystem::path& capture) {
    return json::parse(runOn(capture, "--json"))["warnings"];
  }
  static bool has(const json& sentences, const std::string& part) {
    return std::any_of(sentences.begin(), sentences.end(), [&](const json& sentence) {
      return sentence.get<std::string>().find(part) != std::string::npos;
    });
  }

  TemporaryDirectory directory;
  json manifest = writeSampleFiles(directory);
};

TEST_F(InfoCommand, SaysWhatIsThere) {
  const json capture = info();
  EXPECT_EQ(capture["size"], json({kSampleWidth, kSampleHeight}));
  EXPECT_EQ(capture["metersPerUnit"], 0.001);
  const json& front = capture["buffers"]["frontDepth"];
  EXPECT_EQ(front["file"], (directory / "g.exr").string());
  EXPECT_EQ(front["channels"], json({"Z"}));
  EXPECT_EQ(front["format"], "float");
  EXPECT_EQ(front["encoding"], "viewZ");
  EXPECT_EQ(front["pixels"], kSampleWidth * kSampleHeight - 2);  // two hold nothing
  const Image depth = sampleCapture().frontDepth.image;
  EXPECT_EQ(front["range"], json({depth.data[2], depth.data.back()}));  // they grow
  EXPECT_EQ(capture["buffers"]["material"]["pixels"], 15);  // the odd columns
  EXPECT_EQ(capture["buffers"]["truth"]["scale"], 2);
  ASSERT_EQ(capture["lights"].size(), 2u);
  EXPECT_EQ(capture["lights"][0]["type"], "spot");
  ASSERT_EQ(capture["lights"][0]["shadowMaps"].size(), 1u);
  EXPECT_EQ(capture["lights"][0]["shadowMaps"][0]["size"], json({kSampleShadowSize, kSampleShadowSize}));
  EXPECT_EQ(capture["lights"][0]["shadowMaps"][0]["exit"]["channels"], json({"ViewLayer.Exit.Z"}));
  EXPECT_EQ(capture["lights"][0]["shadowMaps"][0]["casterMaterial"]["materials"], json({0, 1}));
  ASSERT_EQ(capture["lights"][1]["shadowMaps"].size(), 2u);
  EXPECT_EQ(capture["lights"][1]["shadowMaps"][1]["size"], json({1, 1}));
  EXPECT_EQ(capture["materials"][0]["kind"], "coefficients");
  EXPECT_EQ(capture["materials"][0]["pixels"], 15);
  EXPECT_TRUE(capture["missing"].empty()) << capture["missing"];
}

// A ball of a medium with a transport mean free path of 1 / (.2 + .01) mm: the model has no sides.
TEST_F(InfoCommand, WarnsOfBodiesThatAreOpticallyThin) {
  SceneParameters p{.name = "sphere", .width = 64, .height = 64, .shadowSize = 8};
  for (const double radius : {3.0, 12.0}) {
    p.options["radius"] = radius;
    p.options["extent"] = 3 * radius;
    Capture capture = makeScene(p);
    capture.materials[0] = CoefficientMaterial{{0.2, 0.3, 0.4}, {0.01, 0.01, 0.01}, 0, 1.4};
    writeCapture(capture, directory / "ball.exr");
    const json warnings = warningsOf(directory / "ball.exr");
    EXPECT_EQ(has(warnings, "is less than 4 transport mean free paths, which are 4.76 mm each in R"),
              radius == 3)
        << warnings;
    // The ball's width, less at most two pixels of 9/64 mm.
    EXPECT_EQ(has(warnings, "the body's size, 5.") || has(warnings, "the body's size, 6 mm"), radius == 3)
        << warnings;
  }
}

TEST_F(InfoCommand, WarnsOfMapsThatContradictTheSurfaces) {
  const Capture right = makeScene({.name = "head", .width = 96, .height = 96, .shadowSize = 256});
  const auto warns = [&](const char* words, const std::function<void(Capture&)>& change) {
    Capture c = right;
    change(c);
    writeCapture(c, directory / "map.exr");
    return has(warningsOf(directory / "map.exr"), words);
  };
  const auto map = [](Capture& c) -> ShadowMap& { return c.lights.at(0).shadowMaps.at(0); };
  const char *front = "of the surfaces in it lie in front of what it shows", *none = "no surface with a material lies in it";
  EXPECT_FALSE(warns("lights[0].shadowMap: ", [](Capture&) {}));
  EXPECT_TRUE(warns(front, [&](Capture& c) { map(c).depth.encoding = PELLUCID_DEPTH_DEVICE; }));
  EXPECT_TRUE(warns(front, [&](Capture& c) { std::fill(map(c).depth.image.data.begin(), map(c).depth.image.data.end(), 0.0f); }));
  EXPECT_TRUE(warns(front, [&](Capture& c) {
    for (float& depth : map(c).depth.image.data) depth *= 100;
  }));
  EXPECT_FALSE(warns(front, [&](Capture& c) {
    map(c).backFaces = true;
    for (float& depth : map(c).depth.image.data) depth *= 100;
  }));
  EXPECT_TRUE(warns(none, [&](Capture& c) { map(c).clipFromWorld[12] += 5; }));
}

TEST_F(InfoCommand, SaysWhatIsMissing) {
  for (const char* buffer : {"backDepth", "albedo"}) manifest["buffers"].erase(buffer);
  manifest.erase("truth");
  manifest["lights"] = json::array();
  const json missing = info()["missing"];
  EXPECT_NE(run().find("missing most: " + missing[0].get<std::string>()), std::string::npos);
  for (const char* part : {"backDepth", "albedo", "lights", "truth"}) EXPECT_TRUE(has(missing, part)) << part;
}

TEST_F(InfoCommand, SaysThatNormalsAreNotNeeded) {
  EXPECT_FALSE(has(info()["warnings"], "normal"));
  manifest["buffers"]["normal"] = {{"constant", {0, 0, 1}}, {"space", "view"}};
  EXPECT_TRUE(has(info()["warnings"], "the buffer \"normal\" is not needed"));
}

TEST_F(InfoCommand, CountsWhatLooksWrong) {
  // Pixel (1, 0) has a material and an infinite front depth.
  json warnings = info()["warnings"];
  EXPECT_TRUE(has(warnings, "1 of 15 material pixels have no front depth")) << warnings;
  for (const char* good : {"irradiance", "albedo"}) EXPECT_FALSE(has(warnings, good)) << warnings;

  manifest["buffers"]["irradiance"] = {{"constant", {1, -1, 1}}};
  manifest["buffers"]["albedo"]["constant"] = {1, 1, 1.5};
  manifest["buffers"]["backDepth"] = {{"constant", {1}}, {"encoding", "viewZ"}};
  warnings = info()["warnings"];
  // 14 have a front depth.
  for (const char* part :
       {"15 of 15 material pixels have an irradiance", "15 of 15 material pixels have an albedo",
        "14 of 15 material pixels have their back depth in front"})
    EXPECT_TRUE(has(warnings, part)) << part << ": " << warnings;

  manifest["buffers"]["material"] = {{"constant", {0}}};
  EXPECT_TRUE(has(info()["warnings"], "no pixel has a material"));
}

TEST_F(InfoCommand, RepeatsTheModulesFindings) {
  manifest["lights"][0]["type"] = "directional";  // with a perspective shadow map
  for (const char* key : {"innerConeAngle", "outerConeAngle", "range"}) manifest["lights"][0].erase(key);
  EXPECT_TRUE(has(info()["warnings"], "cannot be replayed: lights[0]"));
  manifest = writeSampleFiles(directory);
  manifest["lights"] = {{{"type", "point"}, {"position", {0, 0, 1000}}, {"range", 1}}};
  EXPECT_TRUE(has(info()["warnings"], "lights[0] adds nothing: "));
}

// A good capture gives no warning: what is validated is the frame that replay records.
TEST_F(InfoCommand, GoodCapturesGiveNoWarning) {
  // Without the sample's flaws: infinite front depths, and a spot beside the center of its map's projection.
  manifest["buffers"]["frontDepth"] = {{"constant", {5}}, {"encoding", "viewZ"}};
  manifest["buffers"].erase("backDepth");
  manifest["lights"][0]["position"] = {0, 0, 0};
  EXPECT_EQ(info()["warnings"], json::array());
  for (const SceneInfo& scene : listScenes()) {
    SceneParameters parameters{.name = scene.name, .width = 24, .height = 24};
    parameters.shadowSize = 128;  // finer than four diffusion lengths
    const std::filesystem::path file = directory / (scene.name + ".exr");
    writeCapture(makeScene(parameters), file);
    const json warnings = warningsOf(file);
    // The far plane cuts this scene's sheet between its two faces.
    if (scene.name == "near_far")
      EXPECT_TRUE(warnings.size() == 1 && has(warnings, "have no back depth")) << warnings;
    else
      EXPECT_EQ(warnings, json::array()) << scene.name;
  }
}

}  // namespace
}  // namespace pellucid::harness
