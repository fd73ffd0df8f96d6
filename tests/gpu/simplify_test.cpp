// Fewer triangles for back depth and shadow maps (Whelan 2009, 4.7.3).
#include <cmath>

#include "gpu_fixture.h"
#include "model_builder.h"
#include "raster/raster.h"
#include "raster/mesh.h"

namespace {

using namespace pellucid::test;

constexpr double kRadius = 8;

Model sphere() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, kRadius, 48);
  endPart(model, 1);
  addSphere(model, {0, 0, -20}, 1, 24);
  endPart(model, 2);
  model.lights.resize(1);
  model.lights[0].direction = {0.3, -0.2, 1};
  return model;
}

class Simplify : public GpuTest {};

TEST_F(Simplify, KeepsPartsAndTheirShareOfTriangles) {
  const Model whole = sphere(), simple = simplified(whole, 0.2);
  ASSERT_EQ(simple.parts.size(), 2u);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(simple.parts[i].firstIndex, next);
    next += simple.parts[i].indexCount;
    EXPECT_EQ(simple.parts[i].object, whole.parts[i].object);
    EXPECT_EQ(simple.parts[i].indexCount % 3, 0u);
    EXPECT_NEAR(simple.parts[i].indexCount / double(whole.parts[i].indexCount), 0.2, 0.02);
  }
  EXPECT_EQ(next, simple.indices.size());
  EXPECT_EQ(simplified(whole, 1).indices, whole.indices);
}

// A fifth of the sphere's triangles: chords of about 0.5 mm in place of 8 mm of radius are off by a few
// hundredths of a mm.
TEST_F(Simplify, ChangesWhatLightComesThroughAlone) {
  const Model model = sphere();
  RasterOptions options{.width = 96, .height = 96, .depthEncoding = PELLUCID_DEPTH_VIEW_Z, .shadowSize = 96};
  const RasterResult whole = rasterize(device(), model, frontCamera(true), options);
  options.simplify = 0.2;
  const RasterResult simple = rasterize(device(), model, frontCamera(true), options);
  const Capture &a = whole.capture, &b = simple.capture;
  EXPECT_EQ(a.material, b.material);
  EXPECT_TRUE(sameBits(a.frontDepth.image, b.frontDepth.image));
  EXPECT_TRUE(sameBits(a.irradiance, b.irradiance));
  EXPECT_FALSE(sameBits(a.backDepth.image, b.backDepth.image));
  EXPECT_FALSE(sameBits(a.lights[0].shadowMaps[0].depth.image, b.lights[0].shadowMaps[0].depth.image));
  double sum = 0;
  int covered = 0;
  for (std::size_t i = 0; i < a.material.size(); ++i) {
    const float from = a.backDepth.image.data[i], to = b.backDepth.image.data[i];
    if (a.material[i] == 0 || from >= kNoDepth || to >= kNoDepth) continue;
    ++covered;
    sum += std::abs(static_cast<double>(from - to));
  }
  EXPECT_GT(covered, 3000);
  EXPECT_LT(sum / covered, 0.1) << "mm";
}

}  // namespace
