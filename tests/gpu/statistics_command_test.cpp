// `pellucid replay --stats` and `--debug tiles`.
#include <array>
#include <set>

#include "cli_fixture.h"
#include "pixels.h"

namespace {

using namespace pellucid::test;

class StatisticsCommand : public Cli {
protected:
  void SetUp() override {
    ASSERT_EQ(run("capture --procedural ear --size 96x64 --shadow-size 32 -o " + capture_).code, 0);
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

// Colors of a tile without material that no group reaches, and of one with all passes.
constexpr Color kBlack = {0, 0, 0}, kGreen = {0, 158, 115};

TEST_F(StatisticsCommand, AreATableAndAPicture) {
  const Outcome outcome = run(replay("--stats --debug tiles --tonemap agx"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  for (const char* part : {"statistics ", "groups run", "of most", "base level ", "tiles with material ",
                           "entry point groups ", "probe groups ", "gathered light: ",
                           "lights that can contribute: ", "green ", "entry points of map 0: "})
    EXPECT_NE(outcome.text.find(part), std::string::npos) << part << " is not in\n" << outcome.text;
  // 6 x 4 tiles of 16 pixels, some of which the ear leaves empty.
  const std::string line = outcome.text.substr(outcome.text.find("tiles with material"));
  int tiles = 0, most = 0;
  ASSERT_EQ(std::sscanf(line.c_str(), "tiles with material %d %d", &tiles, &most), 2) << line;
  EXPECT_EQ(most, 24);
  EXPECT_LT(tiles, most);

  const Pixels picture(path("out.png"));
  ASSERT_TRUE(picture.rgb);
  ASSERT_EQ(picture.width, 96);
  ASSERT_EQ(picture.height, 64);
  const std::set<Color> known = {kBlack,         {0, 114, 178},  {204, 121, 167}, {213, 94, 0},
                                 {240, 228, 66}, {86, 180, 233}, {230, 159, 0},   kGreen};
  int green = 0;
  for (int y = 0; y < 64; y += 16)
    for (int x = 0; x < 96; x += 16) {
      EXPECT_EQ(known.count(colorAt(picture, x, y)), 1u) << x << ", " << y;
      green += colorAt(picture, x, y) == kGreen;
    }
  EXPECT_EQ(green, tiles) << "small images have probes wherever they diffuse";
  EXPECT_GT(green, 0);

  // The EXR holds the result.
  const std::string plain = path("plain.exr");
  const Outcome without = run("replay " + capture_ + " --repeat 0 -o " + plain);
  EXPECT_EQ(without.text.find("statistics"), std::string::npos) << without.text;
  expect(0, "compare " + out_ + " " + plain + " --mask " + capture_ + " --limit max=0", "rel_rmse");
}

TEST_F(StatisticsCommand, SayWhatIsMissing) {
  const std::string quick = replay("--set quality=0 --set gather=0 --set indirect=light ");
  expect(0, quick + "--stats", "no tile lists: frame.indirectDispatches asks for none");
  expect(3, quick + "--debug tiles", "has no tile lists to draw: frame.indirectDispatches asks for none");
  expect(2, "plan " + capture_ + " --debug tiles", "\"tiles\" is not one of");
  expect(2, "replay x.exr --debug soul", "\"soul\" is not one of irradiance, occlusion, thickness, tiles");
}

TEST_F(StatisticsCommand, OfASequence) {
  std::filesystem::copy_file(capture_, path("ear.1.exr"));
  const std::string sequence = "replay " + path("ear.#.exr") + " -o " + path("o.#.exr") + " --set quality=0 ";
  expect(2, sequence + "--stats", "--stats is of one capture, not a sequence");
  expect(2, sequence + "--debug tiles", "PNGs need --exposure");
  expect(0, sequence + "--debug tiles --exposure 1", "1 written");
  const Pixels picture(path("o.1.png"));
  ASSERT_TRUE(picture.rgb);
  // Quality 0 has no probes.
  EXPECT_EQ(colorAt(picture, 48, 32), (Color{86, 180, 233}));
}

}  // namespace
