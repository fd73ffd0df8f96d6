// Camera-space thickness on the GPU against the closed forms of the procedural scenes.
#include "gpu_fixture.h"

#include <ostream>

#include "scene/scene.h"

namespace {

using namespace pellucid::test;

struct Solid {
  const char* name;
  bool orthographic = false;
  PellucidDepthEncoding depth = PELLUCID_DEPTH_VIEW_Z;
  bool reversedZ = false;
};

// GoogleTest would print the bytes.
void PrintTo(const Solid& value, std::ostream* out) { *out << value.name; }

class ExactThickness : public GpuTest, public testing::WithParamInterface<Solid> {};

constexpr int kSide = 128;

// Thickness goes to 0 at silhouettes and the relative error without bound: a pixel counts when it and all
// within two pixels show the solid, and no thinner than a quarter of a millimeter.
bool isAwayFromSilhouettes(const Image& exact, int x, int y) {
  constexpr int kReach = 2;
  constexpr float kThinnest = 0.25f;  // mm
  if (x < kReach || y < kReach || x >= exact.width - kReach || y >= exact.height - kReach) return false;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx)
      if (!(*exact.at(x + dx, y + dy) >= kThinnest)) return false;
  return true;
}

TEST_P(ExactThickness, IsTheLengthOfTheViewRayInside) {
  const SceneParameters p{.name = GetParam().name,
                          .width = kSide,
                          .height = kSide,
                          .orthographic = GetParam().orthographic,
                          .reversedZ = GetParam().reversedZ,
                          .depthEncoding = GetParam().depth,
                          .shadowSize = 16};
  Image exact;
  const Capture capture = makeScene(p, &exact);
  ReplaySettings settings = inFloats();
  settings.debugView = PELLUCID_DEBUG_THICKNESS;
  const Image gpu = replay(capture, testMaterial(), settings);
  double worst = 0;
  int count = 0;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      if (!isAwayFromSilhouettes(exact, x, y)) continue;
      const double truth = static_cast<double>(*exact.at(x, y));
      worst = std::max(worst, std::abs(static_cast<double>(*gpu.at(x, y)) - truth) / truth);
      ++count;
    }
  // Each depth is a float near 160 mm, 8e-6 mm off at most; 0.25 mm of thickness makes that 6e-5.
  EXPECT_LT(worst, 1e-4);
  EXPECT_GT(count, kSide * kSide / 20) << "too few pixels to say anything";
  RecordProperty("worst", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExactThickness,
                         testing::Values(Solid{"slab"}, Solid{"wedge"}, Solid{"sphere"},
                                         Solid{"hollow_sphere"}, Solid{"torus"}, Solid{"two_sheets"},
                                         Solid{"slab", true}, Solid{"wedge", true}, Solid{"sphere", true},
                                         Solid{"hollow_sphere", true}, Solid{"torus", true},
                                         Solid{"two_sheets", true},
                                         Solid{"slab", false, PELLUCID_DEPTH_DEVICE, true},
                                         Solid{"wedge", false, PELLUCID_DEPTH_DEVICE, true},
                                         Solid{"sphere", false, PELLUCID_DEPTH_DEVICE, true},
                                         Solid{"hollow_sphere", false, PELLUCID_DEPTH_DEVICE, true},
                                         Solid{"torus", false, PELLUCID_DEPTH_DEVICE, true},
                                         Solid{"two_sheets", false, PELLUCID_DEPTH_DEVICE, true}),
                         [](const auto& test) {
                           return std::string(test.param.name) +
                                  (test.param.orthographic ? "Orthographic" : "Perspective") +
                                  (test.param.depth == PELLUCID_DEPTH_DEVICE ? "DeviceDepth" : "");
                         });

}  // namespace
