// Depths that are none, at pixels that have a material: there is nothing, in every encoding and pass.
#include "gpu_fixture.h"

#include <limits>

namespace {

using namespace pellucid::test;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

// Lit unevenly, with a light behind and its map.
Capture scene(bool deviceDepth) {
  constexpr int kSize = 80;
  Capture c = perspectiveCapture(kSize);
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      for (int k = 0; k < 3; ++k)
        c.irradiance.at(x, y)[k] =
            static_cast<float>((x / 9 + y / 7) % 2) + 0.1f * static_cast<float>((x * 7 + y * 13) % 5);
  c.lights = {backLight()};
  c.lights[0].shadowMaps = {flatShadowMap(-11, PELLUCID_DEPTH_VIEW_Z, 32)};
  if (!deviceDepth) return c;
  // Reversed and infinite: .1 / planar distance.
  c.frontDepth.encoding = PELLUCID_DEPTH_DEVICE;
  for (float& depth : c.frontDepth.image.data) depth = 0.1f / depth;
  return c;
}

TEST_F(GpuTest, DepthsThatAreNoneAreNothingThere) {
  for (const bool device : {true, false}) {
    const float nothing = device ? 0.0f : -1.0f;
    for (const uint32_t samples : {0u, 8u}) {
      Capture c = scene(device);
      ReplaySettings s;
      s.translucency.gatherSamples = samples;
      const auto at = [&](float depth) {
        for (const auto& [x, y] : {std::pair(40, 41), std::pair(55, 70), std::pair(56, 70)})
          c.frontDepth.image.at(x, y)[0] = depth;
        return replay(c, testMaterial(), s);
      };
      const Image expected = at(nothing);
      for (const float v : expected.data) ASSERT_TRUE(std::isfinite(v) && v >= 0);
      // The smallest depths are nearer to 0 than any distance is far.
      for (const float depth :
           {kInfinity, -kInfinity, kNan, -2.0f, device ? 1e-40f : 2e9f, device ? 1e-12f : 1e38f})
        EXPECT_TRUE(sameBits(at(depth), expected))
            << depth << ", device " << device << ", samples " << samples;
    }
  }
}

}  // namespace
