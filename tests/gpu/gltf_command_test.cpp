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

}  // namespace
