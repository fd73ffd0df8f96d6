// The two failure cases of Whelan 2009, figures 4.5 and 4.6, against closed forms; reuse between frames.
#include "gpu_fixture.h"

#include <cstdio>
#include <numbers>

#include "scene/scene.h"

namespace {

using namespace pellucid::test;

constexpr int kSide = 96;
constexpr double kThickness = 2;  // mm, the scenes' default
// Relative: float rounding of positions of 160 mm over 2 mm of thickness, and of the exponential.
constexpr double kRounding = 1e-5;
// Vulkan inherits the precision of acos from atan2: units in the last place of the angle.
constexpr double kAcosUlps = 4096;

class ThesisFigure : public GpuTest {
protected:
  static Capture make(const char* name) {
    return makeScene({.name = name,
                      .width = kSide,
                      .height = kSide,
                      .orthographic = true,
                      .lightType = PELLUCID_LIGHT_DIRECTIONAL});
  }

  // Red light that comes through at a pixel, in the mode of the thesis but for T(d) = e^{-d / 2 mm}.
  static double through(const Capture& c, int x, int y, PellucidAngleModel model) {
    ReplaySettings s = thesisSettings();
    s.translucency.angleModel = model;
    s.transmittance = TransmittanceChoice::Material;
    s.features = PELLUCID_FEATURE_TRANSLUCENCY;
    s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    const Image out = replay(c, testMaterial(), s);
    return static_cast<double>(out.at(x, y)[0] - c.irradiance.at(x, y)[0]);
  }

  struct Expected {
    double value, tolerance;
  };

  // E f(x) T / rho, x the cosine between view and light, f of the model.
  static Expected expected(const Capture& c, PellucidAngleModel model) {
    const Light& light = c.lights.at(0);
    const Matrix& m = c.viewFromWorld;
    double cosine = 0, length = 0;
    for (size_t i = 0; i < 3; ++i) {
      cosine += m[4 * i + 2] * light.direction[i];
      length += light.direction[i] * light.direction[i];
    }
    cosine /= std::sqrt(length);
    double factor = cosine, error = 0;
    if (model == PELLUCID_ANGLE_INVERSE_COSINE) {
      const double angle = std::acos(cosine);
      factor = 1 - angle * 2 / std::numbers::pi;
      error = kAcosUlps * std::exp2(std::floor(std::log2(angle)) - 23) * 2 / std::numbers::pi;
    }
    const double value = light.intensity * light.color[0] * factor * std::exp(-kThickness / 2) / 0.5;
    return {value, value * (kRounding + error / factor)};
  }

  static void expectThrough(const Capture& c, int x, int y) {
    for (const auto model : {PELLUCID_ANGLE_COSINE, PELLUCID_ANGLE_INVERSE_COSINE}) {
      const Expected e = expected(c, model);
      EXPECT_NEAR(through(c, x, y, model), e.value, e.tolerance) << "angle model " << model;
    }
  }
  static void expectNothing(const Capture& c, int x, int y) {
    for (const auto model : {PELLUCID_ANGLE_COSINE, PELLUCID_ANGLE_INVERSE_COSINE})
      EXPECT_EQ(through(c, x, y, model), 0) << "angle model " << model;
  }
};

// Figure 4.5: a body behind the thin part, from the camera. The nearest back face ends the thin part; the
// farthest one would count the gap and the body as flesh.
TEST_F(ThesisFigure, ThinPartInFrontOfAnOccluder) {
  Capture c = make("occluder");
  const int middle = kSide / 2;
  expectThrough(c, middle, middle);
  const double nearest = expected(c, PELLUCID_ANGLE_COSINE).value;
  for (float& depth : c.backDepth.image.data) depth += 40;
  EXPECT_LT(through(c, middle, middle, PELLUCID_ANGLE_COSINE), 1e-6 * nearest);
}

// Figure 4.6: a body between the light and the thin part. The shadow map keeps its light away.
TEST_F(ThesisFigure, ThinPartWhoseLightIsBlocked) {
  Capture c = make("blocked");
  const int middle = kSide / 2;
  int corner = middle;  // the last pixel of the sheet on the diagonal, away from the body's shadow
  const auto isSheet = [&](int i) { return c.material[static_cast<size_t>(i * kSide + i)] != 0; };
  while (isSheet(corner + 1)) ++corner;
  corner -= 2;
  expectNothing(c, middle, middle);
  expectThrough(c, corner, corner);
  // Without the map nothing knows of the body.
  c.lights[0].shadowMaps.clear();
  expectThrough(c, middle, middle);
}

// What the choice of the back face costs where the scene's exact thickness of the first layer is known. The
// farthest face is that of the same scene with its gap filled, in the orthographic view along -z.
TEST_F(ThesisFigure, NearestAndFarthestBackDepth) {
  struct Case {
    const char* name;
    double nearest, farthest;  // limits of the relative RMSE: above nearest's, below farthest's
  };
  for (const Case& test : {Case{"hollow_sphere", 1e-4, 1}, Case{"two_sheets", 1e-4, 3}}) {
    SceneParameters p{.name = test.name,
                      .width = kSide,
                      .height = kSide,
                      .orthographic = true,
                      .lightType = PELLUCID_LIGHT_DIRECTIONAL};
    Image exact;
    const Capture nearest = makeScene(p, &exact);
    Capture farthest = nearest;
    if (test.name == std::string("hollow_sphere")) {
      p.name = "sphere";
      farthest.backDepth = makeScene(p).backDepth;
    } else {
      for (int y = 0; y < kSide; ++y)
        for (int x = kSide / 2; x < kSide; ++x)
          *farthest.backDepth.image.at(x, y) += 15 + 2;  // gap and sheet
    }
    ReplaySettings s = thesisSettings();
    s.transmittance = TransmittanceChoice::Material;
    s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
    s.debugView = PELLUCID_DEBUG_THICKNESS;
    double error[2] = {0, 0}, lost = 0, light = 0, sum = 0;
    for (const bool far : {false, true}) {
      const Image out = replay(far ? farthest : nearest, testMaterial(), s);
      for (size_t i = 0; i < nearest.material.size(); ++i) {
        if (nearest.material[i] == 0) continue;
        const double truth = exact.data[i], thickness = out.data[4 * i];
        error[far] += (thickness - truth) * (thickness - truth);
        sum += far ? 0 : truth * truth;
        light += far ? 0 : std::exp(-truth / 2);
        lost += far ? std::exp(-truth / 2) - std::exp(-thickness / 2) : 0;
      }
    }
    std::printf(
        "%-14s thickness, relative RMSE: nearest %.1e, farthest %.2f; light lost to farthest %.0f %%\n",
        test.name, std::sqrt(error[0] / sum), std::sqrt(error[1] / sum), 100 * lost / light);
    EXPECT_LT(std::sqrt(error[0] / sum), test.nearest) << test.name;
    EXPECT_GT(std::sqrt(error[1] / sum), test.farthest) << test.name;
  }
}

// A light that turns: frames that refresh are as without reuse, frames between them are their own irradiance
// plus the light that came through at the last refresh.
TEST_F(GpuTest, ReuseOverATurningLight) {
  const Context& context = replayer().contextFor(Capture{});
  for (const auto reuse : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE})
    for (const int maps : {1, 9}) {  // one fused dispatch, and two
      ReplaySettings s = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
      s.reuse = reuse;
      ReplaySettings plain = s;
      plain.reuse = PELLUCID_REUSE_NONE;
      std::unique_ptr<FrameRun> last;
      Image kept, keptIrradiance;  // of the last refresh
      int refreshed = 0;
      for (int i = 0; i < 12; ++i) {
        Capture c = flatCapture(24, 16, 2);
        for (size_t p = 0; p < c.irradiance.data.size(); ++p)
          c.irradiance.data[p] += 0.1f * static_cast<float>(i);
        // What was outside of the material at a refresh may be inside of it later.
        for (size_t p = 0; p < c.material.size(); ++p) c.material[p] = static_cast<int>(p % 24) < 10 + i;
        const double angle = 0.2 + 0.02 * i;
        for (int k = 0; k < maps; ++k) {
          Light light = backLight();
          light.direction = {std::sin(angle), 0, std::cos(angle)};
          light.intensity = 1;
          light.shadowMaps = {flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z, 4)};
          c.lights.push_back(light);
        }
        auto run =
            std::make_unique<FrameRun>(device(), context, c, std::vector{testMaterial()}, s, last.get());
        device().run([&](VkCommandBuffer commands) { run->record(commands); });
        const Image out = run->output(), own = replay(c, testMaterial(), plain);
        if (run->plan().historyAge == 0) {
          kept = own;
          keptIrradiance = c.irradiance;
          ++refreshed;
        }
        for (size_t p = 0; p < out.data.size(); ++p) {
          const size_t e = p / 4 * 3 + p % 4;
          if (p % 4 == 3 || c.material[p / 4] == 0) continue;
          const bool seen = kept.data[p] != keptIrradiance.data[e];  // was material at the refresh
          const float through = seen ? kept.data[p] - keptIrradiance.data[e] : 0;
          ASSERT_NEAR(out.data[p], c.irradiance.data[e] + through, 1e-5) << "frame " << i;
        }
        last = std::move(run);
      }
      EXPECT_GT(refreshed, 2);
      EXPECT_LT(refreshed, 12);
      EXPECT_TRUE(reuse != PELLUCID_REUSE_ALTERNATE || refreshed == 6) << refreshed;
    }
}

}  // namespace
