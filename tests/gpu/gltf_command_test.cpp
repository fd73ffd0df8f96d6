// `pellucid capture` of glTF files as a person runs it.
#include "cli_fixture.h"
#include "gltf_builder.h"

namespace {

using namespace pellucid::test;

class GltfCommand : public Cli {
protected:
  static GltfBuilder triangle() { return GltfBuilder::triangle({0, 0, 0, 2, 0, 0, 0, 2, 0}, {{"name", "wax"}}); }
  std::string write(const std::string& name, GltfBuilder b) const {
    std::ofstream(path(name), std::ios::binary) << b.glb();
    return path(name);
  }
};

TEST_F(GltfCommand, AModelWithoutATranslucentMaterialIsRefused) {
  const std::string file = write("t.glb", triangle()), out = path("o.exr");
  const std::string capture = "capture " + file + " --size 16x16 -o " + out;
  expect(3, capture, "t.glb: materials: none is translucent; --material NAME=PRESET");
  EXPECT_FALSE(std::filesystem::exists(out));
  expect(3, capture + R"( --material 'wax={"subsurface_color": [0.8, 0.5, 3]}')",
         "subsurface_color[2]: must be");
  expect(0, capture + " --material 'wax=skin1'", "wrote");
  expect(0, "info " + out, "skin1");
}

// The triangle is 2 units wide and high, and red has a transport mean free path of 1 / (.74 + .032) mm.
TEST_F(GltfCommand, WarnsOfBodiesThatAreOpticallyThin) {
  const std::string file = write("t.glb", triangle()), out = path("o.exr");
  for (const std::string unit : {"mm", "cm"}) {
    const Outcome outcome =
        run("capture " + file + " --size 64x64 --material wax=skin1 --unit " + unit + " -o " + out);
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find("transport mean free paths, which are 1.3 mm each in R") != std::string::npos, unit == "mm")
        << outcome.text;
  }
  const std::string ball = "capture --procedural sphere --set extent=9 --size 32x32 -o " + out;
  expect(0, ball + " --set radius=1.5", "is less than 4 transport mean free paths, which are ");
}

// A triangle that nothing but the camera moves: its light stays where it is on the surface.
TEST_F(GltfCommand, FlickerFollowsPaths) {
  const std::string flicker = "flicker " + write("t.glb", triangle()) +
                              " --size 96x96 --shadow-size 64 --unit cm --material wax=skin1 --light back --pixels 1 ";
  const Outcome outcome = run(flicker + "--path orbit --frames 3 --json --picture " + path("f.png"));
  EXPECT_EQ(outcome.code, 0) << outcome.text;
  const auto changes = changesOf(outcome);
  int paths = 0;
  for (const auto& change : changes) {
    if (!change.contains("steps")) continue;
    ++paths;
    EXPECT_EQ(change["steps"].size(), 2u) << change;
    EXPECT_GT(change["pixels"], 1000) << change;
    EXPECT_LT(change["rel_rmse"][0], 0.02) << change;
  }
  EXPECT_EQ(paths, 2);
  // Two frames of 96 pixels with gaps of 4 pixels, and the changes below: width and height of the PNG's
  // header.
  EXPECT_EQ(bytes("f.png").substr(16, 8), std::string("\0\0\0\xc4\0\0\0\xc0", 8));
  expect(2, flicker + "--path orbit,pan --picture x.png", "--picture: shows one path");
  expect(2, flicker + "--path walk", "--path: \"walk\" is not pan, dolly, orbit, head, lights or blink");
}

}  // namespace
