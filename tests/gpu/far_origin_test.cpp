// Captures far from their world's origin.
#include "gpu_fixture.h"

#include "common/far_origin.h"
#include "gpu/model_builder.h"
#include "raster/raster.h"
#include "replay/exposure.h"

namespace {

using namespace pellucid::test;

class FarOrigin : public GpuTest {};

Capture moved(Capture capture, const Vector3& by) {
  const Vector3 back = {-by[0], -by[1], -by[2]};
  capture.viewFromWorld = fromOrigin(capture.viewFromWorld, back);
  for (Light& light : capture.lights) {
    for (std::size_t i = 0; i < 3; ++i) light.position[i] += by[i];
    for (ShadowMap& map : light.shadowMaps) {
      map.clipFromWorld = fromOrigin(map.clipFromWorld, back);
      if (map.viewFromWorld) map.viewFromWorld = fromOrigin(*map.viewFromWorld, back);
    }
  }
  return capture;
}

TEST_F(FarOrigin, ThePictureIsThatOfTheOrigin) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 5, 32);
  endPart(model, 0);
  model.lights = {directional({0.3, -0.2, 1}, 3), pointLight({20, 5, -60}, 4000)};
  const RasterOptions options{
      .width = 48, .height = 48, .shadowSize = 128, .shadowEncoding = PELLUCID_DEPTH_VIEW_Z};
  // A near plane of 0.5 mm says that things as near are seen, so that the capture counts as far from 1e4 mm
  // on.
  ModelCamera camera = frontCamera(false);
  camera.range = {0.5, 150};
  const Capture near = rasterize(device(), model, camera, options).capture;
  EXPECT_EQ(worldOrigin(near), (Vector3{0, 0, 0}));
  const Image expected = replay(near, inFloats());
  for (const double distance : {1e6, 6e6}) {
    const Capture far = moved(near, {distance, 0.5 * distance, -distance});
    const Image picture = replay(far, inFloats());
    double worst = 0, brightest = 0;
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
      worst = std::max(
          worst, std::abs(static_cast<double>(picture.data[i]) - static_cast<double>(expected.data[i])));
      brightest = std::max(brightest, static_cast<double>(expected.data[i]));
    }
    // The matrices differ by roundings of floats, which now and then move a sample by a texel.
    EXPECT_LT(worst, 2e-3 * brightest) << distance;
  }
}

}  // namespace
