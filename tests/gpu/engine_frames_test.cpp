// Frames as engines have them: encodings of materials, formats of irradiance, outputs that are
// added to, and pre-exposed irradiance.
// No other test finds a sum that is clamped before its last part, or packed floats that are read after they are written.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <map>
#include <numbers>

#include "gpu_fixture.h"
#include "replay/exposure.h"
#include "scene/environment.h"
#include "scene/scene.h"

namespace pellucid::test {
namespace {

using EngineFrames = GpuTest;

// Made once: the head takes longer than the passes over it.
const Capture& head() {
  static const Capture made = [] {
    return makeScene({.name = "head", .width = 96, .height = 72, .shadowSize = 128});
  }();
  return made;
}

ReplaySettings wide() { return gathering(8); }

// ---- Materials

TEST_F(EngineFrames, MaterialIndicesAmongOtherBitsGiveTheSameBits) {
  struct Packed {
    uint32_t shift, mask, mark;
  };
  Capture marked = head();
  for (size_t i = 0; i < marked.material.size(); i += 3)
    if (marked.material[i] != 0) marked.material[i] |= 0x20;
  for (const Packed& p : {Packed{24, 0xFF000000, 0}, Packed{8, 0x3F00, 0x20}}) {
    const Capture& c = p.mark ? marked : head();
    ReplaySettings s = wide();
    s.translucency.materialMarkBit = p.mark;
    const Image plain = replay(c, s);
    s.materialShift = p.shift;
    s.materialMask = p.mask;
    EXPECT_TRUE(sameBits(replay(c, s), plain)) << p.shift << " " << p.mask;
  }
}

// ---- Outputs that are added to

// Specular light, say: all pixels have some, and alpha.
Image specular(const Capture& c) {
  Image held(c.width, c.height, 4);
  for (size_t i = 0; i < held.data.size(); ++i) held.data[i] = static_cast<float>((i * 37) % 64) / 64;
  return held;
}

// Held colors may be below 0: the output is the clamped sum, and no part is clamped before.
TEST_F(EngineFrames, HeldColorsBelowZeroTakeFromTheSum) {
  const Capture c = flatCapture(16, 8);
  ReplaySettings s = inFloats(0);
  s.addToOutput = 1;
  const FrameRun run(device(), replayer().contextFor(c), c, {testMaterial()}, s);
  const struct {
    float held, sum;
  } rows[] = {{-0.25f, 0.75f}, {-1.5f, 0}, {NAN, 1}, {-INFINITY, 0}, {INFINITY, 65504}, {1e30f, 65504}};
  for (const auto& row : rows) {
    run.uploadOutput(Image(c.width, c.height, 4, row.held));
    EXPECT_NEAR(record(run).at(5, 3)[0], row.sum, 1e-6) << row.held;
  }
}

struct Added {
  const char* name;
  VkFormat format;
  // Bounds of the sum and of the result, as both are rounded; 11 bits have 6 of mantissa and the blue 10 have
  // 5, which devices may truncate to.
  double step;
  double zero;  // a step of the format beside 0
};

TEST_F(EngineFrames, ResultIsAddedToWhatTheOutputHolds) {
  const Capture& c = head();
  const Image held = specular(c);
  const std::function<void(ReplaySettings&)> changes[] = {
      [](ReplaySettings&) {}, [](ReplaySettings& s) { s.features = PELLUCID_FEATURE_TRANSLUCENCY; },
      [](ReplaySettings& s) { s.features = PELLUCID_FEATURE_DIFFUSION; },
      [](ReplaySettings& s) { s.features = 0; },
      [](ReplaySettings& s) { s.reuse = PELLUCID_REUSE_ALTERNATE, s.translucency.gatherSamples = 0; }};
  for (const Added& a : {Added{"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT, 1e-6, 1e-7},
                         Added{"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT, 1.0 / 2048, 1e-7},
                         Added{"rg11b10f", VK_FORMAT_B10G11R11_UFLOAT_PACK32, 1.0 / 32, 1.0 / 524288}}) {
    const bool wideOnly = a.format != VK_FORMAT_R32G32B32A32_SFLOAT;
    for (size_t change = 0; change < (wideOnly ? 1 : std::size(changes)); ++change) {
      ReplaySettings s = wide();
      s.outputFormat = a.format;
      changes[change](s);
      const Context& context = replayer().contextFor(c);
      const Image result = record(FrameRun(device(), context, c, compileMaterials(c), s));
      s.addToOutput = 1;
      const FrameRun run(device(), context, c, compileMaterials(c), s);
      run.uploadOutput(held);
      const Image before = run.output();
      const Image sum = record(run);
      const auto channels = static_cast<size_t>(sum.channels);
      for (size_t i = 0; i < sum.pixels(); ++i)
        for (size_t k = 0; k < channels; ++k) {
          const double was = double(before.data[channels * i + k]), is = double(sum.data[channels * i + k]);
          if (c.material[i] == 0 || k == 3) {
            ASSERT_EQ(is, was) << a.name << ", change " << change << ", pixel " << i << ", channel " << k;
            continue;
          }
          const double more = double(result.data[channels * i + k]);
          ASSERT_NEAR(is, was + more, a.step * (was + 2 * more) + a.zero)
              << a.name << ", change " << change << ", pixel " << i << ", channel " << k;
        }
    }
  }
}

// ---- Pre-exposure

// The irradiance of engines: exposed, over pi, and without what a diffuse term of the factor 1 - F loses at
// an index of 1.5. Lights and the sky keep their units.
TEST_F(EngineFrames, PreExposureScalesTheResult) {
  Capture c = head();
  c.environment = Environment{}.harmonics();
  ReplaySettings s = wide();
  s.ambient = true;
  const Image plain = replay(c, s);
  for (const float factor : {0.25f, 0.96f * std::numbers::inv_pi_v<float>}) {
    const auto unscaled = [&](const Capture& frame, float preExposure) {
      s.preExposure = preExposure;
      Image output = replay(frame, s);
      for (float& v : output.data) v /= factor;
      return relativeRmse(output, plain, c.material);
    };
    // The diffusion works in halves: of a power of two the darkest alone lose bits, of others all are rounded
    // anew.
    EXPECT_LT(unscaled(c, factor), factor == 0.25f ? 1e-4 : 1.0 / 2048) << factor;
    // An image that holds the factor without saying so gets too much light that comes through.
    Capture silent = c;
    for (float& v : silent.irradiance.data) v *= factor;
    EXPECT_GT(unscaled(silent, 1), 5e-3) << factor;
  }
}

// The same for captures of any unit, without being asked.
TEST_F(EngineFrames, ReplayChoosesThePreExposure) {
  ReplaySettings s = wide();
  s.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  s.preExposure = 0;
  const ReplayResult plain = replayer().run(head(), compileMaterials(head()), s);
  EXPECT_EQ(plain.preExposure, 1);
  for (const float unit : {3e7f, 1e-7f}) {
    Capture other = head();
    for (float& v : other.irradiance.data) v *= unit;
    for (Light& light : other.lights) light.intensity *= static_cast<double>(unit);
    ReplayResult result = replayer().run(other, compileMaterials(other), s);
    const double exposed = largestLight(other) * static_cast<double>(result.preExposure);
    EXPECT_TRUE(exposed >= 1 && exposed < 2) << exposed;
    for (float& v : result.output.data) v /= unit;
    // The diffusion works in halves, which round at other places.
    EXPECT_LT(relativeRmse(result.output, plain.output, head().material), 5e-4) << unit;
  }
}

// ---- Formats of irradiance

glm::vec3 throughRgb9e5(const glm::vec3& v) { return glm::unpackF3x9_E1x5(glm::packF3x9_E1x5(v)); }
glm::vec3 throughRg11b10(const glm::vec3& v) { return unpackB10G11R11(packB10G11R11(v)); }

TEST_F(EngineFrames, PackedIrradianceGivesThePictureOfItsColors) {
  struct Packed {
    VkFormat format;
    glm::vec3 (*through)(const glm::vec3&);
  };
  for (const Packed& p : {Packed{VK_FORMAT_E5B9G9R9_UFLOAT_PACK32, &throughRgb9e5},
                          Packed{VK_FORMAT_B10G11R11_UFLOAT_PACK32, &throughRg11b10}}) {
    Capture rounded = head();
    for (size_t i = 0; i < rounded.irradiance.pixels(); ++i) {
      float* color = rounded.irradiance.data.data() + i * static_cast<size_t>(rounded.irradiance.channels);
      const glm::vec3 through = p.through({color[0], color[1], color[2]});
      for (int k = 0; k < 3; ++k) color[k] = through[k];
    }
    for (const uint32_t samples : {8u}) {
      ReplaySettings s = gathering(samples);
      s.irradianceFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
      const Image expected = replay(rounded, s);
      s.irradianceFormat = p.format;
      EXPECT_TRUE(sameBits(replay(head(), s), expected)) << p.format << ", samples " << samples;
    }
  }
}

// Stores that truncate darken red and green by 1 %, and blue by 2 %.
TEST_F(EngineFrames, PackedFloatsAreRoundedAndNotDarkened) {
  if (!device().writesWithoutFormat()) GTEST_SKIP() << "the device writes no image without a format";
  ReplaySettings s = wide();
  s.irradianceFormat = s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
  const Image exact = replay(head(), s);
  s.outputFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  const Image packed = replay(head(), s);
  for (size_t k = 0; k < 3; ++k) {
    double sum = 0, packedSum = 0;
    for (size_t i = 0; i < exact.pixels(); ++i) {
      if (head().material[i] == 0) continue;
      const double is = double(packed.data[i * static_cast<size_t>(packed.channels) + k]);
      const double was = double(exact.data[i * static_cast<size_t>(exact.channels) + k]);
      sum += was, packedSum += is;
      ASSERT_NEAR(is, was, was / (k == 2 ? 64 : 128) + 1.0 / 32768) << i << ", channel " << k;
    }
    EXPECT_NEAR(packedSum / sum, 1, 0.002) << "channel " << k;
  }
}

TEST_F(EngineFrames, PackedFloatsInPlaceAreThoseOfAnOwnOutput) {
  if (!device().writesWithoutFormat()) GTEST_SKIP() << "the device writes no image without a format";
  ReplaySettings s = wide();
  s.outputFormat = VK_FORMAT_B10G11R11_UFLOAT_PACK32;
  const Capture& c = head();
  const Image own = replay(c, s);
  s.aliasOutput = true;
  const Image inPlace = replay(c, s);
  for (size_t i = 0; i < own.pixels(); ++i)
    for (size_t k = 0; k < 3 && c.material[i] != 0; ++k)
      ASSERT_EQ(inPlace.data[3 * i + k], own.data[3 * i + k]) << i;
}

}  // namespace
}  // namespace pellucid::test
