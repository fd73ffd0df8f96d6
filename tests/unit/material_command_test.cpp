// `pellucid material`: what it prints and what it refuses.
#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>

#include "cli/commands.h"
#include "common/error.h"
#include "refusal.h"

namespace {

using namespace pellucid::harness;
using Json = nlohmann::json;

std::filesystem::path scratch(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + "_" + name);
}

// Standard output of `pellucid material ARGUMENTS`.
std::string run(const std::string& arguments) {
  CLI::App app;
  addMaterialCommand(app);
  std::ostringstream out;
  std::streambuf* const standard = std::cout.rdbuf(out.rdbuf());
  try {
    app.parse("material " + arguments);
  } catch (...) {
    std::cout.rdbuf(standard);
    throw;
  }
  std::cout.rdbuf(standard);
  return out.str();
}

std::string refusal(const std::string& arguments) {
  return pellucid::test::refusalOf([&] { run(arguments); });
}

TEST(MaterialCommand, JsonHoldsEverything) {
  const Json json =
      Json::parse(run("--scattering .74,.88,1.01 --absorption .032,.17,.48 --ior 1.3 "
                      "--thickness 0.5,2 --gaussians 4 --json"));
  EXPECT_EQ(json["ior"], 1.3);
  EXPECT_EQ(json["unit"], "mm");
  ASSERT_EQ(json["channels"].size(), 3u);
  const Json& red = json["channels"][0];
  EXPECT_EQ(red["name"], "R");
  EXPECT_EQ(red["scattering"], 0.74);
  EXPECT_EQ(red["absorption"], 0.032);
  EXPECT_EQ(red["profile"]["gaussians"]["variance"].size(), 4u);
  EXPECT_EQ(red["profile"]["gaussians"]["weight"].size(), 4u);
  EXPECT_GT(red["profile"]["radius_999"], red["profile"]["burley_d"]);
  ASSERT_EQ(red["thickness"].size(), 2u);
  EXPECT_EQ(red["thickness"][0]["mm"], 0.5);
  EXPECT_NEAR(red["thickness"][0]["exact"].get<double>(), 0.718046191, 1e-6);  // an independent solver
  EXPECT_NEAR(red["thickness"][0]["exact_normal"].get<double>(), 0.793980924, 1e-6);

  // What is printed is enough to evaluate T(d).
  for (const Json& channel : json["channels"]) {
    const Json& c = channel["fit"]["coefficients"];
    const auto at = [&](const char* name) { return c[name].get<double>(); };
    for (const Json& row : channel["thickness"]) {
      const double d = row["mm"];
      const double value =
          channel["fit"]["form"] == "exp2"
              ? at("a1") * std::exp(-at("k1") * d) + at("a2") * std::exp(-at("k2") * d)
              : at("a") / std::sinh(at("kappa") * d + at("z")) + at("b") * std::exp(-at("c") * d);
      EXPECT_NEAR(value / row["fitted"].get<double>(), 1, 1e-5);
      EXPECT_NEAR(row["fitted"].get<double>() / row["exact"].get<double>(), 1,
                  channel["fit"]["max_relative_error"].get<double>() * 1.05);
    }
  }
}

// The manifest's objects: OpenPBR's names, and skin as by the options of its own.
TEST(MaterialCommand, ManifestMaterialInBraces) {
  const auto json = [](const std::string& arguments) { return Json::parse(run(arguments + " --json")); };
  const Json medium =
      json(R"('{"subsurface_color":[0.8,0.8,0.8],"subsurface_radius":2,"specular_ior":1.4}')");
  EXPECT_EQ(medium["ior"], 1.4);
  const Json& red = medium["channels"][0];
  EXPECT_NEAR(red["scattering"].get<double>() + red["absorption"].get<double>(), 0.5, 1e-12);
  EXPECT_NEAR(medium["channels"][2]["scattering"].get<double>(), 4 * red["scattering"].get<double>(), 1e-12);
  EXPECT_EQ(json(R"('{"melanin":0.1,"hemoglobin":0.02}')"), json("--melanin 0.1 --haemoglobin 0.02"));
  EXPECT_EQ(json(R"('{"preset":"skin1"}')"), json("skin1"));
  EXPECT_NE(refusal(R"('{"subsurface_radius":-1}')").find("subsurface_radius"), std::string::npos);
  EXPECT_THROW(run(R"('{"melanin":0.1}' --ior 1.3)"), UsageError);
  EXPECT_THROW(run(R"('{"gaussians":{"variance":[1],"weight":[[1,1,1]]}}')"), UsageError);
}

TEST(MaterialCommand, SpectrumFromFile) {
  const std::filesystem::path path = scratch("spectrum.csv");
  std::ofstream(path) << "nm, s, a\n# measured\n400, 2, 0.5\n\n700, 2, 0.05\n";
  const Json json = Json::parse(run("--spectral " + path.string() + " --json --thickness 1"));
  EXPECT_TRUE(json["channels"][0]["scattering"].is_null());  // many, not one
  EXPECT_GT(json["channels"][0]["thickness"][0]["exact"], json["channels"][2]["thickness"][0]["exact"]);

  std::ofstream(path) << "400,2,0.5\n700,2\n";
  EXPECT_EQ(refusal("--spectral " + path.string()).find(path.string() + ": line 2: \"700,2\""), 0u);
  std::ofstream(path) << "400,2,0.5\n700,2,-1\n";
  EXPECT_NE(refusal("--spectral " + path.string()).find("spectralAbsorption[1]: -1"), std::string::npos);
  std::ofstream(path) << "";
  EXPECT_NE(refusal("--spectral " + path.string()).find("wavelengthCount: 0"), std::string::npos);
  std::filesystem::remove(path);
}

TEST(MaterialCommand, RefusalsNameTheField) {
  for (const auto& [arguments, named] : {std::pair("gravel", "gravel"),
                                         {"skin1 --ior 0.5", "ior: 0.5"},
                                         {"skin1 --thickness inf", "thickness"},
                                         {"--scattering nan,1,1 --absorption 1,1,1", "scattering[0]: nan"}})
    EXPECT_NE(refusal(arguments).find(named), std::string::npos) << arguments;
  EXPECT_THROW(run("--scattering 1,1,1"), UsageError);
  EXPECT_THROW(run("skin1 --melanin 0.1"), UsageError);
  EXPECT_THROW(run(""), UsageError);
  EXPECT_THROW(run("--scattering 1,1 --absorption 1,1,1"), CLI::ParseError);
}

}  // namespace
