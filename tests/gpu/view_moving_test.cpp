// Frames whose scene moves: images that stay on the device are those of the capture, to the bit.
#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>
#include <random>

#include "capture/material.h"
#include "common/error.h"
#include "gpu_fixture.h"
#include "model_builder.h"
#include "raster/passes.h"
#include "view/frames.h"

namespace {

using namespace pellucid::test;

constexpr int kSize = 40;

// A closed body before a double-sided sheet that is open and seen from behind, both translucent.
Model sphereAndSheet() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 5, 20);
  endPart(model, 1);
  model.surfaces.push_back(model.surfaces[0]);
  model.surfaces[1].doubleSided = true;
  addQuad(model, {{-7, -7, -6}, {-7, 7, -6}, {7, 7, -6}, {7, -7, -6}}, {0, 0, -1});
  endPart(model, 2, 1);
  model.lights = {directional({0.2, 0.1, 1}, 2), directional({0, -1, -0.4}, 0.5)};
  return model;
}

Light pointLight() {
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  light.position = {4, 6, 18};
  light.intensity = 500;
  return light;
}

class Moving : public GpuTest {
protected:
  void open(Model model, const RasterOptions& options = smallRaster(kSize),
            const ReplaySettings& settings = {}) {
    frames_.reset();  // before the source that it draws from
    source_ = modelSource(device(), std::move(model), frontCamera(false), options);
    state_ = source_->start();
    state_.settings = settings;
    static Contexts contexts(device());  // a second of pipelines, once
    frames_ = std::make_unique<ViewFrames>(device(), contexts, *source_);
    frames_->update(state_, {});
  }

  void move() {
    constexpr double kStep = 0.05;
    orbit(state_.camera, kStep, 0.4 * kStep);
    for (ViewLight& light : state_.lights)
      dragLight(light.light, state_.camera, source_->center(), -kStep, kStep);
    fitRange(state_.camera, source_->center(), source_->radius());
    frames_->update(state_, {.scene = true});
  }

  Transfers transfersOfMoves(int count) {
    const Transfers before = device().transfers();
    for (int i = 0; i < count; ++i) move();
    const Transfers& after = device().transfers();
    return {after.uploaded - before.uploaded, after.downloaded - before.downloaded};
  }

  void expectReplays(const std::string& what) {
    const Capture& capture = frames_->capture();
    const ReplaySettings settings = settingsFor(state_, Shown::After);
    const Image output = replayer().run(capture, compileMaterials(capture), settings).output;
    const Image replayed = output.channels == 3 ? output : rgb(output);  // packed floats have no alpha
    EXPECT_TRUE(sameBits(frames_->image(Shown::After), replayed)) << what;
    EXPECT_GT(*std::max_element(replayed.data.begin(), replayed.data.end()), 0.01f)
        << what << ": a black picture would be anything's";
  }

  std::unique_ptr<Source> source_;
  ViewState state_;
  std::unique_ptr<ViewFrames> frames_;
};

// Ways to draw and to read what is drawn.
struct Way {
  std::string name;
  bool staysOnDevice;
  RasterOptions raster = smallRaster(kSize);
  ReplaySettings settings = {};
  bool point = false;  // light
};

void PrintTo(const Way& way, std::ostream* out) { *out << way.name; }

std::vector<Way> ways() {
  std::vector<Way> all;
  const auto add = [&](const char* name, bool staysOnDevice) -> Way& {
    return all.emplace_back(Way{name, staysOnDevice});
  };
  add("Default", true);
  add("Point", true).point = true;
  Way& cube = add("Cube", true);
  cube.raster.pointMaps = PointMaps::Six;
  cube.point = true;
  Way& planar = add("PlanarForward", true);
  planar.raster.depthEncoding = planar.raster.shadowEncoding = PELLUCID_DEPTH_VIEW_Z;
  planar.raster.reversedZ = false;
  add("ForwardInfinite", true).raster.infiniteFar = true;
  add("Farthest", true).raster.backFace = BackFace::Farthest;
  add("NoMaps", true).raster.shadowSize = 0;
  add("Simplified", true).raster.simplify = 0.3;
  add("Floats", true).settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  add("CameraThickness", true).settings.translucency.cameraThickness = 1;
  Way& atlas = add("Atlas", false);
  atlas.raster.shadow.placement = MapPlacement::Atlas;
  atlas.raster.shadow.bits = 16;
  atlas.raster.shadow.cull = MapCull::Front;
  Way& distance = add("Distance", false);
  distance.raster.shadowEncoding = PELLUCID_DEPTH_DISTANCE;
  distance.point = true;
  add("ViewNormals", false).raster.normalsInViewSpace = true;
  add("PackedFloats", false).settings.outputFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  return all;
}

class MovingWays : public Moving, public testing::WithParamInterface<Way> {};

INSTANTIATE_TEST_SUITE_P(Ways, MovingWays, testing::ValuesIn(ways()),
                         [](const testing::TestParamInfo<Way>& way) { return way.param.name; });

// The picture of a moved scene is the replay of its capture, and came about without the host where it can.
TEST_P(MovingWays, AreReplaysAndStayOnTheDevice) {
  const Way& way = GetParam();
  Model model = sphereAndSheet();
  if (way.point) model.lights = {pointLight()};
  open(model, way.raster, way.settings);
  const Transfers moved = transfersOfMoves(3);
  EXPECT_EQ(moved.downloaded == 0, way.staysOnDevice) << moved.downloaded << " bytes";
  EXPECT_EQ(moved.uploaded == 0, way.staysOnDevice) << moved.uploaded << " bytes";
  expectReplays("moved");
}

TEST_F(Moving, LobesApartAreReplays) {
  Model model = sphereAndSheet();
  for (Surface& surface : model.surfaces) {
    surface.addedColor = {0.4, 0.05, 0.05};
    surface.displaced = 0.5;
    surface.lobes = SurfaceLobes::Apart;
  }
  open(model);
  const Transfers moved = transfersOfMoves(2);
  EXPECT_EQ(moved.downloaded + moved.uploaded, 0u);
  expectReplays("moved");
}

// A sheet alone: the module gets no back depth, which no pixel has.
TEST_F(Moving, OpenMeshesAreReplaysWithoutBackDepth) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 5);
  endPart(model, 1);
  model.lights = {directional({0.2, 0.1, -1}, 2)};
  open(model);
  move();
  EXPECT_FALSE(frames_->run(Shown::After).frame().backDepth.view);
  ASSERT_EQ(frames_->warnings().size(), 1u);
  EXPECT_NE(frames_->warnings()[0].find("and the capture no backDepth"), std::string::npos);
  expectReplays("moved");
}

TEST_F(Moving, ValuesAreThoseOfTheWholeImages) {
  open(sphereAndSheet());
  state_.settings.debugView = PELLUCID_DEBUG_THICKNESS;
  state_.display.shown = Shown::Debug;
  state_.display.split = true;
  state_.display.left = Shown::Through;
  move();
  const int places[][2] = {{kSize / 2, kSize / 2}, {3, kSize - 5}, {0, 0}, {kSize - 1, kSize - 1}};
  const Shown all[] = {Shown::After, Shown::Before,     Shown::Through, Shown::Difference, Shown::Truth,
                       Shown::Debug, Shown::FrontDepth, Shown::Normal,  Shown::Albedo,     Shown::Material};
  std::vector<std::vector<float>> values;
  const std::uint64_t before = device().transfers().downloaded;
  for (const Shown shown : all)
    for (const auto& [x, y] : places) values.push_back(frames_->value(shown, x, y));
  constexpr std::uint64_t kMostBytes = 150;  // of each value: texels of six images and two outputs
  EXPECT_LE(device().transfers().downloaded - before, kMostBytes * values.size());
  EXPECT_GT(device().transfers().downloaded, before);
  std::size_t i = 0;
  for (const Shown shown : all)
    for (const auto& [x, y] : places) {
      const Image& image = frames_->image(shown);
      const std::vector<float> expected(image.at(x, y), image.at(x, y) + image.channels);
      EXPECT_EQ(values[i++], expected) << static_cast<int>(shown) << " at " << x << ", " << y;
      EXPECT_EQ(frames_->value(shown, x, y), expected);
    }
}

// Images that were drawn for a refused frame lie beside those that are seen, which can still be saved.
TEST_F(Moving, RefusedMovesLeaveWhatIsSeen) {
  open(sphereAndSheet());
  move();
  const ViewState seen = state_;
  for (int i = 0; i < 3; ++i) {
    state_.settings.translucency.maximumThickness = -1;
    EXPECT_THROW(move(), InputError);
  }
  state_ = seen;
  expectReplays("after three refusals");
}

// Rounding of every kind: ties, denormal halves, carries into the exponent, overflow.
TEST_F(Moving, HalvesAreThoseOfUploads) {
  constexpr int kSide = 64;
  Image image(kSide, kSide, 4, 1.0f);
  std::mt19937 random(7);
  std::uniform_real_distribution<float> exponent(-30, 18), mantissa(1, 2);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (i % 4 < 3) image.data[i] = std::ldexp(mantissa(random), static_cast<int>(exponent(random)));
  const float ends[] = {0,
                        std::ldexp(1.0f, -24),
                        std::ldexp(1.0f, -25),
                        std::ldexp(3.0f, -25),
                        1 + 1 / 2048.0f,
                        1 + 3 / 2048.0f,
                        2 - 1 / 2048.0f,
                        65504,
                        65519.99f,
                        65520,
                        1e30f,
                        std::numeric_limits<float>::infinity(),
                        std::ldexp(2047.5f, -25),
                        1e-40f};
  for (std::size_t i = 0; i < std::size(ends); ++i) image.data[4 * i] = ends[i];
  GpuImage floats(device(), kSide, kSide, VK_FORMAT_R32G32B32A32_SFLOAT),
      uploaded(device(), kSide, kSide, VK_FORMAT_R16G16B16A16_SFLOAT),
      drawn(device(), kSide, kSide, VK_FORMAT_R16G16B16A16_SFLOAT);
  floats.upload(image);
  uploaded.upload(image);
  drawn.clear();
  const DrawPasses passes(device());
  device().run([&](VkCommandBuffer commands) { passes.recordHalves(commands, floats, drawn); });
  const Image expected = uploaded.download(), actual = drawn.download();
  for (std::size_t i = 0; i < expected.data.size(); ++i)
    ASSERT_EQ(actual.data[i], expected.data[i]) << image.data[i];
}

}  // namespace
