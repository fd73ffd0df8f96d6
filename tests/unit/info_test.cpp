// `pellucid info` on a capture whose every number is known.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/commands.h"
#include "common/error.h"
#include "unit/capture_samples.h"

namespace pellucid::harness {
namespace {

using nlohmann::json;

class InfoCommand : public testing::Test {
protected:
  std::string run(const std::vector<std::string>& flags = {}) {
    writeText(directory / "m.json", manifest.dump());
    CLI::App app;
    addInfoCommand(app);
    std::vector<std::string> arguments = flags;  // CLI11 takes them last first
    arguments.push_back((directory / "m.json").string());
    arguments.push_back("info");
    testing::internal::CaptureStdout();
    try {
      app.parse(arguments);
    } catch (...) {
      testing::internal::GetCapturedStdout();
      throw;
    }
    return testing::internal::GetCapturedStdout();
  }
  json info() { return json::parse(run({"--json"})); }
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
  EXPECT_EQ(capture["buffers"]["normal"]["constant"], json({0.0, 0.0, 1.0}));
  EXPECT_EQ(capture["buffers"]["normal"]["space"], "view");
  EXPECT_EQ(capture["buffers"]["material"]["pixels"], 15);  // the odd columns
  EXPECT_EQ(capture["buffers"]["truth"]["scale"], 2);
  ASSERT_EQ(capture["lights"].size(), 2u);
  EXPECT_EQ(capture["lights"][0]["type"], "spot");
  ASSERT_EQ(capture["lights"][0]["shadowMaps"].size(), 1u);
  EXPECT_EQ(capture["lights"][0]["shadowMaps"][0]["size"], json({kSampleShadowSize, kSampleShadowSize}));
  ASSERT_EQ(capture["lights"][1]["shadowMaps"].size(), 2u);
  EXPECT_EQ(capture["lights"][1]["shadowMaps"][1]["size"], json({1, 1}));
  EXPECT_EQ(capture["materials"][0]["kind"], "coefficients");
  EXPECT_EQ(capture["materials"][0]["pixels"], 15);
  EXPECT_TRUE(capture["missing"].empty()) << capture["missing"];
}

TEST_F(InfoCommand, SaysWhatIsMissing) {
  for (const char* buffer : {"backDepth", "normal", "albedo"}) manifest["buffers"].erase(buffer);
  manifest.erase("truth");
  manifest["lights"] = json::array();
  const json missing = info()["missing"];
  for (const char* part : {"backDepth", "normal", "albedo", "lights", "truth"})
    EXPECT_TRUE(has(missing, part)) << part;
}

TEST_F(InfoCommand, CountsWhatLooksWrong) {
  // Pixel (1, 0) has a material and an infinite front depth.
  json warnings = info()["warnings"];
  EXPECT_TRUE(has(warnings, "1 of 15 material pixels have no front depth")) << warnings;
  EXPECT_FALSE(has(warnings, "normals")) << warnings;
  EXPECT_FALSE(has(warnings, "irradiance")) << warnings;
  EXPECT_FALSE(has(warnings, "albedo")) << warnings;

  manifest["buffers"]["normal"]["constant"] = {0, 0, -2};
  manifest["buffers"]["irradiance"] = {{"constant", {1, -1, 1}}};
  manifest["buffers"]["albedo"]["constant"] = {1, 1, 1.5};
  manifest["buffers"]["backDepth"] = {{"constant", {1}}, {"encoding", "viewZ"}};
  warnings = info()["warnings"];
  EXPECT_TRUE(has(warnings, "15 of 15 normals are not of length 1")) << warnings;
  EXPECT_TRUE(has(warnings, "14 of 15 normals point away")) << warnings;  // where there is a front depth
  EXPECT_TRUE(has(warnings, "15 of 15 material pixels have an irradiance")) << warnings;
  EXPECT_TRUE(has(warnings, "15 of 15 material pixels have an albedo")) << warnings;
  EXPECT_TRUE(has(warnings, "14 of 15 material pixels have their back depth in front")) << warnings;

  manifest["buffers"]["material"] = {{"constant", {0}}};
  EXPECT_TRUE(has(info()["warnings"], "no pixel has a material"));
}

TEST_F(InfoCommand, RepeatsTheModulesFindings) {
  manifest["lights"][0]["type"] = "directional";  // with a perspective shadow map
  EXPECT_TRUE(has(info()["warnings"], "cannot be replayed: lights[0]"));
}

TEST_F(InfoCommand, PrintsForPeople) {
  const std::string text = run();
  for (const char* part : {"7x5 pixels", "frontDepth: file", "lights[0]: type spot", "shadowMap: file",
                           "material:", "warning: 1 of 15"})
    EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

TEST_F(InfoCommand, BadInputIsThrown) {
  manifest["materials"][0] = {{"preset", "plutonium"}};
  EXPECT_THROW(run(), InputError);
}

}  // namespace
}  // namespace pellucid::harness
