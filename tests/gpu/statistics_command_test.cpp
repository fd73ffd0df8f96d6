// `pellucid replay --stats` and `--debug blocks`.
#include <array>
#include <map>

#include "cli_fixture.h"
#include "pixels.h"

namespace {

using namespace pellucid::test;

class StatisticsCommand : public Cli {
protected:
  void capture(const std::string& size) {
    ASSERT_EQ(run("capture --procedural ear --size " + size + " --shadow-size 32 -o " + capture_).code, 0);
  }

  std::string replay(const std::string& options) const {
    return "replay " + capture_ + " --repeat 0 -o " + out_ + " " + options;
  }

  const std::string capture_ = path("ear.exr"), out_ = path("out.exr");
};

using Color = std::array<int, 3>;

Color colorAt(const Pixels& picture, int x, int y) {
  const stbi_uc* pixel = picture.rgb.get() + 3 * (y * picture.width + x);
  return {pixel[0], pixel[1], pixel[2]};
}

// Colors of a block without material anywhere near, of one beside material, and of one with material.
constexpr Color kBlack = {0, 0, 0}, kBlue = {0, 114, 178}, kYellow = {240, 228, 66};

TEST_F(StatisticsCommand, AreATableAndAPicture) {
  capture("384x256");
  const Outcome outcome = run(replay("--stats --debug blocks --tonemap agx"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* part : {"statistics ", "groups run", "of most", "base level ", "blocks with material ",
                           "entry point groups ", "probe groups ", "lights that can contribute: ", "yellow "})
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << " is not in\n" << outcome.text;
  // 6 x 4 blocks of 64 pixels, some of which the ear leaves empty.
  const std::string line = outcome.text.substr(outcome.text.find("blocks with material"));
  int blocks = 0, most = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "blocks with material %d %d", &blocks, &most), 2) << line;
  EXPECT_EQ(most, 24);
  EXPECT_LT(blocks, most);

  const Pixels picture(path("out.png"));
  ASSERT_TRUE(picture.rgb);
  ASSERT_EQ(picture.width, 384);
  ASSERT_EQ(picture.height, 256);
  std::map<Color, int> found;
  for (int y = 0; y < 256; y += 64)
    for (int x = 0; x < 384; x += 64) ++found[colorAt(picture, x, y)];
  EXPECT_EQ(found[kYellow], blocks);
  EXPECT_EQ(found[kYellow] + found[kBlue] + found[kBlack], most);

  // The EXR holds the result.
  const std::string plain = path("plain.exr");
  const Outcome without = run("replay " + capture_ + " --repeat 0 -o " + plain);
  EXPECT_EQ(without.text.find("statistics"), std::string::npos) << without.text;
  expect(0, "compare " + out_ + " " + plain + " --mask " + capture_ + " --limit max=0", "rel_rmse");
}

}  // namespace
