// `pellucid truth` as a person runs it.
#include <cstdlib>

#include "capture/read.h"
#include "capture/write.h"
#include "cli_fixture.h"
#include "gltf_builder.h"
#include "scene/environment.h"

namespace {

namespace fs = std::filesystem;
using namespace pellucid::harness;
using namespace pellucid::test;

TEST_F(Cli, TruthIsMadeContinuedAndCompared) {
  const std::string file = path("truth.exr"), out = path("out.exr");
  const std::string scene =
      "truth --procedural sphere --set extent=18 --size 24x24 --shadow-size 64 -o " + file;
  expect(0, scene + " --spp 16", "16 samples each");
  expect(0, scene + " --spp 8 --jobs 1", "24 samples each");
  expect(3, scene + " --truth-seed 2", "was made with --truth-seed 1, not 2");
  expect(3, scene + " --light point", "another scene");
  expect(0, scene + " --overwrite --seconds 0.01 --environment uniform:1,1,1", "noise of 8x8 averages");
  expect(0, "replay " + file + " --repeat 0 -o " + out, "");
  // The replay is a model of the truth: it is near it and not equal. Its noise is there.
  expect(1, "compare " + out + " " + file + " --box 4 --limit rel_rmse=0.001", "noise of B");
  expect(0, "compare " + file + " " + file + " --limit max=0", "noise of B");
}

TEST_F(Cli, TruthRefusesByName) {
  expect(2, "truth --procedural sphere --environment blue -o " + path("t.exr"), "\"blue\" is not uniform");
  expect(2, "truth --procedural sphere --like x.exr --size 8x8 -o " + path("t.exr"), "--size: --like takes");
  expect(2, "truth --procedural sphere --spp 1 -o " + path("t.exr"), "--spp");
  expect(3, "truth --procedural sphere --size 8x8 -o " + path("missing/t.exr"), "there is no folder");
  EXPECT_FALSE(fs::exists(path("t.exr")));
}

// A .glb of a triangle of the material "paper", which has two sides.
std::string paperSheet() {
  return GltfBuilder::triangle({-1, -1, 0, 1, -1, 0, 0, 1, 0}, {{"name", "paper"}, {"doubleSided", true}}).glb();
}

// An open sheet, lit from behind, through the whole chain; its light is exact.
TEST_F(Cli, TruthTracesThinWalls) {
  const std::string model = path("sheet.glb"), file = path("t.exr"), out = path("o.exr");
  std::ofstream(model, std::ios::binary) << paperSheet();
  const std::string scene =
      "truth " + model + " --size 24x24 --spp 2 --light directional:0.5,0,1:2 -o " + file;
  expect(3, scene + " --material paper=thin:0.5,0.25", "\"thin:0.5,0.25\" is not thin:R,G,B");
  expect(0, scene + " --material paper=thin:0.5,0.25,0", "paths a second");
  expect(0, "info " + file, "thin wall");
  expect(0, "replay " + file + " --repeat 0 -o " + out);
  expect(0, "compare " + out + " " + file + " --limit rel_rmse=0.001 --limit max=0.001");
}

// Falloff tables and a sky of a capture count in its truth, whose sheet is exact; light that cannot be traced
// is refused.
TEST_F(Cli, TruthLikeHonorsTheCapturesLight) {
  const std::string model = path("sheet.glb"), file = path("c.exr"), out = path("o.exr"),
                    traced = path("t.exr");
  std::ofstream(model, std::ios::binary) << paperSheet();
  expect(0, "capture " + model +
                " --material paper=thin:0.5,0.25,0 --size 24x24 --view 0,0,1 --shadow-size 0 " +
                "--light point:0.2,0.1,-1:3 -o " + file);
  Capture capture = readCapture(file);
  capture.lights[0].range = 3;
  capture.lights[0].direction = {0, 0, 1};
  capture.lights[0].angleTable = {1, 0.5, 0.1, 0};
  capture.lights[0].distanceTable = {0, 0.1, 0.9, 0.2, 1};
  const std::string like =
      "truth " + model + " --material paper=thin:0.5,0.25,0 --overwrite --like " + file + " -o " + traced;
  writeCapture(capture, file, ColorFormat::Float);
  expect(0, like + " --spp 2");
  expect(0, "replay " + file + " --repeat 0 -o " + out);
  expect(0, "compare " + out + " " + traced + " --limit rel_rmse=0.002 --limit max=0.002");
  // The sky alone: noise of the truth's.
  capture.lights.clear();
  capture.environment = Environment{{1, 0.5, 1}, {0.25, 0.5, 0}}.harmonics();
  capture.backDepth = capture.frontDepth;
  writeCapture(capture, file, ColorFormat::Float);
  expect(0, like + " --spp 512");
  expect(0, "replay " + file + " --set ambient=1 --repeat 0 -o " + out);
  expect(0, "compare " + out + " " + traced + " --box 4 --limit rel_rmse=0.02");
  expect(3, like + " --spp 2 --environment uniform:1,1,1", "environment: is not that of --environment");
  capture.hiddenIrradiance = capture.irradiance;
  capture.environment.reset();
  writeCapture(capture, file, ColorFormat::Float);
  expect(3, like + " --spp 2", "hiddenIrradiance: is of light that no ray finds");
}

// The numbers that info prints and docs/accuracy.md has, but for 64 samples a pixel and few pixels.
TEST_F(Cli, LightsWithoutAShadowMapErrAsInfoSays) {
  const auto bias = [&](const std::string& scene) {
    const std::string both = " --procedural " + scene + " -o " + path("");
    expect(0, "truth --spp 64 --overwrite" + both + "t.exr", "samples each");
    expect(0, "capture --shadow-size 0" + both + "c.exr");
    expect(0, "replay " + path("c.exr") + " --repeat 0 -o " + path("o.exr"));
    const Outcome outcome = run("compare --json " + path("o.exr") + " " + path("t.exr"));
    EXPECT_EQ(outcome.code, 0) << outcome.text;
    return nlohmann::json::parse(outcome.text)["bias"].get<std::vector<double>>();
  };
  const std::vector<double> ear = bias("ear --size 32x32"),
                            ball = bias("sphere --size 16x16 --set extent=18");
  const double printed[] = {-0.02, -0.06, -0.06};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(ear[c], printed[c], 0.07) << c;
    EXPECT_GT(ball[c], 0.1) << c;
    EXPECT_LT(ball[c], 3) << c;
  }
}

// A pyramid without its base, then closed.
TEST_F(Cli, TruthClosesHolesOrNamesThem) {
  GltfBuilder b;
  const std::vector<float> corners = {0, 1, 0, -1, 0, -1, -1, 0, 1, 1, 0, 1, 1, 0, -1};
  const std::vector<std::uint16_t> sides = {0, 1, 2, 0, 2, 3, 0, 3, 4, 0, 4, 1};
  b.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", b.vectors(corners)}}}, {"indices", b.indices(sides)}}}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  const std::string model = path("pyramid.glb");
  std::ofstream(model, std::ios::binary) << b.glb();
  const std::string scene = "truth " + model + " --unit cm --material '*=skin1' --size 24x24 --spp 2 -o " +
                            path("t.exr") + " --light sphere:0,9,9:2";
  expect(3, scene, "has 1 hole; --fill-holes closes them");
  expect(0, scene + " --fill-holes --ior 1.4", "1 holes filled");
  // The same body under another material's capture is another scene; far from the camera it is none.
  expect(0, "capture " + model + " --unit cm --material '*=marble' --size 24x24 -o " + path("c.exr"), "");
  const std::string like = "truth " + model + " --like " + path("c.exr") + " --spp 2 -o " + path("l.exr");
  expect(0, like + " --unit cm --fill-holes", "1 holes filled");
  expect(3, like + " --unit mm --fill-holes --overwrite", "is --unit right?");
}

// Cycles' truth of the same head, of 2048 samples a pixel, against two of ours: noise is nearly all that
// differs. Its albedo is not rho but .99 of it, and its pixels are averages.
TEST_F(Cli, TruthAgreesWithCycles) {
  const char* const given = std::getenv("PELLUCID_SHARED");
  const fs::path shared = given ? fs::path(given) : fs::path(PELLUCID_SOURCE_DIR).parent_path() / "shared";
  const fs::path model = shared / "models/LeePerrySmith_70k.glb";
  const fs::path capture = shared / "captures/head_sidelit/manifest.json";
  if (!fs::exists(model) || !fs::exists(capture)) GTEST_SKIP() << shared << " is not there";
  expect(
      0,
      "truth " + model.string() + " --unit 0.052 --like " + capture.string() + " --spp 2 -o " + path("t.exr"),
      "2 samples each");
  expect(0, "compare " + path("t.exr") + " " + capture.string() + " --subset lit --limit bias=0.02",
         "rel_rmse");
  expect(0,
         "compare " + path("t.exr") + " " + capture.string() +
             " --subset lit --box 16 --box-coverage 1 --limit rel_rmse=0.07",
         "rel_rmse");
}

}  // namespace
