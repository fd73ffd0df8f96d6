// Light from all around through thin parts: the closed form of a slab, and the float64 reference.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "gpu_fixture.h"
#include "reference_frame.h"
#include "scene/environment.h"
#include "scene/scene.h"

namespace pellucid::test {
namespace {

using AmbientLight = GpuTest;

ReplaySettings through() {
  ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
  s.translucency.gatherSamples = 0;
  s.ambient = true;
  return s;
}

// Radiance from -z and from +z, linear in between.
Harmonics alongZ(double behind, double inFront) {
  Harmonics h{};
  for (size_t k = 0; k < 3; ++k) {
    h[0][k] = 0.5 * (behind + inFront) * std::sqrt(4 * std::numbers::pi);
    h[2][k] = 0.5 * (inFront - behind) * std::sqrt(4 * std::numbers::pi / 3);
  }
  return h;
}
// Irradiance of a face that looks along z, by the radiance it faces and the radiance of the other side: pi (mean + 2/3 slope).
double irradianceOf(double facing, double opposite) {
  return std::numbers::pi * (0.5 * (facing + opposite) + (facing - opposite) / 3);
}

// A slab of 1 mm whose hidden face looks along -z: light from there comes through, and light from +z is what
// the visible face loses.
TEST_F(AmbientLight, SlabSendsOnWhatComesFromBehind) {
  const PellucidMaterial m = testMaterial();
  Capture c = flatCapture(16, 12);
  const double t[3] = {std::exp(-0.5), std::exp(-1.0), 0.7 * std::exp(-2.0) + 0.3 * std::exp(-0.25)};
  for (const double behind : {0.0, 0.25, 1.0})
    for (const double inFront : {0.0, 0.5}) {
      c.environment = alongZ(behind, inFront);
      const Image out = replay(c, m, through());
      for (size_t k = 0; k < 3; ++k) {
        const double rho = double(m.reflectance[k]), a = 0.5 * (1 / rho + rho);
        const double hidden = irradianceOf(behind, inFront), visible = irradianceOf(inFront, behind);
        // T(0) = 1 has no boundary: R(0) = 0.
        const double scale = a * a - (a * a - 1);
        const double returned = a - std::sqrt(scale * t[k] * t[k] + a * a - 1);
        const double expected =
            double(c.irradiance.data[k]) + (t[k] * hidden - (rho - returned) * visible) / rho;
        EXPECT_NEAR(double(out.at(8, 6)[k]), std::max(expected, 0.0), 2e-5)
            << behind << " behind, " << inFront << " in front, channel " << k;
      }
    }
}

// Light that is kept may be less than nothing: a slab under a sky in front alone returns less than a thick body.
TEST_F(AmbientLight, KeptLightIsTheSame) {
  Capture c = flatCapture(16, 12);
  c.environment = alongZ(0, 0.05);
  const ReplaySettings s = through();
  const Image expected = replay(c, testMaterial(), s);
  EXPECT_LT(expected.at(8, 6)[0], 0.999f * c.irradiance.at(8, 6)[0]);
  for (const PellucidReuse kind : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE}) {
    ReplaySettings reused = s;
    reused.reuse = kind;
    Sequence sequence;
    for (int frame = 0; frame < 2; ++frame)
      EXPECT_LT(relativeRmse(sequence.run(c, testMaterial(), reused), expected), 1e-6) << kind << " frame " << frame;
  }
}

TEST_F(AmbientLight, NoEnvironmentAndNoBackDepthAddNothing) {
  Capture c = flatCapture(16, 12);
  const Image none = replay(c, testMaterial(), through());
  c.environment = Environment{}.harmonics();
  ReplaySettings off = through();
  off.ambient = false;
  EXPECT_TRUE(sameBits(replay(c, testMaterial(), off), none));
  EXPECT_FALSE(sameBits(replay(c, testMaterial(), through()), none));
  c.backDepth.image = {};
  EXPECT_TRUE(sameBits(replay(c, testMaterial(), through()), none));
}

// A sheet sends on its part of what its hidden face has, loses nothing, and needs no back depth.
TEST_F(AmbientLight, ThinWallsSendOnTheirPart) {
  PellucidMaterial m = testMaterial();
  m.thinWalled = 1;
  for (int k = 0; k < 3; ++k) {
    m.reflectance[k] = 0.5f;
    m.wallTransmittance[k] = 0.1f * static_cast<float>(k + 1);
  }
  Capture c = flatCapture(16, 12);
  c.backDepth.image = {};
  c.environment = alongZ(2, 0.5);
  const Image out = replay(c, m, through());
  for (size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(double(out.at(8, 6)[k]),
                double(c.irradiance.data[k]) + double(m.wallTransmittance[k]) * irradianceOf(2, 0.5) / 0.5, 1e-4)
        << k;
}

// Light of the image comes through pixel by pixel. Without an environment the visible face
// loses nothing.
TEST_F(AmbientLight, HiddenIrradianceComesThrough) {
  const PellucidMaterial m = testMaterial();
  Capture c = flatCapture(16, 12);
  c.hiddenIrradiance = Image(16, 12, 3);
  for (size_t i = 0; i < c.hiddenIrradiance.data.size(); ++i)
    c.hiddenIrradiance.data[i] = 0.01f * static_cast<float>(i % 97);
  const double t[3] = {std::exp(-0.5), std::exp(-1.0), 0.7 * std::exp(-2.0) + 0.3 * std::exp(-0.25)};
  for (const float exposure : {1.0f, 0.25f}) {
    ReplaySettings s = through();
    s.ambient.reset();  // a capture with hidden irradiance uses it
    s.preExposure = exposure;
    const Image out = replay(c, m, s);
    for (const auto& [x, y] : {std::pair(8, 6), {3, 9}})
      for (size_t k = 0; k < 3; ++k) {
        const double hidden = double(c.hiddenIrradiance.at(x, y)[k]);
        EXPECT_NEAR(
            double(out.at(x, y)[k]),
            double(exposure) * (double(c.irradiance.at(x, y)[k]) + t[k] * hidden / double(m.reflectance[k])),
            2e-5)
            << x << ", " << y << ", channel " << k;
      }
  }
  ReplaySettings off = through();
  off.ambient = false;
  const Image without = replay(c, m, off);
  c.hiddenIrradiance = {};
  EXPECT_TRUE(sameBits(without, replay(c, m, off)));
}

// Seven of nine coefficients at once, of either sign, under a turned camera; one thickness a pixel, and
// gathered lights beside. The second ear has stored thicknesses, and the head has hidden irradiance, too.
TEST_F(AmbientLight, AgreesWithTheReference) {
  for (const auto& [name, stored] : {std::pair("ear", false), {"ear", true}, {"head", false}}) {
    const SceneParameters p{.name = name, .width = 64, .height = 48, .shadowSize = 64};
    Capture c = makeScene(p);
    if (stored) {
      c.backDepth.encoding = PELLUCID_DEPTH_THICKNESS;
      for (size_t i = 0; i < c.backDepth.image.data.size(); ++i)
        c.backDepth.image.data[i] = static_cast<float>(i % 23) - 2;  // of -1 and -2: not known
    }
    c.environment = Harmonics{{{3, 2, 1},
                               {0.5, -0.25, 0},
                               {-1, 0.5, 0.25},
                               {0.75, 0, 0.5},
                               {0.3, 0.2, 0.1},
                               {0, 0.4, -0.3},
                               {0.2, -0.2, 0.2},
                               {-0.1, 0.3, 0.5},
                               {0.25, 0.5, -0.75}}};
    if (p.name == "head") {
      c.hiddenIrradiance = Image(p.width, p.height, 3);
      for (size_t i = 0; i < c.hiddenIrradiance.data.size(); ++i)
        c.hiddenIrradiance.data[i] = 0.02f * static_cast<float>(i % 89);
    }
    const std::vector<PellucidMaterial> materials(c.materials.size(), skin());
    const ReplaySettings s = through();
    const Image ref = referenceOf(c, materials, s);
    const Image gpu = replayer().run(c, materials, s).output;
    ReplaySettings off = s;
    off.ambient = false;
    const Image without = replayer().run(c, materials, off).output;
    std::vector<double> errors, changes;
    for (size_t i = 0; i < gpu.pixels(); ++i)
      for (size_t k = 0; k < 3 && c.material[i] != 0; ++k) {
        errors.push_back(std::abs(double(gpu.data[4 * i + k]) - double(ref.data[3 * i + k])));
        changes.push_back(std::abs(double(gpu.data[4 * i + k]) - double(without.data[4 * i + k])));
      }
    std::sort(errors.begin(), errors.end());
    // 2 in 1000 pixels have another texel of a shadow map by rounding, or another neighbor in their
    // facet.
    EXPECT_LT(errors[static_cast<size_t>(0.998 * double(errors.size() - 1))], 1e-3) << name;
    EXPECT_GT(*std::max_element(changes.begin(), changes.end()), 0.1) << name;
  }
}

// A slab's visible face loses light that leaves by the hidden face. With a gather, probes say so, and the light
// from all around does not say it again.
TEST_F(AmbientLight, ProbesHaveTheLossOfTheVisibleFace) {
  const Capture c = makeScene({.name = "slab", .width = 32, .height = 32, .shadowSize = 32});
  Capture sky = c;
  sky.environment = alongZ(-0.5, 2.5);  // irradiance 2 pi on the visible face, 0 on the hidden face
  for (const uint32_t samples : {0u, 8u}) {
    ReplaySettings s = gathering(samples);
    s.ambient = true;
    const float with = replay(sky, skin(), s).at(16, 16)[0], without = replay(c, skin(), s).at(16, 16)[0];
    if (samples == 0)
      EXPECT_LT(with, without - 0.05f);
    else
      EXPECT_NEAR(with, without, 1e-4f);
  }
}

// Light from hidden faces is not gathered: after the diffusion it adds what it adds without one. The light
// that visible faces lose differs, because probes tell it where there are some.
TEST_F(AmbientLight, IsTheSameBesideGatheredLight) {
  const SceneParameters p{.name = "ear", .width = 64, .height = 48, .shadowSize = 64};
  Capture c = makeScene(p);
  c.albedo = {};
  const std::vector<PellucidMaterial> materials(c.materials.size(), skin());
  Capture sky = c;
  sky.hiddenIrradiance = Image(p.width, p.height, 3);
  for (size_t i = 0; i < sky.hiddenIrradiance.data.size(); ++i)
    sky.hiddenIrradiance.data[i] = 0.02f * static_cast<float>(i % 97);
  ReplaySettings s = through();
  s.features |= PELLUCID_FEATURE_DIFFUSION;
  ReplaySettings gathered = s;
  gathered.translucency.gatherSamples = 8;
  const Image plain = replayer().run(c, materials, s).output,
              plainSky = replayer().run(sky, materials, s).output;
  const Image other = replayer().run(c, materials, gathered).output,
              otherSky = replayer().run(sky, materials, gathered).output;
  // Beside a gather probes say what thin bodies return of their own light, and a pixel takes that back from what comes through it.
  double alone = 0, beside = 0;
  for (size_t i = 0; i < plain.data.size(); ++i) {
    alone += double(plainSky.data[i]) - double(plain.data[i]);
    beside += double(otherSky.data[i]) - double(other.data[i]);
  }
  EXPECT_NEAR(beside / alone, 1, 0.05);
}

}  // namespace
}  // namespace pellucid::test
