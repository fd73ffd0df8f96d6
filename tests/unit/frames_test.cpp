// Frame lists, patterns and polynomials of the command line, and files that are whole or not there.
#include "cli/frames.h"

#include <numbers>
#include <stdexcept>

#include "capture_samples.h"
#include "cli/settings.h"
#include "common/whole_file.h"

namespace pellucid::harness {
namespace {

TEST(Frames, RangesAndLists) {
  EXPECT_EQ(parseFrames("7"), (std::vector<int>{7}));
  EXPECT_EQ(parseFrames("1-3,20"), (std::vector<int>{1, 2, 3, 20}));
  EXPECT_EQ(parseFrames("20,2-3,0003"), (std::vector<int>{2, 3, 20})) << "ascending, each once";
  EXPECT_EQ(parseFrames("0-599").size(), 600u);
  for (const char* bad :
       {"", ",", "1,", "1-", "-1", "1-2-3", "3-1", "1.5", "1 2", "a", "99999999", "0-9999999"})
    EXPECT_THROW(parseFrames(bad), UsageError) << bad;
}

TEST(Frames, TextIsTheInverse) {
  for (const char* text : {"7", "1-3,20", "0,2,4-5", "1-600"}) EXPECT_EQ(framesText(parseFrames(text)), text);
}

TEST(Frames, PatternPadsToItsWidth) {
  EXPECT_EQ(FramePattern("-o", "a/name.####.exr")(7), "a/name.0007.exr");
  EXPECT_EQ(FramePattern("-o", "a/name.####.exr")(12345), "a/name.12345.exr");
  EXPECT_EQ(FramePattern("-o", "#.exr")(0), "0.exr");
  EXPECT_EQ(FramePattern("-o", "f##")(3), "f03");
  for (const char* bad : {"", "name.exr", "a.##.b.##.exr", "a##/name.exr", "a#/b#.exr"})
    EXPECT_THROW(FramePattern("-o", bad), UsageError) << bad;
}

TEST(Frames, ThoseThatExistAreFound) {
  const TemporaryDirectory folder;
  for (const char* name :
       {"a.0007.exr", "a.0010.exr", "a.12345.exr", "a.7.exr", "a.x007.exr", "b.0001.exr", "a.0003.png"})
    writeText(folder / name, "");
  EXPECT_EQ(FramePattern("capture", (folder / "a.####.exr").string()).existing(),
            (std::vector<int>{7, 10, 12345}));
  EXPECT_TRUE(FramePattern("capture", (folder / "none/a.####.exr").string()).existing().empty());
}

double value(const std::string& name, double x) {
  SettingsOptions options;
  options.set = {"polynomial=" + name};
  double sum = 0, power = 1;
  for (const float c : options.parse().translucency.anglePolynomial) {
    sum += static_cast<double>(c) * power;
    power *= x;
  }
  return sum;
}

// Whelan 2009, eqs. 4.4 and 4.5, at the ends of the angle between camera and light and where the quadratic is
// negative.
TEST(Settings, PolynomialsAreThoseOfTheThesis) {
  constexpr double kPi = std::numbers::pi;
  EXPECT_NEAR(value("quadratic", kPi / 2), 0.036, 5e-4);
  EXPECT_NEAR(value("cubic", kPi / 2), 0.002, 5e-4);
  EXPECT_NEAR(value("quadratic", kPi), 0.867, 5e-4);
  EXPECT_NEAR(value("cubic", kPi), 0.962, 5e-4);
  EXPECT_GT(value("quadratic", 1.67), 0);
  EXPECT_LT(value("quadratic", 1.69), 0);
  EXPECT_LT(value("quadratic", 2.14), 0);
  EXPECT_GT(value("quadratic", 2.16), 0);
}

TEST(WholeFile, ErrorsNameTheFileThatWasAskedFor) {
  const TemporaryDirectory folder;
  const auto sentence = [&](const std::filesystem::path& path) {
    return refusalOf([&] {
      writeWhole(path, [](const std::filesystem::path& file) {
        throw InputError(file.string(), "", "the disk is full");
      });
    });
  };
  EXPECT_EQ(sentence(folder / "o.exr"), (folder / "o.exr").string() + ": the disk is full");
  EXPECT_NE(sentence(folder / "no/o.exr").find("no/o.exr: cannot be written: there is no folder"),
            std::string::npos);
}

TEST(WholeFile, AppearsWhenItIsWhole) {
  const TemporaryDirectory folder;
  const std::filesystem::path path = folder / "out.exr";
  writeText(path, "before");
  EXPECT_THROW(writeWhole(path,
                          [&](const std::filesystem::path& file) {
                            writeText(file, "half");
                            EXPECT_EQ(file.parent_path(), path.parent_path()) << "renaming must not copy";
                            EXPECT_EQ(readText(path), "before");
                            throw std::runtime_error("disk full");
                          }),
               std::runtime_error);
  EXPECT_EQ(readText(path), "before");
  writeWhole(path, [](const std::filesystem::path& file) { writeText(file, "after"); });
  EXPECT_EQ(readText(path), "after");
  const std::filesystem::directory_iterator files(path.parent_path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "a temporary file stays behind";
}

}  // namespace
}  // namespace pellucid::harness
