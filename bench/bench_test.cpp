// Tests of the bench: errors of frames, and the command line.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include "capture/material.h"
#include "capture/write.h"
#include "frame_errors.h"
#include "reference/reference.h"
#include "scene/scene.h"
#include "sections.h"

namespace pellucid::bench {
namespace {

using namespace harness;
using Json = nlohmann::json;

// ---- Errors of frames

Capture head(int width, int height) {
  return makeScene({.name = "head", .width = width, .height = height, .shadowSize = 64});
}

class FrameErrors : public testing::Test {
protected:
  Capture capture = head(48, 27);
};

TEST_F(FrameErrors, SampledPixelsAreTheReferences) {
  const std::vector<PellucidMaterial> materials = compileMaterials(capture);
  const DiffusionTruth truth = diffusionTruth(capture, materials, 40);
  ASSERT_EQ(truth.pixels.size(), 40u);
  Capture plain = capture;
  plain.albedo = {};
  reference::Settings settings;
  settings.features = PELLUCID_FEATURE_DIFFUSION;
  const Image whole = reference::compute(plain, materials, settings).image;
  for (size_t i = 0; i < truth.pixels.size(); ++i) {
    EXPECT_NE(capture.material[truth.pixels[i]], 0);
    for (size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(truth.values[i][c], static_cast<double>(whole.data[3 * truth.pixels[i] + c]),
                  2e-4);  // energy left out
  }
  // The image itself is that far from them, and one that is 3 % brighter 3 % more.
  EXPECT_LT(rootMeanSquare(diffusionErrors(whole, truth)), 2e-4);
  Image brighter = whole;
  for (float& v : brighter.data) v *= 1.03f;
  EXPECT_NEAR(rootMeanSquare(diffusionErrors(brighter, truth)), 0.03, 3e-4);
}

TEST_F(FrameErrors, AlbedoMultipliesBeforeTruthIsCompared) {
  Image result = capture.irradiance, truth = capture.irradiance;
  for (size_t i = 0; i < truth.data.size(); ++i) truth.data[i] *= capture.albedo.data[i];
  capture.truth = Truth{truth, {}};
  EXPECT_EQ(errorFields(result, capture)["truth_relative_rmse"], 0);
  EXPECT_EQ(errorFields(result, capture)["flip"], 0);
  for (float& v : result.data) v *= 1.1f;
  EXPECT_NEAR(errorFields(result, capture)["truth_relative_rmse"], 0.1, 1e-5);
}

TEST_F(FrameErrors, SpotsOfOneFrameAloneAppearOrVanish) {
  capture = head(192, 108);  // pixels whose 9x9 around are lit
  capture.truth = Truth{capture.irradiance};
  capture.albedo = {};
  const auto same = flickerFields(capture.irradiance, capture.irradiance, capture, capture);
  EXPECT_EQ(same["spots_appear"], 0);
  EXPECT_EQ(same["spots_vanish"], 0);
  EXPECT_EQ(same["flicker_rgb"][0], 0);
  // Twice as bright where the face is lit and wholly of material around.
  Image spotted = capture.irradiance;
  for (int y = 4; y < capture.height - 4; ++y)
    for (int x = 4; x < capture.width - 4; ++x) {
      bool isLit = x % 12 == 0 && y % 12 == 0;
      for (int dy = -4; dy <= 4; ++dy)
        for (int dx = -4; dx <= 4; ++dx) isLit = isLit && capture.irradiance.at(x + dx, y + dy)[0] > 0.1f;
      for (int c = 0; c < 3 && isLit; ++c) spotted.at(x, y)[c] *= 2;
    }
  const auto appear = flickerFields(capture.irradiance, spotted, capture, capture);
  EXPECT_GT(appear["spots_appear"], 0);
  EXPECT_EQ(appear["spots_vanish"], 0);
  EXPECT_GT(appear["flicker_rgb"][0], 0);
  EXPECT_EQ(appear["flicker_irradiance_rgb"][0], 0);
  const auto vanish = flickerFields(spotted, capture.irradiance, capture, capture);
  EXPECT_EQ(vanish["spots_vanish"], appear["spots_appear"]);
  EXPECT_EQ(errorFields(spotted, capture)["spots"], appear["spots_appear"]);
  EXPECT_EQ(errorFields(capture.irradiance, capture)["spots"], 0);
}

// ---- The command

class Command : public testing::Test {
protected:
  Command() { std::filesystem::create_directories(folder); }
  ~Command() override { std::filesystem::remove_all(folder); }

  int runs(const std::string& arguments) {
    const int status =
        std::system((std::string(PELLUCID_BENCH) + " " + arguments + " >" + out.string() + " 2>&1").c_str());
    return WEXITSTATUS(status);
  }
  std::string output() const {
    std::stringstream text;
    text << std::ifstream(out).rdbuf();
    return text.str();
  }

  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("pellucid_bench_command_" + std::to_string(getpid()));
  const std::filesystem::path out = folder / "out";
};

// Frames that are made come after captures where their names are given.
TEST_F(Command, MeasuresACaptureAndNothing) {
  Capture capture = head(64, 36);
  capture.truth = Truth{capture.irradiance};
  const std::string exr = folder / "face.exr", json = folder / "run.json";
  writeCapture(capture, exr);
  writeCapture(capture, folder / "face.turned.exr");
  ASSERT_EQ(
      runs(
          "--tables frames --frames " + exr +
          " --frame-names nothing --frame-sizes 32x32 --shadow-size 16 --repeat 1 --error-pixels 50 --json " +
          json),
      0)
      << output();
  const Json run = Json::parse(std::ifstream(json));
  int wholes = 0, dispatches = 0, diffusions = 0, nothing = 0;
  for (const Json& r : run["results"]) {
    if (r["frame"] == "nothing") {
      nothing += r["kind"] == "whole";
      EXPECT_FALSE(r.contains("relative_rmse")) << r;
      continue;
    }
    EXPECT_EQ(r["frame"], "face");
    EXPECT_EQ(r["size"], "64x36");
    dispatches += r["kind"] == "dispatch";
    diffusions += r["kind"] == "diffusion";
    if (r["kind"] == "diffusion") {
      EXPECT_LT(r["relative_rmse"], 0.3) << r;
      EXPECT_GT(r["relative_rmse"], 0) << r;
    }
    if (r["kind"] != "whole") continue;
    ++wholes;
    EXPECT_GT(r["truth_relative_rmse"], 0) << r;
    EXPECT_TRUE(r.contains("spots")) << r;
    if (r["name"].get<std::string>().starts_with("Pellucid")) {
      EXPECT_EQ(r["flicker_rgb"][0], 0) << r;  // nothing turned
      EXPECT_EQ(r["spots_appear"], 0) << r;
    }
    EXPECT_GT(r["us"], 0) << r;
  }
  EXPECT_EQ(wholes, 3 + 7);  // numbers of samples, others
  EXPECT_EQ(nothing, wholes);
  EXPECT_EQ(diffusions, 1 + 7);
  EXPECT_GT(dispatches, 3 * 5);
}

TEST_F(Command, BadInputIsNamed) {
  EXPECT_EQ(runs("--tables frames --frames " + (folder / "none.exr").string()), 3);
  EXPECT_NE(output().find("none.exr"), std::string::npos) << output();
  EXPECT_NE(runs("--frame-sizes 64"), 0);
  EXPECT_NE(output().find("\"64\" is not WIDTHxHEIGHT"), std::string::npos) << output();
}

}  // namespace
}  // namespace pellucid::bench
