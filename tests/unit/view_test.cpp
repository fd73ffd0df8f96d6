// The viewer without a window: camera, lights, input and settings.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "replay/settings.h"
#include "scene/turn.h"
#include "view/input.h"

namespace {

using namespace pellucid::harness;

constexpr double kPi = std::numbers::pi;

ViewCamera cameraAt(const Vector3& eye, const Vector3& pivot) {
  ViewCamera camera;
  camera.lens.viewFromWorld = lookAt(eye, pivot, {0, 1, 0});
  camera.pivot = pivot;
  return camera;
}

double distance(const Vector3& a, const Vector3& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

void expectNear(const Vector3& a, const Vector3& b, double tolerance) {
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

// Rounding of a few turns in double precision.
constexpr double kRounding = 1e-12;

TEST(ViewCamera, YawIsTheTurntablesTurn) {
  ViewCamera camera = cameraAt({1, 2, 5}, {1, 0, -1});
  const Matrix expected = turnedView(camera.lens.viewFromWorld, camera.pivot, 0.3);
  orbit(camera, 0.3, 0);
  for (std::size_t i = 0; i < 16; ++i) EXPECT_NEAR(camera.lens.viewFromWorld[i], expected[i], kRounding);
}

TEST(ViewCamera, OrbitKeepsTheDistanceAndLooksAtThePivot) {
  ViewCamera camera = cameraAt({0, 0, 5}, {0, 0, 0});
  orbit(camera, 0, kPi / 6);
  expectNear(camera.eye(), {0, 2.5, 5 * std::cos(kPi / 6)}, kRounding);
  orbit(camera, kPi / 2, 0);
  expectNear(camera.eye(), {5 * std::cos(kPi / 6), 2.5, 0}, kRounding);
  const Vector3 eye = camera.eye(), back = camera.back();
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(eye[i], 5 * back[i], kRounding);
}

TEST(ViewCamera, RangeHoldsTheSphereAndStaysInFront) {
  ViewCamera camera = cameraAt({0, 0, 5}, {0, 0, 0});
  fitRange(camera, {0, 0, 0}, 1);
  EXPECT_LT(camera.lens.range.nearPlane, 4);
  EXPECT_GT(camera.lens.range.nearPlane, 3.9);
  EXPECT_GT(camera.lens.range.farPlane, 6);
  for (const double z : {0.5, -9.0}) {  // within the sphere, and with it behind
    camera = cameraAt({0, 0, z}, {0, 0, z - 1});
    fitRange(camera, {0, 0, 0}, 1);
    EXPECT_GT(camera.lens.range.nearPlane, 0);
    EXPECT_GT(camera.lens.range.farPlane, camera.lens.range.nearPlane);
  }
}

TEST(ViewLights, NewOnesBringOneToTheCenter) {
  const ViewCamera camera = cameraAt({0, 0, 5}, {0, 0, 0});
  for (const PellucidLightType type :
       {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT}) {
    const Light light = newLight(type, camera, {0, 0, 0}, 2).light;
    const double r = distance(light.position, {0, 0, 0});
    EXPECT_NEAR(type == PELLUCID_LIGHT_DIRECTIONAL ? light.intensity : light.intensity / (r * r), 1,
                kRounding);
    EXPECT_GT(light.direction[2], 0);  // towards the camera
    EXPECT_LT(light.innerConeAngle, light.outerConeAngle);
  }
}

TEST(ViewLights, DragMovesThemAsTheCameraSeesIt) {
  const ViewCamera camera = cameraAt({0, 0, 5}, {0, 0, 0});
  for (const double side : {1.0, -1.0}) {  // before and behind the center
    Light light;
    light.type = PELLUCID_LIGHT_POINT;
    light.position = {0, 0, 3 * side};
    dragLight(light, camera, {0, 0, 0}, 0.2, 0);
    expectNear(light.position, {3 * std::sin(0.2), 0, 3 * side * std::cos(0.2)}, kRounding);
    light.position = {0, 0, 3 * side};
    dragLight(light, camera, {0, 0, 0}, 0, 0.2);
    expectNear(light.position, {0, 3 * std::sin(0.2), 3 * side * std::cos(0.2)}, kRounding);
  }
}

TEST(ViewLights, PullKeepsWhatArrives) {
  Light light;
  light.type = PELLUCID_LIGHT_SPOT;
  light.position = {0, 0, 3};
  light.intensity = 9;
  pullLight(light, {0, 0, 1}, 2);
  expectNear(light.position, {0, 0, 5}, kRounding);
  EXPECT_NEAR(light.intensity / 16, 9.0 / 4, kRounding);
}

// A sphere of radius 1 that nothing renders.
class FakeSource : public Source {
public:
  Scene render(const ViewState&) override { return {}; }
  void fix() { fixedCamera_ = "fixed"; }
};

struct Drag {
  FakeSource source;
  ViewState state;
  Controls controls;
  ScreenRect picture{100, 0, 400, 400};

  Drag() { state.camera = cameraAt({0, 0, 5}, {0, 0, 0}); }
  Changes drag(float fromX, float fromY, float toX, float toY, bool shift = false) {
    ViewInput input;
    input.x = fromX;
    input.y = fromY;
    input.movedX = 1000;  // on the way there
    input.left = true;
    input.shift = shift;
    Changes changes = controls.apply(state, input, source, picture);
    input.x = toX;
    input.y = toY;
    input.movedX = toX - fromX;
    input.movedY = toY - fromY;
    changes.add(controls.apply(state, input, source, picture));
    controls.apply(state, {}, source, picture);
    return changes;
  }
};

TEST(ViewInput, DragOrbitsHalfATurnAPicture) {
  Drag d;
  EXPECT_TRUE(d.drag(200, 200, 400, 200).scene);
  expectNear(d.state.camera.eye(), {-5, 0, 0}, kRounding);  // the model turns right, so the camera goes left
  Drag fixed;
  fixed.source.fix();
  EXPECT_FALSE(fixed.drag(200, 200, 400, 200).any());
}

TEST(ViewInput, ShiftDragsTheSelectedLight) {
  Drag d;
  d.state.lights = {newLight(PELLUCID_LIGHT_POINT, d.state.camera, {0, 0, 0}, 1)};
  d.state.lights[0].light.position = {0, 0, 3};
  EXPECT_TRUE(d.drag(200, 200, 300, 200, true).scene);
  expectNear(d.state.lights[0].light.position, {3 * std::sin(kPi / 4), 0, 3 * std::cos(kPi / 4)}, kRounding);
  expectNear(d.state.camera.eye(), {0, 0, 5}, 0);
}

TEST(ViewSettings, TakeEveryValueThatThePanelAllows) {
  for (const Setting& s : settingsTable()) {
    if (s.label.empty()) continue;
    ReplaySettings settings;
    const std::size_t count = s.get(settings).size();
    for (const double value : {s.low, s.high}) {
      assignNearest(s, settings, Setting::Values(count, value));
      for (const double got : s.get(settings)) EXPECT_EQ(got, value) << s.key;
    }
    assignNearest(s, settings, Setting::Values(count, s.high + 100));
    EXPECT_EQ(s.get(settings)[0], s.high) << s.key;
    assignNearest(s, settings, Setting::Values(count, NAN));
    EXPECT_EQ(s.get(settings)[0], s.high) << s.key;
  }
}

}  // namespace
