// Renders of Blender: a multilayer EXR and the script's JSON, made here as Cycles would make them.
#include "capture/blender.h"

#include <functional>
#include <numbers>

#include "capture_samples.h"
#include "scene/camera.h"

namespace pellucid::harness {
namespace {

using nlohmann::json;

constexpr int kWidth = 16, kHeight = 8;
constexpr double kDistance = 5;  // of the plane z = 0 from the eye

// A plane z = 0 seen from (1, 2, 5) straight down, one blue sun at 60 degrees and one spot.
class Blender : public testing::Test {
protected:
  void SetUp() override {
    names = {"View.Depth.Z",   "View.Normal.X",  "View.Normal.Y",  "View.Normal.Z",
             "View.DiffDir.R", "View.DiffDir.G", "View.DiffDir.B", "View.DiffCol.R",
             "View.DiffCol.G", "View.DiffCol.B", "View.IndexMA.X"};
    scene = json::parse(R"({
      "blender": 1, "metersPerUnit": 0.5,
      "camera": {"matrixWorld": [[2,0,0,1], [0,2,0,2], [0,0,2,5], [0,0,0,1]]},
      "lights": [
        {"name": "Sun", "type": "SUN", "color": [0,0,1], "energy": 3,
         "matrixWorld": [[1,0,0,0], [0,1,0,0], [0,0,1,9], [0,0,0,1]]},
        {"name": "Spot", "type": "SPOT", "color": [1,1,1], "energy": 100, "spotSize": 0.8, "spotBlend": 0.25,
         "matrixWorld": [[0,0,1,7], [0,1,0,8], [-1,0,0,9], [0,0,0,1]]}],
      "materials": [{"passIndex": 7, "material": {"preset": "skin1"}}]})");
    // Blender's camera.calc_matrix_camera(): OpenGL, here with a shift and clip distances 0.1 and 100.
    const double n = 0.1, f = 100;
    scene["camera"]["projection"] = {
        {2, 0, 0.2, 0}, {0, 4, -0.1, 0}, {0, 0, -(f + n) / (f - n), -2 * f * n / (f - n)}, {0, 0, -1, 0}};
    write();
  }
  void write() {
    Image image(kWidth, kHeight, static_cast<int>(names.size()));
    const std::vector<float> values = {kDistance, 0, 0, 1, 0.25f, 0.5f, 1, 0.6f, 0.4f, 0.2f, 7};
    for (std::size_t i = 0; i < image.data.size(); ++i) image.data[i] = values[i % names.size()];
    image.at(0, 0)[0] = 1e10f;  // the background, as Cycles clears it
    for (std::size_t i = 1; i < names.size(); ++i) image.at(0, 0)[i] = 0;
    writeExr(folder / "render.exr", image, names);
  }
  Capture read() {
    writeText(folder / "render.json", scene.dump());
    return readCapture(folder / "render.exr", ManifestPreset::Blender);
  }
  std::string error() {
    return refusalOf([&] { read(); });
  }

  TemporaryDirectory folder;
  std::vector<std::string> names;
  json scene;
};

TEST_F(Blender, BuffersComeFromThePasses) {
  const Capture c = read();
  EXPECT_EQ(c.width, kWidth);
  EXPECT_EQ(c.height, kHeight);
  EXPECT_EQ(c.metersPerUnit, 0.5);
  EXPECT_EQ(*c.frontDepth.image.at(3, 2), static_cast<float>(kDistance));
  EXPECT_EQ(c.frontDepth.encoding, PELLUCID_DEPTH_VIEW_Z);
  EXPECT_GE(*c.frontDepth.image.at(0, 0), 1e9f) << "nothing there";
  EXPECT_EQ(c.normal.at(3, 2)[2], 1);
  EXPECT_FALSE(c.normalsInViewSpace);
  EXPECT_EQ(c.albedo.at(3, 2)[1], 0.4f);
  EXPECT_EQ(c.material[0], 0);
  EXPECT_EQ(c.material[1], 1);
  EXPECT_TRUE(c.backDepth.image.empty());
  // Diffuse Direct is E / pi.
  EXPECT_FLOAT_EQ(c.irradiance.at(3, 2)[0], 0.25f * std::numbers::pi_v<float>);
}

TEST_F(Blender, CameraIsVulkansAndWithoutScale) {
  const Capture c = read();
  // The eye's own point is at the origin, and view units are scene units in spite of the camera's scale.
  EXPECT_EQ(c.viewFromWorld, (Matrix{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -1, -2, -5, 1}));
  // A point of the plane: OpenGL's ndc by hand, y turned over and depth from 0 to 1.
  const Matrix& m = c.clipFromView;
  const double x = 0.5, y = -0.25, z = -kDistance;
  const auto row = [&](std::size_t r) { return m[r] * x + m[4 + r] * y + m[8 + r] * z + m[12 + r]; };
  EXPECT_NEAR(row(3), kDistance, 1e-12);
  EXPECT_NEAR(row(0) / row(3), (2 * x + 0.2 * z) / kDistance, 1e-12);
  EXPECT_NEAR(row(1) / row(3), -(4 * y - 0.1 * z) / kDistance, 1e-12);
  EXPECT_NEAR(deviceDepth(m, 0.1), 0, 1e-9);
  EXPECT_NEAR(deviceDepth(m, 100), 1, 1e-9);
}

TEST_F(Blender, LightsInPellucidsUnits) {
  const Capture c = read();
  ASSERT_EQ(c.lights.size(), 2u);
  EXPECT_EQ(c.lights[0].type, PELLUCID_LIGHT_DIRECTIONAL);
  EXPECT_EQ(c.lights[0].intensity, 3) << "a sun's strength is its irradiance";
  EXPECT_EQ(c.lights[0].direction, (std::array<double, 3>{0, 0, -1}));
  EXPECT_EQ(c.lights[0].color, (std::array<double, 3>{0, 0, 1}));
  const Light& spot = c.lights[1];
  EXPECT_EQ(spot.type, PELLUCID_LIGHT_SPOT);
  EXPECT_NEAR(spot.intensity, 100 / (4 * std::numbers::pi), 1e-12);
  EXPECT_EQ(spot.position, (std::array<double, 3>{7, 8, 9}));
  EXPECT_EQ(spot.direction, (std::array<double, 3>{-1, 0, 0})) << "along its own -z";
  EXPECT_DOUBLE_EQ(spot.outerConeAngle, 0.4);
  EXPECT_DOUBLE_EQ(spot.innerConeAngle, 0.3);
}

TEST_F(Blender, OptionalPasses) {
  names.resize(7);  // no color, no index
  write();
  EXPECT_TRUE(read().albedo.empty());
  EXPECT_EQ(read().material[5], 1);
  std::filesystem::copy_file(folder / "render.exr", folder / "back.exr");
  scene["backDepth"] = "back.exr";
  EXPECT_EQ(*read().backDepth.image.at(3, 2), static_cast<float>(kDistance));
}

TEST_F(Blender, ErrorsNameWhatIsWrong) {
  const auto expectRefusal = [&](const std::function<void()>& change, const std::vector<std::string>& named) {
    SetUp();
    change();
    write();
    expectNames(error(), named);
  };
  expectRefusal([&] { names[4] = "View.Emit.R"; },
                {"render.exr", "irradiance", "View.DiffDir.R", "View.Emit.R"});
  expectRefusal([&] { names[0] = "View.Mist.Z"; }, {"render.exr", "Depth pass"});
  expectRefusal([&] { names[4] = "Other.Depth.Z"; }, {"render.exr", "viewLayer"});
  for (const std::vector<std::string>& cells : tableOf(R"(
/lights/0/type | "AREA" | render.json | lights[0].type | AREA
/camera/matrixWorld | [[1, 0, 0]] | render.json | camera.matrixWorld | 4 rows
/camera/matrixWorld/0/0 | 0 | render.json | camera.matrixWorld | no length
/materials/1 | {"passIndex": 7, "material": {"preset": "skin1"}} | render.json | materials[1].passIndex | 7
/materials/0/passIndex | 8 | render.exr | material | holds 7
/world | 1 | render.json | world | unknown key
)"))
    expectRefusal([&] { scene[json::json_pointer(cells[0])] = json::parse(cells[1]); },
                  {cells.begin() + 2, cells.end()});
  std::filesystem::remove(folder / "render.json");
  expectNames(refusalOf([&] { readCapture(folder / "render.exr", ManifestPreset::Blender); }),
              {"render.json", "blender_export.py"});
}

}  // namespace
}  // namespace pellucid::harness
