// The two failure cases of Whelan 2009, figures 4.5 and 4.6, against closed forms; reuse between frames.
#include "gpu_fixture.h"

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
    SceneParameters p;
    p.name = name;
    p.width = p.height = kSide;
    p.orthographic = true;
    p.lightType = PELLUCID_LIGHT_DIRECTIONAL;
    return makeScene(p);
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
  c.lights[0].shadowMap.reset();
  expectThrough(c, middle, middle);
}

// A light that turns: frames that refresh are as without reuse, frames between them are their own irradiance
// plus the light that came through at the last refresh, gathered or not.
TEST_F(GpuTest, ReuseOverATurningLight) {
  const Context context(device());
  for (const auto reuse : {PELLUCID_REUSE_ALTERNATE, PELLUCID_REUSE_COHERENCE})
    for (const int maps : {1, 9}) {  // one fused dispatch, and two
      ReplaySettings s;
      s.outputFormat = VK_FORMAT_R32G32B32A32_SFLOAT;
      s.features = PELLUCID_FEATURE_TRANSLUCENCY;
      s.reuse = reuse;
      s.translucency.gatherSamples = maps == 1 ? 8 : 0;
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
          light.shadowMap = flatShadowMap(-12, PELLUCID_DEPTH_VIEW_Z, 4);
          c.lights.push_back(light);
        }
        auto run =
            std::make_unique<FrameRun>(device(), context, c, std::vector{testMaterial()}, s, last.get());
        device().run([&](VkCommandBuffer commands) { run->record(commands); });
        const Image out = run->output(), own = replay(c, testMaterial(), plain);
        if (run->plan().history.age == 0) {
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
