// Differences between images against numbers worked out by hand, and the command's limits.
#include "common/compare.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "cli/command.h"
#include "cli/commands.h"
#include "common/error.h"
#include "common/png.h"
#include "unit/capture_samples.h"
#include "unit/run_command.h"

namespace pellucid::harness {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Image filled(int width, int height, std::initializer_list<float> pixel) {
  Image image(width, height, static_cast<int>(pixel.size()));
  for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = pixel.begin()[i % pixel.size()];
  return image;
}

TEST(Compare, DefinitionsByHand) {
  // B is 3, 4 in one channel: RMS sqrt(12.5). A - B is 1, -2: RMSE sqrt(2.5).
  Image a(2, 1, 1), b(2, 1, 1);
  a.data = {4, 2};
  b.data = {3, 4};
  const ChannelDifference channel = compareImages(a, b, {}).channels[0];
  EXPECT_DOUBLE_EQ(channel.relativeRmse, std::sqrt(2.5 / 12.5));
  EXPECT_DOUBLE_EQ(channel.max, 2 / std::sqrt(12.5));
  EXPECT_DOUBLE_EQ(channel.p999, channel.max);
  EXPECT_DOUBLE_EQ(channel.psnr, 20 * std::log10(4 / std::sqrt(2.5)));
  EXPECT_DOUBLE_EQ(channel.bias, 6.0 / 7.0 - 1);
}

TEST(Compare, P999LeavesOutOneInAThousand) {
  // 2000 pixels of 1; three of A are off by 1, 2 and 3. Two may be above, so P99.9 is 1.
  const Image b = filled(2000, 1, {1});
  Image a = b;
  a.data[10] += 3;
  a.data[400] -= 2;
  a.data[1999] += 1;
  const ChannelDifference channel = compareImages(a, b, {}).channels[0];
  EXPECT_EQ(channel.p999, 1);
  EXPECT_EQ(channel.max, 3);
}

TEST(Compare, OnlyTheMaskCounts) {
  const Image b = filled(3, 1, {1});
  Image a = b;
  a.data[2] = 100;
  EXPECT_EQ(compareImages(a, b, {1, 1, 0}).channels[0].max, 0);
  EXPECT_EQ(compareImages(a, b, {1, 1, 0}).pixels, 2u);
  EXPECT_EQ(compareImages(a, b, {1, 1, 1}).channels[0].max, 99);
}

TEST(Compare, BoxesAverageNoiseAway) {
  // A checkerboard of 1 +- 0.5 is exactly 1 in 2x2 blocks.
  const Image b = filled(6, 4, {1});
  Image a = b;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 6; ++x) *a.at(x, y) += (x + y) % 2 ? 0.5f : -0.5f;
  EXPECT_DOUBLE_EQ(compareImages(a, b, {}).channels[0].relativeRmse, 0.5);
  EXPECT_EQ(compareImages(a, b, {}, 2).channels[0].relativeRmse, 0);
  EXPECT_EQ(compareImages(a, b, {}, 2).samples, 6u);
}

TEST(Compare, BoxesNeedHalfOfTheirPixels) {
  // 3x2 pixels in 2x2 blocks: a whole one and the right edge's half one, of 1x2 pixels.
  Image a(3, 2, 1), b(3, 2, 1, 1.0f);
  a.data = {2, 4, 9, 8, 9, 9};
  EXPECT_EQ(compareImages(a, b, {1, 0, 0, 1, 0, 0}, 2).samples, 1u);         // 2 of 4, 0 of 2
  EXPECT_EQ(compareImages(a, b, {1, 0, 0, 1, 0, 0}, 2).channels[0].max, 4);  // mean of 2 and 8, minus 1
  EXPECT_EQ(compareImages(a, b, {1, 0, 1, 0, 0, 0}, 2).samples, 1u);         // 1 of 4, 1 of 2
  EXPECT_EQ(compareImages(a, b, {1, 0, 1, 0, 0, 0}, 2).channels[0].max, 8);  // the 9
  EXPECT_EQ(compareImages(a, b, {}, 100).samples, 1u);
  // Or all of them: the whole block, and of the half one what is inside the image.
  EXPECT_EQ(compareImages(a, b, {1, 1, 0, 1, 1, 1}, 2, 1).samples, 1u);
  EXPECT_EQ(compareImages(a, b, {1, 0, 1, 1, 1, 1}, 2, 1).channels[0].max, 8);
}

TEST(Compare, NonFinitePixelsAreCountedAndLeftOut) {
  Image a = filled(4, 1, {1, 1, 1}), b = a;
  a.at(1, 0)[2] = kNan;
  a.at(2, 0)[0] = -std::numeric_limits<float>::infinity();
  b.at(3, 0)[1] = kNan;
  const Comparison result = compareImages(a, b, {});
  EXPECT_EQ(result.nonFiniteA, 2u);
  EXPECT_EQ(result.nonFiniteB, 1u);
  EXPECT_EQ(result.samples, 1u);
  EXPECT_EQ(result.channels[2].max, 0);
}

TEST(Compare, NothingToCompareIsAnError) {
  const Image image = filled(2, 2, {1});
  EXPECT_THROW(compareImages(image, image, {0, 0, 0, 0}), InputError);
  EXPECT_THROW(compareImages(filled(2, 2, {kNan}), image, {}), InputError);
  EXPECT_THROW(compareImages(filled(2, 3, {1}), image, {}), InputError);
}

TEST(CompareMask, SplitsByFrontIrradiance) {
  Image irradiance(2, 2, 3);
  irradiance.at(0, 0)[2] = 0.1f;
  irradiance.at(0, 1)[0] = 5;
  const std::vector<std::uint8_t> material = {1, 2, 0, 3};
  EXPECT_EQ(comparisonMask(material, irradiance, Subset::All), (std::vector<std::uint8_t>{1, 1, 0, 1}));
  EXPECT_EQ(comparisonMask(material, irradiance, Subset::Lit), (std::vector<std::uint8_t>{1, 0, 0, 0}));
  EXPECT_EQ(comparisonMask(material, irradiance, Subset::Unlit), (std::vector<std::uint8_t>{0, 1, 0, 1}));
}

// ---- The command

// Standard output of `pellucid compare ARGUMENTS`; also in `printed`, when it throws too.
std::string runCompare(std::vector<std::string> arguments, std::string* printed = nullptr) {
  arguments.insert(arguments.begin(), "compare");
  return runCommand(addCompareCommand, arguments, printed);
}

class CompareCommand : public testing::Test {
protected:
  void SetUp() override {
    manifest["buffers"]["irradiance"] = {{"constant", {0, 0, 0}}};
    writeText(directory / "m.json", manifest.dump());
    // The truth is twice E.
    const Image irradiance = sampleCapture().irradiance;
    Image truth = irradiance;
    for (float& value : truth.data) value *= 2;
    write("same.exr", truth);
    for (float& value : truth.data) value *= 1.01f;
    write("near.exr", truth);
    truth.data[3] = kNan;  // pixel (1, 0), which has a material
    write("nan.exr", truth);
  }
  void write(const std::string& name, const Image& image) {
    writeExr(directory / name, image, {"R", "G", "B"});
  }
  std::string path(const std::string& name) { return (directory / name).string(); }

  std::string run(const std::vector<std::string>& arguments) { return runCompare(arguments, &output); }

  TemporaryDirectory directory;
  nlohmann::json manifest = writeSampleFiles(directory);
  std::string output;
};

TEST_F(CompareCommand, MeasuresAgainstTheTruthOverItsMaterial) {
  const auto json = nlohmann::json::parse(run({path("near.exr"), path("m.json"), "--json"}));
  EXPECT_EQ(json["pixels"], 15);  // 3 odd columns of 5 rows
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(json["rel_rmse"][c].get<double>(), 0.01, 1e-6);  // floats times 1.01f
    EXPECT_NEAR(json["bias"][c].get<double>(), 0.01, 1e-6);
  }
  EXPECT_TRUE(nlohmann::json::parse(run({path("same.exr"), path("m.json"), "--json"}))["psnr"][0].is_null());
}

TEST_F(CompareCommand, LimitsDecideTheExitCode) {
  EXPECT_NO_THROW(
      run({path("near.exr"), path("m.json"), "--limit", "rel_rmse=0.02,psnr=35", "--limit", "max=0.5"}));
  EXPECT_THROW(run({path("near.exr"), path("m.json"), "--limit", "rel_rmse=0.005"}), LimitExceeded);
  EXPECT_THROW(run({path("near.exr"), path("m.json"), "--limit", "psnr=80"}), LimitExceeded);
  EXPECT_NO_THROW(run({path("nan.exr"), path("m.json")}));
  EXPECT_THROW(run({path("nan.exr"), path("m.json"), "--limit", "rel_rmse=1000"}), LimitExceeded);
  EXPECT_NE(output.find("infinity in 1 pixels of A"), std::string::npos) << output;  // printed all the same
}

TEST_F(CompareCommand, BadInputIsRefused) {
  for (const char* limit :
       {"rmse=1", "rel_rmse", "rel_rmse=", "rel_rmse=x", "rel_rmse=-1", "rel_rmse=1%", "max=nan"})
    EXPECT_THROW(run({path("near.exr"), path("same.exr"), "--limit", limit}), UsageError) << limit;
  // Subsets need a capture.
  EXPECT_THROW(run({path("near.exr"), path("same.exr"), "--subset", "unlit"}), UsageError);
  EXPECT_NO_THROW(run({path("near.exr"), path("m.json"), "--subset", "unlit"}));
  EXPECT_THROW(run({path("near.exr"), path("m.json"), "--subset", "lit"}), InputError);  // no pixel is
  EXPECT_NO_THROW(run({path("near.exr"), path("same.exr"), "--mask", path("m.json"), "--subset", "unlit"}));
  manifest.erase("truth");
  writeText(directory / "m.json", manifest.dump());
  expectNames(refusalOf([&] { run({path("near.exr"), path("m.json")}); }), {"truth"});
  write("small.exr", Image(4, 4, 3));
  expectNames(refusalOf([&] {
                run({path("near.exr"), path("small.exr")});
              }),
              {"near.exr", "small.exr", "7x5", "4x4"});
}

TEST(CompareCommandOfImages, SaysWhatTheEyeSees) {
  // Without a capture all pixels show one surface. A: a dot, and 10 % too much red in the left half.
  const TemporaryDirectory directory;
  const std::string a = (directory / "a.exr").string(), b = (directory / "b.exr").string();
  const std::string ratio = (directory / "ratio.png").string();
  Image image(32, 16, 3, 1.0f);
  writeExr(b, image, {"R", "G", "B"});
  for (int y = 0; y < 16; ++y)
    for (int x = 0; x < 16; ++x) image.at(x, y)[0] = 1.1f;
  image.at(20, 9)[1] = 2;
  writeExr(a, image, {"R", "G", "B"});
  const auto json = nlohmann::json::parse(runCompare({a, b, "--json", "--ratio", ratio}));
  EXPECT_EQ(json["isolated"]["a"], 1);
  EXPECT_EQ(json["isolated"]["b"], 0);
  EXPECT_EQ(json["spots"], 1);
  EXPECT_EQ(json["tint"]["blocks"], 8);
  EXPECT_NEAR(json["tint"]["channels"][0].get<double>(), 0.05, 1e-6);
  EXPECT_NEAR(json["tint"]["channels"][2].get<double>(), 0, 1e-12);
  EXPECT_GT(json["flip"]["mean"].get<double>(), 0.01);
  EXPECT_GT(json["flip"]["p99"].get<double>(), json["flip"]["mean"].get<double>());
  EXPECT_EQ(readText(ratio).substr(1, 3), "PNG");
  EXPECT_NO_THROW(runCompare({a, b, "--limit", "isolated=1,spots=1,tint=0.06,flip=0.5,flip_p99=0.9"}));
  for (const char* limit : {"isolated=0", "spots=0", "tint=0.04", "flip=0.001", "flip_p99=0.001"})
    EXPECT_THROW(runCompare({a, b, "--limit", limit}), LimitExceeded) << limit;
  EXPECT_NO_THROW(runCompare({b, b, "--limit", "isolated=0,tint=0,flip=0,flip_p99=0"}));
}

// ---- Pictures

TEST(Pictures, SrgbCurveAndItsEnds) {
  Image image(8, 1, 1);
  // 0.0031308 is where the two pieces meet; 0.2158605 is the linear value of sRGB 128 / 255.
  image.data = {0, 0.0031308f, 0.2158605f, 1, 7, -1, kNan, std::numeric_limits<float>::infinity()};
  const std::vector<std::uint8_t> rgb = toSrgb(image);
  const std::vector<std::uint8_t> gray = {0, 10, 128, 255, 255, 0};  // 12.92 * .0031308 * 255 = 10.3
  for (std::size_t i = 0; i < gray.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_EQ(rgb[3 * i + c], gray[i]) << i;
  for (std::size_t i = gray.size(); i < 8; ++i) {
    EXPECT_EQ(rgb[3 * i], 255);
    EXPECT_EQ(rgb[3 * i + 1], 0);
    EXPECT_EQ(rgb[3 * i + 2], 255);
  }
  EXPECT_EQ(toSrgb(image, 1 / 7.0f)[3 * 4], 255);
}

}  // namespace
// Blocks of 2x2 whose pixels err independently: the error of a sum is half of that of four equal ones.
TEST(Compare, NoiseIsOfBlocks) {
  const Image image = filled(4, 4, {2, 4, 0}), error = filled(4, 4, {0.1f, 0.4f, 0});
  const std::vector<std::uint8_t> all(16, 1);
  const std::vector<double> pixels = relativeNoise(image, error, all, 1);
  EXPECT_NEAR(pixels[0], 0.05, 1e-7);
  EXPECT_NEAR(pixels[1], 0.1, 1e-7);
  EXPECT_EQ(pixels[2], 0);
  EXPECT_NEAR(relativeNoise(image, error, all, 2)[0], 0.025, 1e-7);
  // A block that is not wholly of mask does not count, and without any there is nothing to say.
  std::vector<std::uint8_t> some = all;
  some[5] = 0;
  EXPECT_NEAR(relativeNoise(image, error, some, 2)[1], 0.05, 1e-7);
  EXPECT_TRUE(relativeNoise(image, error, some, 4).empty());
}

}  // namespace pellucid::harness
