// Noise in motion: cells that follow an anchor, and probes that are averaged over frames.
#include "gpu_fixture.h"

#include "capture/material.h"
#include "common/compare.h"
#include "common/far_origin.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "replay/exposure.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

const PellucidMaterial& skin() {
  static const PellucidMaterial compiled = compileMaterial(PresetMaterial{"skin1"}, "skin1");
  return compiled;
}

// A ball lit from the side, before nothing: its patterns of samples show.
Capture ball() {
  SceneParameters p{.name = "sphere", .options = {{"radius", 8}, {"extent", 24}, {"lightAngle", 70}}};
  p.width = p.height = 160;
  p.shadowSize = 256;
  p.orthographic = false;
  return movedCapture(makeScene(p), 0, 0, 6);
}

// The ball's front, in the world.
constexpr std::array<float, 4> kAnchor = {0, 0, 8, 1};

ReplaySettings settings(uint32_t spacing = 1) {
  ReplaySettings s = inFloats();
  s.translucency.gatherSamples = 8;
  s.translucency.gatherSpacing = spacing;
  return s;
}

Mask maskOf(const Capture& c) { return comparisonMask(c.material, c.irradiance, Subset::All); }

double rmse(const Capture& c, const Image& a, const Image& b) {
  double worst = 0;
  for (const auto& channel : compareImages(a, b, maskOf(c), 1).channels)
    worst = std::max(worst, channel.relativeRmse);
  return worst;
}

class Motion : public GpuTest {
protected:
  static Image rgbOf(const Capture& c, const ReplaySettings& s) { return rgb(replay(c, skin(), s)); }
};

// ---- Anchor

// By all steps of a cell, and across blocks of 64 pixels. Rays are rounded elsewhere.
TEST_F(Motion, AnchoredNoiseMovesWithTheBody) {
  const Capture still = ball();
  for (const uint32_t spacing : {1u, 2u, 4u}) {
    ReplaySettings s = settings(spacing);
    const Image onScreen = rgbOf(still, s);
    double loose = 0;
    for (const bool anchored : {true, false}) {
      s.anchor = anchored ? kAnchor : std::array<float, 4>{};
      const Image before = anchored ? rgbOf(still, s) : onScreen;
      for (const int k : {1, 2, 3, 6, -5}) {
        const Flicker flicker =
            compareShifted(before, rgbOf(movedCapture(still, k, k / 2, 6), s), maskOf(still), k, k / 2);
        for (const double e : flicker.relativeRmse) {
          EXPECT_TRUE(!anchored || e < 2e-4) << e << ", spacing " << spacing << ", " << k << " pixels";
          loose = std::max(loose, e);
        }
      }
    }
    EXPECT_GT(loose, 0.004) << "there is no noise to keep, spacing " << spacing;
  }
}

// An anchor changes noise and no light.
TEST_F(Motion, AnchorKeepsLight) {
  const Capture c = ball();
  ReplaySettings s = settings();
  s.translucency.gatherSamples = 64;
  const Image expected = rgbOf(c, s);
  for (const std::array<float, 4> anchor : {kAnchor, std::array<float, 4>{3, -2, 5, 1}, std::array<float, 4>{1e6f, 0, 0, 1}}) {
    s.anchor = anchor;
    EXPECT_LT(rmse(c, rgbOf(c, s), expected), 0.02) << anchor[0];
  }
  s.anchor = {0, 0, 1e6f, 1};
  EXPECT_EQ(rgbOf(c, s).data, expected.data) << "behind the camera";
}

// The whole scene elsewhere in the world, where floats are too coarse: replays move the anchor with the world's origin.
TEST_F(Motion, AnchorsOfFarScenesAreTheirBodies) {
  const Capture near = ball();
  constexpr std::array<double, 3> kOffset = {1 << 20, -(1 << 18), 1 << 19};
  const auto moved = [&](const Matrix& fromWorld) {
    return fromOrigin(fromWorld, {-kOffset[0], -kOffset[1], -kOffset[2]});
  };
  Capture far = near;
  far.viewFromWorld = moved(near.viewFromWorld);
  for (Light& light : far.lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.clipFromWorld = moved(map.clipFromWorld);
      if (map.viewFromWorld) map.viewFromWorld = moved(*map.viewFromWorld);
    }
  ASSERT_NE(worldOrigin(far), (std::array<double, 3>{0, 0, 0}));
  ReplaySettings s = settings();
  s.anchor = kAnchor;
  const Image expected = rgbOf(near, s);
  EXPECT_GT(rmse(near, rgbOf(far, s), expected), 0.004) << "there is no noise to tell anchors apart";
  for (std::size_t i = 0; i < 3; ++i) s.anchor[i] += static_cast<float>(kOffset[i]);
  EXPECT_LT(rmse(near, rgbOf(far, s), expected), 5e-4);
}

// Nothing but the rect is written, and an anchor changes its noise alone.
TEST_F(Motion, AnchoredRectIsThePart) {
  const Capture c = ball();
  ReplaySettings s = settings(2);
  s.translucency.gatherSamples = 64;
  s.anchor = {1, 2, 5, 1};
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  s.renderRect = {37, 41, 70, 50};
  const Image part = rgbOf(c, s);
  s.anchor = {};
  const Image loose = rgbOf(c, s);
  EXPECT_NE(part.data, loose.data);
  EXPECT_LT(rmse(c, part, loose), 0.01);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const bool outside = x < 37 || x >= 107 || y < 41 || y >= 91;
      for (int k = 0; k < 3; ++k) {
        const float* albedo = c.albedo.empty() ? nullptr : c.albedo.at(x, y);
        const float untouched = c.irradiance.at(x, y)[k] * (albedo ? albedo[k] : 1);
        ASSERT_TRUE(!outside || part.at(x, y)[k] == untouched) << x << ", " << y;
      }
    }
}

// ---- Accumulation

ReplaySettings accumulated(uint32_t spacing = 1) {
  ReplaySettings s = settings(spacing);
  s.reuse = PELLUCID_REUSE_ACCUMULATE;
  return s;
}

TEST_F(Motion, StillFramesConverge) {
  const Capture c = ball();
  ReplaySettings many = settings();
  many.translucency.gatherSamples = 64;
  const Image expected = rgbOf(c, many);
  ReplaySequence sequence(device());
  const double first = rmse(c, rgb(sequence.run(c, {skin()}, accumulated())), expected);
  Image last;
  double change = 0;
  for (int i = 0; i < 40; ++i) {
    Image now = rgb(sequence.run(c, {skin()}, accumulated()));
    if (i == 39) change = rmse(c, now, last);
    last = std::move(now);
  }
  // Eight samples have an error of their own, which no frame takes away.
  EXPECT_LT(rmse(c, last, expected), 0.9 * first);
  EXPECT_LT(change, 0.1 * first);
}

// The frame before was elsewhere on the screen, which the motion image says; without it the light of other places is kept.
TEST_F(Motion, KeptLightFollowsTheMotion) {
  const Capture still = ball();
  for (const uint32_t spacing : {1u, 4u}) {
    ReplaySequence sequence(device());
    Image before;
    Capture last = still;
    // The diffusion's own change is not the probes'.
    ReplaySettings kept = accumulated(spacing), alike = settings(spacing);
    kept.features = alike.features = PELLUCID_FEATURE_TRANSLUCENCY;
    for (int i = 0; i < 25; ++i) before = rgb(sequence.run(still, {skin()}, kept));
    for (const int x : {4, 8}) {
      Capture moved = movedCapture(still, x / 2, -x / 4, 6);
      moved.motion = Reprojection(last, moved).motion();
      const Image now = rgb(sequence.run(moved, {skin()}, kept));
      const Flicker flicker = compareShifted(before, now, maskOf(still), x / 2, -x / 4);
      const Flicker alone = compareShifted(rgbOf(still, alike), rgbOf(moved, alike), maskOf(still), x / 2, -x / 4);
      for (std::size_t c = 0; c < 3; ++c) {
        // Pixels lie elsewhere between probes of cells of 4 pixels, whose light is no noise.
        EXPECT_LT(flicker.relativeRmse[c], (spacing == 1 ? 0.5 : 1.0) * alone.relativeRmse[c]) << spacing;
      }
      last = std::move(moved);
    }
  }
}

// As a cut: the first frame of a sequence, and one of another size of cells, are as if there were no history.
TEST_F(Motion, CutsStartAnew) {
  const Capture c = ball();
  const Image alone = rgbOf(c, settings(2));
  ReplaySequence sequence(device());
  EXPECT_EQ(rgb(sequence.run(c, {skin()}, accumulated(2))).data, alone.data);
  EXPECT_NE(rgb(sequence.run(c, {skin()}, accumulated(2))).data, alone.data);
  ReplaySequence other(device());
  EXPECT_EQ(rgb(other.run(c, {skin()}, accumulated(2))).data, alone.data);
}

// Light that goes down or up by four times is there within an eighth after a frame, and after 24 within the samples' own error.
TEST_F(Motion, LightThatChangesDoesNotLinger) {
  const Capture lit = ball();
  Capture dark = lit;
  dark.lights[0].intensity = 0.25;
  for (const bool comes : {false, true}) {
    const Capture &before = comes ? dark : lit, &after = comes ? lit : dark;
    ReplaySettings many = settings();
    many.translucency.gatherSamples = 64;
    const Image expected = rgbOf(after, many);
    ReplaySequence sequence(device());
    for (int i = 0; i < 10; ++i) sequence.run(before, {skin()}, accumulated());
    Image now;
    for (int i = 0; i < 24; ++i) {
      now = rgb(sequence.run(after, {skin()}, accumulated()));
      EXPECT_TRUE(i > 0 || rmse(lit, now, expected) < 0.12) << comes << ": " << rmse(lit, now, expected);
    }
    EXPECT_LT(rmse(lit, now, expected), 0.035) << comes;
  }
}

// Kept light has the exposure of its frame.
TEST_F(Motion, ExposureMayChange) {
  const Capture c = ball();
  ReplaySequence sequence(device()), exposed(device());
  for (int i = 0; i < 4; ++i) {
    ReplaySettings s = accumulated();
    const Image expected = rgb(sequence.run(c, {skin()}, s));
    s.preExposure = static_cast<float>(1 << i);
    Image out = rgb(exposed.run(c, {skin()}, s));
    for (float& v : out.data) v /= s.preExposure;
    EXPECT_LT(rmse(c, out, expected), 2e-3) << i;
  }
}

// Motion that is no number keeps nothing.
TEST_F(Motion, BadMotionIsNone) {
  const Capture c = ball();
  Capture bad = c;
  bad.motion = Image(c.width, c.height, 4);
  for (std::size_t i = 0; i < bad.motion.data.size(); ++i)
    bad.motion.data[i] = i % 3 == 0   ? std::nanf("")
                         : i % 3 == 1 ? INFINITY
                                      : -1e30f;
  ReplaySequence sequence(device());
  for (int i = 0; i < 3; ++i) {
    const Image out = rgb(sequence.run(bad, {skin()}, accumulated()));
    EXPECT_LT(rmse(c, out, rgbOf(c, settings())), 0.05);
    for (const float v : out.data) ASSERT_TRUE(std::isfinite(v));
  }
}

}  // namespace
