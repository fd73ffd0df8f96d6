// Planes with painted irradiance, whose diffused result has a closed form.
#include <cmath>

#include "scene/model.h"

namespace pellucid::harness {

namespace {

std::vector<SceneOption> withCommonOptions(std::vector<SceneOption> own) {
  const std::vector<SceneOption> common = {
      kExtent,
      {"tilt", 0, -85, 85, "rotation of the plane about the vertical axis, degrees"},
      {"thickness", 20, 1e-3, 1e3, "depth of the solid behind the plane, mm"},
      {"samples", 1, 1, 64, "irradiance averaged over samples^2 points of each pixel"}};
  own.insert(own.end(), common.begin(), common.end());
  return own;
}

Camera patternCamera(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  const double distance = 5 * extent;
  // A plane tilted by 85 degrees reaches 6 extents towards and away from the eye.
  const bool orthographic = parameters.orthographic.value_or(true);
  return placeCamera(parameters, {{0, 0, distance},
                                  {0, 0, 0},
                                  extent,
                                  true,
                                  orthographic ? -2 * extent : extent / 100,
                                  distance + 10 * extent + options["thickness"]});
}

// A plane through the origin painted with pattern(u, v): lengths (mm) along the plane, u to the right
// and v upward as seen by the camera.
SceneModel patternModel(const SceneParameters& parameters, const OptionValues& options,
                        const std::function<double(double, double)>& pattern) {
  const double tilt = radians(options["tilt"]);
  const glm::dvec3 across(std::cos(tilt), 0, -std::sin(tilt));
  const glm::dvec3 up(0, 1, 0);
  const glm::dvec3 normal(std::sin(tilt), 0, std::cos(tilt));
  const double half = options["thickness"] / 2;

  SceneModel model;
  model.camera = patternCamera(parameters, options);
  model.endless = true;
  Object plane;
  plane.solid = std::make_unique<Polyhedron>(
      Polyhedron::box(-half * normal, glm::dmat3(across, up, normal), {kInfinity, kInfinity, half}));
  model.objects.push_back(std::move(plane));
  model.paint = [=](const glm::dvec3& p) {
    return glm::dvec3(pattern(glm::dot(p, across), glm::dot(p, up)));
  };
  model.paintSamples = static_cast<int>(options["samples"]);
  return model;
}

const SceneOption kAngle = {"angle", 0, -180, 180, "rotation of the pattern in the plane, degrees"};

SceneModel buildPlane(const SceneParameters& parameters, const OptionValues& options) {
  return patternModel(parameters, options, [](double, double) { return 1.0; });
}

SceneModel buildStep(const SceneParameters& parameters, const OptionValues& options) {
  const double angle = radians(options["angle"]);
  return patternModel(parameters, options, [c = std::cos(angle), s = std::sin(angle)](double u, double v) {
    return c * u + s * v > 0 ? 1.0 : 0.0;
  });
}

SceneModel buildChecker(const SceneParameters& parameters, const OptionValues& options) {
  const double angle = radians(options["angle"]);
  return patternModel(parameters, options,
                      [c = std::cos(angle), s = std::sin(angle), cell = options["cell"]](double u, double v) {
                        const double i = std::floor((c * u + s * v) / cell);
                        const double j = std::floor((c * v - s * u) / cell);
                        return std::fmod(i + j, 2) == 0 ? 1.0 : 0.0;
                      });
}

}  // namespace

std::vector<SceneDefinition> patternScenes() {
  return {
      {{"plane", "Plane of irradiance 1: diffusion returns it unchanged", withCommonOptions({})}, buildPlane},
      {{"step", "Half-plane of irradiance 1 through the image's center", withCommonOptions({kAngle})}, buildStep},
      {{"checker", "Checkered irradiance on a plane, 0 and 1",
        withCommonOptions({{"cell", 5, 1e-3, 1e5, "side of a square, mm"}, kAngle})},
       buildChecker},
  };
}

}  // namespace pellucid::harness
