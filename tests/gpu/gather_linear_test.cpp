// The gather is linear in light: lights add up, light that no gathered light brings stays as it is, and thin
// parts return what a slab of their thickness does.
#include "gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "capture/material.h"
#include "pellucid/pellucid_material.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

const PellucidMaterial& skin() {
  static const PellucidMaterial compiled = compileMaterial(PresetMaterial{"skin1"}, "skin1");
  return compiled;
}

class GatherLinear : public GpuTest {
protected:
  static Image gathered(const Capture& c, uint32_t spacing = 0) {
    ReplaySettings s = inFloats();
    s.translucency.gatherSamples = 8;
    s.translucency.gatherSpacing = spacing;
    return rgb(replayer().run(c, std::vector<PellucidMaterial>(c.materials.size(), skin()), s).output);
  }
};

// Made once: the head takes longer than the passes over it.
const Capture& head(const std::map<std::string, double>& options) {
  static std::map<std::map<std::string, double>, Capture> made;
  if (const auto found = made.find(options); found != made.end()) return found->second;
  Capture c = makeScene({.name = "head", .width = 160, .height = 90, .options = options, .shadowSize = 256});
  c.albedo = {};
  return made.emplace(options, std::move(c)).first->second;
}

// The scene's light of index `light` alone, and what it brings to the irradiance.
Capture only(const Capture& both, size_t light, const std::map<std::string, double>& options) {
  Capture c = head(options);
  c.lights = {both.lights.at(light)};
  return c;
}

// Relative RMSE of a from b over the material pixels, and the largest difference over the RMS.
struct Difference {
  double rmse, worst;
};
Difference difference(const Capture& c, const Image& a, const Image& b) {
  double square = 0, power = 0, worst = 0;
  for (size_t i = 0; i < a.pixels(); ++i) {
    if (c.material[i] == 0) continue;
    for (size_t k = 0; k < 3; ++k) {
      const double d = double(a.data[3 * i + k]) - double(b.data[3 * i + k]), v = double(b.data[3 * i + k]);
      square += d * d;
      power += v * v;
      worst = std::max(worst, std::abs(d));
    }
  }
  const double count = 3.0 * static_cast<double>(std::count_if(c.material.begin(), c.material.end(),
                                                               [](uint8_t m) { return m != 0; }));
  return {std::sqrt(square / power), worst / std::sqrt(power / count)};
}

Image sum(const Image& a, const Image& b) {
  Image result = a;
  for (size_t i = 0; i < a.data.size(); ++i) result.data[i] += b.data[i];
  return result;
}

// Halves in the pyramid and of points round to .0005 each; a kink at 0 may add to one pixel.
constexpr double kSumRmse = 2e-3, kSumWorst = 1e-2;

TEST_F(GatherLinear, TwoLightsAddUp) {
  const Capture both = head({});
  ASSERT_EQ(both.lights.size(), 2u);
  const Capture key = only(both, 0, {{"rimLight", 0}}), rim = only(both, 1, {{"keyLight", 0}});
  for (const uint32_t spacing : {1u, 4u}) {
    const Difference d =
        difference(both, gathered(both, spacing), sum(gathered(key, spacing), gathered(rim, spacing)));
    std::printf("spacing %u: relative RMSE from the sum %.5f, worst %.4f\n", spacing, d.rmse, d.worst);
    EXPECT_LT(d.rmse, kSumRmse);
    EXPECT_LT(d.worst, kSumWorst);
  }
  Capture swapped = both;
  std::swap(swapped.lights[0], swapped.lights[1]);
  EXPECT_LT(difference(both, gathered(swapped), gathered(both)).rmse, 1e-3);
}

// Curved surfaces return the same share of light with and without lights: a light of next to nothing leaves
// skin under even light as it is. The light's irradiance is not in the image, and its transmitted light is
// below the last half.
TEST_F(GatherLinear, ALightOfNextToNothingChangesNothing) {
  Capture dark = head({{"rimLight", 0}});
  std::fill(dark.irradiance.data.begin(), dark.irradiance.data.end(), 0.25f);
  for (const uint32_t spacing : {1u, 2u, 4u})
    for (const bool mapped : {true, false}) {
      Capture lit = dark;
      dark.lights.front().intensity = 0;
      lit.lights.front().intensity = 1e-6;
      if (!mapped) lit.lights.front().shadowMaps.clear();
      const Difference d = difference(dark, gathered(lit, spacing), gathered(dark, spacing));
      EXPECT_LT(d.worst, 0x1p-11) << "spacing " << spacing << ", mapped " << mapped;
      Capture none = dark;
      none.lights.clear();
      EXPECT_LT(difference(dark, gathered(none, spacing), gathered(dark, spacing)).worst, 0x1p-11);
    }
  // And curvature does return more and less than a plane.
  const Image out = gathered(dark, 1);
  EXPECT_GT(*std::max_element(out.data.begin(), out.data.end()), 0.25f * 1.02f);
}

// The key light as nine of a ninth each, which need two groups: eight shadow images are a dispatch's.
TEST_F(GatherLinear, ManyLightsInSeveralGroupsAddUp) {
  const Capture one = head({{"rimLight", 0}});
  Capture many = one;
  Light part = one.lights.at(0);
  part.intensity /= 9;
  many.lights.assign(9, part);
  const Difference d = difference(one, gathered(many), gathered(one));
  EXPECT_LT(d.rmse, kSumRmse);
  EXPECT_LT(d.worst, kSumWorst);
}

// Sky, bounces and lights that are not gathered come back as the diffusion and the surface's curvature say,
// whatever the gathered lights are.
TEST_F(GatherLinear, AmbientLightStays) {
  const Capture lit = head({});
  Capture withAmbient = lit, ambient = lit;
  for (float& e : withAmbient.irradiance.data) e += 1;
  std::fill(ambient.irradiance.data.begin(), ambient.irradiance.data.end(), 1.0f);
  for (Light& light : ambient.lights) light.intensity = 1e-9;  // curvature is the gather's
  const Difference d = difference(lit, gathered(withAmbient), sum(gathered(lit), gathered(ambient)));
  EXPECT_LT(d.rmse, kSumRmse);
  EXPECT_LT(d.worst, kSumWorst);
}

// Lit from the front, a slab sends back R(h) and no half-space's rho.
TEST_F(GatherLinear, ThinSlabsReturnLess) {
  for (const double thickness : {0.5, 1.0, 2.0, 4.0}) {
    Capture c = makeScene({.name = "slab",
                           .width = 48,
                           .height = 48,
                           .options = {{"thickness", thickness}, {"lightAngle", 180}, {"extent", 12}},
                           .orthographic = true,
                           .shadowSize = 256});
    c.albedo = {};
    const Image out = gathered(c);
    PellucidSlab slab, half;
    const double scattering[3] = {0.74, 0.88, 1.01}, absorption[3] = {0.032, 0.17, 0.48};  // skin1
    for (int k = 0; k < 3; ++k) {
      ASSERT_EQ(pellucidSlabTransport(scattering[k], absorption[k], 1.4, thickness, &slab, nullptr, nullptr),
                PELLUCID_OK);
      ASSERT_EQ(pellucidSlabTransport(scattering[k], absorption[k], 1.4, INFINITY, &half, nullptr, nullptr),
                PELLUCID_OK);
      const double ratio = double(out.at(24, 24)[k]) / double(c.irradiance.at(24, 24)[k]);
      // Kubelka & Munk's R of T is within .045 of exact transport for skin of .5 mm and more; the rest is
      // samples.
      EXPECT_NEAR(ratio, slab.reflectance / half.reflectance, 0.06) << thickness << " mm, channel " << k;
    }
  }
}

}  // namespace
