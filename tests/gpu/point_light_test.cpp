// Point lights that shine all around: six shadow maps, from the rasterizer to the passes that read them.

#include <algorithm>
#include <glm/glm.hpp>
#include <span>

#include "gpu/gpu_fixture.h"
#include "gpu/model_builder.h"
#include "raster/framing.h"
#include "raster/raster.h"
#include "reference_frame.h"
#include "scene/vector.h"

namespace {

using namespace pellucid::test;

constexpr double kInner = 6, kOuter = 8;  // mm
// Off the center, so that no face of the cube is like another.
const glm::dvec3 kLight(0.9, -0.6, 0.4);

Light lamp(const glm::dvec3& position) { return pointLight(fromGlm(position), 50); }

// A sphere whose surface faces its center.
void addHollow(Model& model, double radius, std::uint32_t rings) {
  const std::size_t firstVertex = model.vertices.size(), firstIndex = model.indices.size();
  addSphere(model, {0, 0, 0}, radius, rings);
  for (std::size_t i = firstVertex; i < model.vertices.size(); ++i)
    for (float& n : model.vertices[i].normal) n = -n;
  turnOver(model, firstIndex);
}

// A shell of 2 mm with a light in it.
Model shell() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, kOuter, 128);
  addHollow(model, kInner, 128);
  endPart(model, 0);
  model.lights = {lamp(kLight)};
  return model;
}

RasterOptions smallOptions() {
  const RasterOptions options{
      .width = 96, .height = 96, .depthEncoding = PELLUCID_DEPTH_VIEW_Z, .shadowSize = 512};
  return options;
}

ModelCamera cameraAt(const Vector3& eye, const Vector3& target, double fov) {
  ModelCamera camera;
  camera.viewFromWorld = lookAt(eye, target, {0, 1, 0});
  camera.verticalFov = fov;
  camera.range = {0.1, 200};
  return camera;
}

// World position of a pixel's front; empty: nothing there.
std::optional<glm::dvec3> positionAt(const Capture& c, int x, int y) {
  const double z = *c.frontDepth.image.at(x, y);
  if (!(z < 1e9)) return std::nullopt;
  const double u = ((x + 0.5) / c.width * 2 - 1) / c.clipFromView[0];
  const double v = ((y + 0.5) / c.height * 2 - 1) / c.clipFromView[5];
  return glm::dvec3(glm::inverse(toGlm(c.viewFromWorld)) * glm::dvec4(u * z, v * z, -z, 1));
}

// Distance from the light to the inner wall in the direction of x.
double toInnerWall(const glm::dvec3& x) {
  const glm::dvec3 d = glm::normalize(x - kLight);
  const double b = glm::dot(kLight, d);
  return -b + std::sqrt(b * b - glm::dot(kLight, kLight) + kInner * kInner);
}

class PointLights : public GpuTest {
protected:
  static RasterResult rasterize(const Model& model, const ModelCamera& camera, const RasterOptions& options) {
    return pellucid::harness::rasterize(device(), model, camera, options);
  }
};

// Face of the cube about the light in which a point lies, and how close to a seam: 1 on it.
struct Face {
  int index;
  double seam;
};
Face faceOf(const glm::dvec3& x) {
  const glm::dvec3 d = x - kLight, a = glm::abs(d);
  const int axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
  const double second = axis == 0 ? std::max(a.y, a.z) : axis == 1 ? std::max(a.x, a.z) : std::max(a.x, a.y);
  return {2 * axis + (d[axis] < 0), second / a[axis]};
}

// A spot of a degree is as bright on its axis as a wide one. The guard of KHR_lights_punctual made it a fifth as bright.
TEST_F(PointLights, NarrowSpotsAreFullOnTheirAxis) {
  const auto lit = [](double outer) {
    Capture c = flatCapture(33, 33, 2);
    Light spot = backLight();
    spot.type = PELLUCID_LIGHT_SPOT;
    spot.position = {0, 0, -212};
    spot.intensity = 3 * 200 * 200;
    spot.outerConeAngle = outer;
    spot.innerConeAngle = 0.75 * outer;
    c.lights = {spot};
    ReplaySettings s = gathering(0);
    s.features = PELLUCID_FEATURE_TRANSLUCENCY;
    return replay(c, testMaterial(), s);
  };
  const Image wide = lit(0.5), narrow = lit(0.02);
  EXPECT_GT(wide.at(16, 16)[0], 1.5f);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(narrow.at(16, 16)[k], wide.at(16, 16)[k], 2e-3f * wide.at(16, 16)[k]);
}

// The wall along each light ray is what geometry says, on every face and across their seams.
TEST_F(PointLights, ThicknessOfAShellAroundTheLight) {
  const Model model = shell();
  // Three faces of the cube show on each side.
  struct Case {
    PellucidDepthEncoding encoding;
    std::vector<double> sides;
  };
  int pixels[6] = {};
  for (const auto& [encoding, sides] : {Case{PELLUCID_DEPTH_DEVICE, {1, -1}},
                                        {PELLUCID_DEPTH_VIEW_Z, {1}},
                                        {PELLUCID_DEPTH_DISTANCE, {-1}}}) {
    int seams = 0;
    for (const double side : sides) {
      RasterOptions options = smallOptions();
      options.shadowEncoding = encoding;
      const RasterResult result =
          rasterize(model, cameraAt({40 * side, 50 * side, 60 * side}, {0, 0, 0}, 0.2), options);
      const Capture& c = result.capture;
      EXPECT_TRUE(result.warnings.empty()) << result.warnings[0];
      ASSERT_EQ(c.lights[0].shadowMaps.size(), 6u);
      ReplaySettings settings = inFloats();
      settings.debugView = PELLUCID_DEBUG_THICKNESS;
      const Image thickness = replay(c, testMaterial(), settings);
      double worst = 0;
      for (int y = 0; y < c.height; ++y)
        for (int x = 0; x < c.width; ++x) {
          const std::optional<glm::dvec3> position = positionAt(c, x, y);
          if (!position) continue;
          const Face face = faceOf(*position);
          ++pixels[face.index];
          seams += face.seam > 0.99;
          const double exact = glm::distance(*position, kLight) - toInnerWall(*position);
          worst = std::max(worst, std::abs(double(thickness.at(x, y)[1]) - exact));
        }
      // A texel is 2 / 512 of the planar distance, at most 7 mm, and the wall leans by at most 55 degrees
      // from a face's plane: half a diagonal of 0.02 mm times 1.4, along a ray 1.7 times as long.
      EXPECT_LT(worst, 0.05) << "encoding " << encoding;
    }
    EXPECT_GT(seams, 20);
  }
  for (const int n : pixels) EXPECT_GT(n, 350);
}

// Seen from within, the wall gets I cos / r^2 everywhere: no seam shows and the wall does not shadow itself.
TEST_F(PointLights, LightsAllAroundWithoutASeam) {
  const Model model = shell();
  int seams = 0;
  for (const Vector3& target :
       {Vector3{3, 2, 1}, Vector3{-2, 3, -1}, Vector3{1, -2, 3}, Vector3{-1, -2, -3}}) {
    const Capture c = rasterize(model, cameraAt({0, 0, 0}, target, 2.2), smallOptions()).capture;
    double worst = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        const std::optional<glm::dvec3> position = positionAt(c, x, y);
        ASSERT_TRUE(position);
        seams += faceOf(*position).seam > 0.99;
        const glm::dvec3 toLight = kLight - *position;
        const double squared = glm::dot(toLight, toLight);
        const double cosine = glm::dot(toLight, -glm::normalize(*position)) / std::sqrt(squared);
        const double exact = 50 * cosine / squared;
        worst = std::max(worst, std::abs(c.irradiance.at(x, y)[0] / exact - 1));
      }
    // As in IrradianceIsLambert: the triangles' dip and their interpolated normals.
    EXPECT_LT(worst, 5e-4);
  }
  EXPECT_GT(seams, 180);
}

// Nothing gets out of a closed shell, not through its seams either.
TEST_F(PointLights, NoLightLeaksOutOfAShell) {
  Model model = shell();
  addHollow(model, 20, 64);
  endPart(model, 1);
  const std::vector<Vector3> targets = {{-1, 1, -1}, {1, 0, 0}, {0, -1, 0.1}};
  for (const int size : {512, 8}) {
    RasterOptions options = smallOptions();
    options.shadowSize = size;
    // Texels that are small leak less.
    for (const Vector3& target : std::span(targets).first(size == 512 ? 1 : 3)) {
      const Vector3 eye = {10 * target[0], 10 * target[1], 10 * target[2]};
      const Vector3 ahead = {20 * target[0], 20 * target[1], 20 * target[2]};
      const Capture c = rasterize(model, cameraAt(eye, ahead, 2), options).capture;
      EXPECT_EQ(*std::max_element(c.irradiance.data.begin(), c.irradiance.data.end()), 0)
          << size << " texels";
    }
  }
}

// A gather's samples go on across seams: about the center of a shell every direction is like any other.
TEST_F(PointLights, GatherDoesNotEndAtSeams) {
  Model model = shell();
  model.lights = {lamp({0, 0, 0})};
  RasterOptions options = smallOptions();
  options.shadowSize = 256;
  const Capture c = rasterize(model, cameraAt({60, 50, 40}, {0, 0, 0}, 0.2), options).capture;
  const Image image = replay(c, testMaterial(), gathering(64));
  double least[2] = {1e30, 1e30}, most[2] = {0, 0};  // away from seams and near them
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x) {
      const std::optional<glm::dvec3> position = positionAt(c, x, y);
      if (!position) continue;
      const glm::dvec3 a = glm::abs(*position);
      const double largest = std::max({a.x, a.y, a.z});
      const double second = a.x + a.y + a.z - largest - std::min({a.x, a.y, a.z});
      const std::size_t seam = second > 0.8 * largest;
      const double exitance = double(image.at(x, y)[0]) / double(c.albedo.at(x, y)[0]);
      least[seam] = std::min(least[seam], exitance);
      most[seam] = std::max(most[seam], exitance);
    }
  EXPECT_GT(least[0], 0.01);
  EXPECT_GT(least[1], 0.97 * least[0]);
  EXPECT_LT(most[1], 1.03 * most[0]);  // 64 samples scatter by 6 %
}

TEST_F(PointLights, AgreeWithTheReference) {
  Model model = shell();
  model.lights.push_back(lamp({-2, 1, 3}));  // its six maps need a dispatch of their own
  model.lights.back().color = {0.2, 0.5, 1};
  RasterOptions options = smallOptions();
  for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_DISTANCE}) {
    options.shadowEncoding = encoding;
    const Capture c = rasterize(model, cameraAt({60, 50, 40}, {0, 0, 0}, 0.2), options).capture;
    ReplaySettings settings = inFloats(PELLUCID_FEATURE_TRANSLUCENCY);
    const Image gpu = replay(c, testMaterial(), settings), ref = referenceOf(c, {testMaterial()}, settings);
    int differ = 0, lit = 0;
    for (std::size_t i = 0; i < gpu.pixels(); ++i) {
      if (c.material[i] == 0) continue;
      lit += ref.data[3 * i] > 0.01f;
      for (std::size_t k = 0; k < 3; ++k)
        differ += std::abs(gpu.data[4 * i + k] - ref.data[3 * i + k]) > 1e-3f * ref.data[3 * i + k] + 1e-6f;
    }
    EXPECT_GT(lit, 3500);
    // Rounding may move a point to the next texel, or across a seam to the next map.
    EXPECT_LT(differ, lit / 500);
  }
}

TEST_F(PointLights, MapsAreAsFewAsSuffice) {
  const Model model = shell();
  const auto count = [&](const Light& light, PointMaps maps) {
    return frameLight(model, light, maps, 64).size();
  };
  const Light inside = lamp(kLight), outside = lamp({0, 0, 40});
  EXPECT_EQ(count(inside, PointMaps::Auto), 6u);
  EXPECT_EQ(count(inside, PointMaps::One), 0u);
  EXPECT_EQ(count(inside, PointMaps::Six), 6u);
  EXPECT_EQ(count(outside, PointMaps::Auto), 1u);
  EXPECT_EQ(count(outside, PointMaps::One), 1u);
  EXPECT_EQ(count(outside, PointMaps::Six), 6u);
  // A little outside of the bounding sphere, beside a corner.
  Model cube = emptyModel();
  addCube(cube, 8);
  endPart(cube, 0);
  EXPECT_EQ(frameLight(cube, lamp({8.3, 7.7, 8}), PointMaps::Auto, 64).size(), 6u);
  Light spot = inside;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.outerConeAngle = 0.5;
  EXPECT_EQ(count(spot, PointMaps::Auto), 1u);
  EXPECT_EQ(count(spot, PointMaps::Six), 1u);
  spot.outerConeAngle = std::numbers::pi / 2;
  EXPECT_EQ(count(spot, PointMaps::Auto), 6u) << "half a sphere is too wide for one";
}

// Maps of distances that a light 4 mm behind a slab's back draws. Five faces of a cube, which end `widening`
// of their width beyond 90 degrees.
std::vector<ShadowMap> mapsBehindASlab(const glm::dvec3& light, double widening) {
  constexpr int kSize = 128;
  std::vector<ShadowMap> maps;
  for (const glm::dvec3& forward : {glm::dvec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}}) {
    const glm::dvec3 right = forward.x != 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0),
                     down = forward.z != 0 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    ShadowMap map;
    glm::dmat4 clip(0);
    const glm::dvec3 rows[] = {right / (1 + widening), down / (1 + widening), forward, forward};
    for (int r = 0; r < 4; ++r) {
      for (int c = 0; c < 3; ++c) clip[c][r] = rows[r][c];
      clip[3][r] = -glm::dot(rows[r], light) - (r == 2 ? 0.1 : 0);
    }
    map.clipFromWorld = fromGlm(clip);
    map.viewFromWorld = lookAt(fromGlm(light), fromGlm(light + forward), fromGlm(down));
    map.depth = {Image(kSize, kSize, 1, kNoDepth), PELLUCID_DEPTH_DISTANCE};
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        const glm::dvec3 ray = forward + (1 + widening) * (((x + 0.5) / kSize * 2 - 1) * right +
                                                           ((y + 0.5) / kSize * 2 - 1) * down);
        if (ray.z > 0)
          *map.depth.image.at(x, y) = static_cast<float>((-12 - light.z) / ray.z * glm::length(ray));
      }
    maps.push_back(std::move(map));
  }
  return maps;
}

// Faces of exactly 90 degrees, and faces that rounding leaves a gap between. Pixels lie on the faces' edges.
TEST_F(PointLights, FacesThatDoNotOverlapHaveNoSeam) {
  Capture c = flatCapture(128, 128, 2);
  c.clipFromView[0] = 1.0 / 8;
  c.clipFromView[5] = -1.0 / 8;
  std::fill(c.irradiance.data.begin(), c.irradiance.data.end(), 0.0f);
  c.lights = {lamp({0, 0, -16})};
  for (const std::uint32_t samples : {0u, 8u}) {
    ReplaySettings settings = gathering(samples);
    settings.features = PELLUCID_FEATURE_TRANSLUCENCY;
    const auto light = [&](double widening, bool byReference) {
      c.lights[0].shadowMaps = mapsBehindASlab({0, 0, -16}, widening);
      return byReference ? referenceOf(c, {skin()}, settings) : replay(c, skin(), settings);
    };
    for (const bool byReference : {false, true}) {
      if (byReference && samples > 0) continue;  // takes minutes
      const Image overlapping = light(0.03, byReference);
      for (const double widening : {0.0, -1e-5}) {
        const Image out = light(widening, byReference);
        for (const int sx : {1, -1})
          for (const int sy : {1, -1}) {
            double sum = 0, expected = 0;
            for (int t = 40; t < 60; ++t) {  // beyond the face in the middle
              const int x = sx > 0 ? 64 + t : 63 - t, y = sy > 0 ? 64 + t : 63 - t;
              sum += double(out.at(x, y)[0]);
              expected += double(overlapping.at(x, y)[0]);
              if (samples == 0) {
                EXPECT_NEAR(out.at(x, y)[0], overlapping.at(x, y)[0], 0.02f * overlapping.at(x, y)[0])
                    << x << " " << y << " widening " << widening << " reference " << byReference;
              }
            }
            ASSERT_GT(expected, 0.01);
            // Noise of 8 samples, averaged over 20 pixels.
            EXPECT_NEAR(sum / expected, 1, 0.05) << sx << " " << sy << " widening " << widening;
          }
      }
    }
  }
}

TEST_F(PointLights, MoreMapsThanAPlanBindsAreRefusedByName) {
  Capture c = flatCapture(8, 8);
  Light light = lamp({0, 0, -20});
  ShadowMap map;
  map.clipFromWorld = multiply(perspective(1, 1, {1, 50, true}), lookAt({0, 0, -20}, {0, 0, 0}, {0, 1, 0}));
  map.depth = {Image(1, 1, 1, 5.0f), PELLUCID_DEPTH_DISTANCE};
  light.shadowMaps.assign(9, map);
  c.lights = {light};
  EXPECT_NE(refusalOf([&] { replay(c, testMaterial()); }).find("lights[0].shadowMapCount is 9"),
            std::string::npos);
  light.shadowMaps.resize(6);
  c.lights.assign(PELLUCID_MAX_DISPATCHES - 8, light);  // each has a dispatch, and the diffusion has some
  EXPECT_EQ(refusalOf([&] { replay(c, testMaterial()); }), "accepted");
  c.lights.assign(PELLUCID_MAX_DISPATCHES, light);
  const std::string error = refusalOf([&] { replay(c, testMaterial()); });
  EXPECT_NE(error.find("shadowImages of all 32 lights are more than the plan's 32 dispatches"),
            std::string::npos)
      << error;
}

}  // namespace
