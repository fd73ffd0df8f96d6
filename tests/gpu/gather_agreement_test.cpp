// The GPU's samples against the float64 gather over all texels, and what maps and conventions cost.
#include "all_texels.h"
#include "gpu_fixture.h"

#include <cstdio>
#include <functional>
#include <map>

#include "common/compare.h"
#include "pellucid/pellucid_material.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

// Diffusion leaves constant irradiance alone on both sides, so that what remains is the gather.
Capture evenlyLit(SceneParameters p, float irradiance = 0.2f) {
  Capture c = makeScene(p);
  std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), irradiance);
  c.albedo = {};
  return c;
}

// The same, over all texels. Diffusion, where any, is the GPU's own: what is compared is the gather.
Image gatherOfAllTexels(const Capture& c, const Image& diffused,
                        const std::function<bool(int, int)>& wanted) {
  return allTexels(c, std::vector<PellucidMaterial>(c.materials.size(), skin()), diffused, wanted);
}

// Relative RMSE of 4x4 averages, the worst channel.
double error(const Capture& c, const Image& a, const Image& b) {
  double worst = 0;
  for (const auto& channel :
       compareImages(a, b, comparisonMask(c.material, c.irradiance, Subset::All), 4).channels)
    worst = std::max(worst, channel.relativeRmse);
  return worst;
}

class GatherAgreement : public GpuTest {
protected:
  static Image gathered(const Capture& c, uint32_t samples = 8, uint32_t spacing = 0) {
    const std::vector<PellucidMaterial> materials(c.materials.size(), skin());
    return rgb(replayer().run(c, materials, gathering(samples, spacing)).output);
  }
};

TEST_F(GatherAgreement, SixteenSamplesAreNearAllTexels) {
  const SceneParameters conventions[] = {{.name = "sphere",
                                          .options = {{"radius", 8}, {"extent", 20}, {"lightAngle", 80}},
                                          .orthographic = false,
                                          .reversedZ = true,
                                          .infiniteFar = true,
                                          .depthEncoding = PELLUCID_DEPTH_DEVICE,
                                          .lightType = PELLUCID_LIGHT_POINT,
                                          .shadowEncoding = PELLUCID_DEPTH_DEVICE},
                                         {.name = "torus",
                                          .options = {{"majorRadius", 8}, {"extent", 26}},
                                          .orthographic = true,
                                          .depthEncoding = PELLUCID_DEPTH_VIEW_Z,
                                          .lightType = PELLUCID_LIGHT_DIRECTIONAL,
                                          .shadowEncoding = PELLUCID_DEPTH_VIEW_Z},
                                         {.name = "wedge",
                                          .options = {{"extent", 24}},
                                          .orthographic = true,
                                          .reversedZ = true,
                                          .depthEncoding = PELLUCID_DEPTH_DEVICE,
                                          .lightType = PELLUCID_LIGHT_DIRECTIONAL,
                                          .shadowEncoding = PELLUCID_DEPTH_DEVICE},
                                         {.name = "slab",
                                          .options = {{"thickness", 2}, {"tilt", 35}, {"extent", 24}},
                                          .orthographic = false,
                                          .depthEncoding = PELLUCID_DEPTH_VIEW_Z,
                                          .lightType = PELLUCID_LIGHT_SPOT,
                                          .shadowEncoding = PELLUCID_DEPTH_DISTANCE}};
  for (SceneParameters p : conventions) {
    p.width = p.height = 64;
    p.shadowSize = 160;
    Capture c = evenlyLit(p);
    // The picture lies in the penumbra of a light with a table of its own.
    for (Light& light : c.lights) {
      light.innerConeAngle = 0;
      for (int i = 0; light.type == PELLUCID_LIGHT_SPOT && i < PELLUCID_LIGHT_TABLE_ENTRIES; ++i)
        light.angleTable.push_back(std::max(0.0, 1 - 8.0 * i / (PELLUCID_LIGHT_TABLE_ENTRIES - 1)));
    }
    // Every eighth of the blocks that error() averages, along each row another one.
    const auto wanted = [](int x, int y) { return (x / 4 + 3 * (y / 4)) % 8 == 0; };
    const Image all = gatherOfAllTexels(c, c.irradiance, wanted);
    Capture compared = c;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x)
        if (!wanted(x, y)) compared.material[static_cast<size_t>(y * c.width + x)] = 0;
    EXPECT_LT(error(compared, gathered(c, 16), all), 0.035) << p.name;
  }
}

// A plane that faces the light and the camera gets nothing from itself, at grazing light, with coarse maps
// and rounded depths, with and without a bias.
TEST_F(GatherAgreement, LitPlanesDoNotGlow) {
  for (const double angle : {150.0, 100.0})
    for (const int shadowSize : {64, 256}) {
      const SceneParameters p{.name = "slab",
                              .width = 64,
                              .height = 64,
                              .options = {{"thickness", 20}, {"lightAngle", angle}, {"extent", 24}},
                              .orthographic = true,
                              .depthEncoding = PELLUCID_DEPTH_DEVICE,
                              .shadowSize = shadowSize,
                              .shadowEncoding = PELLUCID_DEPTH_DEVICE};
      Capture c = evenlyLit(p, static_cast<float>(std::cos((180 - angle) * M_PI / 180)));
      for (float& v : c.lights.at(0).shadowMaps.at(0).depth.image.data) v = std::round(v * 65535) / 65535;
      for (float& v : c.frontDepth.image.data) v = std::round(v * 65535) / 65535;
      const Image out = gathered(c, 16);
      for (int x = 24; x < 40; ++x)
        for (int k = 0; k < 3; ++k)
          EXPECT_NEAR(out.at(x, 32)[k], c.irradiance.at(x, 32)[k], 0.01f * c.irradiance.at(x, 32)[k])
              << angle << " degrees, " << shadowSize << " texels";
    }
}

// A convex cross-section has no air in it: its own exit takes nothing, though cells of 4 pixels read coarse levels of the entry points.
TEST_F(GatherAgreement, ABodyIsNotBeyondItsOwnExit) {
  for (const char* name : {"torus", "sphere"}) {
    const Capture c = evenlyLit({.name = name, .width = 24, .height = 24, .shadowSize = 512}, 0);
    Capture open = c;
    open.lights.at(0).shadowMaps.at(0).exitDepth = {};
    EXPECT_LT(relativeRmse(gathered(c, 8, 4), gathered(open, 8, 4)), 2e-3) << name;
  }
}

// No grain: neighbors take other samples, and flat parts must not show it.
TEST_F(GatherAgreement, FlatPartsAreSmooth) {
  for (const double tilt : {0.0, 40.0}) {
    const SceneParameters p{.name = "slab",
                            .width = 96,
                            .height = 96,
                            .options = {{"thickness", 2}, {"tilt", tilt}, {"extent", 24}},
                            .shadowSize = 256};
    const Capture c = evenlyLit(p, 0);
    const Image out = gathered(c, 8);
    for (int k = 0; k < 3; ++k) {
      double sum = 0, square = 0;
      for (int y = 40; y < 48; ++y)
        for (int x = 40; x < 48; ++x) {
          const double v = out.at(x, y)[k];
          sum += v;
          square += v * v;
        }
      const double mean = sum / 64, deviation = std::sqrt(std::max(0.0, square / 64 - mean * mean));
      // Light at 60 degrees to the tilted plane: rings around an axis between the two are not quite even.
      EXPECT_LT(deviation, (tilt > 0 ? 0.02 : 0.002) * mean) << tilt;
    }
  }
}

// The same frame in another unit of length.
Capture inUnitsOf(double meters, Capture c) {
  const double scale = c.metersPerUnit / meters;
  const auto scaleDepth = [&](Image& image) {
    for (float& v : image.data)
      if (v < kNoDepth) v *= static_cast<float>(scale);
  };
  const auto scaleClip = [&](Matrix& m) {
    for (size_t i = 12; i < 16; ++i) m[i] *= scale;
    if (m[3] == 0 && m[7] == 0 && m[11] == 0)  // orthographic: w is 1
      for (double& v : m) v /= scale;
  };
  const auto scaleView = [&](Matrix& m) {
    for (size_t i = 12; i < 15; ++i) m[i] *= scale;
  };
  c.metersPerUnit = meters;
  scaleClip(c.clipFromView);
  scaleView(c.viewFromWorld);
  scaleDepth(c.frontDepth.image);
  scaleDepth(c.backDepth.image);
  for (Light& light : c.lights) {
    for (double& v : light.position) v *= scale;
    if (light.type != PELLUCID_LIGHT_DIRECTIONAL) light.intensity *= scale * scale;
    for (ShadowMap& map : light.shadowMaps) {
      scaleClip(map.clipFromWorld);
      scaleView(*map.viewFromWorld);
      scaleDepth(map.depth.image);
      scaleDepth(map.exitDepth);
    }
  }
  return c;
}

// A shell, whose maps have exits into its hollow, is the same picture in any unit of length.
TEST_F(GatherAgreement, UnitsOfLengthChangeNothing) {
  for (const auto light : {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT}) {
    const Capture c = evenlyLit({.name = "hollow_sphere",
                                 .width = 64,
                                 .height = 64,
                                 .options = {{"radius", 8}, {"extent", 20}, {"lightAngle", 80}},
                                 .lightType = light,
                                 .shadowSize = 192});
    const Image plain = gathered(c, 16);
    // Powers of two round nothing.
    for (const double meters : {0.001 * 64, 0.001 / 64})
      EXPECT_LT(error(c, gathered(inUnitsOf(meters, c), 16), plain), 1e-5)
          << "light " << light << ", units of " << meters << " m";
  }
}

// With reuse, frames that compute and frames that keep are what frames without it are.
TEST_F(GatherAgreement, KeptPointsDisplaceToo) {
  const Capture c = evenlyLit({.name = "sphere",
                               .width = 64,
                               .height = 64,
                               .options = {{"radius", 8}, {"extent", 20}, {"lightAngle", 60}},
                               .shadowSize = 192});
  for (const uint32_t spacing : {1u, 4u}) {
    ReplaySettings s = gathering(8, spacing);
    const Image expected = replay(c, skin(), s);
    s.reuse = PELLUCID_REUSE_ALTERNATE;
    Sequence sequence;
    for (int i = 0; i < 2; ++i) {
      const Image out = sequence.run(c, skin(), s);
      EXPECT_EQ(sequence.last->plan().historyAge, static_cast<uint32_t>(i));
      for (size_t k = 0; k < out.data.size(); ++k)
        ASSERT_NEAR(out.data[k], expected.data[k], 1e-6f) << "spacing " << spacing << " frame " << i;
    }
  }
}

// From lit to unlit across the terminator, in light from all around: no gap and no seam.
TEST_F(GatherAgreement, TerminatorIsContinuous) {
  for (const auto& [name, angles] : {std::pair("sphere", std::array{90.0, 150.0}), {"torus", {30.0, 90.0}}})
    for (const double angle : angles) {
      SceneParameters p{.name = name, .options = {{"extent", 24}, {"lightAngle", angle}}};
      if (p.name == "sphere")
        p.options["radius"] = 8;
      else
        p.options["majorRadius"] = 8;
      p.width = p.height = 96;
      p.shadowSize = 256;  // 13 texels a mean free path
      p.orthographic = true;
      Capture c = makeScene(p);
      c.albedo = {};
      ReplaySettings spread = inFloats(PELLUCID_FEATURE_DIFFUSION);
      const Image all =
          gatherOfAllTexels(c, rgb(replay(c, skin(), spread)), [](int, int y) { return y == 48; });
      const Image gpu = gathered(c, 16);
      // Along the middle row, inside the outline: the largest second difference relative to the peak.
      double worstGpu[3] = {}, worstAll[3] = {}, peak[3] = {};
      for (int x = 2; x < 94; ++x) {
        bool inside = true;
        for (int i = -2; i <= 2; ++i)
          inside = inside && c.material[static_cast<size_t>(48 * 96 + x + i)] != 0;
        if (!inside) continue;
        for (int k = 0; k < 3; ++k) {
          const auto second = [&](const Image& image) {
            return std::abs(static_cast<double>(image.at(x - 1, 48)[k]) -
                            2 * static_cast<double>(image.at(x, 48)[k]) +
                            static_cast<double>(image.at(x + 1, 48)[k]));
          };
          worstGpu[k] = std::max(worstGpu[k], second(gpu));
          worstAll[k] = std::max(worstAll[k], second(all));
          peak[k] = std::max(peak[k], static_cast<double>(all.at(x, 48)[k]));
        }
      }
      // Half as much again for 16 samples, and 16 % of the peak for what neighboring points differ by: red light through the
      // torus at 30 degrees has 15 %, where a quad of the silhouette meets the next.
      for (int k = 0; k < 3; ++k) EXPECT_LT(worstGpu[k], 1.5 * worstAll[k] + 0.16 * peak[k]) << name << angle;
    }
}

// ---- The gather is linear in light: lights add up, and light that no gathered light brings stays as it is.

// Made once: the head takes longer than the passes over it.
const Capture& head(const std::map<std::string, double>& options) {
  static std::map<std::map<std::string, double>, Capture> made;
  if (const auto found = made.find(options); found != made.end()) return found->second;
  Capture c = makeScene({.name = "head", .width = 96, .height = 72, .options = options, .shadowSize = 128});
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

TEST_F(GatherAgreement, TwoLightsAddUp) {
  const Capture both = head({});
  ASSERT_EQ(both.lights.size(), 2u);
  const Capture key = only(both, 0, {{"rimLight", 0}}), rim = only(both, 1, {{"keyLight", 0}});
  for (const uint32_t spacing : {1u, 4u}) {
    const Difference d = difference(both, gathered(both, 8, spacing),
                                    sum(gathered(key, 8, spacing), gathered(rim, 8, spacing)));
    EXPECT_LT(d.rmse, kSumRmse);
    EXPECT_LT(d.worst, kSumWorst);
  }
}

// Curved surfaces return the same share of light with and without lights: a light of next to nothing leaves
// skin under even light as it is. The light's irradiance is not in the image, and its transmitted light is
// below the last half.
TEST_F(GatherAgreement, ALightOfNextToNothingChangesNothing) {
  Capture dark = head({{"rimLight", 0}});
  std::fill(dark.irradiance.data.begin(), dark.irradiance.data.end(), 0.25f);
  Capture none = dark;
  none.lights.clear();
  for (const uint32_t spacing : {1u, 4u}) {
    dark.lights.front().intensity = 0;
    const Image expected = gathered(dark, 8, spacing);
    EXPECT_LT(difference(dark, gathered(none, 8, spacing), expected).worst, 0x1p-11);
    for (const bool mapped : {true, false}) {
      Capture lit = dark;
      lit.lights.front().intensity = 1e-6;
      if (!mapped) lit.lights.front().shadowMaps.clear();
      const Difference d = difference(dark, gathered(lit, 8, spacing), expected);
      EXPECT_LT(d.worst, 0x1p-11) << "spacing " << spacing << ", mapped " << mapped;
    }
  }
  // And curvature does return more and less than a plane.
  const Image out = gathered(dark, 8, 1);
  EXPECT_GT(*std::max_element(out.data.begin(), out.data.end()), 0.25f * 1.02f);
}

// The key light as nine of a ninth each, which need two groups: eight shadow images are a dispatch's.
TEST_F(GatherAgreement, ManyLightsInSeveralGroupsAddUp) {
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
TEST_F(GatherAgreement, AmbientLightStays) {
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
TEST_F(GatherAgreement, ThinSlabsReturnLess) {
  for (const double thickness : {0.5, 2.0}) {
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

// More lights than a dispatch binds: light adds up, and each keeps its own cone.
TEST_F(GpuTest, GatheredLightsOfSeveralDispatchesAddUp) {
  const Capture one = evenlyLit(
      {.name = "sphere", .width = 32, .height = 32, .lightType = PELLUCID_LIGHT_SPOT, .shadowSize = 32}, 0);
  ReplaySettings s = gathering(8);
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const auto added = [&](int first, int count) {
    Capture c = one;
    c.lights.clear();
    for (int i = first; i < first + count; ++i) {
      Light light = one.lights.at(0);
      light.outerConeAngle *= 1 - 0.05 * i;
      light.innerConeAngle *= 1 - 0.05 * i;
      c.lights.push_back(light);
    }
    return rgb(replay(c, testMaterial(), s));
  };
  const Image all = added(0, 16), near = added(0, 8), far = added(8, 8);
  float most = 0;
  for (std::size_t i = 0; i < all.data.size(); ++i) {
    // Probes hold halves.
    ASSERT_NEAR(all.data[i], near.data[i] + far.data[i], 2e-3f * (0.2f + all.data[i])) << i;
    most = std::max(most, far.data[i]);
  }
  EXPECT_GT(most, 0.1f);
}

}  // namespace
