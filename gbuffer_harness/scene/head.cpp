// Heads as a frame shows them: on a part of the screen, lit by a key and a rim light, or filling it.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/field.h"
#include "scene/model.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// An ellipsoid, mm. Its distance is what a cast of the scene spends its time on: no divisions by radii.
struct Bump {
  glm::dvec3 center, radii;
  double rounding;  // of the crease to what is there already
  glm::dvec3 inverse = 1.0 / radii;
  double reach = std::max({radii.x, radii.y, radii.z});

  // See ellipsoidDistance().
  double distance(const glm::dvec3& p) const {
    const glm::dvec3 q = (p - center) * inverse, r = q * inverse;
    const double k0 = std::sqrt(glm::dot(q, q)), k1 = std::sqrt(glm::dot(r, r));
    return k1 > 0 ? k0 * (k0 - 1) / k1 : -reach;
  }
};

// mm: x to the head's left, y up, z where the face looks. The left half; the right one mirrors it.
const Bump kBulk[] = {{{0, 20, -10}, {75, 95, 95}, 1},         // skull
                      {{0, -45, 15}, {55, 70, 65}, 30},        // jaw
                      {{0, -145, -22}, {50, 95, 48}, 20}};     // neck
const Bump kFeatures[] = {{{38, -25, 55}, {22, 22, 22}, 18},   // cheek
                          {{18, 30, 74}, {26, 8, 10}, 10},     // brow
                          {{0, -92, 62}, {22, 16, 18}, 14},    // chin
                          {{0, -16, 92}, {11, 26, 20}, 12},    // nose
                          {{0, -32, 104}, {12, 10, 12}, 6},    // its tip
                          {{11, -34, 94}, {7, 7, 9}, 5},       // its wing
                          {{0, -50, 80}, {22, 4.5, 7}, 4},     // upper lip
                          {{0, -59, 79}, {20, 5.5, 7.5}, 4}};  // lower lip
const Bump kSocket = {{31, 10, 80}, {20, 13, 16}, 10}, kEyeball = {{30, 9, 66}, {12, 12, 12}, 1};

// True where a point of a ball may be nearer to p than `distance`.
bool mayReach(const glm::dvec3& p, const glm::dvec3& center, double radius, double distance) {
  const double reach = distance + radius;
  const glm::dvec3 offset = p - center;
  return reach > 0 && glm::dot(offset, offset) < reach * reach;
}

void add(double& d, const glm::dvec3& p, const Bump& bump) {
  if (mayReach(p, bump.center, bump.reach, d + bump.rounding))
    d = smoothUnion(d, bump.distance(p), bump.rounding);
}

// A sheet of 3 mm in an ellipse that stands off the head, with a thicker rim.
void addEar(double& d, const glm::dvec3& p) {
  const glm::dvec3 root(74, 2, -8);
  const glm::dvec2 middle(14, 0), radii(18, 31);
  if (!mayReach(p, root + glm::dvec3(7, 0, -12), 38, d + 5)) return;
  constexpr double kSine = 0.5, kCosine = 0.8660254;  // 30 degrees off the head
  const glm::dvec3 q = p - root;
  const glm::dvec2 inSheet(kSine * q.x - kCosine * q.z, q.y);
  const double across = std::abs(kCosine * q.x + kSine * q.z);
  const double inside = ellipsoidDistance({inSheet - middle, 0}, {radii, 1e3});
  const double sheet = smoothIntersection(across - 1.5, inside, 1.5);
  const double rim = std::hypot(inside + 1, across) - 3;
  d = smoothUnion(d, smoothUnion(sheet, rim, 3), 5);
}

class Head : public DistanceField {
public:
  // Looks along +z turned about the vertical by `turn` radians.
  Head(const glm::dvec3& center, double turn)
      : DistanceField(center - glm::dvec3(kReach, 245, kReach), center + glm::dvec3(kReach, 125, kReach),
                      5e-3),
        center_(center),
        sine_(std::sin(turn)),
        cosine_(std::cos(turn)) {}

  double distance(const glm::dvec3& point) const override {
    const glm::dvec3 o = point - center_;
    const glm::dvec3 p(std::abs(cosine_ * o.x - sine_ * o.z), o.y, sine_ * o.x + cosine_ * o.z);
    double d = kBulk[0].distance(p);
    for (int i = 1; i < 3; ++i) add(d, p, kBulk[i]);
    for (const Bump& bump : kFeatures) add(d, p, bump);
    if (mayReach(p, kSocket.center, kSocket.reach, kSocket.rounding - d)) {
      d = smoothIntersection(d, -kSocket.distance(p), kSocket.rounding);
      add(d, p, kEyeball);
    }
    addEar(d, p);
    return 0.75 * d;  // an ellipsoid's bound is up to a third too large
  }

private:
  static constexpr double kReach = 125;  // of ears and nose, turned as they may be

  glm::dvec3 center_;
  double sine_, cosine_;
};

struct View {
  glm::dvec3 target, toCamera;
  double extent;  // mm
};

// A 16:9 image of them covers as much as the frames of a head scan: .14, .95, .06, .003.
constexpr View kViews[] = {{{0, -35, 0}, {0.35, 0.05, 1}, 703},
                           {{2, -14, 80}, {0.1, 0, 1}, 108},
                           {{0, -40, -400}, {0, 0.12, 1}, 3490},
                           {{0, -35, 0}, {0.35, 0.05, 1}, 4870}};
constexpr int kCrowd = 2;

SceneModel buildHead(const SceneParameters& parameters, const OptionValues& options) {
  const int view = static_cast<int>(std::lround(options["view"]));
  const View& v = kViews[view];
  SceneModel model;
  const auto add = [&](const glm::dvec3& center, double turn) {
    model.objects.emplace_back().solid = std::make_unique<Head>(center, turn);
  };
  if (view == kCrowd) {
    // Three rows of three, each row to the side of the one before.
    for (int i = 0; i < 9; ++i)
      add({(i % 3 - 1) * 540 + (i / 3 - 1) * 180, 0, -400.0 * (i / 3)}, 0.35 * (i * 4 % 9 - 4));
    model.center = {0, -60, -400};
    model.radius = 1050;
  } else {
    add(glm::dvec3(0), 0);
    model.center = {0, -60, 0};
    model.radius = 200;
  }
  // The distance at which a 16:9 image has a vertical field of view of 24 degrees.
  const double distance = 1.32 * v.extent;
  const glm::dvec3 eye = v.target + distance * glm::normalize(v.toCamera);
  const double reach = glm::distance(v.target, model.center) + model.radius;
  model.camera = placeCamera(parameters, {eye, v.target, v.extent, false,
                                          std::max(0.1 * distance, distance - reach), distance + reach});
  LightPlacement key{model.center, {-0.6, 0.4, 0.7}, options["keyLight"]};
  LightPlacement rim{model.center, {-0.5, 0.2, -0.85}, options["rimLight"]};
  key.distance = rim.distance = 5 * model.radius;
  key.coneRadius = rim.coneRadius = model.radius;
  model.lights = {placeLight(parameters, key), placeLight(parameters, rim)};
  // Colors go round the circle of hues, so that each light shows where it falls.
  const int further = static_cast<int>(std::lround(options["lights"]));
  for (int i = 0; i < further; ++i) {
    const double turn = 2 * std::numbers::pi * i / further;
    LightPlacement light = key;
    light.towardLight = {std::sin(turn), 0.25, std::cos(turn)};
    light.irradiance = options["furtherLight"];
    for (int c = 0; c < 3; ++c) light.color[c] = 0.5 + 0.5 * std::cos(turn - 2 * std::numbers::pi * c / 3);
    model.lights.push_back(placeLight(parameters, light));
  }
  model.albedo = skinAlbedo;
  return model;
}

}  // namespace

std::vector<SceneDefinition> headScenes() {
  return {{{"head",
            "Heads under a key and a rim light, as a frame shows them",
            {{"view", 0, 0, 3, "0: portrait, 1: a face fills the screen, 2: a crowd of nine, 3: far away"},
             {"keyLight", 2, 0, 1e6, "irradiance of the light from the front"},
             {"rimLight", 2, 0, 1e6, "irradiance of the light from behind"},
             {"lights", 0, 0, 64, "further lights in a circle around, of all hues"},
             {"furtherLight", 1, 0, 1e6, "irradiance of each of them"}}},
           buildHead}};
}

}  // namespace pellucid::harness
