// Noise in motion: cells that follow an anchor, and probes that are averaged over frames.
// No other test finds noise that stays on the screen, or accumulated frames that all take the same samples.
#include "gpu_fixture.h"

#include "common/compare.h"
#include "common/far_origin.h"
#include "gpu/model_builder.h"
#include "metrics/flicker.h"
#include "metrics/moved_capture.h"
#include "replay/exposure.h"
#include "scene/scene.h"

namespace {

using namespace pellucid::test;

// A ball lit from the side, before nothing: its patterns of samples show.
const Capture& ball() {
  static const Capture made = [] {
    SceneParameters p{.name = "sphere", .options = {{"radius", 8}, {"extent", 24}, {"lightAngle", 70}}};
    p.width = p.height = 96;
    p.shadowSize = 160;
    p.orthographic = false;
    return movedCapture(makeScene(p), 0, 0, 6);
  }();
  return made;
}

// The ball's front, in the world.
constexpr std::array<float, 4> kAnchor = {0, 0, 8, 1};

Mask maskOf(const Capture& c) { return comparisonMask(c.material, c.irradiance, Subset::All); }

double rmse(const Capture& c, const Image& a, const Image& b) { return relativeRmse(a, b, c.material); }

class Motion : public GpuTest {
protected:
  static Image rgbOf(const Capture& c, const ReplaySettings& s) { return rgb(replay(c, skin(), s)); }
  static Image next(Sequence& sequence, const Capture& c, const ReplaySettings& s) {
    return rgb(sequence.run(c, skin(), s));
  }
};

// ---- No anchor

// A body of few pixels looks alike wherever pixels, their quads and cells of one pixel lie on it.
TEST_F(Motion, SmallBodiesKeepTheirLight) {
  SceneParameters p{.name = "ear"};
  p.width = p.height = 96;
  const Capture still = makeScene(p);
  const ReplaySettings s = gathering(64, 1);  // no noise
  const Image before = rgbOf(movedCapture(still, 0, 0, 2), s), now = rgbOf(movedCapture(still, 1, 0, 2), s);
  const Flicker flicker = compareShifted(before, now, maskOf(movedCapture(still, 0, 0, 2)), 1, 0);
  for (const double change : flicker.relativeRmse) EXPECT_LT(change, 0.02);  // .08 with normals of quads
}

// ---- Reuse without motion

// Material that comes where a kept frame had none: nothing came through there, whatever a fresh history holds.
TEST_F(Motion, KeptProbesAreNoneWhereNoMaterialWas) {
  for (const std::uint32_t indirect : {0u, 1u}) {
    Capture first = flatCapture(128, 64, 4);
    first.lights = {backLight()};
    first.lights[0].shadowMaps = {flatShadowMap(-14, PELLUCID_DEPTH_VIEW_Z)};
    Capture second = first;
    for (std::size_t i = 0; i < first.material.size(); ++i) (i % 128 < 64 ? second : first).material[i] = 0;
    ReplaySettings s = gathering(8, 1);
    s.indirectDispatches = indirect;
    s.reuse = PELLUCID_REUSE_ALTERNATE;
    Sequence sequence;
    next(sequence, first, s);
    const Image kept = next(sequence, second, s);
    Capture unlit = second;
    unlit.lights.clear();
    const Image none = rgbOf(unlit, s);
    // Without probes, the thin slab returns as much as a thick one: 7 % more.
    for (int x = 72; x < 120; ++x) EXPECT_NEAR(kept.at(x, 32)[0], none.at(x, 32)[0], 0.1) << x << " indirect " << indirect;
  }
}

// ---- Anchor

// By all steps of a cell, and across blocks of 64 pixels. Rays are rounded elsewhere.
TEST_F(Motion, AnchoredNoiseMovesWithTheBody) {
  const Capture& still = ball();
  for (const uint32_t spacing : {1u, 4u}) {
    ReplaySettings anchored = gathering(8, spacing);
    const auto change = [&](const ReplaySettings& s, const Image& before, int k) {
      const Image now = rgbOf(movedCapture(still, k, k / 2, 6), s);
      const auto rmse = compareShifted(before, now, maskOf(still), k, k / 2).relativeRmse;
      return *std::max_element(rmse.begin(), rmse.end());
    };
    EXPECT_GT(change(anchored, rgbOf(still, anchored), 3), 0.004)
        << "there is no noise to keep, spacing " << spacing;
    anchored.anchor = kAnchor;
    const Image before = rgbOf(still, anchored);
    for (const int k : {1, 2, 3, -5})
      EXPECT_LT(change(anchored, before, k), 3e-4) << "spacing " << spacing << ", " << k << " pixels";
  }
}

// An anchor changes noise and no light.
TEST_F(Motion, AnchorKeepsLight) {
  const Capture& c = ball();
  ReplaySettings s = gathering(64);
  const Image expected = rgbOf(c, s);
  for (const std::array<float, 4> anchor :
       {kAnchor, std::array<float, 4>{3, -2, 5, 1}, std::array<float, 4>{1e6f, 0, 0, 1}}) {
    s.anchor = anchor;
    EXPECT_LT(rmse(c, rgbOf(c, s), expected), 0.02) << anchor[0];
  }
  s.anchor = {0, 0, 1e6f, 1};
  EXPECT_EQ(rgbOf(c, s).data, expected.data) << "behind the camera";
}

// ---- Far from the world's origin

// The same scene elsewhere in the world.
Capture moved(Capture capture, const Vector3& by) {
  const Vector3 back = {-by[0], -by[1], -by[2]};
  capture.viewFromWorld = fromOrigin(capture.viewFromWorld, back);
  for (Light& light : capture.lights) {
    for (std::size_t i = 0; i < 3; ++i) light.position[i] += by[i];
    for (ShadowMap& map : light.shadowMaps) {
      map.clipFromWorld = fromOrigin(map.clipFromWorld, back);
      if (map.viewFromWorld) map.viewFromWorld = fromOrigin(*map.viewFromWorld, back);
    }
  }
  return capture;
}

TEST_F(Motion, FarScenesLookAsAtTheOrigin) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 5, 32);
  endPart(model, 0);
  model.lights = {directional({0.3, -0.2, 1}, 3), pointLight({20, 5, -60}, 4000)};
  const RasterOptions options{
      .width = 48, .height = 48, .shadowSize = 128, .shadowEncoding = PELLUCID_DEPTH_VIEW_Z};
  // A near plane of 0.5 mm says that things as near are seen, so that the capture counts as far from 1e4 mm
  // on.
  ModelCamera camera = frontCamera(false);
  camera.range = {0.5, 150};
  const Capture near = rasterize(device(), model, camera, options).capture;
  EXPECT_EQ(worldOrigin(near), (Vector3{0, 0, 0}));
  const Image expected = replay(near, inFloats());
  for (const double distance : {1e6, 6e6}) {
    const Capture far = moved(near, {distance, 0.5 * distance, -distance});
    const Image picture = replay(far, inFloats());
    double worst = 0, brightest = 0;
    for (std::size_t i = 0; i < picture.data.size(); ++i) {
      worst = std::max(
          worst, std::abs(static_cast<double>(picture.data[i]) - static_cast<double>(expected.data[i])));
      brightest = std::max(brightest, static_cast<double>(expected.data[i]));
    }
    // The matrices differ by roundings of floats, which now and then move a sample by a texel.
    EXPECT_LT(worst, 2e-3 * brightest) << distance;
  }
}

// Where floats are too coarse: replays move the anchor with the world's origin.
TEST_F(Motion, AnchorsOfFarScenesAreTheirBodies) {
  const Capture& near = ball();
  constexpr std::array<double, 3> kOffset = {1 << 20, -(1 << 18), 1 << 19};
  const Capture far = moved(near, kOffset);
  ASSERT_NE(worldOrigin(far), (std::array<double, 3>{0, 0, 0}));
  ReplaySettings s = gathering(8);
  s.anchor = kAnchor;
  const Image expected = rgbOf(near, s);
  EXPECT_GT(rmse(near, rgbOf(far, s), expected), 0.004) << "there is no noise to tell anchors apart";
  for (std::size_t i = 0; i < 3; ++i) s.anchor[i] += static_cast<float>(kOffset[i]);
  EXPECT_LT(rmse(near, rgbOf(far, s), expected), 5e-4);
}

// Nothing but the rect is written, and an anchor changes its noise alone.
TEST_F(Motion, AnchoredRectIsThePart) {
  const Capture& c = ball();
  ReplaySettings s = gathering(64, 2);
  s.anchor = {1, 2, 5, 1};
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  s.renderRect = {21, 25, 44, 30};
  const Image part = rgbOf(c, s);
  s.anchor = {};
  const Image loose = rgbOf(c, s);
  EXPECT_NE(part.data, loose.data);
  EXPECT_LT(rmse(c, part, loose), 0.01);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const bool outside = x < 21 || x >= 65 || y < 25 || y >= 55;
      for (int k = 0; outside && k < 3; ++k)
        ASSERT_EQ(part.at(x, y)[k], c.irradiance.at(x, y)[k] * (c.albedo.empty() ? 1 : c.albedo.at(x, y)[k]))
            << x << ", " << y;
    }
}

// ---- Accumulation

ReplaySettings accumulated(uint32_t spacing = 1) {
  ReplaySettings s = gathering(8, spacing);
  s.reuse = PELLUCID_REUSE_ACCUMULATE;
  return s;
}

// The frame before was elsewhere on the screen, which the motion image says; without it the light of other
// places is kept.
TEST_F(Motion, KeptLightConvergesAndFollowsTheMotion) {
  const Capture& still = ball();
  for (const uint32_t spacing : {1u, 4u}) {
    Sequence sequence;
    // The diffusion's own change is not the probes'.
    ReplaySettings kept = accumulated(spacing), alike = gathering(8, spacing), many = gathering(64, spacing);
    kept.features = alike.features = many.features = PELLUCID_FEATURE_TRANSLUCENCY;
    const Image first = next(sequence, still, kept), expected = rgbOf(still, many);
    Image before, last;
    for (int i = 0; i < 14; ++i) {
      last = std::move(before);
      before = next(sequence, still, kept);
    }
    // Eight samples have an error of their own, which no frame takes away.
    const double error = rmse(still, first, expected);
    EXPECT_LT(rmse(still, before, expected), (spacing == 1 ? 0.9 : 0.95) * error) << spacing;
    EXPECT_LT(rmse(still, before, last), 0.2 * error) << spacing;
    Capture moved = movedCapture(still, 4, -2, 6);
    moved.motion = Reprojection(still, moved).motion();
    const Image now = next(sequence, moved, kept);
    const Flicker flicker = compareShifted(before, now, maskOf(still), 4, -2),
                  alone = compareShifted(rgbOf(still, alike), rgbOf(moved, alike), maskOf(still), 4, -2);
    // Pixels lie elsewhere between probes of cells of 4 pixels, whose light is no noise.
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_LT(flicker.relativeRmse[c], (spacing == 1 ? 0.5 : 1.0) * alone.relativeRmse[c]) << spacing;
  }
}

// As a cut: the first frame of a sequence, and one of another size of cells, are as if there were no history.
TEST_F(Motion, CutsStartAnew) {
  const Capture& c = ball();
  const Image alone = rgbOf(c, gathering(8, 2));
  Sequence sequence;
  EXPECT_EQ(next(sequence, c, accumulated(2)).data, alone.data);
  EXPECT_NE(next(sequence, c, accumulated(2)).data, alone.data);
  EXPECT_EQ(next(sequence, c, accumulated(4)).data, rgbOf(c, gathering(8, 4)).data);
}

// Light that goes down or up by four times is there within an eighth after a frame.
TEST_F(Motion, LightThatChangesDoesNotLinger) {
  const Capture& lit = ball();
  Capture dark = lit;
  dark.lights[0].intensity = 0.25;
  for (const bool comes : {false, true}) {
    const Capture &before = comes ? dark : lit, &after = comes ? lit : dark;
    const Image expected = rgbOf(after, gathering(64));
    Sequence sequence;
    for (int i = 0; i < 6; ++i) sequence.run(before, skin(), accumulated());
    EXPECT_LT(rmse(lit, next(sequence, after, accumulated()), expected), 0.12) << comes;
    for (int i = 0; i < 6; ++i) sequence.run(after, skin(), accumulated());
    EXPECT_LT(rmse(lit, next(sequence, after, accumulated()), expected), 0.05) << comes;
  }
}

// No frame wrote the bytes that a fresh history holds: they bring no light around the rect, or where a frame
// had no material.
TEST_F(Motion, BytesOfAFreshHistoryAreNotRead) {
  const Capture& c = ball();
  Capture part = c;  // pixels that lose their material, by groups of the filter
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x)
      if (x / 16 % 2 == y / 16 % 2) part.material[static_cast<size_t>(y * c.width + x)] = 0;
  Capture moved = c;
  moved.motion = Image(c.width, c.height, 2, 0.06f);
  ReplaySettings s = accumulated();
  s.renderRect = {9, 5, 80, 70};
  const auto lastOf = [&](std::uint64_t garbage) {
    const std::vector materials{skin()};
    const Context& context = replayer().contextFor(c);
    const FrameRun first(device(), context, part, materials, s);
    first.fillGarbage(garbage);
    record(first);
    return record(FrameRun(device(), context, moved, materials, s, &first));
  };
  const Image zeros = lastOf(0);
  for (const float v : zeros.data) ASSERT_TRUE(std::isfinite(v));
  for (const std::uint64_t garbage : {1u, 2u, 3u}) EXPECT_TRUE(sameBits(lastOf(garbage), zeros)) << garbage;
}

// What faced another way is another surface: the next frame is as if nothing had been there.
TEST_F(Motion, LightOfASurfaceThatTurnedIsNotKept) {
  const Capture& c = ball();
  Capture none = c, turned = c, second = c;
  std::fill(none.material.begin(), none.material.end(), std::uint8_t{0});
  second.motion = Image(c.width, c.height, 4, 0.0f);
  // Ramps about the ball's depths, of 70 degrees and more: .75 mm for each pixel of .25 mm.
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) *turned.frontDepth.image.at(x, y) += 0.75f * (static_cast<float>(x % 8) - 3.5f);
  ReplaySettings s = accumulated();
  s.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const auto after = [&](const Capture& before) {
    const std::vector materials{skin()};
    const Context& context = replayer().contextFor(c);
    const FrameRun first(device(), context, before, materials, s);
    record(first);
    return record(FrameRun(device(), context, second, materials, s, &first));
  };
  const Image fresh = after(none), kept = after(c), other = after(turned);
  int changed = 0;
  // In the middle the ball itself faces the camera.
  for (int y = 40; y < 56; ++y)
    for (int x = 40; x < 56; ++x)
      for (int k = 0; k < 3; ++k) {
        changed += kept.at(x, y)[k] != fresh.at(x, y)[k];
        EXPECT_EQ(other.at(x, y)[k], fresh.at(x, y)[k]) << x << ", " << y;
      }
  EXPECT_GT(changed, 0) << "nothing is kept of the ball itself";
}

// Cells of 1.3 mm of skin are too far apart to have patterns of their own in a single frame.
TEST_F(Motion, CellsThatHardlyShareAverageOverFramesToo) {
  SceneParameters p{.name = "sphere", .options = {{"radius", 16}, {"extent", 48}, {"lightAngle", 110}}};
  p.width = p.height = 72;
  p.shadowSize = 160;
  const Capture c = makeScene(p);
  ReplaySettings kept = accumulated(2), many = gathering(64, 2), few = gathering(8, 2);
  kept.features = many.features = few.features = PELLUCID_FEATURE_TRANSLUCENCY;
  const Image expected = rgbOf(c, many);
  const double alone = rmse(c, rgbOf(c, few), expected);
  Sequence sequence;
  Image before, last = next(sequence, c, kept);
  for (int i = 0; i < 14; ++i) {
    before = std::move(last);
    last = next(sequence, c, kept);
    EXPECT_FALSE(sameBits(before, last)) << "frame " << i << " takes the samples of the one before";
  }
  EXPECT_LT(rmse(c, last, expected), 0.95 * alone);
  EXPECT_LT(rmse(c, last, before), 0.3 * alone) << "it flickers";
}

// Kept light has the exposure of its frame.
TEST_F(Motion, ExposureMayChange) {
  const Capture& c = ball();
  Sequence sequence, exposed;
  for (int i = 0; i < 3; ++i) {
    ReplaySettings s = accumulated();
    const Image expected = next(sequence, c, s);
    s.preExposure = static_cast<float>(1 << 2 * i);
    Image out = next(exposed, c, s);
    for (float& v : out.data) v /= s.preExposure;
    EXPECT_LT(rmse(c, out, expected), 2e-3) << i;
  }
}

// Motion that is no number keeps nothing.
TEST_F(Motion, BadMotionIsNone) {
  Capture bad = ball();
  bad.motion = Image(bad.width, bad.height, 2);
  for (std::size_t i = 0; i < bad.motion.data.size(); ++i)
    bad.motion.data[i] = i % 3 == 0 ? std::nanf("") : i % 3 == 1 ? INFINITY : -1e30f;
  const Image expected = rgbOf(ball(), gathering(8));
  Sequence sequence;
  for (int i = 0; i < 2; ++i) {
    const Image out = next(sequence, bad, accumulated());
    EXPECT_LT(rmse(bad, out, expected), 0.05);
    for (const float v : out.data) ASSERT_TRUE(std::isfinite(v));
  }
}

}  // namespace
