// The viewer's frames are replays of their captures to the bit, also where images stay on the device. The screen shows them.
#include <algorithm>
#include <ostream>

#include "common/error.h"
#include "common/png.h"
#include "gpu_fixture.h"
#include "model_builder.h"
#include "view/display.h"
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

class ViewFramesTest : public GpuTest {
protected:
  void open(Model model = sphereAndSheet(), const RasterOptions& options = smallRaster(kSize),
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

  void expectReplays(const char* what) {
    const Capture& capture = frames_->capture();
    const ReplaySettings settings = settingsFor(state_, Shown::After);
    const Image output = replay(capture, settings);
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
  Way& cube = add("Cube", true);
  cube.raster.pointMaps = PointMaps::Six;
  cube.point = true;
  Way& planar = add("PlanarForward", true);
  planar.raster.depthEncoding = planar.raster.shadowEncoding = PELLUCID_DEPTH_VIEW_Z;
  planar.raster.reversedZ = false;
  add("Farthest", true).raster.backFace = BackFace::Farthest;
  add("NoMaps", true).raster.shadowSize = 0;
  add("Simplified", true).raster.simplify = 0.3;
  add("CameraThickness", true).settings.translucency.cameraThickness = 1;
  Way& atlas = add("Atlas", false);
  atlas.raster.shadow.placement = MapPlacement::Atlas;
  atlas.raster.shadow.bits = 16;
  atlas.raster.shadow.cull = MapCull::Front;
  add("PackedFloats", false).settings.outputFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  return all;
}

class MovingWays : public ViewFramesTest, public testing::WithParamInterface<Way> {};

INSTANTIATE_TEST_SUITE_P(Ways, MovingWays, testing::ValuesIn(ways()),
                         [](const testing::TestParamInfo<Way>& way) { return way.param.name; });

// The picture of a moved scene is the replay of its capture, and came about without the host where it can.
TEST_P(MovingWays, AreReplaysAndStayOnTheDevice) {
  const Way& way = GetParam();
  Model model = sphereAndSheet();
  if (way.point) model.lights = {pointLight({4, 6, 18}, 500)};
  open(model, way.raster, way.settings);
  const Transfers moved = transfersOfMoves(2);
  EXPECT_EQ(moved.downloaded == 0, way.staysOnDevice) << moved.downloaded << " bytes";
  EXPECT_EQ(moved.uploaded == 0, way.staysOnDevice) << moved.uploaded << " bytes";
  expectReplays("moved");
}

TEST_F(ViewFramesTest, LobesApartAreReplays) {
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
TEST_F(ViewFramesTest, OpenMeshesAreReplaysWithoutBackDepth) {
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

TEST_F(ViewFramesTest, ValuesAreThoseOfTheWholeImages) {
  open();
  state_.settings.debugView = PELLUCID_DEBUG_THICKNESS;
  state_.display.shown = Shown::Debug;
  state_.display.split = true;
  state_.display.left = Shown::Through;
  move();
  const int places[][2] = {{kSize / 2, kSize / 2}, {3, kSize - 5}, {0, 0}, {kSize - 1, kSize - 1}};
  const Shown all[] = {Shown::After, Shown::Before,     Shown::Through, Shown::Difference, Shown::Truth,
                       Shown::Debug, Shown::FrontDepth, Shown::Albedo,  Shown::Material};
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
TEST_F(ViewFramesTest, RefusedMovesLeaveWhatIsSeen) {
  open();
  move();
  const ViewState seen = state_;
  for (int i = 0; i < 2; ++i) {
    state_.settings.translucency.maximumThickness = -1;
    EXPECT_THROW(move(), InputError);
  }
  state_ = seen;
  expectReplays("after two refusals");
}

TEST_F(ViewFramesTest, AreReplaysOfTheirCaptures) {
  open();
  expectReplays("as opened");
  orbit(state_.camera, 0.4, 0.3);
  fitRange(state_.camera, source_->center(), source_->radius());
  frames_->update(state_, {.scene = true});
  expectReplays("orbited");
  state_.lights.push_back(
      newLight(PELLUCID_LIGHT_POINT, state_.camera, source_->center(), source_->radius()));
  state_.lights[0].on = false;
  frames_->update(state_, {.scene = true});
  EXPECT_EQ(frames_->capture().lights.size(), 2u);
  expectReplays("other lights");
  state_.materials[0] = CoefficientMaterial{{2, 2, 2}, {0.01, 0.05, 0.1}, 0, 1.3};
  frames_->update(state_, {.materials = true});
  expectReplays("another material");
  state_.settings.translucency.gatherSamples = 16;
  state_.settings.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  frames_->update(state_, {.frame = true});
  expectReplays("other settings");
  state_.width = 31;
  state_.height = 17;
  frames_->update(state_, {.scene = true});
  expectReplays("another size");
}

TEST_F(ViewFramesTest, AlternateReuseTakesWhatCameThroughFromTheFrameBefore) {
  open();
  state_.settings.reuse = PELLUCID_REUSE_ALTERNATE;
  frames_->forgetHistory();
  frames_->update(state_, {.frame = true});
  const std::uint32_t fresh = frames_->run(Shown::After).plan().dispatchCount;
  frames_->update(state_, {.frame = true});
  EXPECT_LT(frames_->run(Shown::After).plan().dispatchCount, fresh);
  frames_->forgetHistory();
  frames_->update(state_, {.frame = true});
  EXPECT_EQ(frames_->run(Shown::After).plan().dispatchCount, fresh);
  expectReplays("without the frames before");
}

// The screen, of which the picture covers all but a margin of 8 pixels, each texel two pixels wide.
class ViewScreen : public ViewFramesTest {
protected:
  static constexpr int kMargin = 8, kScale = 2, kSide = kScale * kSize + 2 * kMargin;

  ViewScreen()
      : screen_(device(), {kSide, kSide, {{VK_FORMAT_R8G8B8A8_UNORM, {.float32 = {0, 0, 1, 1}}}}}),
        display_(device(), screen_) {}

  Image draw(Shown shown, const ScreenRect& clip, float low = 0, float high = 1) {
    state_.display.shown = shown;
    frames_->update(state_, {.shown = true});
    device().run([&](VkCommandBuffer commandBuffer) {
      screen_.begin(commandBuffer);
      display_.draw(commandBuffer, *frames_, state_.display, shown, picture_, clip, low, high);
      screen_.end(commandBuffer);
    });
    return screen_.image(0).download();
  }
  const float* pixel(const Image& screen, int x, int y) const {
    return screen.at(kMargin + kScale * x + 1, kMargin + kScale * y);
  }

  ScreenRect picture_{kMargin, kMargin, kScale* kSize, kScale* kSize};
  RenderTarget screen_;
  DisplayPass display_;
};

TEST_F(ViewScreen, ShowsItsImagesInSrgb) {
  open();
  state_.display.exposure = 1.5f;
  for (const Shown shown : {Shown::After, Shown::Through, Shown::Difference, Shown::Albedo}) {
    const Image screen = draw(shown, picture_);
    const std::vector<std::uint8_t> expected = toSrgb(frames_->image(shown), state_.display.exposure);
    // The device rounds a curve that is computed in floats, of an irradiance that is stored in halves.
    constexpr float kTolerance = 1.01f;
    int lit = 0;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int c = 0; c < 3; ++c) {
          const float byte = expected[static_cast<std::size_t>((y * kSize + x) * 3 + c)];
          lit += byte > 20;
          ASSERT_NEAR(pixel(screen, x, y)[c] * 255, byte, kTolerance) << int(shown) << ": " << x << ", " << y;
        }
    EXPECT_GT(lit, 50) << int(shown);
    EXPECT_EQ(screen.at(2, 2)[2], 1) << "beside the picture";
  }
}

class ViewSources : public GpuTest {};

TEST_F(ViewSources, CapturesKeepTheirCameraAndFindTheirCenter) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 6, 24);
  endPart(model, 1);
  model.lights = {directional({0.2, 0.1, 1}, 2), directional({0, -1, -0.4}, 0.5)};
  const Capture capture = rasterize(device(), model, frontCamera(false), smallRaster(kSize)).capture;
  const std::unique_ptr<Source> source = captureSource(capture);
  EXPECT_FALSE(source->fixedCamera().empty());
  const Vector3 center = source->center();
  EXPECT_NEAR(center[0], 0, 0.3);  // half a pixel, 20 mm over 40
  EXPECT_NEAR(center[1], 0, 0.3);
  EXPECT_GT(center[2], 2);  // of the half that is seen
  EXPECT_LT(center[2], 6);
  ViewState state = source->start();
  state.lights[0].on = false;
  const Capture seen = source->render(state).capture;
  EXPECT_EQ(seen.lights.size(), 1u);
  EXPECT_FALSE(seen.lights[0].shadowMaps.empty());
  EXPECT_TRUE(sameBits(seen.irradiance, capture.irradiance));
}

TEST_F(ViewSources, ScenesAreThoseOfCaptures) {
  const SceneParameters parameters{.name = "sphere", .width = 24, .height = 24, .shadowSize = 32};
  const Capture expected = makeScene(parameters);
  const std::unique_ptr<Source> source = sceneSource(parameters, expected.materials);
  const Capture seen = source->render(source->start()).capture;
  EXPECT_TRUE(sameBits(seen.frontDepth.image, expected.frontDepth.image));
  EXPECT_TRUE(sameBits(seen.irradiance, expected.irradiance));
  EXPECT_EQ(seen.material, expected.material);
}

}  // namespace
