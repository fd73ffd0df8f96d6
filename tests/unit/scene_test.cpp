// Procedural scenes against closed forms, and the cameras in every convention.
#include "scene/scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "common/error.h"
#include "reference/light.h"
#include "refusal.h"
#include "scene/model.h"
#include "scene/render.h"
#include "scene/vector.h"

namespace pellucid::harness {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

SceneParameters sized(const std::string& name, int size) {
  const SceneParameters parameters{.name = name, .width = size, .height = size, .shadowSize = 0};
  return parameters;
}

SceneModel buildModel(const SceneParameters& parameters) {
  const SceneDefinition& scene = findScene(parameters.name);
  return scene.build(parameters, OptionValues(scene.info, parameters.options));
}

// Largest relative error of the cast thickness in double, over pixels where `exact` is at least
// `smallest` mm; every one of them must be hit.
double thicknessError(const SceneParameters& parameters, const std::function<double(const Ray&)>& exact,
                      double smallest) {
  const SceneModel model = buildModel(parameters);
  double worst = 0;
  int counted = 0;
  for (int y = 0; y < parameters.height; ++y) {
    for (int x = 0; x < parameters.width; ++x) {
      const Ray ray = model.camera.ray(x + 0.5, y + 0.5, parameters.width, parameters.height);
      const double expected = exact(ray);
      if (expected < smallest) continue;
      const std::optional<Hit> hit = firstHit(model.objects, ray, -kInfinity);
      if (!hit) return kInfinity;
      worst = std::max(worst, std::abs(hit->exit - hit->enter - expected) / expected);
      ++counted;
    }
  }
  EXPECT_GT(counted, parameters.width * parameters.height / 20) << "too few pixels to mean anything";
  return worst;
}

// Distance of the ray's line from the origin, and of the eye.
double lineDistance(const Ray& ray) { return glm::length(glm::cross(ray.origin, ray.direction)); }

// The first sheet, the chord and the way to the cavity, in closed form.
double slabThickness(const Ray& ray, double degrees, double thickness) {
  const double angle = degrees * std::numbers::pi / 180;
  return thickness / std::abs(ray.direction.x * std::sin(angle) + ray.direction.z * std::cos(angle));
}

double wedgeThickness(const Ray& ray) {
  const double tangent = std::tan(15 * std::numbers::pi / 180);
  // Along the axis: x tan(angle). Obliquely, intersect with the back face z = -(x - edge) tan.
  const double x = ray.at(-ray.origin.z / ray.direction.z).x + 18;
  return x * tangent / (-ray.direction.z - ray.direction.x * tangent);
}

double halfChord(const Ray& ray, double radius) {
  return std::sqrt(std::max(0.0, radius * radius - std::pow(lineDistance(ray), 2)));
}

// Found without the quartic: the distance to a torus is known exactly, so march and bisect it.
double torusThickness(const Ray& ray) {
  const double tilt = 30 * std::numbers::pi / 180;
  const glm::dvec3 axis(0, std::sin(tilt), std::cos(tilt));
  const auto distance = [&](const glm::dvec3& p) {
    const double height = glm::dot(p, axis);
    return std::hypot(glm::length(p - height * axis) - 12, height) - 3.6;
  };
  const auto crossing = [&](double t, double end, double sign) {
    while (t < end && sign * distance(ray.at(t)) > 0) t += std::max(1e-3, sign * distance(ray.at(t)));
    if (t >= end) return kInfinity;
    double a = t - std::max(2e-3, 2 * std::abs(distance(ray.at(t)))), b = t;
    for (int i = 0; i < 60; ++i) (sign * distance(ray.at((a + b) / 2)) > 0 ? a : b) = (a + b) / 2;
    return (a + b) / 2;
  };
  const double enter = crossing(100, 300, 1);
  return std::isinf(enter) ? 0.0 : crossing(enter + 1e-6, 300, -1) - enter;
}

TEST(Scene, ThicknessIsThatOfTheClosedForm) {
  struct Row {
    const char* scene;
    std::map<std::string, double> options;
    std::function<double(const Ray&)> exact;
    double smallest;  // thickness away from silhouettes; at them its relative error grows without bound as it
                      // goes to 0
  };
  const Row rows[] = {{"slab", {{"tilt", 0}}, [](const Ray& ray) { return slabThickness(ray, 0, 4); }, 1},
                      {"slab", {{"tilt", 50}}, [](const Ray& ray) { return slabThickness(ray, 50, 4); }, 1},
                      {"wedge", {}, wedgeThickness, 0.01},
                      {"sphere", {{"extent", 18}}, [](const Ray& ray) { return 2 * halfChord(ray, 8); }, 0.5},
                      {"hollow_sphere",
                       {{"extent", 18}},
                       [](const Ray& ray) {
                         const double outer = halfChord(ray, 8), inner = halfChord(ray, 6);
                         return inner > 0 ? outer - inner : 2 * outer;
                       },
                       0.5},
                      {"two_sheets", {}, [](const Ray& ray) { return slabThickness(ray, 0, 2); }, 1},
                      {"torus", {}, torusThickness, 0.5}};
  for (const Row& row : rows)
    for (const bool orthographic : {false, true}) {
      SceneParameters parameters = sized(row.scene, 64);
      parameters.orthographic = orthographic;
      parameters.options = row.options;
      EXPECT_LT(thicknessError(parameters, row.exact, row.smallest), 1e-6)
          << row.scene << " " << orthographic;
    }
}

class BallField : public DistanceField {
public:
  BallField() : DistanceField(glm::dvec3(-3), glm::dvec3(3), 1e-3) {}
  double distance(const glm::dvec3& p) const override { return glm::length(p) - 2; }
};

TEST(Scene, DistanceFieldAgreesWithAnAnalyticBall) {
  const BallField field;
  const Ellipsoid sphere(glm::dvec3(0), glm::dvec3(2));
  for (int i = 0; i < 60; ++i) {
    const double offset = 0.0331 * i;  // up to 1.95: the last rays graze
    const Ray ray{{offset, 0.1, 300}, glm::normalize(glm::dvec3(0, 0, -1))};
    for (const double tMin : {0.0, 299.9}) {  // before the ball, and from within it or outside
      const std::optional<Span> expected = sphere.firstSpan(ray, tMin);
      const std::optional<Span> found = field.firstSpan(ray, tMin);
      ASSERT_EQ(expected.has_value(), found.has_value()) << offset << " " << tMin;
      if (!expected) continue;
      EXPECT_NEAR(found->enter, expected->enter, 3e-9);
      EXPECT_NEAR(found->exit, expected->exit, 3e-9);
      EXPECT_NEAR(glm::length(field.normal(ray.at(found->enter)) - sphere.normal(ray.at(expected->enter))), 0,
                  1e-6);
      EXPECT_TRUE(field.blocks(ray, tMin, expected->enter + 0.01));
      EXPECT_FALSE(field.blocks(ray, tMin, expected->enter - 0.01));
    }
  }
}

TEST(Scene, OverlappingObjectsEndWhereTheirUnionEnds) {
  std::vector<Object> objects;
  for (const double z : {0.0, -1.5, -3.0, -9.0}) {  // the first three overlap in a chain
    objects.emplace_back().solid = std::make_unique<Ellipsoid>(glm::dvec3(0, 0, z), glm::dvec3(1));
  }
  const std::optional<Hit> hit = firstHit(objects, {{0, 0, 5}, {0, 0, -1}}, 0);
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->enter, 4);
  EXPECT_DOUBLE_EQ(hit->exit, 9);
}

// ---- Cameras

struct Convention {
  bool orthographic, reversed, infinite;
};

void expectKnownPoints(const Convention& c) {
  const double n = 2;
  const double f = c.infinite ? kInfinity : 50;
  const double tangent = 0.5;  // half the vertical view
  const double aspect = 1.6;
  const Matrix matrix = c.orthographic
                            ? orthographic(2 * aspect, 2, {n, f, c.reversed})
                            : perspective(2 * std::atan(tangent), aspect, {n, f, c.reversed});
  const auto project = [&](double x, double y, double viewZ) {
    const glm::dvec4 clip = toGlm(matrix) * glm::dvec4(x, y, -viewZ, 1);
    EXPECT_GT(clip.w, 0);
    return glm::dvec3(clip) / clip.w;
  };
  for (const double z : {n, 10.0, 49.0}) {
    const double top = c.orthographic ? 1 : z * tangent;
    const glm::dvec3 corner = project(-top * aspect, top, z);  // upper left as seen
    EXPECT_NEAR(corner.x, -1, 1e-14);
    EXPECT_NEAR(corner.y, -1, 1e-14);  // Vulkan's y points down
    EXPECT_NEAR(corner.z, deviceDepth(matrix, z), 1e-14);
  }
  EXPECT_NEAR(project(0, 0, n).z, c.reversed ? 1 : 0, 1e-14);
  const double farthest = c.infinite ? 1e12 : f;
  EXPECT_NEAR(project(0, 0, farthest).z, c.reversed ? 0 : 1, 1e-11);
  EXPECT_EQ(clearDepth(matrix), c.reversed ? 0 : 1);
}

TEST(Scene, CamerasMapKnownPointsInEveryConvention) {
  for (const bool reversed : {false, true})
    for (const auto& [parallel, infinite] : {std::pair(false, false), {false, true}, {true, false}}) {
      SCOPED_TRACE(testing::Message() << "reversed " << reversed << ", orthographic " << parallel << ", infinite "
                                      << infinite);
      expectKnownPoints({parallel, reversed, infinite});
    }
}

TEST(Scene, LookAtIsRigidAndPutsTheTargetOnTheAxis) {
  for (const Vector3& up : {Vector3{0, 1, 0}, Vector3{1, 2, 3}}) {  // the second is parallel to the axis
    const glm::dmat4 view = toGlm(lookAt({1, 2, 3}, {2, 4, 6}, up));
    EXPECT_NEAR(glm::determinant(view), 1, 1e-14);
    EXPECT_NEAR(glm::length(glm::dvec3(view * glm::dvec4(1, 2, 3, 1))), 0, 1e-14);
    const glm::dvec3 target(view * glm::dvec4(2, 4, 6, 1));
    EXPECT_NEAR(glm::length(target - glm::dvec3(0, 0, -std::sqrt(14))), 0, 1e-14);
    if (up == Vector3{0, 1, 0}) {
      EXPECT_GT((view * glm::dvec4(0, 1, 0, 0)).y, 0);
    }
  }
}

// ---- Light

struct ShadowCase {
  const char* scene;
  PellucidLightType light;
  PellucidDepthEncoding encoding;
};
class SceneShadow : public ::testing::TestWithParam<ShadowCase> {};
INSTANTIATE_TEST_SUITE_P(
    Lights, SceneShadow,
    ::testing::Values(ShadowCase{"spheres", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_VIEW_Z},
                      ShadowCase{"spheres", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_DISTANCE},
                      ShadowCase{"torus", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_DEVICE},
                      ShadowCase{"torus", PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_DEPTH_DEVICE},
                      ShadowCase{"spheres", PELLUCID_LIGHT_SPOT, PELLUCID_DEPTH_VIEW_Z},
                      ShadowCase{"ear", PELLUCID_LIGHT_POINT, PELLUCID_DEPTH_VIEW_Z}));

// Front and back surface of every pixel: shadow ray against shadow map, wherever the map can know.
// It cannot at the edge of a shadow (points a texel aside disagree) and nearer to the receiver than the
// receiver's own slope changes the distance within a texel.
TEST_P(SceneShadow, MapAgreesWithShadowRays) {
  SceneParameters parameters = sized(GetParam().scene, 40);
  parameters.lightType = GetParam().light;
  parameters.shadowEncoding = GetParam().encoding;
  parameters.shadowSize = 400;
  const Capture capture = makeScene(parameters);
  const SceneModel model = buildModel(parameters);
  const double texel = 2 * model.radius / parameters.shadowSize;
  int lit = 0;
  int shadowed = 0;
  const auto compare = [&](const Light& light, const glm::dvec3& point, const glm::dvec3& normal) {
    glm::dvec3 toLight = -toGlm(light.direction);
    if (light.type != PELLUCID_LIGHT_DIRECTIONAL) toLight = glm::normalize(toGlm(light.position) - point);
    const double cosine = glm::dot(normal, toLight);
    const reference::ShadowView view(light, light.shadowMaps[0]);
    if (cosine < 0.3 || view.at(point).kind == reference::ShadowView::Kind::Outside) return;
    const double slack = 2.5 * texel / cosine;
    const glm::dvec3 side = texel * glm::normalize(glm::cross(toLight, glm::dvec3(0.3, 0.5, 0.8))),
                     other = glm::cross(toLight, side);
    int blocked = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const reference::ShadowView::Lookup found = view.at(point + double(dx) * side + double(dy) * other);
        blocked += found.kind == reference::ShadowView::Kind::Surface && found.distance > slack;
      }
    if (blocked != 0 && blocked != 9) return;
    const glm::dvec3 origin = blocked ? point : point + slack * toLight;
    EXPECT_EQ(blocked == 0, reaches(model.objects, light, origin, normal, 1e-3))
        << point.x << " " << point.y << " " << point.z;
    ++(blocked ? shadowed : lit);
  };
  for (int i = 0; i < 40 * 40; ++i) {
    const Ray ray = model.camera.ray(i % 40 + 0.5, i / 40 + 0.5, 40, 40);
    const std::optional<Hit> hit = firstHit(model.objects, ray, 0);
    if (!hit) continue;
    const glm::dvec3 front = ray.at(hit->enter);
    const glm::dvec3 back = ray.at(hit->exit);
    for (const Light& light : capture.lights) {
      compare(light, front, hit->object->solid->normal(front));
      compare(light, back, hit->object->solid->normal(back));
    }
  }
  EXPECT_GT(lit, 50);
  // A ring barely shades itself; the others must have shown shadow.
  if (std::string(GetParam().scene) != "torus") {
    EXPECT_GT(shadowed, 50);
  }
}

TEST(Scene, IrradianceFollowsTheLightsDefinition) {
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  light.position = {0, 0, 10};
  light.direction = {0, 0, -1};
  light.intensity = 300;
  light.color = {1, 0.5, 0};
  const glm::dvec3 up(0, 0, 1);
  // 300 / 10^2 head on; at 45 degrees 300 cos 45 / 200.
  EXPECT_NEAR(unshadowedIrradiance(light, {0, 0, 0}, up).x, 3, 1e-12);
  EXPECT_NEAR(unshadowedIrradiance(light, {0, 0, 0}, up).y, 1.5, 1e-12);
  EXPECT_NEAR(unshadowedIrradiance(light, {10, 0, 0}, up).x, 1.5 * std::numbers::sqrt2 / 2, 1e-12);
  EXPECT_EQ(unshadowedIrradiance(light, {0, 0, 0}, -up), glm::dvec3(0));
  light.range = 20;  // window of KHR_lights_punctual: 1 - (10/20)^4
  EXPECT_NEAR(unshadowedIrradiance(light, {0, 0, 0}, up).x, 3 * (1 - 1.0 / 16), 1e-12);
  light.range = 0;
  light.type = PELLUCID_LIGHT_SPOT;
  light.innerConeAngle = 0.1;
  light.outerConeAngle = 0.3;
  EXPECT_NEAR(unshadowedIrradiance(light, {0, 0, 0}, up).x, 3, 1e-12);
  EXPECT_EQ(unshadowedIrradiance(light, {10 * std::tan(0.31), 0, 0}, up), glm::dvec3(0));
  const double middle = (std::cos(0.2) - std::cos(0.3)) / (std::cos(0.1) - std::cos(0.3));
  EXPECT_NEAR(unshadowedIrradiance(light, {10 * std::tan(0.2), 0, 0}, up).x,
              middle * middle * 3 * std::pow(std::cos(0.2), 3), 1e-12);
  light.type = PELLUCID_LIGHT_DIRECTIONAL;
  EXPECT_NEAR(unshadowedIrradiance(light, {99, 0, 0}, up).x, 300, 1e-12);
}

TEST(Scene, LightTypesGiveTheSameIrradianceAtTheCenter) {
  for (const PellucidLightType type :
       {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT}) {
    SceneParameters parameters = sized("slab", 8);
    parameters.lightType = type;
    const Light light = buildModel(parameters).lights.at(0);
    EXPECT_NEAR(unshadowedIrradiance(light, glm::dvec3(0), -toGlm(light.direction)).x, 1, 1e-12) << type;
  }
}

// ---- Patterns

TEST(Scene, StepIsAveragedOverThePixel) {
  SceneParameters parameters = sized("step", 65);  // the edge halves the middle column
  parameters.options = {{"samples", 8}};
  const Capture capture = makeScene(parameters);
  for (int x = 0; x < 65; ++x) {
    EXPECT_EQ(*capture.irradiance.at(x, 20), x < 32 ? 0.0f : x == 32 ? 0.5f : 1.0f) << x;
  }
  parameters.options = {{"angle", 90}};  // positive side: up
  const Capture turned = makeScene(parameters);
  EXPECT_EQ(*turned.irradiance.at(5, 3), 1);
  EXPECT_EQ(*turned.irradiance.at(60, 60), 0);
}

TEST(Scene, TiltedPatternIsForeshortened) {
  SceneParameters parameters = sized("checker", 64);
  parameters.options = {{"tilt", 60}, {"cell", 10}, {"extent", 40}};
  const Capture capture = makeScene(parameters);
  // Squares are 8 pixels wide and 16 high.
  for (int x = 0; x < 64; ++x)
    for (const int y : {20, 40}) EXPECT_EQ(*capture.irradiance.at(x, y), (x / 8 + y / 32) % 2 == 0 ? 1 : 0) << x;
}

TEST(Scene, BodiesHaveNumbersByBodyByMediumOrByPart) {
  for (const int numbers : {0, 1, 2}) {
    SceneParameters p = sized("bodies", 40);
    p.options = {{"numbers", numbers}};
    const Capture c = makeScene(p);
    const auto at = [&](int x, int y) { return int(c.material[static_cast<std::size_t>(40 * y + x)]); };
    // 1 mm a pixel.
    EXPECT_EQ(at(12, 12), 1) << numbers;
    EXPECT_EQ(at(28, 12), numbers == 1 ? 1 : 2) << numbers;
    EXPECT_EQ(at(17, 29), 1) << numbers;
    EXPECT_EQ(at(23, 29), numbers == 2 ? 2 : 1) << numbers;
  }
}

TEST(Scene, SeedsScatterObjects) {
  SceneParameters parameters = sized("spheres", 24);
  const Image first = makeScene(parameters).frontDepth.image;
  parameters.seed = 2;
  EXPECT_NE(first.data, makeScene(parameters).frontDepth.image.data);
}

// ---- Errors

TEST(Scene, ErrorsNameFieldAndValue) {
  struct Row {
    const char* words;
    void (*change)(SceneParameters&);
  };
  const Row rows[] = {
      {"no scene \"eer\"", [](SceneParameters& p) { p.name = "eer"; }},
      {"no option \"thicknes\"",
       [](SceneParameters& p) {
         p.options = {{"thicknes", 1}};
       }},
      {"option thickness = -1",
       [](SceneParameters& p) {
         p.options = {{"thickness", -1}};
       }},
      {"option thickness = nan",
       [](SceneParameters& p) {
         p.options = {{"thickness", std::nan("")}};
       }},
      {"width: 0", [](SceneParameters& p) { p.width = 0; }},
      {"width: 100000", [](SceneParameters& p) { p.width = 100000; }},
      {"shadowSize: -1", [](SceneParameters& p) { p.shadowSize = -1; }},
      {"infiniteFar",
       [](SceneParameters& p) {
         p.infiniteFar = true;
         p.orthographic = true;
       }},
      {"depthEncoding", [](SceneParameters& p) { p.depthEncoding = PELLUCID_DEPTH_DISTANCE; }},
      {"scene \"sphere\": its light", [](SceneParameters& p) {
         p.name = "sphere";
         p.shadowSize = 8;
         p.lightType = PELLUCID_LIGHT_POINT;
         p.options = {{"radius", 1e4}};
       }}};
  for (const Row& row : rows) {
    SceneParameters parameters = sized("slab", 8);
    row.change(parameters);
    const std::string refusal = pellucid::test::refusalOf([&] { makeScene(parameters); });
    EXPECT_NE(refusal.find(row.words), std::string::npos) << refusal;
  }
}

TEST(Scene, CamerasRefuseWhatHasNoProjection) {
  EXPECT_THROW(perspective(1, 1, {0, 10}), InputError);
  EXPECT_THROW(perspective(1, 1, {5, 5}), InputError);
  EXPECT_THROW(perspective(0, 1, {1, 10}), InputError);
  EXPECT_THROW(perspective(4, 1, {1, 10}), InputError);
  EXPECT_THROW(perspective(1, std::nan(""), {1, 10}), InputError);
  EXPECT_THROW(orthographic(1, 1, {0, kInfinity}), InputError);
  EXPECT_THROW(orthographic(0, 1, {0, 1}), InputError);
}

// ---- Turntables

TEST(SceneTurn, CarriesCameraAndLightsRoundCounterclockwise) {
  SceneParameters parameters = sized("sphere", 8);
  parameters.lightType = PELLUCID_LIGHT_POINT;
  const Capture still = makeScene(parameters);
  parameters.turn = {std::numbers::pi / 2, std::numbers::pi};
  const Capture turned = makeScene(parameters);
  // From above +z goes to +x.
  const auto eyeOf = [](const Capture& c) { return glm::dvec3(glm::inverse(toGlm(c.viewFromWorld))[3]); };
  const glm::dvec3 from = eyeOf(still), to = eyeOf(turned);
  EXPECT_NEAR(to[0], from[2], 1e-9);
  EXPECT_NEAR(to[2], -from[0], 1e-9);
  EXPECT_GT(from[2], 100);
  EXPECT_NEAR(turned.lights[0].position[0], -still.lights[0].position[0], 1e-9);
  EXPECT_NEAR(turned.lights[0].position[2], -still.lights[0].position[2], 1e-9);
}

}  // namespace
}  // namespace pellucid::harness
