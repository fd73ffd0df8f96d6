// Planes with painted irradiance, whose diffused result has a closed form.
#include <cmath>
#include <limits>
#include <numbers>

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

// Coordinate across an edge turned by the option `angle`; positive to the right of a vertical edge.
std::function<double(double, double)> acrossEdge(const OptionValues& options) {
  const double angle = radians(options["angle"]);
  return [c = std::cos(angle), s = std::sin(angle)](double u, double v) { return c * u + s * v; };
}

const SceneOption kAngle = {"angle", 0, -180, 180, "rotation of the pattern in the plane, degrees"};
const SceneOption kLow = {"low", 0, 0, 1e6, "irradiance of the dark part"};
const SceneOption kHigh = {"high", 1, 0, 1e6, "irradiance of the bright part"};

SceneModel buildPlane(const SceneParameters& parameters, const OptionValues& options) {
  return patternModel(parameters, options, [e = options["irradiance"]](double, double) { return e; });
}

SceneModel buildStep(const SceneParameters& parameters, const OptionValues& options) {
  return patternModel(parameters, options,
                      [x = acrossEdge(options), low = options["low"], high = options["high"]](
                          double u, double v) { return x(u, v) > 0 ? high : low; });
}

SceneModel buildSinusoid(const SceneParameters& parameters, const OptionValues& options) {
  return patternModel(parameters, options,
                      [x = acrossEdge(options), k = 2 * std::numbers::pi / options["period"]](
                          double u, double v) { return 1 + std::cos(k * x(u, v)); });
}

SceneModel buildChecker(const SceneParameters& parameters, const OptionValues& options) {
  const double angle = radians(options["angle"]);
  return patternModel(parameters, options,
                      [c = std::cos(angle), s = std::sin(angle), cell = options["cell"], low = options["low"],
                       high = options["high"]](double u, double v) {
                        const double i = std::floor((c * u + s * v) / cell);
                        const double j = std::floor((c * v - s * u) / cell);
                        return std::fmod(i + j, 2) == 0 ? high : low;
                      });
}

SceneModel buildDisc(const SceneParameters& parameters, const OptionValues& options) {
  return patternModel(parameters, options, [radius = options["radius"]](double u, double v) {
    return std::hypot(u, v) < radius ? 1.0 : 0.0;
  });
}

SceneModel buildImpulse(const SceneParameters& parameters, const OptionValues& options) {
  // The pixel whose top left corner is nearest the image's center.
  const double pitch = options["extent"] / parameters.width;
  const double u0 = parameters.width % 2 == 0 ? pitch / 2 : 0;
  const double v0 = parameters.height % 2 == 0 ? -pitch / 2 : 0;
  return patternModel(parameters, options, [=, e = options["irradiance"]](double u, double v) {
    return std::abs(u - u0) < pitch / 2 && std::abs(v - v0) < pitch / 2 ? e : 0;
  });
}

SceneModel buildGap(const SceneParameters& parameters, const OptionValues& options) {
  const double half = options["thickness"] / 2;
  const double gap = options["gap"];
  SceneModel model;
  model.camera = patternCamera(parameters, options);
  model.endless = true;
  // Each half reaches from the middle outwards: two of a box's three pairs of faces, and one face.
  for (const double side : {-1.0, 1.0}) {
    const double front = side < 0 ? 0 : -gap;
    Object object;
    object.solid = std::make_unique<Polyhedron>(std::vector<Polyhedron::Plane>{
        {{-side, 0, 0}, 0}, {{0, 0, 1}, front}, {{0, 0, -1}, 2 * half - front}});
    model.objects.push_back(std::move(object));
  }
  model.paint = [](const glm::dvec3& p) { return glm::dvec3(p.x < 0 ? 1 : 0); };
  model.paintSamples = static_cast<int>(options["samples"]);
  return model;
}

}  // namespace

std::vector<SceneDefinition> patternScenes() {
  return {
      {{"plane", "Plane of constant irradiance: diffusion returns it unchanged",
        withCommonOptions({{"irradiance", 1, 0, 1e6, "E everywhere"}})},
       buildPlane},
      {{"step", "Half-plane irradiance step through the image's center",
        withCommonOptions({kAngle, kLow, kHigh})},
       buildStep},
      {{"tilted", "Irradiance step on a tilted plane, the edge along the tilt axis",
        [] {
          std::vector<SceneOption> options = withCommonOptions({kAngle, kLow, kHigh});
          for (SceneOption& option : options) {
            if (option.name == "tilt") option.defaultValue = 45;
          }
          return options;
        }()},
       buildStep},
      {{"checker", "Checkered irradiance on a plane",
        withCommonOptions({{"cell", 5, 1e-3, 1e5, "side of a square, mm"}, kAngle, kLow, kHigh})},
       buildChecker},
      {{"sinusoid", "Irradiance 1 + cos(2 pi x / period) on a plane",
        withCommonOptions({{"period", 10, 1e-3, 1e5, "mm"}, kAngle})},
       buildSinusoid},
      {{"disc", "Disc of irradiance 1 in the dark", withCommonOptions({{"radius", 4, 1e-3, 1e5, "mm"}})},
       buildDisc},
      {{"impulse", "One lit pixel in the dark: the profile itself (orthographic, no tilt)",
        withCommonOptions({{"irradiance", 1, 0, 1e6, "E of the pixel"}})},
       buildImpulse},
      {{"gap", "Lit half-plane in front of a dark one: light must not leak across the depth gap",
        withCommonOptions({{"gap", 5, 0, 1e4, "distance in depth, mm"}})},
       buildGap},
  };
}

}  // namespace pellucid::harness
