// Scenes of many surfaces, scattered from the seed.
#include <cmath>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "scene/model.h"

namespace pellucid::harness {

namespace {

// Uniform in [0, 1). std::uniform_real_distribution differs between standard libraries.
class Random {
public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double operator()() { return static_cast<double>(engine_()) / 4294967296.0; }
  double between(double low, double high) { return low + (high - low) * (*this)(); }

private:
  std::mt19937 engine_;
};

SceneModel buildSpheres(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  SceneModel model;
  model.camera = frontCamera(parameters, extent);
  model.radius = 1.2 * extent;
  model.lights = {lightAt(parameters, {0.5, 0.6, -1}, 1, extent),
                  lightAt(parameters, {-1, 0.5, 0.4}, 0.3, extent)};

  struct Ball {
    glm::dvec3 center;
    double radius;
  };
  std::vector<Ball> balls;
  Random random(parameters.seed);
  // Balls that would overlap another are dropped, so there may be fewer than asked for.
  for (int i = 0; i < static_cast<int>(options["count"]); ++i) {
    const double radius = extent * random.between(0.2, 1) * options["largest"];
    const double x = extent * random.between(-0.5, 0.5);
    const double y = extent * random.between(-0.5, 0.5);
    const Ball ball{{x, y, extent * random.between(-0.5, 0.5)}, radius};
    bool apart = true;
    for (const Ball& other : balls) {
      apart = apart && glm::distance(ball.center, other.center) > ball.radius + other.radius;
    }
    if (!apart) continue;
    balls.push_back(ball);
    model.objects.emplace_back().solid = std::make_unique<Ellipsoid>(ball.center, glm::dvec3(ball.radius));
  }
  return model;
}

// A leaf of grass: a thin four-sided pyramid standing at `root`, its broad side facing `front`, leaning
// forward by `lean` times its height.
std::unique_ptr<Solid> makeBlade(const glm::dvec3& root, const glm::dvec3& front, double lean, double height,
                                 double width, double thickness) {
  const glm::dvec3 right(front.z, 0, -front.x);
  const glm::dvec3 tip = root + glm::dvec3(0, height, 0) + lean * height * front;
  const auto through = [&](const glm::dvec3& point, const glm::dvec3& a, const glm::dvec3& b) {
    glm::dvec3 normal = glm::normalize(glm::cross(a, b));
    if (glm::dot(normal, (root + tip) / 2.0 - point) > 0) normal = -normal;
    return Polyhedron::Plane{normal, glm::dot(normal, point)};
  };
  std::vector<Polyhedron::Plane> planes = {{{0, -1, 0}, -root.y}};
  for (const double side : {-0.5, 0.5}) {
    const glm::dvec3 edge = root + side * width * right;
    const glm::dvec3 face = root + side * thickness * front;
    planes.push_back(through(edge, tip - edge, front));
    planes.push_back(through(face, tip - face, right));
  }
  return std::make_unique<Polyhedron>(std::move(planes));
}

SceneModel buildBlades(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  SceneModel model;
  model.camera = placeCamera(
      parameters, {{0, 0.5 * extent, 4 * extent}, {0, 0, 0}, extent, false, extent / 4, 12 * extent});
  model.radius = 1.2 * extent;
  model.lights = {lightAt(parameters, {0.3, 0.6, -1}, 1, extent)};
  Random random(parameters.seed);
  for (int i = 0; i < static_cast<int>(options["count"]); ++i) {
    const double x = extent * random.between(-0.5, 0.5);
    const double z = extent * random.between(-0.5, 0.5);
    const double yaw = random.between(0, 2 * std::numbers::pi);
    const double lean = random.between(-0.4, 0.4);
    const double height = extent * random.between(0.4, 0.9);
    model.objects.emplace_back().solid = makeBlade({x, -0.45 * extent, z}, {std::sin(yaw), 0, std::cos(yaw)},
                                                   lean, height, options["width"], options["thickness"]);
  }
  return model;
}

}  // namespace

std::vector<SceneDefinition> clutterScenes() {
  return {
      {{"spheres",
        "Many small balls at random depths",
        {{"count", 300, 1, 5000, "balls tried"}, {"largest", 0.08, 1e-3, 0.5, "radius, extents"}, kExtent}},
       buildSpheres},
      {{"blades",
        "Grass-like blades, many of them seen at grazing angles",
        {{"count", 120, 1, 5000, "blades"},
         {"width", 2.5, 1e-3, 1e3, "at the root, mm"},
         {"thickness", 0.4, 1e-4, 1e3, "at the root, mm"},
         kExtent}},
       buildBlades},
  };
}

}  // namespace pellucid::harness
