// The viewer's frames against replays of their captures, and its screen against their images.
#include <algorithm>

#include "capture/material.h"
#include "common/png.h"
#include "gpu_fixture.h"
#include "model_builder.h"
#include "raster/bodies.h"
#include "raster/framing.h"
#include "view/display.h"
#include "view/frames.h"

namespace {

using namespace pellucid::test;

constexpr int kSize = 48;

Model litSphere() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 6, 24);
  endPart(model, 1);
  model.lights = {directional({0.2, 0.1, 1}, 2), directional({0, -1, -0.4}, 0.5)};
  return model;
}

// Counts what it is asked for.
class CountingSource : public Source {
public:
  explicit CountingSource(std::unique_ptr<Source> source) : source_(std::move(source)) {
    start_ = source_->start();
    center_ = source_->center();
    radius_ = source_->radius();
  }
  Scene render(const ViewState& state) override {
    ++renders;
    return source_->render(state);
  }
  std::vector<MaterialSource> materials(const ViewState& state) const override {
    return source_->materials(state);
  }
  int renders = 0;

private:
  std::unique_ptr<Source> source_;
};

class ViewFramesTest : public GpuTest {
protected:
  void SetUp() override {
    GpuTest::SetUp();
    open(litSphere());
  }

  void open(Model model) {
    frames_.reset();
    source_ = std::make_unique<CountingSource>(
        modelSource(device(), std::move(model), frontCamera(false), smallRaster(kSize)));
    state_ = source_->start();
    static Contexts contexts(device());  // a second of pipelines, once
    frames_ = std::make_unique<ViewFrames>(device(), contexts, *source_);
    frames_->update(state_, {});
  }

  void expectReplays(const char* what) {
    const Capture& capture = frames_->capture();
    const ReplaySettings settings = settingsFor(state_, Shown::After);
    const Image replayed = rgb(replayer().run(capture, compileMaterials(capture), settings).output);
    EXPECT_TRUE(sameBits(frames_->image(Shown::After), replayed)) << what;
    const float most = *std::max_element(replayed.data.begin(), replayed.data.end());
    EXPECT_GT(most, 0.01f) << what << ": a black picture would be anything's";
  }

  std::unique_ptr<CountingSource> source_;
  ViewState state_;
  std::unique_ptr<ViewFrames> frames_;
};

// The left ball is lit and the right one is not; the panel has their one material.
TEST_F(ViewFramesTest, BodiesOfOneMaterialKeepTheirLight) {
  Model model = ballInShadow(24);
  ASSERT_EQ(separateBodies(model, {20}).added, 1u);
  open(std::move(model));
  ASSERT_EQ(state_.materials.size(), 1u);
  for (const char* preset : {"skin1", "marble"}) {
    state_.materials[0] = PresetMaterial{preset};
    frames_->update(state_, {.materials = true});
    expectReplays(preset);
    EXPECT_EQ(frames_->capture().materials.size(), 2u);
    const Image& result = frames_->image(Shown::After);
    for (int i = 0; i < kSize * kSize; ++i)
      if (frames_->capture().material[static_cast<std::size_t>(i)] == 2) {
        ASSERT_EQ(result.data[static_cast<std::size_t>(3 * i)], 0) << preset << " " << i;
      }
  }
}

TEST_F(ViewFramesTest, AreReplaysOfTheirCaptures) {
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

TEST_F(ViewFramesTest, RenderOnlyWhatChanged) {
  EXPECT_EQ(source_->renders, 1);
  EXPECT_EQ(frames_->recorded(), 1u);
  frames_->update(state_, {.shown = true});
  EXPECT_EQ(frames_->recorded(), 1u);
  frames_->update(state_, {.frame = true});
  EXPECT_EQ(source_->renders, 1);
  EXPECT_EQ(frames_->recorded(), 2u);
  frames_->update(state_, {.scene = true});
  EXPECT_EQ(source_->renders, 2);
  EXPECT_EQ(frames_->recorded(), 3u);
  EXPECT_EQ(frames_->times().size(), frames_->run(Shown::After).plan().dispatchCount);
}

TEST_F(ViewFramesTest, AlternateReuseTakesWhatCameThroughFromTheFrameBefore) {
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
      : screen_(device(), kSide, kSide, {{VK_FORMAT_R8G8B8A8_UNORM, {.float32 = {0, 0, 1, 1}}}},
                std::nullopt),
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
  state_.display.exposure = 1.5f;
  for (const auto& [shown, map] : {std::pair{Shown::After, ToneMap::None},
                                   {Shown::After, ToneMap::Agx},
                                   {Shown::After, ToneMap::Aces},
                                   {Shown::Before, ToneMap::Agx},
                                   {Shown::Through, ToneMap::None},
                                   {Shown::Difference, ToneMap::None},
                                   {Shown::Albedo, ToneMap::None}}) {
    state_.display.toneMap = map;
    const Image screen = draw(shown, picture_);
    const std::vector<std::uint8_t> expected = toSrgb(frames_->image(shown), state_.display.exposure, map);
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
  const Model model = litSphere();
  const Capture capture = rasterize(device(), model, frontCamera(false), smallRaster(kSize)).capture;
  const std::unique_ptr<Source> source = captureSource(capture);
  EXPECT_FALSE(source->fixedCamera().empty());
  const Vector3 center = source->center();
  EXPECT_NEAR(center[0], 0, 0.3);  // half a pixel, 20 mm over 48
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
