// Back-lit solids, most of them of known thickness.
#include <cmath>
#include <limits>

#include "scene/model.h"

namespace pellucid::harness {

namespace {

// Of a shadow map around what it covers.
constexpr double kMargin = 1.1;

const SceneOption kLightAngle = {"lightAngle", 20, -180, 180,
                                 "direction towards the light, degrees from straight behind"};
const SceneOption kTilt = {"tilt", 0, -85, 85, "rotation about the vertical axis, degrees"};
const SceneOption kThickness = {"thickness", 4, 1e-6, 1e3, "mm"};

void addObject(SceneModel& model, std::unique_ptr<Solid> solid) {
  model.objects.emplace_back().solid = std::move(solid);
}

void addBox(SceneModel& model, const glm::dvec3& center, const glm::dvec3& halfExtent,
            const glm::dmat3& axes = glm::dmat3(1)) {
  addObject(model, std::make_unique<Polyhedron>(Polyhedron::box(center, axes, halfExtent)));
}

// Axes of a box turned about the vertical axis; the third is its front normal.
glm::dmat3 turned(double degrees) {
  const double angle = radians(degrees);
  return {{std::cos(angle), 0, -std::sin(angle)}, {0, 1, 0}, {std::sin(angle), 0, std::cos(angle)}};
}

// The camera on the z axis looking at the origin, one light behind it, shadow maps over what is seen.
SceneModel backLit(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  SceneModel model;
  model.camera = frontCamera(parameters, extent);
  model.radius = extent;
  const double angle = radians(options["lightAngle"]);
  model.lights = {lightAt(parameters, {std::sin(angle), 0, -std::cos(angle)}, 1, extent)};
  return model;
}

// Between concentric spheres around the origin.
class HollowSphere : public DistanceField {
public:
  HollowSphere(double outer, double inner)
      : DistanceField(glm::dvec3(-1.01 * outer), glm::dvec3(1.01 * outer), 1e-3 * (outer - inner)),
        outer_(outer),
        inner_(inner) {}
  double distance(const glm::dvec3& p) const override {
    const double r = glm::length(p);
    return std::max(r - outer_, inner_ - r);
  }

private:
  double outer_, inner_;
};

// Around the origin.
class Torus : public DistanceField {
public:
  Torus(const glm::dvec3& axis, double major, double minor)
      : DistanceField(glm::dvec3(-1.01 * (major + minor)), glm::dvec3(1.01 * (major + minor)), 1e-3 * minor),
        axis_(axis),
        major_(major),
        minor_(minor) {}
  double distance(const glm::dvec3& p) const override {
    const double height = glm::dot(axis_, p);
    return std::hypot(glm::length(p - height * axis_) - major_, height) - minor_;
  }

private:
  glm::dvec3 axis_;
  double major_, minor_;
};

SceneModel buildSlab(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const glm::dmat3 axes = turned(options["tilt"]);
  const double thickness = options["thickness"];
  model.endless = true;
  addBox(model, -thickness / 2 * axes[2], {kInfinity, kInfinity, thickness / 2}, axes);
  return model;
}

SceneModel buildWedge(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double angle = radians(options["angle"]);
  const double edge = -0.45 * options["extent"];  // x of the sharp edge
  model.endless = true;
  const glm::dvec3 back(-std::sin(angle), 0, -std::cos(angle));
  addObject(model, std::make_unique<Polyhedron>(
                       std::vector<Polyhedron::Plane>{{{0, 0, 1}, 0}, {back, -edge * std::sin(angle)}}));
  return model;
}

SceneModel buildSphere(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double radius = options["radius"];
  addObject(model, std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(radius)));
  model.radius = kMargin * radius;
  return model;
}

SceneModel buildHollowSphere(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double outer = options["radius"];
  const double inner = outer * options["hollow"];
  addObject(model, std::make_unique<HollowSphere>(outer, inner));
  model.radius = kMargin * outer;
  return model;
}

SceneModel buildTorus(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double tilt = radians(options["tilt"]);
  addObject(model, std::make_unique<Torus>(glm::dvec3(0, std::sin(tilt), std::cos(tilt)), options["majorRadius"],
                                           options["majorRadius"] * options["tube"]));
  model.radius = kMargin * options["majorRadius"] * (1 + options["tube"]);
  return model;
}

SceneModel buildTwoSheets(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double thickness = options["thickness"];
  const double second = -thickness - options["gap"];  // front of the second sheet
  model.endless = true;
  addBox(model, {0, 0, -thickness / 2}, {kInfinity, kInfinity, thickness / 2});
  addObject(model, std::make_unique<Polyhedron>(std::vector<Polyhedron::Plane>{
                       {{-1, 0, 0}, 0}, {{0, 0, 1}, second}, {{0, 0, -1}, thickness - second}}));
  return model;
}

SceneModel buildBodies(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double unit = options["extent"] / 40, gap = options["gap"], numbers = options["numbers"];
  const auto ball = [&](double x, double y, double radius) {
    addObject(model, std::make_unique<Ellipsoid>(unit * glm::dvec3(x, y, 0), glm::dvec3(unit * radius)));
  };
  ball(-7.5, 8, 7.5);
  ball(gap / unit + 5, 8, 5);
  ball(0, -9, 8);
  model.materials = {PresetMaterial{"skin1"}, PresetMaterial{"skin1"}};
  model.objects[1].material = numbers == 1 ? 1 : 2;
  if (numbers == 2)
    model.objects[2].materialAt = [](const glm::dvec3& p) {
      return static_cast<std::uint8_t>(p.x < 0 ? 1 : 2);
    };
  return model;
}

SceneModel buildNearFar(const SceneParameters& parameters, const OptionValues& options) {
  SceneModel model = backLit(parameters, options);
  const double extent = options["extent"];
  const double tilt = radians(options["tilt"]);
  // Clip planes close around the target, so that the sheet leaves the frustum through both.
  model.camera =
      placeCamera(parameters, {{0, 0, 4 * extent}, {0, 0, 0}, extent, false, 3.2 * extent, 4.8 * extent});
  model.endless = true;
  const glm::dvec3 normal(0, std::sin(tilt), std::cos(tilt));
  const double half = options["thickness"] / 2;
  addBox(model, -half * normal, {kInfinity, kInfinity, half},
         {{1, 0, 0}, glm::cross(normal, {1, 0, 0}), normal});
  return model;
}

SceneOption withDefault(SceneOption option, double value) {
  option.defaultValue = value;
  return option;
}

}  // namespace

std::vector<SceneDefinition> solidScenes() {
  const SceneOption radius = {"radius", 8, 1e-3, 1e4, "mm"};
  const SceneOption thin = withDefault(kThickness, 2);
  return {
      {{"slab", "Infinite slab lit from behind", {kThickness, kTilt, kLightAngle, kExtent}}, buildSlab},
      {{"wedge",
        "Infinite wedge, sharp edge at the left, lit from behind",
        {{"angle", 15, 0.1, 80, "between the faces, degrees"}, kLightAngle, kExtent}},
       buildWedge},
      {{"sphere", "Sphere lit from behind", {radius, kLightAngle, kExtent}}, buildSphere},
      {{"hollow_sphere",
        "Spherical shell lit from behind",
        {radius, {"hollow", 0.75, 0.01, 0.999, "inner radius / outer radius"}, kLightAngle, kExtent}},
       buildHollowSphere},
      {{"torus",
        "Ring lit from behind",
        {{"majorRadius", 12, 1e-3, 1e4, "radius of the ring's middle line, mm"},
         {"tube", 0.3, 0.01, 0.99, "tube radius / majorRadius"},
         withDefault(kTilt, 30),
         kLightAngle,
         kExtent}},
       buildTorus},
      {{"two_sheets",
        "Thin sheet; behind its right half a second one stands in the light",
        {thin, {"gap", 15, 1e-3, 1e4, "between the sheets, mm"}, kLightAngle, kExtent}},
       buildTwoSheets},
      {{"bodies",
        "Ball in the shadow of another of its medium, and a ball of two parts, lit from the left",
        {{"gap", 3, 1e-3, 1e3, "between the balls, mm"},
         {"numbers", 0, 0, 2, "of the medium: 0: one a body, 1: one, 2: one a part"},
         withDefault(kLightAngle, -90),
         kExtent}},
       buildBodies},
      {{"near_far",
        "Thin sheet that leaves the frustum through the near and the far plane",
        {thin, {"tilt", 70, 65, 85, "rotation about the horizontal axis, degrees"}, kLightAngle, kExtent}},
       buildNearFar},
  };
}

}  // namespace pellucid::harness
