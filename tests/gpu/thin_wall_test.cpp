// Sheets without thickness: closed forms, the float64 reference and path tracing.
#include <functional>

#include "gpu/model_builder.h"
#include "gpu_fixture.h"
#include "raster/raster.h"
#include "reference/path_tracer/trace_scene.h"
#include "reference/path_tracer/truth.h"
#include "reference_frame.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;
namespace reference = pellucid::harness::reference;

constexpr double kE = 2;
constexpr std::array<double, 3> kReflectance = {0.5, 0.25, 0.125}, kTransmittance = {0.5, 0.6, 0.1};
const MaterialSource kPaper = ThinWallMaterial{kReflectance, kTransmittance, {}};

// A square of 10 mm that faces the camera, of paper on both sides.
Model sheet() {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 5);
  endPart(model, 0);
  model.surfaces[0].doubleSided = true;
  model.surfaces[0].baseColor = kReflectance;
  model.materials[0] = kPaper;
  return model;
}

// An opaque square between the sheet and a light behind.
void addOccluder(Model& model, double half, double z) {
  Surface opaque;
  opaque.doubleSided = true;
  model.surfaces.push_back(opaque);
  addSquare(model, 0, 0, z, half);
  endPart(model, 1, static_cast<std::uint32_t>(model.surfaces.size() - 1));
}

// A sphere of skin beside the sheet, so that a frame may gather.
void addSkin(Model& model, const Vector3& center, double radius) {
  Surface skin;
  skin.baseColor = {0.5, 0.5, 0.5};
  skin.material = 2;
  model.surfaces.push_back(skin);
  model.materials.emplace_back(PresetMaterial{"skin1"});
  addSphere(model, center, radius, 24);
  endPart(model, 2, static_cast<std::uint32_t>(model.surfaces.size() - 1));
}

class ThinWall : public GpuTest {
protected:
  static Capture draw(const Model& model, int shadowSize = 256, PointMaps maps = PointMaps::Auto) {
    const RasterOptions options{.width = 65, .height = 65, .shadowSize = shadowSize, .pointMaps = maps};
    return rasterize(device(), model, frontCamera(true), options).capture;
  }
};

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

const Vector3 kBehind[] = {{0, 0, 1}, {-4, 1, 1}};

double cosineOf(const Vector3& d) { return d[2] / std::hypot(d[0], d[1], d[2]); }

TEST_F(ThinWall, LightFromBehindIsTransmittanceTimesTheIrradianceOfTheOtherFace) {
  for (const int shadowSize : {0, 64})
    for (const Vector3& direction : kBehind) {
      Model model = sheet();
      addSkin(model, {0, 8, 0}, 1.5);
      model.lights = {directional(direction, kE)};
      const Capture c = draw(model, shadowSize);
      for (const std::uint32_t samples : {0u, 8u}) {
        SCOPED_TRACE(testing::Message()
                     << samples << " samples"
                     << ", map " << shadowSize << ", light " << direction[0] << " " << direction[1]);
        // The sphere shadows the edge of the sheet.
        expectPixels(c, replay(c, gathering(samples)), 1, [&](double, double y, std::size_t k) {
          return y > 2 && shadowSize > 0 ? -1 : kTransmittance[k] * kE * cosineOf(direction);
        });
      }
    }
}

TEST_F(ThinWall, LightsDoNotReachBeyondTheirMaps) {
  Model model = sheet();
  model.lights = {directional(kBehind[0], kE)};
  Capture c = draw(model);
  c.lights[0].shadowMaps[0].clipFromWorld[12] += 3;  // the sheet lies beside the map
  expectPixels(c, replay(c, gathering(0)), 1, [](double, double, std::size_t) { return 0; });
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
    expectPixels(c, replay(c, gathering(0)), 1, [&](double, double, std::size_t k) {
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
    // Facets of 64 rings lie up to .1 % nearer to the light. Normals of depths are 7 degrees off where pixels
    // of .3 mm change their depth most, towards the rim.
    expectPixels(
        c, replay(c, gathering(8)), 1,
        [&](double x, double y, std::size_t k) {
          return std::hypot(x, y) < 4.5 ? kTransmittance[k] * 50 / 25 : -1;
        },
        1e-2);
  }
}

TEST_F(ThinWall, TheFarWallOfALanternHoldsLightFromOutsideBack) {
  Model model = lantern();
  model.lights = {directional({0, 0, 1}, kE)};
  const Capture c = draw(model);
  expectPixels(c, replay(c, gathering(8)), 1, [&](double x, double y, std::size_t) {
    return std::hypot(x, y) < 4.5 ? 0 : -1;  // the walls meet at the rim
  });
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
  for (const std::uint32_t samples : {0u, 8u}) {
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
  Model model = sheet();
  addOccluder(model, 2, -1);
  addSkin(model, {0, 8, 0}, 1);
  model.lights = {directional({0, 0, 1}, kE)};
  const Capture still = draw(model, 512);
  Capture spreading = still;
  spreading.materials[0] = ThinWallMaterial{kReflectance, kTransmittance, {{1, 1, 1}}};
  const auto atEdge = [&](const Capture& c, std::uint32_t samples) {
    return static_cast<double>(replay(c, gathering(samples)).at(32 + 5, 32)[0]);  // 1.5 of 2 mm
  };
  const double plain = atEdge(spreading, 0);
  EXPECT_GT(plain, 0.1);
  EXPECT_NEAR(atEdge(spreading, 8), plain, 0.03);
  for (const std::uint32_t samples : {0u, 8u}) EXPECT_LT(atEdge(still, samples), 1e-3) << samples;
}

// Wherever the passes run, with a gather and without.
TEST_F(ThinWall, EveryOrderOfDispatchesHasTheSameLight) {
  Model model = sheet();
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE)};
  const Capture c = draw(model);
  for (const std::uint32_t spacing : {1u, 4u})
    for (const std::uint32_t features : {1u, 3u}) {
      SCOPED_TRACE(testing::Message() << spacing << " " << features);
      ReplaySettings settings = gathering(8, spacing);
      settings.indirectDispatches = (spacing == 1) == (features == 1);
      settings.features = features;
      expectPixels(c, replay(c, settings), 1, [&](double, double y, std::size_t k) {
        return y > 2 ? -1 : kTransmittance[k] * kE * cosineOf({1, 0.5, 1});
      });
    }
}

// ---- The reference and path tracing

// Curved sheets, lights of all kinds and encodings, with and without back depths, beside a solid.
TEST_F(ThinWall, AgreesWithTheReference) {
  PellucidMaterial wall = compileMaterial(ThinWallMaterial{{0.4, 0.3, 0.2}, {0.5, 0.6, 0.1}, {}}, "wall");
  struct Row {
    const char* scene;
    PellucidLightType light;
    PellucidDepthEncoding shadow;
    bool source;
    bool back, maps;
  };
  for (const Row& row : {Row{"ear", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_DEVICE, 0, true, true},
                         Row{"ear", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_VIEW_Z, 0, true, true},
                         Row{"torus", PELLUCID_LIGHT_SPOT, PELLUCID_DEPTH_DISTANCE, 1, false, true},
                         Row{"blades", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_VIEW_Z, 1, true, true},
                         Row{"sphere", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_DEVICE, 0, false, false}})
    for (const bool solid : {false, true}) {
      SCOPED_TRACE(testing::Message() << row.scene << " solid " << solid);
      Capture c = makeScene({.name = row.scene,
                             .width = 48,
                             .height = 40,
                             .lightType = row.light,
                             .shadowSize = 64,
                             .shadowEncoding = row.shadow});
      if (!row.back) c.backDepth = {};
      if (!row.maps) c.lights[0].shadowMaps.clear();
      std::vector<PellucidMaterial> materials(std::max<std::size_t>(c.materials.size(), 1), wall);
      if (solid) {
        materials.push_back(testMaterial());
        for (int y = 0; y < c.height; ++y)
          for (int x = 0; x < c.width / 2; ++x)
            if (std::uint8_t& m = c.material[static_cast<std::size_t>(y * c.width + x)]; m != 0)
              m = static_cast<std::uint8_t>(materials.size());
      }
      ReplaySettings s = gathering(0);
      s.features = PELLUCID_FEATURE_TRANSLUCENCY;
      s.translucency.cameraThickness = row.source;
      const Image gpu = replayer().run(c, materials, s).output, ref = referenceOf(c, materials, s);
      std::size_t pixels = 0, apart = 0;
      double most = 0;
      for (std::size_t i = 0; i < gpu.pixels(); ++i) {
        if (c.material[i] == 0) continue;
        ++pixels;
        double worst = 0;
        for (std::size_t k = 0; k < 3; ++k) {
          worst = std::max(worst, std::abs(static_cast<double>(gpu.data[4 * i + k] - ref.data[3 * i + k])));
          most = std::max(most, static_cast<double>(ref.data[3 * i + k] - c.irradiance.data[3 * i + k]));
        }
        apart += worst > 1e-3;
      }
      EXPECT_GT(most, 0.1) << "nothing comes through";
      // Roundings move a pixel to the next texel of a map, where a far one decides.
      EXPECT_LE(apart, pixels / 100) << "of " << pixels;
    }
}

// Sheets and an occluder by path tracing, in light of a point and the sun from both sides.
TEST_F(ThinWall, AgreesWithPathTracing) {
  Model model = sheet();
  addOccluder(model, 2, -3);
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE), pointLight({3, 0, -20}, 300), directional({0.2, 0, -1}, 0.5)};
  const Capture c = draw(model, 512);
  const auto scene = reference::makeMeshScene(model);
  const auto media = reference::traceMedia(c.materials, c.name);
  reference::Emitters emitters;
  emitters.lights = model.lights;
  reference::VisibleSurface surface = reference::visibleSurface(c, *scene);
  for (std::size_t i = 0; i < surface.points.size(); ++i)
    if (c.material[i] != 1) surface.points[i].reset();
  reference::TruthSums sums;
  reference::TruthTracer(c, surface, *scene, media, emitters).trace(sums, 2, 1, 0, [] {});
  const Image truth = reference::truthOf(sums).image;
  for (const std::uint32_t samples : {0u, 8u}) {
    const Image output = replay(c, gathering(samples));
    double squares = 0, total = 0;
    std::size_t apart = 0, pixels = 0;
    for (std::size_t i = 0; i < output.pixels(); ++i)
      for (std::size_t k = 0; k < 3 && c.material[i] == 1; ++k) {
        const double t = static_cast<double>(truth.data[3 * i + k]);
        const double error = static_cast<double>(output.data[4 * i + k]) - t;
        squares += error * error;
        total += t * t;
        apart += std::abs(error) > 1e-3 * std::max(t, 0.1);
        ++pixels;
      }
    EXPECT_GT(total / static_cast<double>(pixels), 0.1);
    // Edges of shadows alone, which maps filter over two texels: a pixel in twenty lies there.
    EXPECT_LT(static_cast<double>(apart), 0.05 * static_cast<double>(pixels)) << samples;
    EXPECT_LT(std::sqrt(squares / total), 0.05) << samples;
  }
}

}  // namespace
