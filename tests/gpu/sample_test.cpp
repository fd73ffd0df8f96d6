// The deferred renderer of gbuffer_harness/sample: what each feature changes, and captures of its frames
// replayed.
// No other test finds constants overwritten while their frame is in flight, or a queue that does not wait for the other.
#include <algorithm>
#include <numeric>

#include "gpu_fixture.h"
#include "sample/renderer.h"

namespace {

using namespace pellucid::test;
using namespace pellucid::sample;

constexpr int kMapTexels = 128;
constexpr std::uint32_t kSide = 64;

class Sample : public GpuTest {
protected:
  // The sample's own device has a second queue where there is one.
  static Device& device() {
    static Device shared([] {
      DeviceOptions options{"", true};
      options.computeQueue = true;
      return options;
    }());
    return shared;
  }
  void TearDown() override {
    GpuTest::TearDown();
    EXPECT_EQ(device().validationMessages(), std::vector<std::string>());
  }
  static const Scene& scene() {
    static const Scene shared = headScene(8, kMapTexels);
    return shared;
  }
  static Renderer& renderer() {
    static Renderer shared(device(), scene(), {kSide, kSide}, kMapTexels);
    return shared;
  }
  static ViewCamera camera() {
    ViewCamera camera = scene().camera;
    fitRange(camera, scene().bounds.center, scene().bounds.radius);
    return camera;
  }
  // Without antialiasing, so that frames do not depend on those before.
  static Settings still() {
    Settings settings;
    settings.taa = false;
    return settings;
  }
  static Image drawn(const Settings& settings) {
    renderer().draw(settings, camera());
    return renderer().color();
  }
};

double mean(const Image& image) {
  return std::accumulate(image.data.begin(), image.data.end(), 0.0) / static_cast<double>(image.data.size());
}

TEST_F(Sample, EachFeatureOnAndOff) {
  const Image all = drawn(still());
  EXPECT_GT(mean(all), 0.05);
  for (bool Settings::*const feature : {&Settings::pellucid, &Settings::sun, &Settings::spots,
                                        &Settings::point, &Settings::ambient, &Settings::specular}) {
    Settings settings = still();
    settings.*feature = false;
    const Image without = drawn(settings);
    EXPECT_TRUE(
        std::all_of(without.data.begin(), without.data.end(), [](float v) { return v >= 0 && v < 100; }));
    EXPECT_GT(relativeRmse(without, all), 0.02);
    EXPECT_LT(mean(without), mean(all));
  }
  EXPECT_TRUE(sameBits(drawn(still()), all)) << "nothing of other frames stays";
}

// docs/integration.md: the irradiance is the engine's, and Pellucid adds to the color alone.
TEST_F(Sample, WithoutPellucidTheColorIsAlbedoTimesIrradiance) {
  Settings settings = still();
  settings.specular = false;
  const Image with = drawn(settings), irradiance = renderer().irradiance();
  settings.pellucid = false;
  const Image without = drawn(settings);
  EXPECT_TRUE(sameBits(renderer().irradiance(), irradiance));
  const Capture capture = renderer().capture();
  int covered = 0;
  for (std::size_t i = 0; i < capture.material.size(); ++i)
    for (std::size_t c = 0; capture.material[i] != 0 && c < 3; ++c, ++covered)
      ASSERT_NEAR(without.data[3 * i + c], capture.albedo.data[3 * i + c] * irradiance.data[3 * i + c],
                  0.01 * without.data[3 * i + c] + 1e-4);  // 0.7 % of llvmpipe's sRGB decoding
  EXPECT_GT(covered, 1500);
  EXPECT_GT(relativeRmse(with, without), 0.05);
}

// Jitter, a rect at the images' corner and exposure included. The replay lacks the rest of the images, and
// its albedo is decoded by the CPU: llvmpipe's sRGB decoding differs by up to 0.7 %.
TEST_F(Sample, CapturesReplayToTheSamePicture) {
  Settings settings;
  settings.exposure = 1.7f;
  settings.cullFronts = true;
  for (const double scale : {1.0, 0.6}) {
    settings.scale = scale;
    for (int frame = 0; frame < 2; ++frame) renderer().draw(settings, camera());
    const Capture capture = renderer().capture();
    EXPECT_EQ(capture.width, scale < 1 ? 38 : 64);
    ReplaySettings replayed;
    replayed.ambient = true;
    replayed.translucency.gatherSamples = settings.gatherSamples;
    // Quads of the pyramid and patterns of samples lie as in the sample's frame.
    for (int i = 0; i < 3; ++i) replayed.anchor[i] = static_cast<float>(camera().pivot[i]);
    replayed.anchor[3] = 1;
    const Image output = replay(capture, replayed), &truth = capture.truth->image;
    EXPECT_LT(relativeRmse(output, truth, capture.material), 0.005) << scale;
    EXPECT_GT(mean(truth), 0.02);
  }
}

TEST_F(Sample, FramesInFlightKeepTheirConstants) {
  const Image alone = drawn(still());
  Settings other = still();
  other.sun = other.ambient = false;
  other.scale = 0.5;
  renderer().picture();  // the device is idle
  renderer().draw(other, camera());
  renderer().draw(still(), camera());  // the first may still run
  EXPECT_TRUE(sameBits(renderer().color(), alone));
  renderer().draw(still(), camera());
  renderer().draw(other, camera());
  const Image dim = renderer().color();
  EXPECT_TRUE(sameBits(drawn(other), dim));
}

// After frames in flight of all kinds. A device that has one queue takes the submissions of both in turn.
TEST_F(Sample, AQueueOfItsOwnGivesTheSamePicture) {
  const Image color = drawn(still()), picture = renderer().picture().download();
  Settings settings;
  for (const auto& [own, pellucid, scale] :
       {std::tuple(true, true, 1.0), {false, true, 0.7}, {true, false, 1.0}}) {
    settings.ownQueue = own;
    settings.pellucid = pellucid;
    settings.scale = scale;
    renderer().draw(settings, camera());
  }
  settings = still();
  settings.ownQueue = true;
  EXPECT_TRUE(sameBits(drawn(settings), color));
  EXPECT_TRUE(sameBits(renderer().picture().download(), picture));
}

// A rect with a projection of its own is what images of its size would hold.
TEST_F(Sample, ARectIsAsAnImageOfItsSize) {
  Settings settings = still();
  settings.scale = 0.5;
  const Image rect = drawn(settings);
  Renderer small(device(), scene(), {kSide / 2, kSide / 2}, kMapTexels);
  small.draw(still(), camera());
  EXPECT_LT(relativeRmse(rect, small.color()), 0.01);
}

// Images of a size before leave nothing behind, and the antialiasing begins anew.
TEST_F(Sample, ResizedIsAsMadeInThatSize) {
  Renderer small(device(), scene(), {kSide / 2, kSide / 2}, kMapTexels);
  small.draw(still(), camera());
  const Image color = small.color(), picture = small.picture().download();
  Renderer resized(device(), scene(), {kSide, kSide / 4}, kMapTexels);
  resized.draw(Settings(), camera());
  resized.resize({kSide / 2, kSide / 2});
  resized.draw(still(), camera());
  EXPECT_TRUE(sameBits(resized.color(), color));
  EXPECT_TRUE(sameBits(resized.picture().download(), picture));
}

// Still pictures become sharper; the mean stays.
TEST_F(Sample, AntialiasingKeepsTheMean) {
  Settings settings;
  settings.pellucid = false;
  const auto picture = [&](bool taa) {
    settings.taa = taa;
    for (int frame = 0; frame < 5; ++frame) renderer().draw(settings, camera());
    return rgb(renderer().picture().download());
  };
  const Image jagged = picture(false), smooth = picture(true);
  EXPECT_NEAR(mean(smooth) / mean(jagged), 1, 0.01);
  const double difference = relativeRmse(smooth, jagged);
  EXPECT_GT(difference, 0.005);
  EXPECT_LT(difference, 0.1);
}

// Light of the spots on the head, relative to maps without a bias.
class SpotMaps : public Sample {
protected:
  static Image skin(const Settings& settings) {
    Image result = drawn(settings);
    const std::vector<std::uint8_t> material = renderer().capture().material;
    for (std::size_t i = 0; i < result.data.size(); ++i) result.data[i] *= material[i / 3] != 0;
    return result;
  }
  static Settings plain() {
    Settings settings = still();
    settings.sun = settings.point = settings.ambient = settings.specular = false;
    settings.biasConstant = settings.biasSlope = 0;
    return settings;
  }
};

// Maps of front faces beside the engine's culled ones: its light stays, and Pellucid has the plain maps.
TEST_F(SpotMaps, FrontsBesideCulledMapsGiveThePlainPicture) {
  Settings settings = plain();
  const Image truth = skin(settings), irradiance = renderer().irradiance();
  settings.cullFronts = true;
  const Image culled = skin(settings), culledIrradiance = renderer().irradiance();
  settings.fronts = true;
  const Image beside = skin(settings);
  EXPECT_TRUE(sameBits(renderer().irradiance(), culledIrradiance));
  // The engine's own shadows differ, which the irradiance has.
  EXPECT_LT(relativeRmse(beside, truth), 0.01 + relativeRmse(culledIrradiance, irradiance));
  EXPECT_LT(relativeRmse(beside, truth), 0.5 * relativeRmse(culled, truth));
  for (const Light& light : renderer().capture().lights)
    for (const ShadowMap& map : light.shadowMaps) EXPECT_FALSE(map.backFaces);
}

// Bounds are the differences of the first commit, rounded up. Culled fronts lack what gathered light adds: with a
// gather they are darker. Relative RMSE of biased maps is of single pixels: the bias moves surfaces by texels.
TEST_F(SpotMaps, CulledFrontsAndBiasGiveThePlainPictureWhereTheyAreSaid) {
  for (const std::uint32_t samples : {0u, 8u}) {
    Settings settings = plain();
    settings.gatherSamples = samples;
    const Image truth = skin(settings);
    settings.cullFronts = true;
    EXPECT_NEAR(mean(skin(settings)) / mean(truth), 1, 0.06) << samples;
    settings.mistake = Mistake::Fronts;
    EXPECT_GT(mean(skin(settings)) / mean(truth), 3) << samples;
    settings = plain();
    settings.gatherSamples = samples;
    settings.biasConstant = 2 * Settings().biasConstant;
    settings.biasSlope = 2 * Settings().biasSlope;
    const Image said = skin(settings);
    EXPECT_NEAR(mean(said) / mean(truth), 1, 0.04) << samples;
    settings.mistake = Mistake::Bias;
    EXPECT_GT(relativeRmse(skin(settings), truth), 1.01 * relativeRmse(said, truth)) << samples;
  }
}

}  // namespace
