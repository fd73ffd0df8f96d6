// Sheets without thickness: closed forms.
#include <functional>

#include "thin_wall_fixture.h"

namespace {

using namespace pellucid::test;

// The diffusion rounds to halves, by 5e-4.
constexpr double kTolerance = 1e-3;

// Every pixel of a material against expected(x, y, channel), pixel centers in mm.
void expectPixels(const Capture& c, const Image& output, std::uint8_t material,
                  const std::function<double(double, double, std::size_t)>& expected,
                  double tolerance = kTolerance) {
  std::size_t pixels = 0, wrong = 0;
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      if (c.material[static_cast<std::size_t>(y * c.width + x)] != material) continue;
      const Vector3 at = rayOf(c, x, y).origin;
      for (std::size_t k = 0; k < 3; ++k) {
        const double e = expected(at[0], at[1], k);
        if (e < 0) continue;  // not known here
        ++pixels;
        const double found = static_cast<double>(output.at(x, y)[k]);
        if (std::abs(found - e) <= tolerance * std::max(e, 0.1)) continue;
        if (++wrong <= 3)
          ADD_FAILURE() << "pixel " << x << " " << y << " channel " << k << ": " << found << ", not " << e;
      }
    }
  EXPECT_GT(pixels, 100u);
  EXPECT_EQ(wrong, 0u);
}

const Vector3 kBehind[] = {{0, 0, 1}, {1, 0.5, 1}, {-4, 1, 1}};

double cosineOf(const Vector3& d) { return d[2] / std::hypot(d[0], d[1], d[2]); }

TEST_F(ThinWall, LightFromBehindIsTransmittanceTimesTheIrradianceOfTheOtherFace) {
  for (const int shadowSize : {0, 64})
    for (const bool skin : {false, true})
      for (const Vector3& direction : kBehind) {
        Model model = sheet();
        if (skin) addSkin(model, {0, 8, 0}, 1.5);
        model.lights = {directional(direction, kE)};
        const Capture c = draw(model, shadowSize);
        for (const std::uint32_t samples : {0u, 8u, 16u}) {
          SCOPED_TRACE(testing::Message() << samples << " samples"
                                          << ", map " << shadowSize << ", skin " << skin << ", light "
                                          << direction[0] << " " << direction[1]);
          // The sphere shadows the edge of the sheet.
          expectPixels(c, run(c, gathering(samples)), 1, [&](double, double y, std::size_t k) {
            return skin && y > 2 && shadowSize > 0 ? -1 : kTransmittance[k] * kE * cosineOf(direction);
          });
        }
      }
}

TEST_F(ThinWall, LightFromTheFrontIsReflectedAlone) {
  Model model = sheet();
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({0.5, 0, -1}, kE)};
  const Capture c = draw(model);
  for (const std::uint32_t samples : {0u, 8u, 16u})
    expectPixels(c, run(c, gathering(samples)), 1, [&](double, double y, std::size_t k) {
      return y > 2 ? -1 : kReflectance[k] * kE / std::hypot(0.5, 1);
    });
}

TEST_F(ThinWall, WhatStandsBetweenHoldsLightBack) {
  Model model = sheet();
  addOccluder(model, 2, -1);
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({0, 0, 1}, kE)};
  const Capture c = draw(model, 512);
  for (const std::uint32_t samples : {0u, 8u, 16u})
    expectPixels(c, run(c, gathering(samples)), 1, [&](double x, double y, std::size_t k) {
      const double off = std::max(std::abs(x), std::abs(y)) - 2;
      // A texel is some .04 mm.
      return std::abs(off) < 0.2 || y > 4 ? -1 : off < 0 ? 0 : kTransmittance[k] * kE;
    });
}

// The sheet shadows neither itself nor what lies behind it as seen from the light.
TEST_F(ThinWall, WhatLiesBeyondTheSheetHoldsNothingBack) {
  Model model = sheet();
  model.lights = {directional({0.3, 0, 1}, kE)};
  const Capture plain = draw(model);
  Capture c = plain;
  // A map that does not show the sheet at all, and one that shows a surface beyond.
  for (const float stored : {0.0f, 0.01f}) {
    std::fill(c.lights[0].shadowMaps[0].depth.image.data.begin(),
              c.lights[0].shadowMaps[0].depth.image.data.end(), stored);
    expectPixels(c, run(c, gathering(0)), 1, [&](double, double, std::size_t k) {
      return kTransmittance[k] * kE * cosineOf({0.3, 0, 1});
    });
  }
}

Model lantern() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 5, 64);
  endPart(model, 0);
  model.surfaces[0].doubleSided = true;
  model.surfaces[0].baseColor = kReflectance;
  model.materials[0] = kPaper;
  return model;
}

TEST_F(ThinWall, ALanternShinesByTheLightWithin) {
  for (const int shadowSize : {0, 256}) {
    Model model = lantern();
    model.lights = {pointLight({0, 0, 0}, 50)};
    const Capture c = draw(model, shadowSize, PointMaps::Six);
    // Facets of 64 rings, whose normals are interpolated, lie up to .1 % nearer to the light.
    expectPixels(
        c, run(c, gathering(8)), 1,
        [&](double, double, std::size_t k) { return kTransmittance[k] * 50 / 25; }, 4e-3);
  }
}

TEST_F(ThinWall, TheFarWallOfALanternHoldsLightFromOutsideBack) {
  Model model = lantern();
  model.lights = {directional({0, 0, 1}, kE)};
  const Capture c = draw(model);
  expectPixels(c, run(c, gathering(8)), 1, [&](double x, double y, std::size_t) {
    return std::hypot(x, y) < 4.5 ? 0 : -1;  // the walls meet at the rim
  });
}

// Normal maps bend normals away from a lit face; that does not bring the light to its other side.
TEST_F(ThinWall, NormalsThatBendDoNotLightALitFace) {
  Model model = sheet();
  model.lights = {directional({1, 0, -0.5}, kE)};
  Capture c = draw(model);
  for (std::size_t i = 0; i < c.normal.pixels(); ++i) {
    c.normal.data[3 * i] = 0.9f;
    c.normal.data[3 * i + 2] = 0.43589f;
  }
  expectPixels(c, run(c, gathering(0)), 1, [&](double x, double y, std::size_t k) {
    // Beyond the edge there are no depths to take a normal from.
    const double e = static_cast<double>(c.irradiance.at(32, 32)[k]);
    return std::max(std::abs(x), std::abs(y)) > 4.5 ? -1 : kReflectance[k] * e;
  });
}

TEST_F(ThinWall, WithoutNormalsThoseOfTheDepthsCount) {
  for (const Vector3& direction : kBehind) {
    Model model = sheet();
    addSkin(model, {0, 8, 0}, 1.5);
    model.lights = {directional(direction, kE)};
    Capture c = draw(model);
    c.normal = {};
    c.backDepth = {};
    for (const std::uint32_t samples : {0u, 8u})
      expectPixels(c, run(c, gathering(samples)), 1, [&](double, double y, std::size_t k) {
        return y > 2 ? -1 : kTransmittance[k] * kE * cosineOf(direction);
      });
  }
}

// As beside a solid that light does not come through.
TEST_F(ThinWall, SolidsOfTheFrameDoNotSeeThatSheetsAreThin) {
  Model model = sheet();
  addSkin(model, {0, 7.5, 0}, 2);
  model.lights = {directional({1, 0.2, 1}, kE), directional({-1, 0, 0.3}, kE)};
  const Capture c = draw(model);
  const std::vector<PellucidMaterial> materials = compileMaterials(c);
  std::vector<PellucidMaterial> opaque = materials;
  opaque[0].thinWalled = 0;
  for (float(&t)[5] : opaque[0].transmittance) t[0] = 1e-9f, t[1] = 1;
  for (const std::uint32_t samples : {0u, 8u, 16u}) {
    const Image with = replayer().run(c, materials, gathering(samples)).output,
                alone = replayer().run(c, opaque, gathering(samples)).output;
    double worst = 0;
    for (std::size_t i = 0; i < c.material.size(); ++i)
      for (std::size_t k = 0; k < 3 && c.material[i] == 2; ++k)
        worst = std::max(worst, std::abs(static_cast<double>(with.data[4 * i + k] - alone.data[4 * i + k])));
    EXPECT_LT(worst, 1e-3) << samples;
  }
}

// Light spreads within a sheet if its material says so, and equally with any gather.
TEST_F(ThinWall, LightSpreadsWithinASheetIfItsMaterialSaysSo) {
  const auto atEdge = [&](std::uint32_t samples, bool spreads) {
    Model model = sheet();
    if (spreads) model.materials[0] = ThinWallMaterial{kReflectance, kTransmittance, {{1, 1, 1}}};
    addOccluder(model, 2, -1);
    addSkin(model, {0, 8, 0}, 1);
    model.lights = {directional({0, 0, 1}, kE)};
    const Capture c = draw(model, 512);
    return static_cast<double>(run(c, gathering(samples)).at(32 + 5, 32)[0]);  // 1.5 of 2 mm
  };
  for (const std::uint32_t samples : {0u, 8u, 16u}) {
    EXPECT_LT(atEdge(samples, false), 1e-3) << samples;
    EXPECT_GT(atEdge(samples, true), 0.1) << samples;
    EXPECT_NEAR(atEdge(samples, true), atEdge(0, true), 0.03) << samples;
  }
}

TEST_F(ThinWall, FramesThatReuseKeepTheSheetsLight) {
  Model model = sheet();
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE), directional({0, 1, 1}, kE)};
  Capture c = draw(model);
  c.lights[1].shadowMaps.clear();
  const std::vector<PellucidMaterial> materials = compileMaterials(c);
  for (const std::uint32_t samples : {0u, 8u}) {
    ReplaySettings settings = gathering(samples);
    const Image plain = replayer().run(c, materials, settings).output;
    settings.reuse = PELLUCID_REUSE_ALTERNATE;
    std::unique_ptr<FrameRun> last;
    for (std::uint32_t age : {0u, 1u}) {
      auto frame =
          std::make_unique<FrameRun>(device(), replayer().contextFor(c), c, materials, settings, last.get());
      device().run([&](VkCommandBuffer commands) { frame->record(commands); });
      EXPECT_EQ(frame->plan().historyAge, age);
      const Image output = frame->output();
      for (std::size_t i = 0; i < plain.pixels(); ++i)
        for (std::size_t k = 0; k < 3 && c.material[i] == 1; ++k)
          ASSERT_NEAR(output.data[4 * i + k], plain.data[4 * i + k], 1e-3) << samples << " age " << age;
      last = std::move(frame);
    }
  }
}

// Wherever the passes run, with a gather and without.
TEST_F(ThinWall, EveryOrderOfDispatchesHasTheSameLight) {
  Model model = sheet();
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE)};
  const Capture c = draw(model);
  for (const std::uint32_t spacing : {1u, 4u})
    for (const auto indirect : {1, 0})
      for (const std::uint32_t features : {1u, 3u}) {
        SCOPED_TRACE(testing::Message() << spacing << " " << indirect << " " << features);
        ReplaySettings settings = gathering(8);
        settings.translucency.gatherSpacing = spacing;
        settings.indirectDispatches = indirect;
        settings.features = features;
        expectPixels(c, run(c, settings), 1, [&](double, double y, std::size_t k) {
          return y > 2 ? -1 : kTransmittance[k] * kE * cosineOf({1, 0.5, 1});
        });
      }
}

}  // namespace
