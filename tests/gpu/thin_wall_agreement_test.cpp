// Sheets without thickness against the float64 reference and path tracing.
#include "reference/path_tracer/trace_scene.h"
#include "reference/path_tracer/truth.h"
#include "reference/reference.h"
#include "scene/scene.h"
#include "thin_wall_fixture.h"

namespace {

using namespace pellucid::test;
namespace reference = pellucid::harness::reference;

// Curved sheets, lights of all kinds and encodings, with and without normals and back depths, beside a solid.
TEST_F(ThinWall, AgreesWithTheReference) {
  PellucidMaterial wall = compileMaterial(ThinWallMaterial{{0.4, 0.3, 0.2}, {0.5, 0.6, 0.1}, {}}, "wall");
  struct Row {
    const char* scene;
    PellucidLightType light;
    PellucidDepthEncoding shadow;
    bool source;
    bool normals, back, maps;
  };
  for (const Row& row :
       {Row{"ear", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_DEVICE, 0, true, true, true},
        Row{"ear", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_VIEW_Z, 0, false, true, true},
        Row{"torus", PELLUCID_LIGHT_SPOT, PELLUCID_DEPTH_DISTANCE, 1, true, false, true},
        Row{"blades", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_VIEW_Z, 1, true, true, true},
        Row{"sphere", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_DEVICE, 0, true, false, false}})
    for (const bool solid : {false, true}) {
      SCOPED_TRACE(testing::Message() << row.scene << " solid " << solid);
      Capture c = makeScene({.name = row.scene,
                             .width = 48,
                             .height = 40,
                             .lightType = row.light,
                             .shadowSize = 64,
                             .shadowEncoding = row.shadow});
      if (!row.normals) c.normal = {};
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
      reference::Settings r;
      r.features = s.features;
      r.translucency = s.translucency;
      r.translucency.gatherSamples = 0;
      const Image gpu = replayer().run(c, materials, s).output,
                  ref = reference::compute(c, materials, r).image;
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

// Gathered frames: the sheet's part of them does not depend on the samples, so that it is the reference's.
TEST_F(ThinWall, AgreesWithTheReferenceBesideAGather) {
  Model model = sheet();
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE), pointLight({3, 0, -20}, 300), directional({0, 1, 1}, kE)};
  Capture c = draw(model, 64);
  c.lights[2].shadowMaps.clear();
  const std::vector<PellucidMaterial> materials = compileMaterials(c);
  const ReplaySettings s = gathering(8);
  reference::Settings r;
  r.translucency = s.translucency;
  r.translucency.gatherSamples = 8;
  for (const std::uint8_t m : c.material) r.wanted.push_back(m == 1);
  const Image gpu = replayer().run(c, materials, s).output, ref = reference::compute(c, materials, r).image;
  for (std::size_t i = 0; i < gpu.pixels(); ++i)
    for (std::size_t k = 0; k < 3 && c.material[i] == 1; ++k)
      ASSERT_NEAR(gpu.data[4 * i + k], ref.data[3 * i + k], 1e-3) << i;
}

// Sheets and an occluder by path tracing, in light of a point and the sun from both sides.
TEST_F(ThinWall, AgreesWithPathTracing) {
  Model model = sheet();
  addOccluder(model, 2, -3);
  addSkin(model, {0, 8, 0}, 1.5);
  model.lights = {directional({1, 0.5, 1}, kE), pointLight({3, 0, -20}, 300), directional({0.2, 0, -1}, 0.5)};
  const Capture c = draw(model, 1024);
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
    const Image output = run(c, gathering(samples));
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
