// The rasterizer against geometry: depths, thickness, light and shadows.
// No other test finds holes that count as thickness, or exit depths and caster materials of another surface.
#include <cmath>

#include "capture/material.h"
#include "gpu/all_texels.h"
#include "gpu/gpu_fixture.h"
#include "gpu/model_builder.h"
#include "raster/bodies.h"
#include "raster/framing.h"
#include "raster/mesh.h"
#include "raster/raster.h"
#include "reference/light.h"
#include "scene/vector.h"

namespace {

using namespace pellucid::harness;
using namespace pellucid::test;
namespace reference = pellucid::harness::reference;

class Raster : public GpuTest {
protected:
  static RasterResult rasterize(const Model& model, const ModelCamera& camera, const RasterOptions& options) {
    return pellucid::harness::rasterize(device(), model, camera, options);
  }
};

struct Convention {
  const char* name;
  bool orthographic, reversed, infinite;
  PellucidDepthEncoding encoding;
};
const Convention kConventions[] = {
    {"perspective reversed", false, true, false, PELLUCID_DEPTH_DEVICE},
    {"perspective reversed infinite", false, true, true, PELLUCID_DEPTH_DEVICE},
    {"perspective forward", false, false, false, PELLUCID_DEPTH_DEVICE},
    {"perspective forward infinite", false, false, true, PELLUCID_DEPTH_DEVICE},
    {"perspective viewZ", false, true, false, PELLUCID_DEPTH_VIEW_Z},
    {"orthographic reversed", true, true, false, PELLUCID_DEPTH_DEVICE},
    {"orthographic forward", true, false, false, PELLUCID_DEPTH_DEVICE},
    {"orthographic viewZ", true, false, false, PELLUCID_DEPTH_VIEW_Z},
};

RasterOptions optionsOf(const Convention& c, int size) {
  const RasterOptions options{.width = size,
                              .height = size,
                              .reversedZ = c.reversed,
                              .infiniteFar = c.infinite,
                              .depthEncoding = c.encoding};
  return options;
}

TEST_F(Raster, CubeHasExactDepthsInEveryConvention) {
  Model model = emptyModel();
  addCube(model, 5);
  endPart(model, 0);
  for (const Convention& convention : kConventions) {
    const Capture c =
        rasterize(model, frontCamera(convention.orthographic), optionsOf(convention, 64)).capture;
    // Through the middle the ray is along z but for half a pixel: only front and back face are met.
    // A float depth in [50, 150] mm resolves 2^-24 * 150 mm where planar; forward perspective depth
    // 2^-24 * z^2 / n = 1.3e-5 mm; the matrix product loses a few of these.
    for (const int x : {31, 32, 24})
      for (const int y : {31, 32, 40}) {
        EXPECT_NEAR(planar(c, c.frontDepth, x, y), 95, 2e-4) << convention.name;
        EXPECT_NEAR(planar(c, c.backDepth, x, y), 105, 2e-4) << convention.name;
        EXPECT_EQ(c.material[static_cast<std::size_t>(y * 64 + x)], 1) << convention.name;
      }
    EXPECT_EQ(planar(c, c.frontDepth, 1, 1), -1) << convention.name;
    EXPECT_EQ(planar(c, c.backDepth, 1, 1), -1) << convention.name;
    EXPECT_EQ(c.material[65], 0) << convention.name;
    EXPECT_NEAR(c.albedo.at(32, 32)[0], 0.5, 1e-6) << convention.name;
    EXPECT_NEAR(c.albedo.at(32, 32)[2], 0.125, 1e-6) << convention.name;
  }
}

// At an edge of the silhouette that runs through a pixel's center, front and back are one: the body is closed
// and has a thickness of 0. Some pixels are such edges at these sizes.
TEST_F(Raster, EdgesOfClosedBodiesAreNotOpen) {
  Model model = emptyModel();
  addCube(model, 1);
  for (Vertex& v : model.vertices) v.position[0] += 2;
  endPart(model, 0);
  addCube(model, 1);
  for (std::size_t i = 24; i < 48; ++i) model.vertices[i].position[0] -= 2;
  endPart(model, 1);
  for (const int size : {64, 100}) {
    for (const PellucidDepthEncoding encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z}) {
      const RasterOptions options{.width = size, .height = size, .depthEncoding = encoding};
      const RasterResult result = rasterize(model, frameModel(model, {0, 0, 1}, 0.5, 1, false), options);
      const Capture& c = result.capture;
      EXPECT_EQ(result.openPixels, 0u) << size;
      for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
          if (planar(c, c.frontDepth, x, y) < 0) continue;
          ASSERT_GE(planar(c, c.backDepth, x, y), planar(c, c.frontDepth, x, y)) << x << " " << y;
        }
    }
  }
  // Inside out, the faces that are seen are those far away, and no body begins there.
  turnOver(model, 0);
  RasterOptions options{.width = 64, .height = 64};
  const RasterResult inverted = rasterize(model, frameModel(model, {0, 0, 1}, 0.5, 1, false), options);
  EXPECT_GT(inverted.openPixels, 500u);
}

// Triangles of a sphere of 256 rings are right-angled with legs r a, a = pi / 256: they dip r a^2 / 4
// = 3.8e-5 r below it. Where the surface stands at cosine c to the ray, the thickness 2 r c is off by 2 dips
// / c.
TEST_F(Raster, SphereHasExactThickness) {
  constexpr double kRadius = 8;
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, kRadius, 256);
  endPart(model, 0);
  for (const bool orthographic : {false, true}) {
    RasterOptions options{.width = 100, .height = 100};
    const RasterResult result = rasterize(model, frontCamera(orthographic), options);
    const Capture& c = result.capture;
    EXPECT_EQ(result.openPixels, 0u);
    double worst = 0;
    int compared = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        double t[2] = {};
        const bool hit = meetSphere(rayOf(c, x, y), kRadius, t);
        const double front = planar(c, c.frontDepth, x, y), back = planar(c, c.backDepth, x, y);
        if (!hit) {
          ASSERT_LT(front, 0);
          continue;
        }
        const double exact = t[1] - t[0];
        if (exact < 0.5 * kRadius) continue;  // c > 1/4
        worst = std::max(worst, std::abs((back - front) / exact - 1));
        ++compared;
      }
    EXPECT_GT(compared, 3700);
    EXPECT_LT(worst, 16 * 3.8e-5) << (orthographic ? "orthographic" : "perspective");
  }
}

TEST_F(Raster, FarthestBackFaceSpansHollows) {
  Model model = emptyModel();
  addCube(model, 5);
  // A hollow: the inner cube turned inside out, in the same object.
  const std::size_t first = model.indices.size();
  addCube(model, 4);
  turnOver(model, first);
  endPart(model, 0);
  RasterOptions options{.width = 32, .height = 32};
  const Capture nearest = rasterize(model, frontCamera(false), options).capture;
  EXPECT_NEAR(planar(nearest, nearest.backDepth, 16, 16), 96, 2e-4);
  options.backFace = BackFace::Farthest;
  const Capture farthest = rasterize(model, frontCamera(false), options).capture;
  EXPECT_NEAR(planar(farthest, farthest.backDepth, 16, 16), 105, 2e-4);
}

// What is behind an open mesh must not become its thickness.
TEST_F(Raster, OpenMeshHasNoThickness) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 20, 5);
  endPart(model, 0);
  addSphere(model, {0, 0, -20}, 9, 32);
  endPart(model, 1);
  RasterOptions options{.width = 64, .height = 64};
  for (const BackFace back : {BackFace::Nearest, BackFace::Farthest}) {
    options.backFace = back;
    const RasterResult result = rasterize(model, frontCamera(true), options);
    const Capture& c = result.capture;
    EXPECT_NEAR(planar(c, c.frontDepth, 32, 32), 80, 2e-4);
    EXPECT_EQ(planar(c, c.backDepth, 32, 32), -1) << "the square has no back";
    EXPECT_NEAR(planar(c, c.frontDepth, 32, 8), 120 - std::sqrt(81 - 7.34375 * 7.34375), 0.2);
    EXPECT_GT(planar(c, c.backDepth, 32, 8), 120) << "the sphere beside it is closed";
    EXPECT_EQ(result.openPixels, 32u * 32u);
    ASSERT_EQ(result.warnings.size(), 1u);
    EXPECT_NE(result.warnings[0].find("1024 of "), std::string::npos) << result.warnings[0];
  }
}

// A cube without its back, and a closed one of the same object behind it: the first back face along the ray
// belongs to the second cube.
TEST_F(Raster, HoleIsNotThickness) {
  Model model = emptyModel();
  addCube(model, 5);
  model.indices.erase(model.indices.begin() + 4 * 6, model.indices.begin() + 5 * 6);  // z = -5
  const std::size_t first = model.vertices.size();
  addCube(model, 3);
  for (std::size_t i = first; i < model.vertices.size(); ++i) model.vertices[i].position[2] -= 20;
  endPart(model, 0);
  RasterOptions options{.width = 40, .height = 40};  // 0.5 mm
  const RasterResult result = rasterize(model, frontCamera(true), options);
  EXPECT_EQ(planar(result.capture, result.capture.backDepth, 20, 20), -1);
  EXPECT_EQ(result.openPixels, 20u * 20u);
}

TEST_F(Raster, SingleSidedFacesAreInvisibleFromBehindUnlessDoubleSided) {
  Model model = emptyModel();
  addQuad(model, {{-5, -5, 0}, {-5, 5, 0}, {5, 5, 0}, {5, -5, 0}}, {0, 0, -1});
  endPart(model, 0);
  RasterOptions options{.width = 16, .height = 16};
  const Capture culled = rasterize(model, frontCamera(true), options).capture;
  EXPECT_EQ(culled.material[16 * 8 + 8], 0);
  model.surfaces[0].doubleSided = true;
  model.lights = {directional({0, 0, -1})};
  const Capture seen = rasterize(model, frontCamera(true), options).capture;
  EXPECT_EQ(seen.material[16 * 8 + 8], 1);
  EXPECT_NEAR(seen.irradiance.at(8, 8)[0], 1, 1e-6) << "the normal turns towards the camera";
  EXPECT_EQ(planar(seen, seen.backDepth, 8, 8), -1);
}

// E = I N.L on a sphere in the light of the float64 reference, from normals interpolated between 256 rings.
TEST_F(Raster, IrradianceIsLambert) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 8, 256);
  endPart(model, 0);
  Light sun = directional({-0.6, 0, -0.8}, 3);
  sun.color = {1, 0.5, 0.25};
  const Light point = pointLight({60, 30, 40}, 8000);
  Light spot = point;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.direction = {-60, -30, -40};
  spot.innerConeAngle = 0.02;
  spot.outerConeAngle = 0.12;
  spot.range = 200;

  const RasterOptions options{.width = 64, .height = 64, .shadowSize = 512};
  for (const Light& light : {sun, point, spot}) {
    model.lights = {light};
    const Capture c = rasterize(model, frontCamera(false), options).capture;
    ASSERT_FALSE(c.lights[0].shadowMaps.empty());
    double worst = 0, brightest = 0;
    for (int y = 0; y < c.height; ++y)
      for (int x = 0; x < c.width; ++x) {
        double t[2];
        const PixelRay ray = rayOf(c, x, y);
        if (c.material[static_cast<std::size_t>(y * c.width + x)] == 0 || !meetSphere(ray, 8, t)) continue;
        Vector3 p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = ray.origin[i] + t[0] * ray.direction[i];
        if (p[2] < 2) continue;  // the rim, as above
        const auto arrival = reference::arrivalAt(light, toGlm(p));
        const double e = arrival.irradiance.x * std::max(0.0, glm::dot(arrival.toLight, toGlm(p)) / 8);
        brightest = std::max(brightest, e);
        worst = std::max(worst, std::abs(c.irradiance.at(x, y)[0] - e));
        if (light.type == PELLUCID_LIGHT_DIRECTIONAL) {
          ASSERT_NEAR(c.irradiance.at(x, y)[1], 0.5f * c.irradiance.at(x, y)[0], 1e-6);
        }
      }
    // The chord's dip moves a point by 1.9e-5 r / cos; normals between rings are exact to (pi/256)^2 / 8.
    EXPECT_LT(worst, 5e-4 * brightest) << "light type " << light.type;
    EXPECT_GT(brightest, 0.5);
  }
}

// A square 20 mm above a larger one shadows it exactly where the geometry says.
TEST_F(Raster, ShadowsFallWhereTheyShould) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 9);
  endPart(model, 0);
  addSquare(model, -6, 0, 20, 2);  // seen beside its shadow
  endPart(model, 1);
  const Light point = pointLight({-18, 0, 60}, 3600);  // the shadow is 1.5 times as large, about x = 0
  Light spot = point;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.direction = {18, 0, -60};
  spot.innerConeAngle = 0.3;
  spot.outerConeAngle = 0.5;
  struct Case {
    Light light;
    double half;
  };
  const Case cases[] = {{directional({6, 0, -20}), 2}, {point, 3}, {spot, 3}};
  RasterOptions options{.width = 200, .height = 200};  // 0.1 mm a pixel
  for (const Case& k : cases) {
    model.lights = {k.light};
    const Capture c = rasterize(model, frontCamera(true), options).capture;
    ASSERT_FALSE(c.lights[0].shadowMaps.empty());
    int compared = 0;
    for (int y = 0; y < 200; ++y)
      for (int x = 0; x < 200; ++x) {
        const Vector3 p = {(x + 0.5) * 0.1 - 10, 10 - (y + 0.5) * 0.1, 0};
        if (std::abs(p[0]) > 8.9 || std::abs(p[1]) > 8.9) continue;
        if (p[0] < -3.9 && std::abs(p[1]) < 2.1) continue;  // the upper square hides it
        const double inside = k.half - std::max(std::abs(p[0]), std::abs(p[1]));
        // Texels are 24 mm / 1024; four of them blend, and the offset shifts by one and a half.
        if (std::abs(inside) < 0.1) continue;
        if (inside > 0)
          ASSERT_EQ(c.irradiance.at(x, y)[0], 0) << p[0] << ", " << p[1] << " light " << k.light.type;
        else
          ASSERT_GT(c.irradiance.at(x, y)[0], 0.3) << p[0] << ", " << p[1] << " light " << k.light.type;
        ++compared;
      }
    EXPECT_GT(compared, 20000);
  }
}

// Beside the map of a sphere and an opaque square: where the light leaves the sphere, and what it meets.
TEST_F(Raster, ShadowMapsKnowWhatCastsAndWhereItEnds) {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 8, 256);
  endPart(model, 0);
  model.surfaces.push_back(model.surfaces[0]);
  model.surfaces[1].material = 0;
  addSquare(model, 0, 0, 20, 2);
  endPart(model, 1, 1);
  Light spot;
  spot.type = PELLUCID_LIGHT_SPOT;
  spot.position = {0, 0, 60};
  spot.direction = {0, 0, -1};
  spot.outerConeAngle = 0.5;
  RasterOptions options{.width = 16, .height = 16, .shadowSize = 64};
  for (const Light& light : {directional({0, 0, -1}), spot})
    for (const auto encoding : {PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_DISTANCE}) {
      SCOPED_TRACE(testing::Message() << "light " << light.type << ", encoding " << encoding);
      options.shadowEncoding = encoding;
      model.lights = {light};
      const Capture capture = rasterize(model, frontCamera(true), options).capture;
      const ShadowMap& map = capture.lights[0].shadowMaps[0];
      ASSERT_EQ(map.exitDepth.pixels(), map.depth.image.pixels());
      ASSERT_EQ(map.casterMaterial.size(), map.depth.image.pixels());
      const glm::dmat4 worldFromClip = glm::inverse(toGlm(map.clipFromWorld));
      const float nothing = encoding == PELLUCID_DEPTH_DEVICE ? 0.0f : kNoDepth;
      const bool perspective = light.type == PELLUCID_LIGHT_SPOT;
      int chords = 0, opaque = 0;
      for (int y = 0; y < 64; ++y)
        for (int x = 0; x < 64; ++x) {
          const glm::dvec2 ndc((x + 0.5) / 32 - 1, (y + 0.5) / 32 - 1);
          const auto unproject = [&](double depth) {
            const glm::dvec4 p = worldFromClip * glm::dvec4(ndc, depth, 1);
            return glm::dvec3(p) / p.w;
          };
          const glm::dvec3 start =
              perspective ? toGlm(light.position) : unproject(1);  // reversed: the near plane
          const glm::dvec3 along = glm::normalize(unproject(0.5) - start);
          const double nearest = glm::dot(along, -start);  // to the center
          const double off = glm::length(start + nearest * along);
          const float exit = *map.exitDepth.at(x, y);
          const int material = map.casterMaterial[static_cast<std::size_t>(y * 64 + x)];
          const double square = std::max(std::abs((start + (20 - start.z) / along.z * along).x),
                                         std::abs((start + (20 - start.z) / along.z * along).y));
          if (std::abs(square - 2) < 0.05 || std::abs(off - 8) < 0.05) continue;  // edges
          if (square < 2) {
            EXPECT_EQ(material, 0);
            EXPECT_EQ(exit, nothing) << "a square bounds no volume";
            ++opaque;
          } else if (off < 8) {
            EXPECT_EQ(material, 1);
            const glm::dvec3 leaves = start + (nearest + std::sqrt(64 - off * off)) * along;
            const double planar = -(*map.viewFromWorld)[2] * leaves.x - (*map.viewFromWorld)[6] * leaves.y -
                                  (*map.viewFromWorld)[10] * leaves.z - (*map.viewFromWorld)[14];
            const glm::dvec4 clip = toGlm(map.clipFromWorld) * glm::dvec4(leaves, 1);
            const double expected = encoding == PELLUCID_DEPTH_DEVICE ? clip.z / clip.w
                                    : encoding == PELLUCID_DEPTH_VIEW_Z || !perspective
                                        ? planar
                                        : glm::distance(leaves, start);
            // Chords of the mesh lie 2.4e-3 mm within the sphere at most; at the rim more along the ray.
            const double tolerance = 0.0024 / std::sqrt(1 - off * off / 64) + 1e-4;
            EXPECT_NEAR(exit, expected, encoding == PELLUCID_DEPTH_DEVICE ? tolerance / 16 : tolerance);
            ++chords;
          } else {
            EXPECT_EQ(material, 0);
            EXPECT_EQ(exit, nothing);
          }
        }
      EXPECT_GT(chords, 500);
      EXPECT_GT(opaque, 10);
    }
}

TEST_F(Raster, TexturesMarksAndHoles) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 8);
  endPart(model, 0);
  const std::array<float, 2> uv[] = {{0, 1}, {1, 1}, {1, 0}, {0, 0}};
  for (std::size_t i = 0; i < 4; ++i) {
    model.vertices[i].uv = uv[i];
    model.vertices[i].mark = i < 2 ? 0 : 1;  // the upper half is marked
    model.vertices[i].color = {1, 1, 0.5f};
  }
  Texture texture;
  texture.width = texture.height = 2;
  texture.rgba = {255, 0, 0, 255, 0, 255, 0, 255, 0, 0, 188, 255, 255, 255, 255, 10};
  texture.wrapU = texture.wrapV = TextureWrap::Clamp;
  model.textures = {texture};
  model.surfaces[0].texture = 0;
  model.surfaces[0].baseColor = {1, 1, 1};
  model.surfaces[0].addedColor = {0, 0, 0.25};
  model.surfaces[0].alphaCutoff = 0.5;
  RasterOptions options{.width = 40, .height = 40};  // 0.5 mm
  const Capture c = rasterize(model, frontCamera(true), options).capture;
  const auto expectColor = [&](int x, int y, double r, double g, double b) {
    EXPECT_NEAR(c.albedo.at(x, y)[0], r, 1e-3) << x << ", " << y;  // half-float texels
    EXPECT_NEAR(c.albedo.at(x, y)[1], g, 1e-3) << x << ", " << y;
    EXPECT_NEAR(c.albedo.at(x, y)[2], b, 1e-3) << x << ", " << y;
  };
  expectColor(6, 6, 1, 0, 0.25);
  expectColor(33, 6, 0, 1, 0.25);
  expectColor(6, 33, 0, 0, 0.25 + 0.5 * 0.5029);  // sRGB 188
  EXPECT_LT(planar(c, c.frontDepth, 33, 33), 0) << "a hole";
  EXPECT_EQ(c.material[40 * 6 + 6], 1);
  EXPECT_EQ(c.material[40 * 33 + 6], 0) << "not marked";
  EXPECT_NEAR(planar(c, c.frontDepth, 6, 33), 100, 2e-4) << "but there";
}

// glTF 2.0, 3.9.2: COLOR_0 multiplies the base color, its alpha the base color's.
TEST_F(Raster, AlphaOfVerticesMakesHolesForCameraAndLights) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 4, 8);  // a card before a slab that it would hide and shadow
  endPart(model, 0);
  for (std::size_t i = 0; i < 4; ++i) model.vertices[i].alpha = i % 3 == 0 ? 0 : 1;  // 0 at the left edge
  addSquare(model, 0, 0, 0, 10);
  endPart(model, 1, 1);
  model.surfaces.push_back(model.surfaces[0]);
  model.surfaces[0].alphaCutoff = 0.5;
  Light light;
  light.direction = {0, 0, -1};
  model.lights = {light};
  RasterOptions options = smallRaster(40);
  const Capture c = rasterize(model, frontCamera(true), options).capture;
  EXPECT_NEAR(planar(c, c.frontDepth, 30, 20), 96, 2e-4);
  EXPECT_NEAR(planar(c, c.frontDepth, 14, 20), 100, 2e-4) << "alpha .33 is below the cutoff";
  EXPECT_NEAR(c.irradiance.at(14, 20)[0], 1, 1e-5) << "and casts no shadow";
  model.surfaces[0].alphaCutoff = 0.3;
  const Capture whole = rasterize(model, frontCamera(true), options).capture;
  EXPECT_NEAR(planar(whole, whole.frontDepth, 14, 20), 96, 2e-4);
}

TEST(Framing, TheWholeModelIsInView) {
  Model model = emptyModel();
  addCube(model, 5);
  endPart(model, 0);
  for (const double aspect : {0.5, 1.0, 2.0})
    for (const bool orthographicCamera : {false, true}) {
      const ModelCamera camera = frameModel(model, {1, 2, 3}, 0.6, aspect, orthographicCamera);
      const Matrix clip =
          multiply(orthographicCamera ? orthographic(camera.height * aspect, camera.height, camera.range)
                                      : perspective(camera.verticalFov, aspect, camera.range),
                   camera.viewFromWorld);
      double widest = 0;
      for (const Vertex& v : model.vertices) {
        double p[4];
        for (std::size_t r = 0; r < 4; ++r)
          p[r] = clip[r] * v.position[0] + clip[4 + r] * v.position[1] + clip[8 + r] * v.position[2] +
                 clip[12 + r];
        EXPECT_GT(p[2], 0);
        EXPECT_LT(p[2], p[3]);
        widest = std::max({widest, std::abs(p[0] / p[3]), std::abs(p[1] / p[3])});
      }
      EXPECT_NEAR(widest, 1 / 1.05, 1e-6) << "the margin is 5 %, aspect " << aspect;
    }
}

// The left one of two balls that are 1 mm apart is lit, and the right one lies in its shadow.
TEST_F(Raster, NoLightCrossesTheAirBetweenBodies) {
  Model model = ballInShadow(32);
  RasterOptions options = smallRaster(48);
  options.shadowSize = 512;
  ModelCamera camera = frontCamera(true);
  camera.height = 28;
  double most[2] = {};
  for (const bool separated : {false, true}) {
    if (separated) {
      const PellucidMaterial skin = compileMaterial(model.materials[0], "skin1");
      ASSERT_EQ(separateBodies(model, {static_cast<double>(skin.radius[0])}).added, 1u);
    }
    const Capture c = rasterize(model, camera, options).capture;
    const Image result = replayer().run(c, compileMaterials(c), {}).output;
    for (int y = 0; y < 48; ++y)
      for (int x = 24; x < 48; ++x) most[separated] = std::max(most[separated], double(result.at(x, y)[0]));
    EXPECT_GT(result.at(6, 24)[0], 0.1f) << "the lit one";
  }
  EXPECT_GT(most[0], 0.02) << "one number says that it is one body";
  EXPECT_EQ(most[1], 0);
}

// An opaque plate of 16 mm in a slab of 4 mm, lit from behind at 18 degrees: path tracing has .006 and .000
// of .93 in red behind it. Light that enters beside the plate must not come straight through it.
TEST_F(Raster, PlatesInABodyBlockLightFromAside) {
  RasterOptions options = smallRaster(48);
  options.shadowSize = 512;
  ModelCamera camera = frontCamera(true);
  camera.height = 42;
  const auto capture = [&](std::optional<double> plate) {
    Model model = emptyModel();
    const auto add = [&](float x, float y, float z, float depth) {
      const std::size_t first = model.vertices.size();
      addCube(model, 1);
      for (std::size_t i = first; i < model.vertices.size(); ++i) {
        std::array<float, 3>& p = model.vertices[i].position;
        p = {x * p[0], y * p[1], z * p[2] + depth};
      }
    };
    add(20, 20, 2, 0);
    endPart(model, 0);
    if (plate) {
      add(8, 8, 0.5f, static_cast<float>(*plate));
      model.surfaces.emplace_back();
      endPart(model, 1, 1);
    }
    model.lights = {directional({0.3, 0.1, 1}, 4)};
    return rasterize(model, camera, options).capture;
  };
  const auto middle = [](const Image& image) { return *image.at(24, 24); };
  const Capture without = capture({});
  const std::vector<PellucidMaterial> materials = compileMaterials(without);
  ReplaySettings settings;
  settings.translucency.gatherSamples = 8;
  const float open = middle(replayer().run(without, materials, settings).output);
  EXPECT_GT(open, 0.5f);
  for (const double plate : {0.0, 1.2}) {
    const Capture c = capture(plate);
    const Image result = replayer().run(c, materials, settings).output;
    EXPECT_LT(middle(result), 0.03f * open) << plate;
    // The float64 gather over all texels decides alike.
    const Image expected =
        allTexels(c, materials, Image(48, 48, 3), [](int x, int y) { return x == 24 && y == 24; });
    EXPECT_LT(middle(expected) * materials[0].reflectance[0], 0.03f * open) << plate;
  }
}

// ---- Fewer triangles for back depth and shadow maps (Whelan 2009, 4.7.3)

Model twoSpheres() {
  Model model = emptyModel();
  addSphere(model, {0, 0, 0}, 8, 48);
  endPart(model, 1);
  addSphere(model, {0, 0, -20}, 1, 24);
  endPart(model, 2);
  model.lights.resize(1);
  model.lights[0].direction = {0.3, -0.2, 1};
  return model;
}

class Simplify : public GpuTest {};

TEST_F(Simplify, KeepsPartsAndTheirShareOfTriangles) {
  const Model whole = twoSpheres(), simple = simplified(whole, 0.2);
  ASSERT_EQ(simple.parts.size(), 2u);
  std::uint32_t next = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(simple.parts[i].firstIndex, next);
    next += simple.parts[i].indexCount;
    EXPECT_EQ(simple.parts[i].object, whole.parts[i].object);
    EXPECT_EQ(simple.parts[i].indexCount % 3, 0u);
    EXPECT_NEAR(simple.parts[i].indexCount / double(whole.parts[i].indexCount), 0.2, 0.02);
  }
  EXPECT_EQ(next, simple.indices.size());
  EXPECT_EQ(simplified(whole, 1).indices, whole.indices);
}

// A fifth of the sphere's triangles: chords of about 0.5 mm in place of 8 mm of radius are off by a few
// hundredths of a mm.
TEST_F(Simplify, ChangesWhatLightComesThroughAlone) {
  const Model model = twoSpheres();
  RasterOptions options{.width = 96, .height = 96, .depthEncoding = PELLUCID_DEPTH_VIEW_Z, .shadowSize = 96};
  const RasterResult whole = rasterize(device(), model, frontCamera(true), options);
  options.simplify = 0.2;
  const RasterResult simple = rasterize(device(), model, frontCamera(true), options);
  const Capture &a = whole.capture, &b = simple.capture;
  EXPECT_EQ(a.material, b.material);
  EXPECT_TRUE(sameBits(a.frontDepth.image, b.frontDepth.image));
  EXPECT_TRUE(sameBits(a.irradiance, b.irradiance));
  EXPECT_FALSE(sameBits(a.backDepth.image, b.backDepth.image));
  EXPECT_FALSE(sameBits(a.lights[0].shadowMaps[0].depth.image, b.lights[0].shadowMaps[0].depth.image));
  double sum = 0;
  int covered = 0;
  for (std::size_t i = 0; i < a.material.size(); ++i) {
    const float from = a.backDepth.image.data[i], to = b.backDepth.image.data[i];
    if (a.material[i] == 0 || from >= kNoDepth || to >= kNoDepth) continue;
    ++covered;
    sum += std::abs(static_cast<double>(from - to));
  }
  EXPECT_GT(covered, 3000);
  EXPECT_LT(sum / covered, 0.1) << "mm";
}

// ---- Surfaces whose reflected and transmitted light have colors of their own, through the replay

constexpr double kE = 2;

// A leaf, as KHR_materials_diffuse_transmission has it: half of the light comes through, in (.8, .1, .1).
Model leaf() {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 5);
  endPart(model, 0);
  Surface& surface = model.surfaces[0];
  surface.doubleSided = true;
  surface.baseColor = {0.1, 0.6, 0.1};
  surface.addedColor = {0.4, 0.05, 0.05};
  surface.displaced = 0.5;
  surface.lobes = SurfaceLobes::Apart;
  BurleyMaterial medium{{1e-3, 1e-3, 1e-3}, {{}}};
  for (auto& channel : *medium.transmittance) channel = {1, 1e-6, 0, 1e-6};
  model.materials = {medium};
  return model;
}

class Lobes : public GpuTest {
protected:
  // The replayed light in the middle, with the sun travelling along z.
  static std::array<double, 3> middle(Model model, double direction) {
    model.lights = {directional({0, 0, direction}, kE)};
    const RasterOptions options{.width = 33, .height = 33, .shadowSize = 256};
    const Capture capture = rasterize(device(), model, frontCamera(true), options).capture;
    const Image output = replay(capture, inFloats());
    const float* rgb = output.at(16, 16);
    return {rgb[0], rgb[1], rgb[2]};
  }
};

// Half floats of images and shadow texels that straddle the sheet leave a percent.
constexpr double kTolerance = 0.01;

void expectRgb(const std::array<double, 3>& rgb, const std::array<double, 3>& expected) {
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(rgb[c], expected[c], kTolerance * std::max(expected[c], 0.1)) << c;
}

TEST_F(Lobes, ReflectedAndTransmittedLightHaveTheirOwnColors) {
  expectRgb(middle(leaf(), -1), {0.1, 0.6, 0.1});
  expectRgb(middle(leaf(), 1), {0.8, 0.1, 0.1});
}

// No blue light comes through, but blue reflects in spite of an albedo of 0.
TEST_F(Lobes, ChannelsWithoutTransmittedLightReflect) {
  Model model = leaf();
  model.surfaces[0].addedColor = {0.4, 0.05, 0};
  expectRgb(middle(model, -1), {0.1, 0.6, 0.1});
  EXPECT_LT(middle(model, 1)[2], 0.005);
}

// The lobe map's alpha says how much comes through, its color in which color.
TEST_F(Lobes, TheMapMultipliesWhatComesThrough) {
  Model model = leaf();
  model.textures = {Texture{1, 1, {255, 0, 255, 128}}};  // sRGB 1, 0, 1; half
  model.surfaces[0].lobeMap = 0;
  const double alpha = 128 / 255.0;
  expectRgb(middle(model, -1),
            {kE * 0.1 * (1 - 0.5 * alpha), kE * 0.6 * (1 - 0.5 * alpha), kE * 0.1 * (1 - 0.5 * alpha)});
  // An albedo is at least 1 / 1024, because it carries the reflected light, too.
  expectRgb(middle(model, 1), {0.8 * alpha, kE / 1024, 0.1 * alpha});
}

// A thin wall: a third of what scatters comes back.
TEST_F(Lobes, ScatteredLightComesBackToo) {
  Model model = leaf();
  Surface& surface = model.surfaces[0];
  surface.baseColor = {0, 0, 0};
  surface.displaced = 0;
  surface.backscatter = 0.5;
  expectRgb(middle(model, -1), {0.4, 0.05, 0.05});
  expectRgb(middle(model, 1), {0.8, 0.1, 0.1});
}

}  // namespace
