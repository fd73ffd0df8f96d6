// Maps as engines draw them must not put spots on a face that the same maps drawn plainly lack. Light grazes
// the procedural head. Without a gather one thickness a pixel comes from the map's own slopes and keeps
// spots.
#include <algorithm>

#include "common/compare.h"
#include "gpu_fixture.h"
#include "metrics/spots.h"
#include "raster/mesh.h"
#include "raster/framing.h"
#include "raster/raster.h"
#include "scene/model.h"

namespace pellucid::test {
namespace {

// Meshed once, with 2 mm between vertices.
const Model& head() {
  static const Model made = [] {
    SceneParameters scene;
    scene.name = "head";
    return meshOf(sceneModel(scene), scene.name, 2);
  }();
  return made;
}

// Spots of biased maps that the plain map lacks: single pixels of rims and folds whose surfaces the camera
// does not show. Without normals of the camera the D16 frame has 9, and that with a normal offset 17.
constexpr std::size_t kMost = 7;

struct EngineFrame {
  const char* name;
  void (*draw)(RasterOptions&);
};

class EngineSpots : public GpuTest, public testing::WithParamInterface<EngineFrame> {
protected:
  static Capture capture(const EngineFrame& frame, bool plain) {
    Model model = head();
    Light light;
    light.direction = {0.6, -0.75, -0.45};
    light.intensity = 3;
    model.lights = {light};
    RasterOptions options{.width = 320, .height = 180};
    frame.draw(options);
    if (plain) {
      ShadowDrawing drawing;
      drawing.cascades = options.shadow.cascades;
      drawing.placement = options.shadow.placement;
      options.shadow = drawing;
    }
    const double aspect = static_cast<double>(options.width) / options.height;
    ModelCamera camera = frameModel(model, {0.1, 0, 1}, 0.35, aspect, false);
    camera.verticalFov *= 0.5;  // the face fills the picture
    return rasterize(device(), model, camera, options).capture;
  }
  // All spots, and those that the plain maps' picture lacks.
  static std::pair<std::size_t, std::size_t> spots(const Capture& c, const Capture& plain) {
    const Surfaces surfaces(c);
    const auto seen = [&](const Image& image) { return SpotImage(image, surfaces, c.material); };
    const auto run = [&](const Capture& of) { return seen(rgb(replay(of, gathering(8)))); };
    const SpotImage result = run(c), expected = run(plain), input = seen(litAlbedo(c));
    const std::vector<Spot> all = result.find(&input);
    return {all.size(), result.lackedBy(expected, all).size()};
  }
};

TEST_P(EngineSpots, AreNotThere) {
  const Capture engine = capture(GetParam(), false);
  Capture plain = engine;  // G-buffer and irradiance
  plain.lights = capture(GetParam(), true).lights;
  const auto [all, lacked] = spots(engine, plain);
  EXPECT_LE(lacked, kMost) << "of " << all;
}

// As engines ship them.
void biased(RasterOptions& options, int bits, double constant, double slope) {
  options.shadow.bits = bits;
  options.shadow.depthBiasConstant = constant;
  options.shadow.depthBiasSlope = slope;
}

const EngineFrame kFrames[] = {
    {"D16", [](RasterOptions& o) { biased(o, 16, 4, 3); }},
    {"NormalOffset",
     [](RasterOptions& o) {
       biased(o, 16, 80, 0);  // 2.5 texels of a map of 2048 around the model
       o.shadow.normalOffset = 2.5;
     }},
    {"Filtered",
     [](RasterOptions& o) {
       biased(o, 32, 1.25, 1.75);
       o.shadow.filter = 7;
     }},
    {"Jittered",
     [](RasterOptions& o) {
       biased(o, 16, 4, 3);
       o.shadow.filter = 1;
       o.jitter = {0.37, -0.21};
     }},
};

INSTANTIATE_TEST_SUITE_P(Habits, EngineSpots, testing::ValuesIn(kFrames),
                         [](const auto& frame) { return std::string(frame.param.name); });

}  // namespace
}  // namespace pellucid::test
