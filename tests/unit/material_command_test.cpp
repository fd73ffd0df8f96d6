// `pellucid material`: what it prints and what it refuses.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cli/commands.h"
#include "common/error.h"
#include "refusal.h"
#include "unit/run_command.h"

namespace {

using namespace pellucid::harness;

std::filesystem::path scratch(const std::string& name) {
  const auto* test = testing::UnitTest::GetInstance()->current_test_info();
  return std::filesystem::path(testing::TempDir()) / (std::string(test->name()) + "_" + name);
}

std::string run(const std::string& arguments) { return runCommand(addMaterialCommand, {"material", arguments}); }

std::string refusal(const std::string& arguments) {
  return pellucid::test::refusalOf([&] { run(arguments); });
}

// The numbers of the row with this title: of red, green and blue.
std::array<double, 3> row(const std::string& text, const std::string& title) {
  const std::size_t at = text.find("\n" + title + "  ");
  EXPECT_NE(at, std::string::npos) << title << " in\n" << text;
  std::istringstream numbers(text.substr(std::min(at, text.size() - 1) + 1 + title.size()));
  std::array<double, 3> values{};
  for (double& value : values) numbers >> value;
  return values;
}

// The printed numbers are enough to evaluate T(d).
TEST(MaterialCommand, PrintsTheFitAndItsError) {
  const std::string text =
      run(R"('{"scattering":[0.74,0.88,1.01],"absorption":[0.032,0.17,0.48],"ior":1.3}')");
  EXPECT_EQ(row(text, "scattering (reduced)")[0], 0.74);
  EXPECT_EQ(row(text, "absorption")[2], 0.48);
  EXPECT_NEAR(row(text, "0.5 mm")[0], 0.718046191, 1e-5);  // an independent solver
  for (std::size_t c = 0; c < 3; ++c) {
    const auto of = [&](const char* title) { return row(text, title)[c]; };
    EXPECT_GT(of("radius of 99.9 %"), of("Burley d"));
    const std::string slab = text.substr(text.find("\n2 mm"));
    const double fitted = of("a") / std::sinh(of("kappa") * 2 + of("z")) + of("b") * std::exp(-of("c") * 2);
    EXPECT_NEAR(row(slab, "  fitted")[c] / fitted, 1, 1e-4);
    EXPECT_NEAR(row(slab, "  fitted")[c] / of("2 mm"), 1, 0.0105 * of("largest error, %"));
  }
}

// The manifest's objects: OpenPBR's names, and presets.
TEST(MaterialCommand, ManifestMaterialInBraces) {
  const std::string medium = run(R"('{"subsurface_color":[0.8,0.8,0.8],"subsurface_radius":2,"specular_ior":1.4}')");
  EXPECT_NE(medium.find("index of refraction 1.4"), std::string::npos) << medium;
  const auto scattering = row(medium, "scattering (reduced)"), absorption = row(medium, "absorption");
  EXPECT_NEAR(scattering[0] + absorption[0], 0.5, 1e-5);
  EXPECT_NEAR(scattering[2], 4 * scattering[0], 1e-4);
  EXPECT_EQ(run(R"('{"preset":"skin1"}')"), run("skin1"));
  EXPECT_NE(refusal(R"('{"subsurface_radius":-1}')").find("subsurface_radius"), std::string::npos);
  EXPECT_THROW(run(R"('{"melanin":0.1}' --ior 1.3)"), UsageError);
  EXPECT_THROW(run(R"('{"gaussians":{"variance":[1],"weight":[[1,1,1]]}}')"), UsageError);
}

TEST(MaterialCommand, SpectrumFromFile) {
  const std::filesystem::path path = scratch("spectrum.csv");
  std::ofstream(path) << "nm, s, a\n# measured\n400, 2, 0.5\n\n700, 2, 0.05\n";
  const std::string text = run("--spectral " + path.string());
  EXPECT_EQ(text.find("scattering"), std::string::npos) << "many, not one";
  EXPECT_GT(row(text, "1 mm")[0], row(text, "1 mm")[2]);

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
                                         {"skin1 --ior 0.5", "ior: 0.5"}})
    EXPECT_NE(refusal(arguments).find(named), std::string::npos) << arguments;
  EXPECT_THROW(run(""), UsageError);
  EXPECT_THROW(run("skin1 --spectral x.csv"), UsageError);
}

}  // namespace
