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

TEST_F(GltfCommand, CamerasOfOneNameAreChosenByTheirNodes) {
  GltfBuilder b = triangle();
  b.json["cameras"] = {{{"name", "Camera"}, {"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 0.1}}}}};
  for (const char* node : {"Front", "Side"}) b.json["nodes"].push_back({{"name", node}, {"camera", 0}, {"translation", {0, 0, 5}}});
  for (int i = 0; i < 3; ++i) b.json["scenes"][0]["nodes"][i] = i;
  const std::string capture = "capture " + write("t.glb", b) + " --size 16x16 --material wax=skin1 -o " + path("o.exr") + " --camera ";
  expect(2, capture + "Camera", "2 cameras are called \"Camera\"; name a node: auto, Camera (node Front), Camera (node Side)");
  expect(0, capture + "Side", "wrote");
}

TEST_F(GltfCommand, NormalsAgainstTheWindingAreNamed) {
  for (const float z : {1.0f, -1.0f}) {
    GltfBuilder b = triangle();
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b.vectors({0, 0, z, 0, 0, z, 0, 0, z});
    const Outcome outcome = run("capture " + write("t.glb", b) + " --size 16x16 --material wax=skin1 -o " + path("o.exr"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    EXPECT_EQ(outcome.text.find("NORMAL: points against the winding") != std::string::npos, z < 0) << outcome.text;
  }
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
