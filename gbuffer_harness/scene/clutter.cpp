// Scenes of many or irregular surfaces, scattered from the seed.
#include <cmath>
#include <numbers>
#include <vector>

#include "scene/model.h"
#include "scene/noise.h"

namespace pellucid::harness {

namespace {

const SceneOption kExtent = {"extent", 40, 1e-3, 1e5, "visible width, mm"};

LightPlacement lightAt(const glm::dvec3& toward, double irradiance, double extent) {
  LightPlacement light{glm::dvec3(0), toward, irradiance};
  light.distance = 5 * extent;
  light.coneRadius = extent;
  return light;
}

SceneModel buildSpheres(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  SceneModel model;
  model.camera =
      placeCamera(parameters, {{0, 0, 4 * extent}, {0, 0, 0}, extent, false, extent / 4, 12 * extent});
  model.radius = 1.2 * extent;
  model.lights = {placeLight(parameters, lightAt({0.5, 0.6, -1}, 1, extent)),
                  placeLight(parameters, lightAt({-1, 0.5, 0.4}, 0.3, extent))};

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
  model.lights = {placeLight(parameters, lightAt({0.3, 0.6, -1}, 1, extent))};
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

// A solid between two height fields over the xy plane.
class NoisySheet : public DistanceField {
public:
  NoisySheet(unsigned seed, double halfWidth, double thickness, double amplitude, double scale, int octaves)
      : DistanceField(glm::dvec3(-1.01 * halfWidth, -1.01 * halfWidth, -thickness - 2 * amplitude),
                      glm::dvec3(1.01 * halfWidth, 1.01 * halfWidth, 2 * amplitude), 1e-3 * thickness),
        noise_(seed),
        halfWidth_(halfWidth),
        thickness_(thickness),
        amplitude_(amplitude),
        scale_(scale),
        octaves_(octaves),
        // Every octave of the noise has slopes up to about 2.5 amplitudes per cell.
        steepness_(std::hypot(1, 2.5 * amplitude / scale * octaves)) {}

  double distance(const glm::dvec3& p) const override {
    const double front = amplitude_ * noise_.fractal(p.x / scale_, p.y / scale_, octaves_);
    // The back repeats the front's waves elsewhere and half as high, which varies the thickness.
    const double back =
        amplitude_ / 2 * noise_.fractal(p.x / scale_ + 91.7, p.y / scale_ + 43.1, octaves_) - thickness_;
    const double sides = std::max(std::abs(p.x), std::abs(p.y)) - halfWidth_;
    return std::max(std::max(p.z - front, back - p.z) / steepness_, sides);
  }

private:
  Noise noise_;
  double halfWidth_, thickness_, amplitude_, scale_;
  int octaves_;
  double steepness_;
};

SceneModel buildNoise(const SceneParameters& parameters, const OptionValues& options) {
  const double extent = options["extent"];
  SceneModel model;
  model.camera =
      placeCamera(parameters, {{0, 0, 4 * extent}, {0, 0, 0}, extent, false, extent / 4, 12 * extent});
  model.radius = extent;
  model.objects.emplace_back().solid =
      std::make_unique<NoisySheet>(parameters.seed, 0.45 * extent, options["thickness"], options["amplitude"],
                                   options["scale"], static_cast<int>(options["octaves"]));
  model.lights = {placeLight(parameters, lightAt({0.2, 0.3, -1}, 1, extent)),
                  placeLight(parameters, lightAt({-1, 0.4, 0.3}, 0.5, extent))};
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
      {{"noise",
        "Sheet with fractal front and back",
        {{"thickness", 4, 0.1, 100, "mean, mm"},
         {"amplitude", 1.2, 0, 10, "of the first octave, mm"},
         {"scale", 8, 0.1, 1e4, "cell of the first octave, mm"},
         {"octaves", 5, 1, 10, "of halved amplitude and doubled frequency"},
         kExtent}},
       buildNoise},
  };
}

}  // namespace pellucid::harness
