// What the diffusion promises about pixels.
#include "gpu_fixture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace {

using namespace pellucid::test;

ReplaySettings diffusionOnly() { return inFloats(PELLUCID_FEATURE_DIFFUSION); }

using Diffusion = GpuTest;

// Gaussians of these standard deviations in pixels of flatCapture's width, equal weights, in all channels.
PellucidMaterial gaussians(std::initializer_list<double> deviations, double pixel) {
  PellucidMaterial m = testMaterial();
  m.gaussianCount = 0;
  for (const double s : deviations) {
    for (int c = 0; c < 3; ++c) {
      m.gaussianVariance[c][m.gaussianCount] = static_cast<float>(s * s * pixel * pixel);
      m.gaussianWeight[c][m.gaussianCount] = 1 / static_cast<float>(deviations.size());
      m.radius[c] = static_cast<float>(3.8 * s * pixel);
    }
    ++m.gaussianCount;
  }
  return m;
}

double pixelOf(const Capture& c) { return 2 / (c.clipFromView[0] * c.width); }

Capture dark(int width, int height) {
  Capture c = flatCapture(width, height);
  std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
  return c;
}

void light(Capture& c, int x, int y, float value) {
  for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = value;
}

double sum(const Image& image, int channel) {
  double total = 0;
  for (size_t i = 0; i < image.pixels(); ++i) total += image.data[4 * i + static_cast<size_t>(channel)];
  return total;
}

// Wherever the spot lies against the pyramid, and far enough from the rim that all of it stays inside.
TEST_F(Diffusion, IsolatedSpotKeepsItsEnergy) {
  for (const auto& deviations : {std::initializer_list<double>{0.7}, {1, 4}, {14}}) {
    double total = 0, worst = 0;
    for (const auto& [x, y] : {std::pair(96, 96), std::pair(97, 99), std::pair(102, 98), std::pair(95, 93)}) {
      Capture c = dark(192, 192);
      light(c, x, y, 1000);
      const double energy = sum(replay(c, gaussians(deviations, pixelOf(c)), diffusionOnly()), 0) / 1000;
      total += energy / 4;
      worst = std::max(worst, std::abs(energy - 1));
    }
    EXPECT_NEAR(total, 1, 5e-3);
    EXPECT_LT(worst, 5e-3);
  }
}

// The result belongs to the image and not to the workgroups: a rect at any offset gives the same pixels, away
// from its own rim.
TEST_F(Diffusion, ShiftedRectGivesTheSamePixels) {
  Capture step = dark(128, 128);
  for (int y = 56; y < 72; ++y)
    for (int x = 56; x < 72; ++x) light(step, x, y, static_cast<float>((x * 7 + y * 13) % 5));
  // A step in depth and, of a material that reaches less far, a disc. Then bars before what is behind: edges
  // wherever one looks.
  step.materials.resize(2);
  Capture bars = step;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x) {
      if (x + y / 4 > 82) step.frontDepth.image.at(x, y)[0] += 5;
      if (std::hypot(x - 60, y - 64) < 5) step.material[static_cast<size_t>(128 * y + x)] = 2;
      if (x % 3 == 0) bars.frontDepth.image.at(x, y)[0] += 5;
    }
  for (const auto& deviations : {std::initializer_list<double>{1, 4}, {7}})
    for (const Capture* c : {&step, &bars}) {
      const double pixel = pixelOf(*c);
      const std::vector<PellucidMaterial> m = {gaussians(deviations, pixel), gaussians({1}, pixel)};
      const Image whole = replayer().run(*c, m, diffusionOnly()).output;
      for (const auto& rect : {std::array<uint32_t, 4>{2, 3, 120, 119}, {13, 11, 110, 101}}) {
        ReplaySettings s = diffusionOnly();
        s.renderRect = rect;
        const Image part = replayer().run(*c, m, s).output;
        for (int y = 44; y < 84; ++y)
          for (int x = 44; x < 84; ++x)
            // A texel of a coarse level that the rect cuts has another slope, and so another area.
            EXPECT_NEAR(part.at(x, y)[0], whole.at(x, y)[0], 3e-3 * (1 + whole.at(x, y)[0]))
                << (c == &step ? "step " : "bars ") << x << ", " << y;
      }
    }
}

// An edge of depth 30 times the kernel's reach lets nothing over.
TEST_F(Diffusion, NoHaloAtASilhouette) {
  Capture c = dark(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool front = x + y / 3 < 37;
      c.frontDepth.image.at(x, y)[0] = front ? 10.0f : 60.0f;
      if (front) light(c, x, y, 1);
    }
  const Image out = replay(c, gaussians({1, 3}, pixelOf(c)), diffusionOnly());
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) EXPECT_NEAR(out.at(x, y)[0], x + y / 3 < 37 ? 1 : 0, 1e-3) << x << ", " << y;
}

TEST_F(Diffusion, MaterialsDoNotBleed) {
  Capture c = dark(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      const bool lit = (x + 2 * y) % 97 < 53;
      c.material[static_cast<size_t>(y * 64 + x)] = lit ? 1 : 2;
      if (lit) light(c, x, y, 1);
    }
  c.materials.resize(2);
  const double pixel = pixelOf(c);
  const Image out =
      replayer().run(c, {gaussians({1, 3}, pixel), gaussians({6}, pixel)}, diffusionOnly()).output;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      EXPECT_NEAR(out.at(x, y)[0], (x + 2 * y) % 97 < 53 ? 1 : 0, 1e-3) << x << ", " << y;
}

TEST_F(Diffusion, SubpixelRadiusReturnsTheInput) {
  Capture c = dark(32, 32);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) light(c, x, y, static_cast<float>((x * 7 + y * 13) % 5));
  const Image out = replay(c, gaussians({0.03, 0.12}, pixelOf(c)), diffusionOnly());
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x)
      EXPECT_NEAR(out.at(x, y)[0], c.irradiance.at(x, y)[0], 1e-3) << x << ", " << y;
}

// A kernel that reaches everything averages over the area of the surface, not over pixels: a third, where
// the dark half is folds of 60 degrees and so twice as large as it looks.
TEST_F(Diffusion, SurfacesCountByTheirArea) {
  Capture c = dark(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) {
      if (x < 32) {
        light(c, x, y, 1);
        continue;
      }
      const int fold = x % 32;
      const double distance = fold < 16 ? fold + 0.5 : 31.5 - fold;
      c.frontDepth.image.at(x, y)[0] += static_cast<float>(std::sqrt(3) * distance * pixelOf(c));
    }
  const Image out = replay(c, gaussians({1e4}, pixelOf(c)), diffusionOnly());
  double sum = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x) sum += out.at(x, y)[0] / 4096;
  // Coarse levels lose some of what is folded, as they go by the tangents of single texels.
  EXPECT_NEAR(sum, 1.0 / 3, 0.04);
}

// Seen edge-on and away from the middle of a wide view, where rounding leaves least of the other side of what
// is steep.
TEST_F(Diffusion, SteepSurfacesKeepConstants) {
  for (const double slope : {10.0, 1e3, 1e5}) {
    Capture c = flatCapture(64, 64);
    c.clipFromView = {0.2, 0, 0, 0, 0, -0.2, 0, 0, 0, 0, 0, -1, 0, 0, 0.1, 0};  // 157 degrees
    for (int y = 0; y < 64; ++y)
      for (int x = 0; x < 64; ++x) {
        const int along = x + y / 2, fold = along % 32;
        const double steps = fold < 16 ? fold : 31 - fold;
        c.frontDepth.image.at(x, y)[0] = static_cast<float>(10 + slope * steps * 10 / 0.2 / 32);
        for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = 0.5f;
      }
    for (const double deviation : {3.0, 1e3}) {
      const Image out = replay(c, gaussians({deviation}, 10 / 0.2 / 32), diffusionOnly());
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x)
          for (int k = 0; k < 3; ++k)
            ASSERT_NEAR(out.at(x, y)[k], 0.5, 5e-4) << slope << ", " << x << ", " << y;
    }
  }
}

// Pixels of one plane are filtered without their depths, those near an edge one by one. A hole makes edges of
// what was a plane; where the kernel does not reach it, nothing else may change.
TEST_F(Diffusion, PlanesAndEdgesAreFilteredAlike) {
  Capture c = dark(96, 96);
  for (int y = 0; y < 96; ++y)
    for (int x = 0; x < 96; ++x)
      light(c, x, y, static_cast<float>(1 + 0.8 * std::sin(x * 0.26) * std::cos(y * 0.21)));
  const PellucidMaterial m = gaussians({0.4, 1}, pixelOf(c));
  const Image plane = replay(c, m, diffusionOnly());
  c.material[48 * 96 + 48] = 0;
  const Image holed = replay(c, m, diffusionOnly());
  double most = 0;
  int compared = 0;
  for (int y = 36; y < 62; ++y)
    for (int x = 36; x < 62; ++x) {
      if (std::max(std::abs(x - 48), std::abs(y - 48)) < 6) continue;  // six deviations and more
      most = std::max(most, static_cast<double>(std::abs(plane.at(x, y)[0] - holed.at(x, y)[0])));
      ++compared;
    }
  EXPECT_GT(compared, 500);
  // Level 2 reaches further than the kernel, with little.
  EXPECT_LT(most, 2e-3);
}

// Without a depth there is no scale to diffuse over: the pixel keeps its irradiance, alone or on a plane.
TEST_F(Diffusion, PixelsWithoutADepthKeepTheirIrradiance) {
  for (const bool alone : {true, false}) {
    Capture c = dark(32, 32);
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) light(c, x, y, 1);
    if (alone) std::fill(c.material.begin(), c.material.end(), 0u);
    // The last three at the rect's border, in quads that it cuts and in others.
    const std::pair<int, int> without[] = {{5, 6}, {20, 17}, {1, 11}, {16, 2}, {30, 30}};
    for (const auto& [x, y] : without) {
      c.material[static_cast<size_t>(32 * y + x)] = 1;
      c.frontDepth.image.at(x, y)[0] = 0;
      light(c, x, y, 7);
    }
    for (const std::array<uint32_t, 4>& rect :
         {std::array<uint32_t, 4>{}, {1, 1, 30, 30}, {0, 2, 31, 29}, {1, 2, 30, 29}}) {
      ReplaySettings s = diffusionOnly();
      s.renderRect = rect;
      const Image out = replay(c, gaussians({1, 3}, pixelOf(c)), s);
      for (const auto& [x, y] : without) EXPECT_EQ(out.at(x, y)[0], 7) << x << ", " << y;
      if (alone) continue;
      for (const auto& [x, y] : {std::pair(4, 6), std::pair(21, 18), std::pair(12, 12), std::pair(1, 12),
                                 std::pair(2, 11), std::pair(15, 2), std::pair(16, 3), std::pair(30, 29)})
        EXPECT_NEAR(out.at(x, y)[0], 1, 1e-3) << x << ", " << y;
    }
  }
}

// Some texture everywhere.
Capture textured(Capture c) {
  const int size = c.width;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x)
      light(c, x, y,
            static_cast<float>((x / 9 + y / 7) % 2) + 0.1f * static_cast<float>((x * 7 + y * 13) % 5));
  return c;
}

// In place, too, where the base level copies the irradiance; with and without light that is gathered.
TEST_F(Diffusion, AlphaIsTheIrradiances) {
  Capture c = flatCapture(48, 32, 4);
  Image irradiance(48, 32, 4);
  for (size_t i = 0; i < irradiance.pixels(); ++i) {
    std::copy_n(&c.irradiance.data[3 * i], 3, &irradiance.data[4 * i]);
    irradiance.data[4 * i + 3] = i % 3 == 0 ? 0.25f : 0.5f;
  }
  c.irradiance = irradiance;
  for (const bool lit : {false, true})
    for (const bool inPlace : {false, true}) {
      if (lit) c.lights = {backLight()}, c.lights[0].shadowMaps = {flatShadowMap(-14, PELLUCID_DEPTH_VIEW_Z)};
      ReplaySettings s = lit ? gathering(8) : diffusionOnly();
      s.aliasOutput = inPlace;
      const Image out = replay(c, testMaterial(), s);
      for (size_t i = 0; i < out.pixels(); ++i)
        ASSERT_EQ(out.data[4 * i + 3], irradiance.data[4 * i + 3]) << i << " lit " << lit << " in place " << inPlace;
    }
}

// The view shows the input of the diffusion: without translucency, no light comes through.
TEST_F(Diffusion, ViewOfItsInputIsTheIrradiance) {
  Capture c = textured(flatCapture(48, 48));
  c.lights = {backLight()};
  ReplaySettings s = diffusionOnly();
  s.debugView = PELLUCID_DEBUG_IRRADIANCE;
  EXPECT_LT(relativeRmse(replay(c, testMaterial(), s), c.irradiance), 1e-3);
  s.features |= PELLUCID_FEATURE_TRANSLUCENCY;
  EXPECT_GT(relativeRmse(replay(c, testMaterial(), s), c.irradiance), 0.1);
}

// Plans of orthographic cameras leave out levels that no Gaussian reaches, and the image stays the same.
TEST_F(Diffusion, SmallRadiiAreTheSameWithFewerLevels) {
  const Capture perspective = textured(perspectiveCapture(96));
  Capture orthographic = textured(flatCapture(96, 96));
  orthographic.clipFromView[0] = 2 / (0.5 * 96);  // the same pixels of .5 mm
  orthographic.clipFromView[5] = -orthographic.clipFromView[0];
  struct Row {
    std::initializer_list<double> deviations;
    uint32_t dropped;  // levels
  };
  for (const Row& row : {Row{{0.7, 1.5, 3, 5.5}, 4}, {{7}, 2}, {{1, 21.5}, 2}}) {
    const PellucidMaterial m = gaussians(row.deviations, 0.5);
    const ReplayResult all = replayer().run(perspective, {m}, diffusionOnly());
    const ReplayResult fewer = replayer().run(orthographic, {m}, diffusionOnly());
    EXPECT_EQ(coarsestUpsampled(fewer.plan) + row.dropped, coarsestUpsampled(all.plan));
    EXPECT_EQ(fewer.plan.dispatchCount + row.dropped / 4, all.plan.dispatchCount) << "levels 4 to 7 have one";
    double most = 0;
    for (size_t i = 0; i < all.output.data.size(); ++i)
      most = std::max(most, static_cast<double>(std::abs(all.output.data[i] - fewer.output.data[i])));
    EXPECT_LT(most, 1e-3) << row.deviations.size() << " Gaussians, the first " << *row.deviations.begin();
  }
}

// The engine owns alpha: in an output of floats, no pixel of a plane rounds alpha to a half.
TEST_F(GpuTest, DiffusionKeepsTheBitsOfAlphaInFloats) {
  Capture c = flatCapture(64, 64);
  c.irradiance = Image(64, 64, 4, 0.1f);
  const Image out = replay(c, skin(), inFloats(PELLUCID_FEATURE_DIFFUSION));
  for (std::size_t i = 3; i < out.data.size(); i += 4) ASSERT_EQ(out.data[i], 0.1f) << i / 4;
}

}  // namespace
