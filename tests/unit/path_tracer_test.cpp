#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "capture/capture.h"
#include "gpu/model_builder.h"
#include "pellucid/pellucid_material.h"
#include "raster/bodies.h"
#include "reference/ambient.h"
#include "reference/light.h"
#include "reference/path_tracer/truth.h"
#include "reference/path_tracer/walk.h"
#include "refusal.h"
#include "scene/model.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::harness::reference;
namespace test = pellucid::test;

TraceMedium skin1(double ior) { return {{0.74, 0.88, 1.01}, {0.032, 0.17, 0.48}, 0, ior}; }

struct Mean {
  glm::dvec3 sum{0}, squares{0};
  int count = 0;
  void add(const glm::dvec3& value) {
    sum += value;
    squares += value * value;
    ++count;
  }
  glm::dvec3 mean() const { return sum / static_cast<double>(count); }
  glm::dvec3 standardError() const {
    return glm::sqrt((squares / static_cast<double>(count) - mean() * mean()) / static_cast<double>(count));
  }
};

void expectNear(const Mean& mean, const glm::dvec3& expected, double errors, const std::string& of) {
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(mean.mean()[c], expected[c], errors * mean.standardError()[c]) << of << ", channel " << c;
}

SceneModel oneSolid(std::unique_ptr<Solid> solid) {
  SceneModel model;
  model.radius = 3;
  model.objects.push_back({std::move(solid), 1, {}});
  return model;
}

// Faces at z = 0 and z = -thickness.
SceneModel slab(double thickness) {
  SceneModel model = oneSolid(
      std::make_unique<Polyhedron>(std::vector<Polyhedron::Plane>{{{0, 0, 1}, 0}, {{0, 0, -1}, thickness}}));
  model.endless = true;
  return model;
}

const SurfacePoint kTop{{0, 0, 0}, {0, 0, 1}, {0, 0, 1}, 0, 1};

// Transmittance and reflectance of slabs under Lambertian light, against discrete ordinates. Three standard
// errors; seeds are fixed, so that what passes keeps passing.
TEST(PathTracer, SlabsTransmitAndReflectAsTransportSays) {
  for (const double ior : {1.0, 1.3, 1.4, 1.5})
    for (const double thickness : {0.5, 2.0}) {
      const SceneModel model = slab(thickness);
      const auto scene = makeSolidScene(model);
      const TraceMedium medium = skin1(ior);
      Mean through, back;
      for (std::uint64_t i = 0; i < 100000; ++i) {
        PathRandom random(8, 0, i);
        const auto exit = walk(*scene, medium, kTop, random);
        const bool top = exit && exit->surface.face.z > 0;
        through.add(exit && !top ? exit->weight : glm::dvec3(0));
        back.add(top ? exit->weight : glm::dvec3(0));
      }
      glm::dvec3 transmittance, reflectance;
      for (int c = 0; c < 3; ++c) {
        PellucidSlab truth;
        ASSERT_EQ(pellucidSlabTransport(medium.scattering[c], medium.absorption[c], ior, thickness, &truth,
                                        nullptr, nullptr),
                  PELLUCID_OK);
        transmittance[c] = truth.transmittance;
        reflectance[c] = truth.reflectance;
      }
      const std::string of = "ior " + std::to_string(ior) + ", " + std::to_string(thickness) + " mm";
      expectNear(through, transmittance, 3, "T, " + of);
      expectNear(back, reflectance, 3, "R, " + of);
    }
}

// van de Hulst (1980), as quoted with Wang et al. (1995): mu_a = 10/cm, mu_s = 90/cm, g = .75, .02 cm, a
// beam at normal incidence, no boundary: Rd = .09739, Tt = .66096.
TEST(PathTracer, AnisotropicSlabIsVanDeHulsts) {
  const SceneModel model = slab(0.2);
  const auto scene = makeSolidScene(model);
  const TraceMedium medium{glm::dvec3(9), glm::dvec3(1), 0.75, 1};
  Mean through, back;
  for (std::uint64_t i = 0; i < 40000; ++i) {
    PathRandom random(3, 0, i);
    const auto exit = walkFrom(*scene, medium, 0, {0, 0, -1e-9}, {0, 0, -1}, random);
    const bool top = exit && exit->surface.face.z > 0;
    through.add(exit && !top ? exit->weight : glm::dvec3(0));
    back.add(top ? exit->weight : glm::dvec3(0));
  }
  expectNear(through, glm::dvec3(.66096), 3, "T");
  expectNear(back, glm::dvec3(.09739), 3, "R");
}

// A cube around the origin, without its top where `open`.
Model cube(double half, bool open) {
  Model model = test::emptyModel();
  model.surfaces[0].name = "skin";
  test::addCube(model, half);
  if (open) model.indices.erase(model.indices.begin() + 3 * 6, model.indices.begin() + 4 * 6);  // y = half
  test::endPart(model, 0);
  return model;
}

// The same body of triangles and of planes, with a boundary that reflects inside: every corner and edge is
// met.
TEST(PathTracer, MeshesAreTheSolidsTheyEnclose) {
  const Model mesh = cube(1.5, false);
  const SceneModel planes =
      oneSolid(std::make_unique<Polyhedron>(Polyhedron::box(glm::dvec3(0), glm::dmat3(1), glm::dvec3(1.5))));
  const std::unique_ptr<TraceScene> scenes[] = {makeMeshScene(mesh), makeSolidScene(planes)};
  Emitters emitters;
  emitters.lights.resize(1);
  emitters.lights[0].direction = {-0.3, -0.5, 0.8};
  Mean means[2];
  for (int s = 0; s < 2; ++s) {
    const auto start = scenes[s]->first({{0.3, 0.4, 9}, {0, 0, -1}}, 0);
    ASSERT_TRUE(start);
    EXPECT_NEAR(start->position.z, 1.5, 1e-5);
    for (std::uint64_t i = 0; i < 50000; ++i) {
      PathRandom random(static_cast<std::uint64_t>(s), 0, i);
      const auto exit = walk(*scenes[s], skin1(1.4), *start, random);
      means[s].add(exit ? exit->weight * sampleIrradiance(*scenes[s], emitters, exit->surface, random)
                        : glm::dvec3(0));
    }
  }
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(means[0].mean()[c], means[1].mean()[c],
                3 * std::hypot(means[0].standardError()[c], means[1].standardError()[c]));
}

// A plate without a material inside the cube: of a node of its own, or a second primitive of the cube's node.
Model cubeWithPlate(bool ownObject, double halfWidth) {
  Model model = cube(1.5, false);
  const std::size_t first = model.vertices.size();
  test::addCube(model, 1);
  for (std::size_t i = first; i < model.vertices.size(); ++i)
    for (std::size_t axis = 0; axis < 3; ++axis)
      model.vertices[i].position[axis] *= static_cast<float>(axis == 2 ? 0.2 : halfWidth);
  model.surfaces.emplace_back();
  test::endPart(model, ownObject ? 7 : 0, 1);
  return model;
}

// The plate from wall to wall as solids.
SceneModel solidsWithPlate() {
  const auto box = [](const glm::dvec3& half) {
    return std::make_unique<Polyhedron>(Polyhedron::box(glm::dvec3(0), glm::dmat3(1), half));
  };
  SceneModel model = oneSolid(box(glm::dvec3(1.5)));
  model.objects.push_back({box({1.6, 1.6, 0.2}), 0, {}});
  return model;
}

TEST(PathTracer, OpaqueBodiesWithinAMediumEndPaths) {
  const SceneModel plates = solidsWithPlate();
  for (const double ior : {1.0, 1.4}) {
    const std::unique_ptr<TraceScene> whole = makeMeshScene(cube(1.5, false)),
                                      node = makeMeshScene(cubeWithPlate(true, 1)),
                                      primitive = makeMeshScene(cubeWithPlate(false, 1)),
                                      wall = makeMeshScene(cubeWithPlate(true, 1.6)),
                                      solids = makeSolidScene(plates);
    const auto start = whole->first({{0.3, 0.4, 9}, {0, 0, -1}}, 0);
    ASSERT_TRUE(start);
    int through = 0, past = 0;
    for (std::uint64_t i = 0; i < 20000; ++i) {
      const auto exitOf = [&](const TraceScene& scene) {
        PathRandom random(1, 0, i);
        return walk(scene, skin1(ior), *start, random);
      };
      const auto isFar = [](const std::optional<WalkExit>& exit) {
        return exit && exit->surface.position.z < -1.4;
      };
      const std::optional<WalkExit> a = exitOf(*node), b = exitOf(*primitive);
      ASSERT_EQ(a.has_value(), b.has_value()) << "however the file writes the plate";
      if (a) {
        ASSERT_EQ(a->surface.position, b->surface.position);
      }
      through += isFar(exitOf(*whole));
      past += isFar(a);
      for (const auto* closed : {&wall, &solids})
        ASSERT_FALSE(isFar(exitOf(**closed))) << "a plate from wall to wall lets nothing by";
    }
    EXPECT_GT(through, 1000);
    EXPECT_LT(3 * past, through)
        << "the gap of 1/2 at each side is 5/9 of the section, but far from the middle";
    EXPECT_GT(past, 0);
  }
}

TEST(PathTracer, HolesAreFoundAndFilled) {
  EXPECT_TRUE(openObjects(cube(1, false)).empty()) << "eight corners, each three vertices at one place";
  Model model = cube(1, true);
  const std::vector<OpenObject> open = openObjects(model);
  ASSERT_EQ(open.size(), 1u);
  EXPECT_EQ(open[0].holes, 1u);
  EXPECT_EQ(open[0].looseEdges, 0u);
  EXPECT_EQ(open[0].surface, "skin");
  EXPECT_EQ(fillHoles(model), 1u);
  EXPECT_TRUE(openObjects(model).empty());
  EXPECT_EQ(model.vertices.back().normal[1], 1) << "the lid faces up";
  std::swap(model.indices[0], model.indices[1]);  // a face turned over
  ASSERT_EQ(openObjects(model).size(), 1u);
  EXPECT_GT(openObjects(model)[0].looseEdges + openObjects(model)[0].holes, 0u);
  model.surfaces[0].material = 0;
  EXPECT_TRUE(openObjects(model).empty()) << "no light is walked through what is opaque";
}

// Irradiance of lights that are not points, against closed forms.
TEST(PathTracer, AreaLightsBringWhatTheyShould) {
  const SceneModel model = oneSolid(std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(1)));
  const auto scene = makeSolidScene(model);
  const SurfacePoint top{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, 0, 1};
  const auto mean = [&](const Emitters& emitters) {
    Mean result;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      PathRandom random(1, 0, i);
      result.add(sampleIrradiance(*scene, emitters, top, random));
    }
    return result;
  };
  Emitters sphere;
  sphere.lights.resize(1);
  sphere.lights[0].type = PELLUCID_LIGHT_POINT;
  sphere.lights[0].position = {0, 6, 0};
  sphere.lights[0].radius = 3;
  sphere.lights[0].intensity = 50;
  // Seen whole from a surface that faces its center it is a point there: pi L (R / D)^2 = I / D^2.
  expectNear(mean(sphere), glm::dvec3(2), 3, "sphere");
  Emitters sky;
  sky.environment = Environment{{1, 0.5, 1}, {1, 0.5, 0}};
  // Of a body's top, which sees the upper half: pi times uniform radiance; 5/6 pi of (1 + cos) / 2.
  const Mean lit = mean(sky);
  EXPECT_NEAR(lit.mean().x, std::numbers::pi, 1e-12);
  EXPECT_NEAR(lit.mean().y, std::numbers::pi / 2, 1e-12);
  EXPECT_NEAR(lit.mean().z, std::numbers::pi * 5 / 6, 3 * lit.standardError().z);
}

// A sky given by coefficients is the sky.
TEST(PathTracer, HarmonicsAreTheirEnvironment) {
  const SceneModel model = oneSolid(std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(1)));
  const auto scene = makeSolidScene(model);
  const glm::dvec3 n = glm::normalize(glm::dvec3(0.5, 0.7, -0.2));
  const SurfacePoint point{n, n, n, 0, 1};
  Emitters sky, coefficients;
  sky.environment = Environment{{1, 0.5, 1}, {1, 0.5, 0}};
  coefficients.harmonics = sky.environment->harmonics();
  for (std::uint64_t i = 0; i < 100; ++i) {
    PathRandom a(1, 0, i), b(1, 0, i);
    const glm::dvec3 difference =
        sampleIrradiance(*scene, sky, point, a) - sampleIrradiance(*scene, coefficients, point, b);
    EXPECT_LT(glm::length(difference), 1e-12) << i;
  }
  // Of all coefficients, the mean over the upper half is the irradiance that the reference makes of them.
  for (std::size_t k = 1; k < 9; ++k)
    (*coefficients.harmonics)[k] = {0.1 * double(k % 3), 0.2 - 0.05 * double(k), 0.04 * double(k)};
  (*coefficients.harmonics)[0] = {3, 3, 3};
  Mean mean;
  for (std::uint64_t i = 0; i < 20000; ++i) {
    PathRandom random(2, 0, i);
    mean.add(sampleIrradiance(*scene, coefficients, point, random));
  }
  expectNear(mean, Ambient::irradiance(*coefficients.harmonics, n), 4, "harmonics");
}

// Every field of a light that the passes honor counts in the truth, too, as the reference has it.
TEST(PathTracer, LightsAreThoseOfTheReference) {
  const SceneModel model = oneSolid(std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(1)));
  const auto scene = makeSolidScene(model);
  const SurfacePoint top{{0, 1, 0}, {0, 1, 0}, {0, 1, 0}, 0, 1};
  const auto traced = [&](const Light& light) {
    Emitters emitters;
    emitters.lights = {light};
    PathRandom random(1, 0, 0);
    return sampleIrradiance(*scene, emitters, top, random);
  };
  for (const PellucidLightType type :
       {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT}) {
    Light plain;
    // A new field fails to compile here: add it to the changes below, or refuse it by name in `pellucid
    // truth`. AreaLightsBringWhatTheyShould is of the radius; errors of tables are of files, and shadow maps
    // of geometry.
    [[maybe_unused]] auto& [lightType, position, direction, color, intensity, range, radius, innerConeAngle,
                            outerConeAngle, angleTable, distanceTable, angleTableError, distanceTableError,
                            shadowMaps] = plain;
    lightType = type;
    position = {2, 6, 1};
    direction = {-0.5, -1, -0.3};
    color = {1, 0.5, 0.25};
    intensity = 40;
    range = 9;
    innerConeAngle = 0.1;
    outerConeAngle = 1.2;
    Light other;
    other.position = {1, 4, 0};
    other.direction = {-0.4, -2, 0.5};
    other.color = {0.25, 1, 2};
    other.intensity = 7;
    other.range = 6;
    other.innerConeAngle = 0.02;
    other.outerConeAngle = 0.9;
    other.angleTable = {1, 0.25, 0.125, 0};
    other.distanceTable = {0, 0.5, 0.125, 0.0625};
    const auto of = [&other](auto Light::*field) -> std::function<void(Light&)> {
      return [&other, field](Light& light) { light.*field = other.*field; };
    };
    const std::pair<const char*, std::function<void(Light&)>> changes[] = {
        {"none", [](Light&) {}},
        {"position", of(&Light::position)},
        {"direction", of(&Light::direction)},
        {"color", of(&Light::color)},
        {"intensity", of(&Light::intensity)},
        {"range", of(&Light::range)},
        {"innerConeAngle", of(&Light::innerConeAngle)},
        {"outerConeAngle", of(&Light::outerConeAngle)},
        {"angleTable", of(&Light::angleTable)},
        {"distanceTable", of(&Light::distanceTable)}};
    const glm::dvec3 unchanged = traced(plain);
    for (const auto& [field, change] : changes) {
      Light light = plain;
      change(light);
      if (light.type == PELLUCID_LIGHT_DIRECTIONAL &&
          (!light.angleTable.empty() || !light.distanceTable.empty()))
        continue;  // refused by readers of captures
      const Arrival arrival = arrivalAt(light, {0, 1, 0});
      const glm::dvec3 expected = arrival.irradiance * std::max(arrival.toLight.y, 0.0),
                       value = traced(light);
      EXPECT_LT(glm::length(value - expected), 1e-12 * glm::length(expected)) << type << " " << field;
      const bool isOfType = type == PELLUCID_LIGHT_SPOT ||
                            (std::string(field).find("Cone") == std::string::npos &&
                             (type == PELLUCID_LIGHT_POINT
                                  ? std::string(field) != "direction"
                                  : std::string(field) != "position" && std::string(field) != "range"));
      EXPECT_EQ(value != unchanged, isOfType && std::string(field) != "none") << type << " " << field;
    }
  }
}

// A capture of 8 x 8 pixels of a ball.
Capture ball(const SceneModel& model) {
  Capture capture;
  capture.width = capture.height = 8;
  capture.clipFromView = orthographic(4, 4, {1, 20, false});
  capture.viewFromWorld = lookAt({0, 0, 10}, {0, 0, 0}, {0, 1, 0});
  capture.material.assign(64, 0);
  capture.materials = model.materials;
  for (const std::size_t i : {27u, 28u, 35u, 36u}) capture.material[i] = 1;
  return capture;
}

TEST(PathTracer, TruthIsOfItsSeedWhateverTheThreadsAndGoesOn) {
  const SceneModel model = oneSolid(std::make_unique<Ellipsoid>(glm::dvec3(0), glm::dvec3(2)));
  const auto scene = makeSolidScene(model);
  const Capture capture = ball(model);
  Emitters emitters;
  emitters.lights.resize(1);
  const std::vector<TraceMedium> media = traceMedia(capture.materials, "ball");
  const VisibleSurface surface = visibleSurface(capture, *scene);
  EXPECT_EQ(surface.missed, 0u);
  const TruthTracer tracer(capture, surface, *scene, media, emitters);
  TruthSums once, twice, other;
  tracer.trace(once, 64, 1, 1, [] {});
  tracer.trace(twice, 24, 1, 4, [] {});
  Truth half = truthOf(twice);
  tracer.trace(twice, 40, 1, 3, [] {});
  EXPECT_EQ(truthOf(once).image.data, truthOf(twice).image.data);
  tracer.trace(other, 64, 2, 1, [] {});
  EXPECT_NE(truthOf(once).image.data, truthOf(other).image.data);
  // Through the floats of a file nothing but rounding is lost.
  TruthSums resumed = sumsOf(half);
  tracer.trace(resumed, 40, 1, 2, [] {});
  const Truth a = truthOf(once), b = truthOf(resumed);
  for (std::size_t i = 0; i < a.image.data.size(); ++i) {
    EXPECT_NEAR(a.image.data[i], b.image.data[i], 1e-5);
    EXPECT_NEAR(a.standardError.data[i], b.standardError.data[i], 1e-5);
  }
  EXPECT_GT(a.image.at(3, 3)[0], 0);
  EXPECT_EQ(a.image.at(0, 0)[0], 0) << "no material";
}

// A flat body lit from the front gives E, as a replay without albedo does; with albedo rho it is rho E.
TEST(PathTracer, TruthIsInTheDomainOfAReplay) {
  const SceneModel model = slab(1000);
  const auto scene = makeSolidScene(model);
  Capture capture = ball(model);
  Emitters emitters;
  emitters.lights.resize(1);  // travels along -z
  emitters.lights[0].intensity = 2;
  const std::vector<TraceMedium> media = traceMedia(capture.materials, "slab");
  const VisibleSurface surface = visibleSurface(capture, *scene);
  TruthSums sums;
  TruthTracer(capture, surface, *scene, media, emitters).trace(sums, 4000, 1, 0, [] {});
  const Truth truth = truthOf(sums);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(truth.image.at(3, 3)[c], 2, 3.5 * truth.standardError.at(3, 3)[c]) << c;
}

TEST(PathTracer, MediaThatNoWalkKnowsAreRefusedByName) {
  const auto complaint = [](const MaterialSource& source) {
    return test::refusalOf([&] { traceMedia({source}, "file"); });
  };
  EXPECT_NE(complaint(BurleyMaterial{{1, 1, 1}, {}}).find("file: materials[0]"), std::string::npos);
  EXPECT_NE(complaint(PresetMaterial{"nothing"}).find("\"nothing\""), std::string::npos);
  EXPECT_NE(complaint(CoefficientMaterial{{1, 1, 1}, {0, 0, 0}, 1, 1.4}).find("g: 1"), std::string::npos);
  EXPECT_EQ(complaint(PresetMaterial{"marble"}), "accepted");
  EXPECT_EQ(complaint(ThinWallMaterial{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {}}), "accepted");
  EXPECT_EQ(traceMedia({PresetMaterial{"marble"}}, "")[0].scattering.x, 2.19);
}

}  // namespace
