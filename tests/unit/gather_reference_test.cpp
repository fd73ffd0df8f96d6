// The gather over all texels against path-traced truth.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "capture/material.h"
#include "capture/capture.h"
#include "reference/gather.h"
#include "reference/path_tracer/truth.h"
#include "reference/path_tracer/walk.h"
#include "scene/model.h"

namespace {

using namespace pellucid::harness;
namespace reference = pellucid::harness::reference;

constexpr std::array<double, 3> kScattering = {0.74, 0.88, 1.01}, kAbsorption = {0.032, 0.17, 0.48};  // skin1

// A pixel; the truth's noise is 1 to 8 % where it is bright and is taken off below.
constexpr std::uint64_t kWalks = 20000;

// What leaves a ball in light from all around, against walks.
TEST(GatherBody, BallsReturnWhatWalksDo) {
  struct Case {
    std::array<double, 3> scattering, absorption;
    double ior, radius, limit[3];  // mm; relative, noise included
  };
  // With an index of refraction the fit of `excess` (module/src/material/gather.cpp) leaves 4 %.
  const Case cases[] = {{{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1, 4, {0.02, 0.03, 0.02}},
                        {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1, 24, {0.02, 0.02, 0.03}},
                        {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1.4, 4, {0.02, 0.04, 0.04}},
                        {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 1.4, 24, {0.03, 0.03, 0.03}},
                        {{2.19, 2.62, 3.0}, {0.0021, 0.0041, 0.0071}, 1.5, 2, {0.02, 0.02, 0.02}}};
  for (const Case& k : cases) {
    const PellucidMaterial material =
        compileMaterial(CoefficientMaterial{k.scattering, k.absorption, 0, k.ior}, "test");
    const glm::dvec3 leaves = reference::GatherKernel(material).leavesBall(k.radius);
    SceneModel ball;
    ball.radius = k.radius;
    ball.objects.emplace_back().solid = std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(k.radius));
    const auto scene = reference::makeSolidScene(ball);
    const reference::TraceMedium medium{{k.scattering[0], k.scattering[1], k.scattering[2]},
                                        {k.absorption[0], k.absorption[1], k.absorption[2]},
                                        0,
                                        k.ior};
    const reference::SurfacePoint top{{0, 0, k.radius}, {0, 0, 1}, {0, 0, 1}, 0, 1};
    // The irradiance is 1 wherever a path leaves.
    constexpr int kBallWalks = 60000;  // noise of .5 %
    glm::dvec3 walked(0);
    for (std::uint64_t i = 0; i < kBallWalks; ++i) {
      reference::PathRandom random(100, 0, i);
      if (const auto exit = reference::walk(*scene, medium, top, random)) walked += exit->weight;
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(leaves[c] / (walked[c] / kBallWalks), 1, k.limit[c])
          << "ior " << k.ior << " radius " << k.radius << " channel " << c;
  }
}

// One pixel's exitance from all texels, against paths from the same point.
struct Shape {
  const char* scene;
  std::map<std::string, double> options;
  double matched, fresnel;  // largest relative error of any channel, of index 1 and 1.4
};
void PrintTo(const Shape& value, std::ostream* out) { *out << value.scene; }

class GatherModel : public testing::TestWithParam<std::tuple<Shape, double>> {};

TEST_P(GatherModel, IsNearTheTruth) {
  const auto& [shape, ior] = GetParam();
  const SceneParameters parameters{.name = shape.scene,
                                   .width = 48,
                                   .height = 48,
                                   .options = shape.options,
                                   .orthographic = true,
                                   .shadowSize = 384};
  const Capture c = makeScene(parameters);
  const PellucidMaterial material = compileMaterial(CoefficientMaterial{kScattering, kAbsorption, 0, ior}, "test");
  const reference::SurfaceReader surfaces(c);
  const reference::Gather gather(c, surfaces, {material});
  // Unlit pixels along the middle row, where no light from the front is near.
  Capture looked = c;
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x)
      if (y != 24 || x < 6 || x >= 42 || x % 4 != 2 || c.irradiance.at(x, y)[0] > 0)
        looked.material[static_cast<std::size_t>(48 * y + x)] = 0;
  const SceneModel model = sceneModel(parameters);
  const auto scene = reference::makeSolidScene(model);
  const std::vector<reference::TraceMedium> media = {{{kScattering[0], kScattering[1], kScattering[2]},
                                                      {kAbsorption[0], kAbsorption[1], kAbsorption[2]},
                                                      0,
                                                      ior}};
  const reference::Emitters emitters{c.lights, {}, {}};
  const reference::VisibleSurface visible = reference::visibleSurface(looked, *scene);
  reference::TruthSums sums;
  reference::TruthTracer(looked, visible, *scene, media, emitters).trace(sums, kWalks, 1, 0, [] {});
  const Truth truth = reference::truthOf(sums);
  double square[3] = {}, noise[3] = {}, power[3] = {};
  for (std::size_t i = 0; i < looked.material.size(); ++i) {
    if (looked.material[i] == 0) continue;
    const reference::Gathered g =
        gather.at(*surfaces.at(static_cast<int>(i % 48), static_cast<int>(i / 48)), 0);
    for (int k = 0; k < 3; ++k) {
      const std::size_t of = 3 * i + static_cast<std::size_t>(k);
      const double gathered = g.transmitted[k] / double(material.reflectance[k]) + g.returned[k];
      square[k] += std::pow(gathered - double(truth.image.data[of]), 2);
      noise[k] += std::pow(double(truth.standardError.data[of]), 2);
      power[k] += std::pow(double(truth.image.data[of]), 2);
    }
  }
  for (int k = 0; k < 3; ++k) {
    // The truth's own noise is not the model's error.
    const double error = std::sqrt(std::max(0.0, square[k] - noise[k]) / power[k]);
    std::printf("%s ior %.1f channel %d: relative error %.3f, noise of the truth %.3f\n", shape.scene, ior, k,
                error, std::sqrt(noise[k] / power[k]));
    EXPECT_LT(error, ior > 1 ? shape.fresnel : shape.matched);
  }
}

// Small round bodies: without Fresnel the model is up to 27 % bright in red. With it light that is reflected
// inside comes around from everywhere, which a kernel of two points does not know: 22 and 34 % dark.
const Shape kShapes[] = {
    {"slab", {{"thickness", 2}, {"extent", 40}}, 0.05, 0.05},
    {"wedge", {{"angle", 20}, {"extent", 24}}, 0.06, 0.11},
    {"sphere", {{"radius", 4}, {"extent", 10}}, 0.40, 0.38},
    {"torus", {{"majorRadius", 6}, {"tube", 0.35}, {"tilt", 0.4 * 180 / M_PI}, {"extent", 20}}, 0.16, 0.27}};

INSTANTIATE_TEST_SUITE_P(Shapes, GatherModel,
                         testing::Combine(testing::ValuesIn(kShapes), testing::Values(1.0, 1.4)),
                         [](const auto& test) {
                           return std::string(std::get<0>(test.param).scene) +
                                  (std::get<1>(test.param) > 1 ? "Fresnel" : "Matched");
                         });

}  // namespace
