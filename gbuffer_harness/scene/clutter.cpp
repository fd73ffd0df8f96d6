// Scenes of many or irregular surfaces, scattered from the seed.
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
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

// Perlin's improved noise (2002) in two dimensions, and sums of its octaves.
class Noise {
public:
  explicit Noise(unsigned seed);
  double operator()(double x, double y) const;  // about -1 .. 1, period 256
  // Octaves of doubled frequency and halved amplitude.
  double fractal(double x, double y, int octaves) const;

private:
  std::array<std::uint8_t, 512> permutation_;
};

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }

// Dot product with one of eight directions of the plane.
double gradient(std::uint8_t hash, double x, double y) {
  constexpr double kDirections[][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}};
  constexpr double kDiagonal = 0.7071067811865476;
  const auto& [dx, dy] = kDirections[hash & 7];
  return (hash & 4 ? kDiagonal : 1) * (dx * x + dy * y);
}

Noise::Noise(unsigned seed) {
  std::iota(permutation_.begin(), permutation_.begin() + 256, std::uint8_t{0});
  Random random(seed);
  for (std::size_t i = 255; i > 0; --i) {
    std::swap(permutation_[i], permutation_[static_cast<std::size_t>(random() * static_cast<double>(i + 1))]);
  }
  for (std::size_t i = 0; i < 256; ++i) permutation_[256 + i] = permutation_[i];
}

double Noise::operator()(double x, double y) const {
  const double fx = std::floor(x);
  const double fy = std::floor(y);
  const auto i = static_cast<std::size_t>(static_cast<long long>(fx) & 255);
  const auto j = static_cast<std::size_t>(static_cast<long long>(fy) & 255);
  x -= fx;
  y -= fy;
  const auto corner = [&](std::size_t dx, std::size_t dy) {
    return gradient(permutation_[permutation_[i + dx] + j + dy], x - static_cast<double>(dx),
                    y - static_cast<double>(dy));
  };
  const double u = fade(x);
  const double v = fade(y);
  return std::lerp(std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

double Noise::fractal(double x, double y, int octaves) const {
  double sum = 0;
  double amplitude = 1;
  for (int i = 0; i < octaves; ++i, amplitude /= 2) {
    // Each octave is shifted, or all of them would vanish together at the lattice points.
    sum += amplitude * (*this)(x + 17.3 * i, y + 5.7 * i);
    x *= 2;
    y *= 2;
  }
  return sum;
}

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
  model.camera = frontCamera(parameters, extent);
  model.radius = extent;
  model.objects.emplace_back().solid =
      std::make_unique<NoisySheet>(parameters.seed, 0.45 * extent, options["thickness"], options["amplitude"],
                                   options["scale"], static_cast<int>(options["octaves"]));
  model.lights = {lightAt(parameters, {0.2, 0.3, -1}, 1, extent),
                  lightAt(parameters, {-1, 0.4, 0.3}, 0.5, extent)};
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
