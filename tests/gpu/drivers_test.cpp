// Another driver against the one that all other tests run on: every option at each number of samples, on
// captures of some thousand pixels. `./run driver` names the other one; without a name there is nothing to
// compare.
#include <gtest/gtest.h>

#include <cstdlib>

#include "capture/material.h"
#include "gpu_fixture.h"
#include "scene/scene.h"
#include "stress/measures.h"

namespace {

using namespace pellucid::test;

constexpr const char* kVariable = "PELLUCID_OTHER_DEVICE";

struct Option {
  const char* name;
  void (*change)(ReplaySettings& settings, Capture& capture);
  // The largest difference of a value from llvmpipe's, over the larger of the two or 1e-3 of a white pixel,
  // at all but one pixel in a thousand. Halves are apart by 1e-3, and a pass of the diffusion keeps them.
  // Samples at the border of two texels fall either way: one of 16 that does so is .004 of a pixel's light.
  double tolerance = 5e-3;
};

constexpr Option kOptions[] = {
    {"as it is", [](ReplaySettings&, Capture&) {}},
    {"32 bits", [](ReplaySettings& s, Capture&) { s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT; }},
    {"packed floats", [](ReplaySettings& s, Capture&) { s.outputFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32; },
     0.04},  // blue keeps 5 bits
    {"no lists", [](ReplaySettings& s, Capture&) { s.indirectDispatches = 0; }},
    {"cells of 2 pixels", [](ReplaySettings& s, Capture&) { s.translucency.gatherSpacing = 2; }},
    {"cells of 4 pixels", [](ReplaySettings& s, Capture&) { s.translucency.gatherSpacing = 4; }},
    {"64 samples", [](ReplaySettings& s, Capture&) { s.translucency.gatherSamples = 64; }},
    {"camera thickness", [](ReplaySettings& s, Capture&) { s.translucency.cameraThickness = 1; }},
    {"translucency alone", [](ReplaySettings& s, Capture&) { s.features = PELLUCID_FEATURE_TRANSLUCENCY; },
     8e-3},  // no irradiance beside it
    {"diffusion alone", [](ReplaySettings& s, Capture&) { s.features = PELLUCID_FEATURE_DIFFUSION; }},
    {"in place", [](ReplaySettings& s, Capture&) { s.aliasOutput = true; }},
    {"a rect",
     [](ReplaySettings& s, Capture&) {
       s.renderRect = {7, 5, 61, 50};
     }},
    {"a material mask",
     [](ReplaySettings& s, Capture&) {
       s.materialShift = 8;
       s.materialMask = 0xFF00;
     }},
    {"pre-exposure", [](ReplaySettings& s, Capture&) { s.preExposure = 0.25f; }},
    {"reuse", [](ReplaySettings& s, Capture&) { s.reuse = PELLUCID_REUSE_ALTERNATE; }},
    {"no albedo", [](ReplaySettings&, Capture& c) { c.albedo = {}; }},
    {"no back depth", [](ReplaySettings&, Capture& c) { c.backDepth.image = {}; }},
    {"no shadow map", [](ReplaySettings&, Capture& c) { c.lights.at(0).shadowMaps.clear(); }},
    {"linear transmittance",
     [](ReplaySettings& s, Capture&) { s.transmittance = TransmittanceChoice::Linear; }},
    {"Gaussian transmittance",
     [](ReplaySettings& s, Capture&) { s.transmittance = TransmittanceChoice::Gaussians; }},
    {"inverse cosine",
     [](ReplaySettings& s, Capture&) { s.translucency.angleModel = PELLUCID_ANGLE_INVERSE_COSINE; }},
    {"thickness shown", [](ReplaySettings& s, Capture&) { s.debugView = PELLUCID_DEBUG_THICKNESS; }},
    {"transmittance shown", [](ReplaySettings& s, Capture&) { s.debugView = PELLUCID_DEBUG_TRANSMITTANCE; }},
    {"occlusion shown", [](ReplaySettings& s, Capture&) { s.debugView = PELLUCID_DEBUG_OCCLUSION; }},
    {"irradiance shown", [](ReplaySettings& s, Capture&) { s.debugView = PELLUCID_DEBUG_IRRADIANCE; }}};

// A driver with the contexts that captures ask for.
struct Driver {
  Device device;
  Replayer replayer{device};

  explicit Driver(const char* name) : device({name, true}) {}
};

// The value that all but one in a thousand of the pixels' worst channels stay below.
double difference(const Capture& c, const Image& a, const Image& b) {
  std::vector<double> worst;
  const auto channels = static_cast<size_t>(a.channels);
  for (size_t i = 0; i < a.pixels(); ++i) {
    if (c.material[i] == 0) continue;
    double most = 0;
    for (size_t k = 0; k < 3; ++k) {
      const double x = static_cast<double>(a.data[i * channels + k]),
                   y = static_cast<double>(b.data[i * channels + k]);
      most = std::max(most, std::abs(x - y) / std::max({std::abs(x), std::abs(y), stress::kFloor}));
    }
    worst.push_back(std::isnan(most) ? INFINITY : most);
  }
  EXPECT_GT(worst.size(), 1000u);
  std::sort(worst.begin(), worst.end());
  return worst[worst.size() * 999 / 1000];
}

Capture capture(std::optional<PellucidLightType> light) {
  return makeScene({.name = "ear", .width = 72, .height = 72, .lightType = light, .shadowSize = 128});
}

TEST(Drivers, AgreeOnEveryOptionAndRepeatEachBit) {
  const char* other = std::getenv(kVariable);
  if (!other || !*other)
    GTEST_SKIP() << kVariable << " names no other device: ./run driver swiftshader sets it";
  Driver first("llvmpipe"), second(other);
  double worst = 0;
  for (const std::optional<PellucidLightType> light :
       {std::optional<PellucidLightType>(), std::optional(PELLUCID_LIGHT_SPOT)}) {
    const Capture whole = capture(light);
    const std::vector<PellucidMaterial> materials = compileMaterials(whole);
    for (const Option& option : kOptions)
      for (const uint32_t samples : {0u, 8u, 16u}) {
        SCOPED_TRACE(std::string(option.name) + (light ? ", spot light" : ", directional light") + ", " +
                     std::to_string(samples) + " samples");
        ReplaySettings settings;
        settings.translucency.gatherSamples = samples;
        Capture c = whole;
        option.change(settings, c);
        const Image expected = first.replayer.run(c, materials, settings).output;
        const Image output = second.replayer.run(c, materials, settings).output;
        EXPECT_TRUE(sameBits(output, second.replayer.run(c, materials, settings).output)) << "repeated";
        const double apart = difference(c, output, expected);
        // A sample that rounding moves over a texel's border brings other light.
        const double tolerance = (samples > 0 ? 2 : 1) * option.tolerance;
        EXPECT_LT(apart, tolerance);
        worst = std::max(worst, apart / tolerance);
      }
  }
  std::printf("worst difference: %.2g of its tolerance\n", worst);
  for (const Driver* driver : {&first, &second})
    for (const std::string& message : driver->device.validationMessages()) ADD_FAILURE() << message;
}

}  // namespace
