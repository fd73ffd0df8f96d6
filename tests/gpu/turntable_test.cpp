// Turntables: a camera and lights that turn back are a model that turns.
#include <cmath>
#include <numbers>

#include "gpu_fixture.h"
#include "raster/framing.h"
#include "raster/raster.h"
#include "scene/turn.h"
#include "scene/vector.h"

namespace {

using namespace pellucid::test;

// A double-sided triangle without symmetry, leaning, around (1, 2, 3).
Model triangle() {
  Model model;
  model.name = "triangle";
  const glm::vec3 corners[] = {{-1, 1, 2}, {4, 1.5f, 3}, {0, 4, 5}};
  const glm::vec3 normal = glm::normalize(glm::cross(corners[1] - corners[0], corners[2] - corners[0]));
  for (const glm::vec3& p : corners)
    model.vertices.push_back({{p.x, p.y, p.z}, {normal.x, normal.y, normal.z}});
  model.indices = {0, 1, 2};
  model.parts = {{0, 3, 0, 0}};
  model.surfaces.resize(1);
  model.surfaces[0].material = 1;
  model.surfaces[0].doubleSided = true;
  model.materials = {PresetMaterial{"skin1"}};
  model.lights.resize(1);
  model.lights[0].type = PELLUCID_LIGHT_POINT;
  model.lights[0].position = {9, 8, 20};
  model.lights[0].intensity = 200;
  return model;
}

// About the vertical through `center`, counterclockwise from above.
Model turned(Model model, const Vector3& center, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  const auto turn = [&](std::array<float, 3>& v, double x, double z) {
    const double dx = static_cast<double>(v[0]) - x, dz = static_cast<double>(v[2]) - z;
    v[0] = static_cast<float>(x + c * dx + s * dz);
    v[2] = static_cast<float>(z - s * dx + c * dz);
  };
  for (Vertex& vertex : model.vertices) {
    turn(vertex.position, center[0], center[2]);
    turn(vertex.normal, 0, 0);
  }
  return model;
}

class Turntable : public GpuTest {};

TEST_F(Turntable, TurningBackIsTheModelTurning) {
  const Model model = triangle();
  const Vector3 center = boundsOf(model).center;
  const std::vector<double> turns = {0, 0.7, 1.9};
  const ModelCamera camera = frameModel(model, {0.3, 0.2, 1}, 0.5, 1, false, turns);
  const RasterOptions options{.width = 64, .height = 64, .shadowSize = 64};
  for (const double angle : turns) {
    const Capture expected = rasterize(device(), turned(model, center, angle), camera, options).capture;
    Model still = model;
    still.lights[0] = turnedLight(model.lights[0], center, -angle);
    ModelCamera carried = camera;
    carried.viewFromWorld = turnedView(camera.viewFromWorld, center, -angle);
    const Capture actual = rasterize(device(), still, carried, options).capture;
    int covered = 0, different = 0;
    double worstDepth = 0, worstLight = 0;
    for (size_t i = 0; i < expected.material.size(); ++i) {
      different += expected.material[i] != actual.material[i];
      if (!expected.material[i] || !actual.material[i]) continue;
      ++covered;
      const auto difference = [](float a, float b) { return std::abs(static_cast<double>(a - b)); };
      worstDepth = std::max(worstDepth,
                            difference(expected.frontDepth.image.data[i], actual.frontDepth.image.data[i]));
      worstLight =
          std::max(worstLight, difference(expected.irradiance.data[3 * i], actual.irradiance.data[3 * i]));
    }
    EXPECT_GT(covered, 100) << angle;
    EXPECT_LE(different, 2) << angle << ": rounding may move a pixel of the edge";
    EXPECT_LT(worstDepth, 1e-5) << angle;
    EXPECT_LT(worstLight, 1e-3) << angle;
  }
}

TEST_F(Turntable, AutoCameraSeesEveryFrame) {
  const Model model = triangle();
  const Vector3 center = boundsOf(model).center;
  std::vector<double> turns;
  for (int i = 0; i < 12; ++i) turns.push_back(2 * std::numbers::pi * i / 12);
  const ModelCamera camera = frameModel(model, {0, 0.4, 1}, 0.6, 1.5, false, turns);
  for (const double angle : turns) {
    const glm::dmat4 view = toGlm(turnedView(camera.viewFromWorld, center, angle));
    for (const Vertex& v : model.vertices) {
      const glm::dvec3 p = view * glm::dvec4(v.position[0], v.position[1], v.position[2], 1);
      const double top = -p.z * std::tan(0.3);
      EXPECT_LT(std::abs(p.y), top) << angle;
      EXPECT_LT(std::abs(p.x), 1.5 * top) << angle;
      EXPECT_GT(-p.z, camera.range.nearPlane) << angle;
      EXPECT_LT(-p.z, camera.range.farPlane) << angle;
    }
  }
}

}  // namespace
