// The light-space gather where its answer is known: K_T integrates to T(d) over a slab.
#include "gpu_fixture.h"

#include <limits>

namespace {

using namespace pellucid::test;

using Gather = GpuTest;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Texels of 0.2 mm, so that the camera's view of a face is not mistaken for the face behind it, across 50 mm:
// 0.1 % of the light that leaves 4 mm of slab enters beyond.
void cover50mm(ShadowMap& map) {
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.04;
  map.depth.image = Image(256, 256, 1, map.depth.image.data[0]);
}

Capture backlitSlab(double thickness, PellucidDepthEncoding encoding) {
  Capture c = flatCapture(8, 8, thickness);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-10 - thickness, encoding)};
  cover50mm(c.lights[0].shadowMaps[0]);
  return c;
}

// Straight from the camera, with a map of depth 10.
Light frontLight() {
  Light light = backLight();
  light.direction = {0, 0, -1};
  ShadowMap map;
  map.clipFromWorld = kIdentity;
  map.clipFromWorld[0] = map.clipFromWorld[5] = 0.01;
  map.clipFromWorld[10] = -1.0 / 100;  // grows towards -z from z = 0
  map.viewFromWorld = kIdentity;
  map.depth.encoding = PELLUCID_DEPTH_VIEW_Z;
  map.depth.image = Image(1, 1, 1, 10);
  cover50mm(map);
  light.shadowMaps = {map};
  return light;
}

double transmittance(int channel, double d) {
  return channel == 0   ? std::exp(-d / 2)
         : channel == 1 ? std::exp(-d)
                        : 0.7 * std::exp(-2 * d) + 0.3 * std::exp(-d / 4);
}

// What the table in place of T(h) and q(h) is off by, at most.
constexpr double kFitted = 0.02;

// The passes of the diffusion add the light. Without the feature each pixel keeps its own irradiance under
// it.
TEST_F(Gather, NeedsNoDiffusion) {
  Capture c = backlitSlab(2, PELLUCID_DEPTH_DEVICE);
  for (size_t i = 0; i < c.irradiance.pixels(); ++i) c.irradiance.data[3 * i] = static_cast<float>(i % 5);
  PellucidMaterial wide = testMaterial();
  wide.gaussianCount = 1;
  for (int k = 0; k < 3; ++k) {
    wide.gaussianVariance[k][0] = 9;
    wide.gaussianWeight[k][0] = 1;
    wide.radius[k] = 12;
  }
  ReplaySettings s = gathering(8);
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const Image out = replay(c, wide, s);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x)
      for (int k = 0; k < 3; ++k) {
        const double exact = 6 * transmittance(k, 2),
                     added = static_cast<double>(out.at(x, y)[k] - c.irradiance.at(x, y)[k]);
        EXPECT_NEAR(added, exact, kFitted * exact) << x << ", " << y << " channel " << k;
      }
}

// Rings are integrated, so that neither the number of samples nor the distance of probes matters where depth
// is constant.
TEST_F(Gather, IsTheSlabsTransmittance) {
  struct Row {
    uint32_t samples, spacing;
    PellucidDepthEncoding encoding;
  };
  for (const Row& row : {Row{4, 1, PELLUCID_DEPTH_VIEW_Z}, Row{16, 4, PELLUCID_DEPTH_DISTANCE},
                         Row{64, 2, PELLUCID_DEPTH_DEVICE}})
    for (const double d : {0.5, 4.0}) {
      Capture c = backlitSlab(d, row.encoding);
      for (float& v : c.irradiance.data) v = 0;  // of which a thin slab returns less
      const Image out = replay(c, testMaterial(), gathering(row.samples, row.spacing));
      for (int k = 0; k < 3; ++k) {
        const double exact = 6 * transmittance(k, d);
        EXPECT_NEAR(static_cast<double>(out.at(4, 4)[k]), exact, kFitted * exact)
            << row.samples << " samples, spacing " << row.spacing << ", d " << d << " channel " << k;
      }
    }
}

// A white channel decays over kilometers, which must not take the samples and the table of T from the others.
TEST_F(Gather, IsTheSlabsTransmittanceBesideAWhiteChannel) {
  PellucidMaterialDesc desc;
  pellucidInitMaterialDesc(&desc);
  for (int k = 0; k < 3; ++k) {
    desc.scattering[k] = 1;
    desc.absorption[k] = k == 0 ? 0.0 : 0.1 * k;
  }
  PellucidMaterial material;
  ASSERT_EQ(pellucidCompileMaterial(&desc, &material, nullptr, nullptr, nullptr), PELLUCID_OK);
  for (const double d : {0.5, 4.0}) {
    Capture c = backlitSlab(d, PELLUCID_DEPTH_VIEW_Z);
    for (float& v : c.irradiance.data) v = 0;
    const Image out = replay(c, material, gathering(16));
    for (int k = 0; k < 3; ++k) {
      const double exact = 3 * pellucidEvaluateTransmittance(&material, static_cast<uint32_t>(k), d) / static_cast<double>(material.reflectance[k]);
      // The map's 50 mm lack what a white medium spreads farther.
      EXPECT_NEAR(static_cast<double>(out.at(4, 4)[k]), exact, 2 * kFitted * exact) << "d " << d << " channel " << k;
    }
  }
}

// Lit from the front: the camera sees what it sees, and beyond the image's edges lies more of the same.
TEST_F(Gather, ConstantLightStaysConstant) {
  Capture c = flatCapture(8, 8, 2);
  c.backDepth = {};  // a thin slab returns less
  for (size_t i = 0; i < c.irradiance.data.size(); ++i) c.irradiance.data[i] = 3;
  c.lights = {frontLight()};
  const Image out = replay(c, testMaterial(), gathering(32));
  // What enters beyond the edges stands for as much as it displaces.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(out.at(4, 4)[k], 3, 6e-3);
}

// Without diffusion, light that enters where the camera sees it stays there: nothing comes through. The front
// recedes by 1.5 mm a mm.
TEST_F(Gather, SlopesThatTheCameraSeesAreNotHidden) {
  Capture c = flatCapture(48, 48, 20);
  c.lights = {frontLight()};
  const auto recede = [](Image& depth, double side) {
    for (int y = 0; y < depth.height; ++y)
      for (int x = 0; x < depth.width; ++x)
        *depth.at(x, y) = static_cast<float>(50 + 1.5 * side * (x + 0.5 - 0.5 * depth.width));
  };
  recede(c.lights[0].shadowMaps[0].depth.image, 0.2);
  recede(c.frontDepth.image, 0.25);
  std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
  ReplaySettings s = gathering(32);
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const Image out = replay(c, testMaterial(), s);
  // Of an irradiance of 3, .02 comes from beyond the image's edges. Points that count as hidden would bring .2 and more.
  for (int x = 16; x < 32; ++x) EXPECT_LT(out.at(x, 24)[0], 0.05f) << x;
}

// Cells of 4 pixels are linear between their probes: a slab that gets thicker along x, or along y, is as with a probe a pixel.
TEST_F(Gather, CellsAreLinearBetweenProbes) {
  for (const bool alongX : {true, false}) {
    Capture c = flatCapture(48, 48, 8);
    c.lights = {backLight()};
    c.lights[0].shadowMaps = {flatShadowMap(-18, PELLUCID_DEPTH_DEVICE)};
    cover50mm(c.lights[0].shadowMaps[0]);
    // By .3 mm a mm: texels have .2 mm.
    Image& depth = c.lights[0].shadowMaps[0].depth.image;
    for (int y = 0; y < depth.height; ++y)
      for (int x = 0; x < depth.width; ++x)
        depth.at(x, y)[0] += static_cast<float>(((alongX ? x : y) - 128) * 0.2 * 0.3 / 100 + 0.04);
    std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
    ReplaySettings s = gathering(32);
    s.translucency.gatherSpacing = 1;
    const Image expected = replay(c, testMaterial(), s);
    s.translucency.gatherSpacing = 4;
    const Image out = replay(c, testMaterial(), s);
    double sum = 0, most = 0;
    for (int y = 8; y < 40; ++y)
      for (int x = 8; x < 40; ++x) {
        ASSERT_GT(expected.at(x, y)[0], 1e-3f);
        const double e = std::abs(static_cast<double>(out.at(x, y)[0]) / static_cast<double>(expected.at(x, y)[0]) - 1);
        sum += e / (32 * 32);
        most = std::max(most, e);
      }
    EXPECT_LT(sum, 0.02) << alongX;
    EXPECT_LT(most, 0.06) << alongX;
  }
}

// The caster material beside the map: 0 is an opaque occluder, the pixels are of material 1.
TEST_F(Gather, LightEntersThroughTheReceiversMaterialOnly) {
  Capture c = backlitSlab(2, PELLUCID_DEPTH_DEVICE);
  for (float& v : c.irradiance.data) v = 0;
  ShadowMap& map = c.lights[0].shadowMaps[0];
  const Image unnamed = replay(c, testMaterial(), gathering(16));
  for (const int material : {1, 0, 2, 255}) {
    map.casterMaterial.assign(map.depth.image.pixels(), static_cast<std::uint8_t>(material));
    const Image out = replay(c, testMaterial(), gathering(16));
    for (int k = 0; k < 3; ++k) EXPECT_EQ(out.at(4, 4)[k], material == 1 ? unnamed.at(4, 4)[k] : 0) << material;
  }
}

// Depths that an engine clamped to a near plane within the slab do not say where light enters: none comes
// through, with biases and reversed depth, too. A surface just behind the near plane is one.
TEST_F(Gather, ClampedDepthsLetNoLightThrough) {
  for (const std::uint32_t samples : {0u, 8u})
    for (const bool reversed : {false, true})
      for (const double bias : {0.0, 0.01}) {
        const auto lit = [&](double depth, bool hasExit) {
          Capture c = flatCapture(32, 32, 4);
          c.lights = {backLight()};
          ShadowMap map = flatShadowMap(-11, PELLUCID_DEPTH_DEVICE);
          map.clipFromWorld[10] = reversed ? -0.01 : 0.01;
          map.clipFromWorld[14] = reversed ? 1 - 0.11 : 0.11;  // near plane at -11; the slab ends at -14
          map.depthBiasConstant = reversed ? -bias : bias;
          const double stored = reversed ? 1 - depth : depth;
          std::fill(map.depth.image.data.begin(), map.depth.image.data.end(),
                    static_cast<float>(depth < 1 ? stored + map.depthBiasConstant : stored));
          if (hasExit) map.exitDepth = Image(32, 32, 1, static_cast<float>(stored));
          c.lights[0].shadowMaps = {map};
          return replay(c, skin(), gathering(samples));
        };
        const Image nothing = lit(1, false);
        for (const bool hasExit : {false, true})
          EXPECT_LT(relativeRmse(lit(0, hasExit), nothing), 1e-3)
              << samples << " reversed " << reversed << " bias " << bias << " exit " << hasExit;
        // A tenth of a mm behind the near plane.
        EXPECT_GT(lit(0.001, false).at(16, 16)[0], 1.5f * nothing.at(16, 16)[0])
            << samples << " reversed " << reversed << " bias " << bias;
      }
}

// Also in a material that is never opaque: its T(d) falls by half over meters.
TEST_F(Gather, ClampedDepthsLetNoLightThroughClearMaterials) {
  PellucidMaterial clear = testMaterial();
  for (auto& t : clear.transmittance) t[0] = 1, t[1] = 1e-4f, t[2] = 0;
  const auto lit = [&](float depth) {
    Capture c = flatCapture(32, 32, 4);
    c.lights = {backLight()};
    ShadowMap map = flatShadowMap(-11, PELLUCID_DEPTH_DEVICE);
    map.clipFromWorld[14] = 0.11;
    std::fill(map.depth.image.data.begin(), map.depth.image.data.end(), depth);
    c.lights[0].shadowMaps = {map};
    return replay(c, clear, gathering(0));
  };
  const Image nothing = lit(1);
  EXPECT_LT(relativeRmse(lit(0), nothing), 1e-3);
  EXPECT_GT(lit(0.001f).at(16, 16)[0], 1.5f * nothing.at(16, 16)[0]);
}

// The offset moves the surface that the map stores, and not its exit.
TEST_F(Gather, ExitsHaveNoOffset) {
  for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_DISTANCE}) {
    const float perUnit = encoding == PELLUCID_DEPTH_DEVICE ? 0.01f : 1.0f;
    Capture c = backlitSlab(4, encoding);
    std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
    ShadowMap& map = c.lights[0].shadowMaps[0];
    map.exitDepth = Image(256, 256, 1, map.depth.image.data[0] + 4 * perUnit);
    const Image expected = replay(c, testMaterial(), gathering(8));
    EXPECT_GT(expected.at(4, 4)[0], 0.5f);
    map.offsetLength = 1;
    for (float& d : map.depth.image.data) d += perUnit;
    EXPECT_LT(relativeRmse(replay(c, testMaterial(), gathering(8)), expected), 1e-3) << encoding;
  }
}

// Alpha-hashed hair in front of a slab lit from behind, as opaque texels in all encodings: light is what the free texels let by.
TEST_F(Gather, SingleTexelsOfHairArePartialShadow) {
  constexpr int kTexels = 256;
  for (const auto& [encoding, away, covered] : {std::tuple(PELLUCID_DEPTH_VIEW_Z, 10.0f, 0.5),
                                                {PELLUCID_DEPTH_DEVICE, 30.0f, 0.75},
                                                {PELLUCID_DEPTH_DISTANCE, 30.0f, 0.25}}) {
    Capture c = flatCapture(48, 48, 4);
    std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
    c.lights = {backLight()};
    ShadowMap map = flatShadowMap(-14, encoding, kTexels);
    map.clipFromWorld[0] = map.clipFromWorld[5] = 1.0 / 20;  // texels of .16 mm
    const float perUnit = encoding == PELLUCID_DEPTH_DEVICE ? 0.01f : 1.0f;
    map.exitDepth = Image(kTexels, kTexels, 1, map.depth.image.data[0] + 4 * perUnit);
    map.casterMaterial.assign(map.depth.image.pixels(), 1);
    const auto light = [&] {
      c.lights[0].shadowMaps = {map};
      const Image out = replay(c, skin(), gathering(8));
      double sum = 0;
      for (int y = 8; y < 40; ++y)
        for (int x = 8; x < 40; ++x) sum += double(out.at(x, y)[0]);
      return sum;
    };
    const double bare = light();
    std::uint32_t state = 1;
    int hair = 0;
    for (std::size_t i = 0; i < map.depth.image.pixels(); ++i) {
      state = 1664525u * state + 1013904223u;  // Numerical Recipes
      if ((state >> 8) / double(1 << 24) >= covered) continue;
      ++hair;
      map.depth.image.data[i] -= away * perUnit;
      map.exitDepth.data[i] = map.depth.image.data[i] + 0.1f * perUnit;
      map.casterMaterial[i] = 0;
    }
    EXPECT_NEAR(light() / bare, 1 - hair / double(map.depth.image.pixels()), 0.04) << encoding;
  }
}

// Hair in every second pixel, as a checkerboard, over a tilted slab that is lit from before and behind: the skin between stays.
TEST_F(Gather, SkinBetweenPixelsOfHairStays) {
  constexpr int kSide = 48, kTexels = 192;
  const auto front = [](double x) { return 12 + 0.5 * x; };
  Capture c = flatCapture(kSide, kSide, 4);
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const double z = front(((x + 0.5) / kSide * 2 - 1) * kSide / 8);
      *c.frontDepth.image.at(x, y) = static_cast<float>(z);
      *c.backDepth.image.at(x, y) = static_cast<float>(z + 4);
    }
  Light before = backLight(), behind = backLight();
  before.direction = {0, 0, -1};
  before.intensity = 1;
  ShadowMap map;
  map.clipFromWorld = kIdentity;
  map.clipFromWorld[0] = map.clipFromWorld[5] = 1.0 / 16;
  map.clipFromWorld[10] = -0.01;
  map.depth = {Image(kTexels, kTexels, 1), PELLUCID_DEPTH_DEVICE};
  for (int y = 0; y < kTexels; ++y)
    for (int x = 0; x < kTexels; ++x)
      *map.depth.image.at(x, y) = static_cast<float>(front(((x + 0.5) / kTexels * 2 - 1) * 16) / 100);
  before.shadowMaps = {map};
  c.lights = {before, behind};
  Capture hairy = c;
  std::vector<std::uint8_t> skinPixels(c.material.size());
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const auto i = static_cast<std::size_t>(y * kSide + x);
      const bool within = std::min({x, y, kSide - 1 - x, kSide - 1 - y}) > 3;
      skinPixels[i] = (x + y) % 2 != 0 && within;
      if ((x + y) % 2 != 0) continue;
      hairy.material[i] = 0;
      hairy.frontDepth.image.data[i] -= 8;
      for (std::size_t k = 0; k < 3; ++k) hairy.irradiance.data[3 * i + k] = 0;
    }
  for (const std::uint32_t samples : {0u, 8u})
    EXPECT_LT(relativeRmse(replay(hairy, skin(), gathering(samples)), replay(c, skin(), gathering(samples)), skinPixels), 0.04)
        << samples;
}

TEST_F(Gather, NothingFromOutsideOrEmptyTexels) {
  Capture c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  c.backDepth = {};  // a thin slab returns less
  for (const float nothing : {pellucid::harness::kNoDepth, 0.0f, kNan}) {
    for (float& v : c.lights[0].shadowMaps[0].depth.image.data) v = nothing;
    EXPECT_NEAR(replay(c, testMaterial(), gathering(16)).at(4, 4)[0], 1, 1e-5) << nothing;
  }
  c = backlitSlab(1, PELLUCID_DEPTH_VIEW_Z);
  c.backDepth = {};
  c.lights[0].shadowMaps[0].clipFromWorld[12] = 5;
  EXPECT_NEAR(replay(c, testMaterial(), gathering(16)).at(4, 4)[0], 1, 1e-5);
}

}  // namespace
