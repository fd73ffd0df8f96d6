// Lights with falloff of their own: analytic answers, and the float64 reference.
#include <algorithm>
#include <numbers>

#include "common/compare.h"
#include "gpu_fixture.h"
#include "reference_frame.h"
#include "scene/scene.h"
#include "scene/vector.h"

namespace engine {
#include "falloff_snippet.inc"  // of docs/integration.md
}

namespace {

using namespace pellucid::test;

constexpr int kEntries = PELLUCID_LIGHT_TABLE_ENTRIES;

std::vector<double> table(double (*factor)(double at)) {
  std::vector<double> result;
  for (int i = 0; i < kEntries; ++i) result.push_back(factor(i / (kEntries - 1.0)));
  return result;
}
double line(double at) { return 1 - at; }
double square(double at) { return at * at; }
// An IES profile as lamps have them: two lobes beside the axis.
double lobes(double at) {
  return 0.95 * std::pow(std::sin(4 * std::numbers::pi * std::min(at, 0.25)), 2) + 0.05;
}

ReplaySettings translucency() { return inFloats(PELLUCID_FEATURE_TRANSLUCENCY); }

class LightTables : public GpuTest {};

// Dark in front, with a lamp 5 mm behind its hidden face.
Capture slabBeforeALamp() {
  Capture c = flatCapture(48, 40);
  std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
  Light lamp;
  lamp.type = PELLUCID_LIGHT_POINT;
  lamp.position = {1.5, -1, -16};
  lamp.direction = {0.6, 0, 0.8};
  lamp.intensity = 100;
  c.lights = {lamp};
  return c;
}
glm::dvec3 fromLamp(const Capture& c, int x, int y) {
  const glm::dvec3 hidden(((x + 0.5) / c.width * 2 - 1) / c.clipFromView[0],
                          ((y + 0.5) / c.height * 2 - 1) / c.clipFromView[5], -11);
  return hidden - toGlm(c.lights[0].position);
}

// Light comes through a slab of 1 mm; what arrives behind it is known in closed form.
TEST_F(LightTables, FactorsAreThoseOfAngleAndDistance) {
  Capture c = slabBeforeALamp();
  const Image plain = replay(c, testMaterial(), translucency());
  c.lights[0].angleTable = table(line);
  const Image byAngle = replay(c, testMaterial(), translucency());
  c.lights[0].angleTable = {};
  c.lights[0].range = 9;
  c.lights[0].distanceTable = table(square);
  const Image byDistance = replay(c, testMaterial(), translucency());
  int beyond = 0;
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const glm::dvec3 way = fromLamp(c, x, y);
      const double away = glm::length(way), angle = std::acos(glm::dot(way, toGlm(c.lights[0].direction)) / away);
      ASSERT_GT(*plain.at(x, y), 0.01f);
      // Entries are halves.
      ASSERT_NEAR(double(*byAngle.at(x, y)) / double(*plain.at(x, y)), 1 - angle / std::numbers::pi, 5e-4);
      const double at = away / 9, place = at * (kEntries - 1), below = std::floor(place);
      const double factor =
          std::lerp(square(below / (kEntries - 1)), square((below + 1) / (kEntries - 1)), place - below);
      ASSERT_NEAR(double(*byDistance.at(x, y)) / double(*plain.at(x, y)), at < 1 ? factor : 0, 5e-4);
      beyond += at >= 1;
    }
  EXPECT_GT(beyond, 50);
  EXPECT_LT(beyond, 1000);
}

// The code that docs/integration.md shows, on the device: the light is what the engine's function says.
TEST_F(LightTables, FalloffsOfEnginesAreThoseOfTheirTables) {
  constexpr float kRange = 9;
  Capture c = slabBeforeALamp();
  const Image plain = replay(c, testMaterial(), translucency());
  for (float (*const falloff)(float, float) : {engine::inverseSquare, engine::smoothWindow}) {
    float most = 0;
    const PellucidLightTable made = engine::falloffTable(kRange, falloff, &most);
    EXPECT_EQ(*std::max_element(std::begin(made.factor), std::end(made.factor)), 1);
    c.lights[0].range = static_cast<double>(kRange);
    c.lights[0].distanceTable.assign(std::begin(made.factor), std::end(made.factor));
    c.lights[0].intensity = 100 * static_cast<double>(most);
    const Image output = replay(c, testMaterial(), translucency());
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        const double away = glm::length(fromLamp(c, x, y));
        const double expected =
            away < static_cast<double>(kRange)
                ? away * away * static_cast<double>(falloff(static_cast<float>(away), kRange))
                : 0;
        // Of the most: 63 lines in place of curves whose second derivative is at most 47, and halves.
        ASSERT_NEAR(double(*output.at(x, y)) / double(*plain.at(x, y)), expected,
                    (47.0 / 8 / (63 * 63) + 5e-4) * static_cast<double>(most));
      }
  }
}

// One thickness a pixel, from maps and from the camera.
TEST_F(LightTables, AgreeWithTheReference) {
  for (const auto type : {PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT}) {
    Capture c =
        makeScene({.name = "sphere", .width = 64, .height = 64, .lightType = type, .shadowSize = 128});
    const std::vector<PellucidMaterial> materials(c.materials.size(), testMaterial());
    Light& light = c.lights[0];
    const Vector3 center = sceneCenter({.name = "sphere"});
    double away = 0;
    for (size_t i = 0; i < 3; ++i) away += std::pow(center[i] - light.position[i], 2);
    light.range = 1.2 * std::sqrt(away);
    light.distanceTable = table(square);
    light.angleTable = table(lobes);
    for (size_t i = 0; i < 3; ++i) light.direction[i] = (center[i] - light.position[i]) / std::sqrt(away);
    for (const auto source : {0, 1}) {
      ReplaySettings s = translucency();
      s.translucency.cameraThickness = source;
      const Image gpu = rgb(replayer().run(c, materials, s).output), truth = referenceOf(c, materials, s);
      const auto metrics =
          compareImages(gpu, truth, comparisonMask(c.material, c.irradiance, Subset::All), 1);
      for (const auto& channel : metrics.channels) EXPECT_LT(channel.relativeRmse, 5e-4) << type << source;
    }
  }
}

TEST_F(LightTables, ContextsWithoutRefuseThem) {
  Capture c = flatCapture(16, 16);
  Light lamp;
  lamp.type = PELLUCID_LIGHT_POINT;
  lamp.position = {0, 0, -16};
  lamp.direction = {0, 0, 1};
  lamp.angleTable = table(line);
  c.lights = {lamp};
  const Context plain(device());
  EXPECT_NE(refusalOfRecording(FrameRun(device(), plain, c, {testMaterial()}, translucency())), "accepted");
  EXPECT_NE(plain.message().find("lightTableCount is above 0, but PellucidContextOptions::lightTables is 0"),
            std::string::npos)
      << plain.message();
  EXPECT_THROW(Context(device(), [](PellucidContextDesc& desc) { desc.options.lightTables = 2; }),
               DeviceError);
}

}  // namespace
