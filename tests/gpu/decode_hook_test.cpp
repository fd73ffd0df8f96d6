// A library whose shaders have engine_decode.glsl in place of compute/frame/gbuffer_decode.glsl.
#include <cmath>

#include "gpu_fixture.h"

namespace pellucid::test {
namespace {

using DecodeHook = GpuTest;

TEST_F(DecodeHook, EnginesOwnEncodingsGiveTheSlabsAnswer) {
  Capture c = flatCapture(32, 24);
  c.lights.push_back(backLight());
  for (size_t i = 0; i < c.irradiance.pixels(); ++i) {
    c.frontDepth.image.data[i] *= -1;
    c.backDepth.image.data[i] *= -1;
    c.material[i] = i % 32 < 8 ? 255 : 254;  // none, the first
  }
  ReplaySettings s;
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  s.translucency.gatherSamples = 0;
  s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const PellucidMaterial material = testMaterial();
  const Image out = replay(c, material, s);
  const double t[3] = {std::exp(-0.5), std::exp(-1), 0.7 * std::exp(-2) + 0.3 * std::exp(-0.25)};
  for (size_t i = 0; i < out.pixels(); ++i)
    for (size_t k = 0; k < 3; ++k) {
      const double irradiance = double(c.irradiance.data[3 * i + k]);
      const double expected = irradiance + (i % 32 < 8 ? 0 : t[k] * 3 / double(material.reflectance[k]));
      // Depths of 10 and 11 units differ by floats' rounding, which is 1e-6 of a unit.
      ASSERT_NEAR(double(out.data[4 * i + k]), expected, 1e-5) << "pixel " << i << ", channel " << k;
    }
}

}  // namespace
}  // namespace pellucid::test
