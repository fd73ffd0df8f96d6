// Shadow maps as engines draw them, against plain maps of the same scene: depth bias, front faces culled, few
// bits, tiles of an atlas, layers of an array, cascades. And exactly, on planes.
// No other test finds a bias or an offset of the rasterizer that is taken back in part, or rows of a neighboring tile in a slope.
#include <algorithm>
#include <cmath>

#include "capture/read.h"
#include "capture/shadow_images.h"
#include "capture/write.h"
#include "common/error.h"
#include "gpu_fixture.h"
#include "model_builder.h"
#include "raster/raster.h"
#include "reference_frame.h"
#include "scene/vector.h"
#include "temporary_directory.h"

namespace {

using namespace pellucid::test;

class EngineMaps : public GpuTest {
protected:
  static Capture draw(const Model& model, const ShadowDrawing& shadow, int size = 256) {
    RasterOptions options{.width = 96, .height = 96, .shadowSize = size};
    options.shadow = shadow;
    return rasterize(device(), model, frontCamera(false), options).capture;
  }
  static Image render(const Capture& c, uint32_t samples, bool source = 0) {
    ReplaySettings s = gathering(samples);
    s.translucency.cameraThickness = source;
    return replay(c, s);
  }
  // In red, green and blue: of pixels that some light reaches.
  static std::array<double, 3> meanLit(const Capture& c, const Image& image) {
    std::array<double, 3> sum{};
    std::size_t count = 0;
    for (std::size_t i = 0; i < c.material.size(); ++i) {
      if (c.material[i] == 0 || !(c.irradiance.data[3 * i] > 0)) continue;
      for (std::size_t k = 0; k < 3; ++k) sum[k] += double(image.data[4 * i + k]);
      ++count;
    }
    for (double& s : sum) s /= static_cast<double>(count);
    return sum;
  }
  static void expectNear(const std::array<double, 3>& mean, const std::array<double, 3>& plain,
                         double share) {
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(mean[k] / plain[k], 1, share) << "channel " << k;
  }
  static ShadowDrawing biased(int bits) {
    ShadowDrawing drawing;
    drawing.depthBiasConstant = 1.25;
    drawing.depthBiasSlope = 1.75;
    drawing.bits = bits;
    return drawing;
  }
};

TEST_F(EngineMaps, DepthBiasIsTakenBack) {
  const Model model = ballAndEar();
  const Capture plain = draw(model, {}), c = draw(model, biased(16));
  EXPECT_LT(c.lights[0].shadowMaps[0].depthBiasSlope, 0) << "depths are reversed";
  for (const uint32_t samples : {0u, 8u}) {
    SCOPED_TRACE(samples);
    expectNear(meanLit(c, render(c, samples)), meanLit(plain, render(plain, samples)), 0.02);
  }
}

// The map does not know where light enters: the light has the camera's thickness.
TEST_F(EngineMaps, FrontFacesCulled) {
  const Model model = ballAndEar();
  const Capture plain = draw(model, {});
  ShadowDrawing culled;
  culled.cull = MapCull::Front;
  const Capture c = draw(model, culled);
  EXPECT_TRUE(c.lights[0].shadowMaps[0].backFaces);
  Capture none = c;
  none.lights.clear();
  const Image expected = render(plain, 0, 1);
  for (const uint32_t samples : {0u, 8u}) {
    SCOPED_TRACE(samples);
    const Image image = render(c, samples);
    // On so small a ball points within a tolerance of the face that light leaves by are 2 % of the light. In
    // a frame that may gather, curved bodies return up to 19 % more than in the frame without a gather.
    expectNear(meanLit(c, image), meanLit(plain, expected), samples == 0 ? 0.03 : 0.2);
    // Never white: the light of rims, whose chord is short, is all that is brighter than with the plain map.
    const float brightest = *std::max_element(expected.data.begin(), expected.data.end());
    const auto white = std::count_if(image.data.begin(), image.data.end(),
                                     [&](float value) { return value > 1.1f * brightest; });
    EXPECT_LT(static_cast<double>(white), 0.02 * static_cast<double>(image.data.size()));
    Capture blind = c;
    blind.backDepth.image = none.backDepth.image = {};
    const ReplayResult without = replayer().run(blind, compileMaterials(blind), gathering(samples));
    EXPECT_TRUE(sameBits(without.output, render(none, samples)))
        << "without back depth nothing comes through";
    EXPECT_EQ(without.plan.activeLights, 0u);
  }
}

// A body behind another one is in its shadow, beyond the face that light leaves the first by.
TEST_F(EngineMaps, BackFacesOcclude) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 3, 32);
  endPart(model, 0);
  addSphere(model, {0, 0, -20}, 3.3, 32);
  endPart(model, 1);
  model.lights = {directional({0, 0, 1}, 2)};
  ShadowDrawing culled;
  culled.cull = MapCull::Front;
  const Capture c = draw(model, culled);
  Capture none = c;
  none.lights.clear();
  EXPECT_TRUE(sameBits(render(c, 0), render(none, 0))) << "the farther ball shadows all of the nearer one";
  model.parts.pop_back();
  const Capture alone = draw(model, culled);
  EXPECT_GT(render(alone, 0).at(48, 48)[0], render(none, 0).at(48, 48)[0]);
}

TEST_F(EngineMaps, AtlasAndArrayAreAsSeparateMaps) {
  const Model model = ballAndEar();
  const Capture separate = draw(model, biased(32));
  const Image expected[] = {render(separate, 0), render(separate, 8)};
  for (const MapPlacement placement : {MapPlacement::Atlas, MapPlacement::Array}) {
    ShadowDrawing drawing = biased(32);
    drawing.placement = placement;
    const Capture c = draw(model, drawing);
    EXPECT_EQ(shadowImages(c.lights).images.size(), 3u)
        << "depth, exit depth and caster material of all maps";
    EXPECT_EQ(hasLayers(c.lights), placement == MapPlacement::Array);
    for (const uint32_t samples : {0u, 8u})
      EXPECT_TRUE(sameBits(render(c, samples), expected[samples / 8]))
          << "placement " << static_cast<int>(placement) << ", samples " << samples;
  }
}

// Three maps leave a tile of four empty.
TEST_F(EngineMaps, AnAtlasWithAnEmptyTileIsWritten) {
  Model model = ballAndEar();
  model.lights = {directional({0, 0, 1}), directional({0, 1, 0}), directional({1, 0, 0})};
  ShadowDrawing drawing;
  drawing.placement = MapPlacement::Atlas;
  const Capture drawn = draw(model, drawing);
  const TemporaryDirectory folder;
  writeCapture(drawn, folder / "c.exr");
  const Capture read = readCapture(folder / "c.exr");
  ASSERT_EQ(read.lights.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_EQ(read.lights[i].shadowMaps[0].casterMaterial, drawn.lights[i].shadowMaps[0].casterMaterial);
}

TEST_F(EngineMaps, LayersNeedAnArrayContext) {
  Capture c = flatCapture(8, 8);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_DEVICE)};
  c.lights[0].shadowMaps[0].sharedImage = 0;
  c.lights[0].shadowMaps[0].layer = 3;
  const Context flat(device());
  ReplaySettings s;
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const FrameRun run(device(), flat, c, {testMaterial()}, s);
  const std::string said = refusalOfRecording(run);
  EXPECT_NE(said.find("shadowMaps[0].options.layer is 3"), std::string::npos) << said;
}

// Passes of an array context bind array views, those without lights and those after a gather among them.
TEST_F(EngineMaps, ArrayContextsBindArrayViewsAlone) {
  Capture c = flatCapture(8, 8);
  const Context arrays(
      device(), [](PellucidContextDesc& desc) { desc.options.shadowViewType = VK_IMAGE_VIEW_TYPE_2D_ARRAY; });
  ReplaySettings s;
  s.features = 0;
  const FrameRun none(device(), arrays, c, {testMaterial()}, s);
  const std::string said = refusalOfRecording(none);
  EXPECT_NE(said.find("shadowImages has no view"), std::string::npos) << said;
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_DEVICE)};
  c.lights[0].shadowMaps[0].sharedImage = 0;
  c.lights[0].shadowMaps[0].layer = 1;
  for (const uint32_t features : {0u, uint32_t{PELLUCID_FEATURE_TRANSLUCENCY}}) {
    s.features = features;
    // The fixture fails with the first validation message.
    const Image image = replayer().run(c, {testMaterial()}, s).output;
    EXPECT_GT(*image.at(4, 4), 0);
  }
}

TEST_F(EngineMaps, FewBitsMakeNoSeams) {
  const Model model = ballAndEar();
  const Capture plain = draw(model, {});
  ShadowDrawing drawing;
  drawing.bits = 16;
  const Capture c = draw(model, drawing);
  EXPECT_GT(c.lights[0].shadowMaps[0].depthStep, 0);
  for (const uint32_t samples : {0u, 8u}) {
    const Image image = render(c, samples), expected = render(plain, samples);
    const float peak = *std::max_element(expected.data.begin(), expected.data.end());
    for (std::size_t i = 0; i < image.data.size(); ++i)
      ASSERT_NEAR(image.data[i], expected.data[i], 0.01f * peak) << "samples " << samples;
  }
}

// A plane that leans across the light's rays, with what a rasterizer adds to its depths.
class LeaningPlane : public GpuTest, public testing::WithParamInterface<PellucidDepthEncoding> {
protected:
  static constexpr double kConstant = 0.3, kSlope = 2.5, kOffset = 0.4;
  // Depths grow by `step` a texel along x and half of that along y.
  static ShadowMap map(double step) {
    ShadowMap m = flatShadowMap(-12, GetParam(), 64);
    m.clipFromWorld[0] = m.clipFromWorld[5] = 0.1;  // +-10 mm
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        *m.depth.image.at(x, y) += static_cast<float>(step * (x - 32) + 0.5 * step * (y - 32));
    return m;
  }
  static double unit() { return GetParam() == PELLUCID_DEPTH_DEVICE ? 0.01 : 1; }  // of a mm, stored
  // `around`: maps of lights that are off.
  static Image through(const ShadowMap& m, const std::vector<ShadowMap>& around = {}) {
    Capture c = flatCapture(32, 32);
    for (float& e : c.irradiance.data) e = 0;
    c.lights.assign(1 + around.size(), backLight());
    c.lights[0].shadowMaps = {m};
    for (std::size_t i = 0; i < around.size(); ++i) {
      c.lights[1 + i].intensity = 0;
      c.lights[1 + i].shadowMaps = {around[i]};
    }
    ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
    const Image image = replay(c, testMaterial(), s);
    const Image exact = referenceOf(c, {testMaterial()}, s);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x)
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(image.at(x, y)[k], exact.at(x, y)[k], 2e-4) << x << ", " << y;
    return image;
  }
};

TEST_P(LeaningPlane, OffsetsAreTakenBack) {
  const double step = 0.01 * unit();
  const ShadowMap plain = map(step);
  const Image expected = through(plain);
  for (const double sign : {1.0, -1.0}) {
    ShadowMap biased = plain;
    biased.depthBiasConstant = sign * kConstant * unit();
    biased.depthBiasSlope = sign * kSlope;
    biased.offsetLength = kOffset;
    for (float& d : biased.depth.image.data)
      d += static_cast<float>(sign * (kConstant * unit() + kSlope * step) + kOffset * unit());
    const Image image = through(biased);
    // A slope of floats of size .4: 3e-8 / 1e-4 of the slope bias; then three additions.
    for (std::size_t i = 0; i < image.data.size(); ++i) ASSERT_NEAR(image.data[i], expected.data[i], 2e-4);
    biased.sharedImage = 0;
    biased.offset = {3, 7};
    const Image tile = through(biased);
    EXPECT_TRUE(sameBits(tile, image)) << "what lies around the tile is not read";
  }
}

// The map is smaller than the picture, and its border goes on evenly in the next tiles, as no slope would.
TEST_P(LeaningPlane, SlopesEndAtTheTile) {
  for (const bool steepAlongY : {false, true}) {
    const ShadowMap leaning = map(0.01 * unit());
    ShadowMap alone = leaning;
    alone.clipFromWorld[0] = alone.clipFromWorld[5] = 0.415;  // pixels at 2.375 mm lie in the last texels
    alone.depthBiasSlope = kSlope;
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x)
        *alone.depth.image.at(x, y) = *(steepAlongY ? leaning.depth.image.at(y, x) : leaning.depth.image.at(x, y)) +
                                      static_cast<float>(kSlope * 0.01 * unit());
    const Image expected = through(alone);
    ShadowMap tile = alone;
    tile.sharedImage = 0;
    tile.offset = {8, 8};
    std::vector<ShadowMap> around;
    for (const int end : {0, 63})
      for (const bool row : {false, true}) {
        ShadowMap& next = around.emplace_back(tile);
        next.depthBiasSlope = 0;
        next.depth.image = row ? Image(64, 1, 1) : Image(1, 64, 1);
        for (int i = 0; i < 64; ++i)
          next.depth.image.data[static_cast<std::size_t>(i)] = *(row ? tile.depth.image.at(i, end) : tile.depth.image.at(end, i));
        next.offset[row] += end == 0 ? -1 : 64;
      }
    EXPECT_TRUE(sameBits(through(tile, around), expected)) << "steep along " << (steepAlongY ? "y" : "x");
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, LeaningPlane,
                         testing::Values(PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z,
                                         PELLUCID_DEPTH_DISTANCE),
                         testing::PrintToStringParamName());

TEST_F(EngineMaps, DrawingsThatNoMapHasAreRefused) {
  const Model model = ballAndEar();
  const std::pair<const char*, void (*)(RasterOptions&)> kWrong[] = {
      {"shadowBits: 8 is not 16, 24 or 32", [](RasterOptions& o) { o.shadow.bits = 8; }},
      {"shadowDepthBias: nan", [](RasterOptions& o) { o.shadow.depthBiasSlope = NAN; }},
      {"shadowDepth: must be device",
       [](RasterOptions& o) {
         o.shadow.cull = MapCull::Front;
         o.shadowEncoding = PELLUCID_DEPTH_VIEW_Z;
       }},
      {"shadowNormalOffset: -1", [](RasterOptions& o) { o.shadow.normalOffset = -1; }},
      {"shadowCascades: 7", [](RasterOptions& o) { o.shadow.cascades = 7; }},
      {"shadowFilter: 4 is not 0 or an odd number", [](RasterOptions& o) { o.shadow.filter = 4; }},
      {"width: 0 is outside 1 .. 8192", [](RasterOptions& o) { o.width = 0; }},
      {"shadowSize: 9000", [](RasterOptions& o) { o.shadowSize = 9000; }},
      {"depthEncoding", [](RasterOptions& o) { o.depthEncoding = PELLUCID_DEPTH_DISTANCE; }},
      {"simplify", [](RasterOptions& o) { o.simplify = NAN; }},
      {"jitter: 1.5", [](RasterOptions& o) { o.jitter[1] = 1.5; }},
      {"shadowSize: is 0", [](RasterOptions& o) {
         o.shadow.placement = MapPlacement::Atlas;
         o.shadowSize = 0;
       }}};
  for (const auto& [sentence, change] : kWrong) {
    RasterOptions options{.width = 8, .height = 8};
    change(options);
    const std::string said = refusalOf([&] { rasterize(device(), model, frontCamera(false), options); });
    EXPECT_NE(said.find(sentence), std::string::npos) << said;
  }
}

// ---- What the irradiance and the camera of an engine have

// A square that casts a shadow onto a larger one, 20 mm behind. The light falls straight.
Model squareAndShadow() {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 9);
  endPart(model, 0);
  addSquare(model, 0, 0, 20, 3);
  endPart(model, 1);
  model.lights = {directional({0.3, 0, -1})};  // the shadow's edges are at x = 3 and 9
  return model;
}

// N taps across make a ramp of N texels: a bilinear one of one texel, and N - 1 that further taps add.
TEST_F(EngineMaps, FilteredShadowsAreRamps) {
  const Model model = squareAndShadow();
  RasterOptions options{.width = 200, .height = 200};  // .1 mm a pixel
  options.shadowSize = 128;
  options.shadow.bits = 24;
  options.shadow.depthBiasConstant = 10;
  constexpr float kRounding = 1e-4f;  // of the weights' sum
  options.shadow.depthBiasSlope = 6;  // texels, beyond the reach of the widest filter
  for (const int filter : {1, 3, 7}) {
    options.shadow.filter = filter;
    const Capture c = rasterize(device(), model, frontCamera(true), options).capture;
    const double texel = 2 / c.lights[0].shadowMaps[0].clipFromWorld[5] / -options.shadowSize;
    const float lit = c.irradiance.at(20, 20)[0];
    int soft = 0;
    float last = 0;
    // Along y, across which the light does not lean: from the shadow's middle to beyond its edge at 3 mm.
    for (int y = 100; y > 20; --y) {
      const float e = c.irradiance.at(160, y)[0];
      EXPECT_GE(e, last - kRounding * lit);
      last = e;
      soft += e > kRounding * lit && e < (1 - kRounding) * lit;
    }
    EXPECT_NEAR(last, lit, kRounding * lit);
    EXPECT_EQ(c.irradiance.at(160, 100)[0], 0);
    EXPECT_NEAR(0.1 * soft, filter * std::abs(texel), 0.15) << filter;  // a pixel and a half
  }
}

// A face that the light meets straight stays; one that it meets at 60 degrees moves by half the offset.
TEST_F(EngineMaps, NormalOffsetsGrowWithTheAngle) {
  for (const double lean : {0.0, std::sqrt(3.0)}) {
    Model model = emptyModel();
    addSquare(model, 0, 0, 0, 9);
    endPart(model, 0);
    model.lights = {directional({lean, 0, -1})};
    const auto mapOf = [&](double offset) {
      ShadowDrawing drawing;
      drawing.normalOffset = offset;
      return draw(model, drawing, 64).lights[0].shadowMaps[0];
    };
    const ShadowMap plainMap = mapOf(0), movedMap = mapOf(4);
    EXPECT_EQ(plainMap.offsetLength, 0);
    const double texel = movedMap.offsetLength / 4;
    EXPECT_GT(texel, 0);
    // By 4 texels times 1 - cosine along the normal; the plane moves along the ray by that over the cosine.
    const double cosine = 1 / std::hypot(1, lean), along = 4 * texel * (1 - cosine) / cosine;
    const glm::dvec3 axis = glm::normalize(toGlm(model.lights[0].direction));
    const double depthPerLength = movedMap.clipFromWorld[2] * axis.x + movedMap.clipFromWorld[10] * axis.z;
    const double change = *movedMap.depth.image.at(32, 32) - *plainMap.depth.image.at(32, 32);
    EXPECT_NEAR(change / depthPerLength, along, 0.02 * texel) << lean;  // rounding of floats
  }
}

TEST_F(EngineMaps, CascadesFollowTheCamera) {
  Model model = ballAndEar();
  model.lights.resize(1);
  RasterOptions options{.width = 96, .height = 96, .shadowSize = 256};
  const Capture whole = rasterize(device(), model, frontCamera(false), options).capture;
  options.shadow.cascades = 3;
  options.shadow.placement = MapPlacement::Array;
  const Capture c = rasterize(device(), model, frontCamera(false), options).capture;
  ASSERT_EQ(c.lights[0].shadowMaps.size(), 3u);
  for (const ShadowMap& map : c.lights[0].shadowMaps) EXPECT_GE(map.layer, 0);
  // Shadows are those of one map but for texels at their edges.
  std::size_t differ = 0, lit = 0;
  for (std::size_t i = 0; i < c.material.size(); ++i) {
    lit += whole.irradiance.data[3 * i] > 0;
    differ += std::abs(whole.irradiance.data[3 * i] - c.irradiance.data[3 * i]) > 0.02f;
  }
  EXPECT_GT(lit, 1000u);
  EXPECT_LT(differ, lit / 50);
  ModelCamera parallel = frontCamera(true);
  EXPECT_THROW(rasterize(device(), model, parallel, options), InputError);
}

// A jitter of a whole pixel shows the same points one pixel on, with their irradiance.
TEST_F(EngineMaps, JitterMovesThePicture) {
  const Model model = ballAndEar();
  for (const bool orthographic : {false, true}) {
    RasterOptions options{.width = 96, .height = 96, .shadowSize = 128};
    const Capture still = rasterize(device(), model, frontCamera(orthographic), options).capture;
    options.jitter = {1, -1};
    const Capture moved = rasterize(device(), model, frontCamera(orthographic), options).capture;
    std::size_t differ = 0, covered = 0;
    for (int y = 1; y < 96; ++y)
      for (int x = 0; x + 1 < 96; ++x) {
        const float a = still.irradiance.at(x, y)[0], b = moved.irradiance.at(x + 1, y - 1)[0];
        covered += a > 0;
        differ += std::abs(a - b) > 1e-3f;  // an edge that rounding moves
      }
    EXPECT_GT(covered, 1000u);
    EXPECT_LT(differ, covered / 100);
    options.jitter = {0.5, 0};
    EXPECT_NE(rasterize(device(), model, frontCamera(orthographic), options).capture.irradiance.data,
              still.irradiance.data);
  }
}

// Their own depth format and that of the maps that exit depths come from, with one fragment shader: a
// pipeline of each.
TEST_F(EngineMaps, PointLightsHaveMapsOfFewBits) {
  Model model = ballAndEar();
  model.lights = {Light{}};
  model.lights[0].type = PELLUCID_LIGHT_POINT;
  model.lights[0].position = {10, 10, 30};
  model.lights[0].intensity = 2000;
  ShadowDrawing shadow;
  shadow.bits = 16;
  const Capture few = draw(model, shadow, 64), plain = draw(model, {}, 64);
  expectNear(meanLit(few, render(few, 0)), meanLit(plain, render(plain, 0)), 0.02);
}

}  // namespace
