// Normal maps of the rasterizer against the tilt that one vector of the map means.
#include <functional>
#include <glm/glm.hpp>

#include "gpu/gpu_fixture.h"
#include "gpu/model_builder.h"
#include "raster/raster.h"

namespace {

using namespace pellucid::test;

class NormalMap : public GpuTest {
protected:
  static Capture capture(const Model& model) {
    RasterOptions options{.width = 32, .height = 32};
    return rasterize(device(), model, frontCamera(true), options).capture;
  }

  // By the irradiance, a color each, of lights from three directions before the face.
  static void expectNormal(Model model, const glm::dvec3& expected) {
    const double side = expected.z < 0 ? -1 : 1;
    const glm::dvec3 toLights[] = {
        glm::normalize(glm::dvec3(1, 0, side)), glm::normalize(glm::dvec3(0, 1, side)), {0, 0, side}};
    model.lights.clear();
    for (std::size_t i = 0; i < 3; ++i) {
      Light& light = model.lights.emplace_back(directional({-toLights[i].x, -toLights[i].y, -toLights[i].z}));
      light.color = {0, 0, 0};
      light.color[i] = 1;
    }
    const Capture c = capture(model);
    for (const int x : {8, 16, 23})
      for (std::size_t i = 0; i < 3; ++i)  // normals are half floats
        EXPECT_NEAR(c.irradiance.at(x, 14)[i], glm::dot(expected, toLights[i]), 1e-3) << "light " << i;
  }
};

constexpr std::array<std::uint8_t, 4> kTexel = {200, 90, 220, 255};

glm::dvec3 vectorOf(double scale) {
  const auto component = [](std::size_t i) { return kTexel[i] / 127.5 - 1; };
  return glm::normalize(glm::dvec3(scale * component(0), scale * component(1), component(2)));
}

// A square facing +z whose map is the same vector everywhere; uv of a corner from its position, in -8 .. 8.
Model tilted(const std::function<std::array<float, 2>(double x, double y)>& uv) {
  Model model = emptyModel();
  addSquare(model, 0, 0, 0, 8);
  endPart(model, 0);
  Texture map;
  map.width = map.height = 1;
  map.rgba.assign(kTexel.begin(), kTexel.end());
  map.isNormalMap = true;
  model.textures = {map};
  model.surfaces[0].normalMap = 0;
  for (Vertex& v : model.vertices) v.normalUv = uv(double(v.position[0]), double(v.position[1]));
  model.lights = {directional({0, 0, -1})};
  return model;
}

std::array<float, 2> upright(double x, double y) {  // v grows downwards
  return {static_cast<float>(x / 16), static_cast<float>(-y / 16)};
}

TEST_F(NormalMap, IsTiltedAlongTheTexture) {
  const glm::dvec3 n = vectorOf(1);
  expectNormal(tilted(upright), n);
  const auto mirrored = [](double x, double y) { return upright(-x, y); };
  expectNormal(tilted(mirrored), {-n.x, n.y, n.z});
  const auto turned = [](double x, double y) { return upright(y, -x); };  // u along +y, up along -x
  expectNormal(tilted(turned), {-n.y, n.x, n.z});
  const auto sheared = [](double x, double y) { return upright(x + 0.5 * y, y); };
  expectNormal(tilted(sheared), n);  // u still grows along x where v is constant
}

TEST_F(NormalMap, SuppliedTangentsCount) {
  const glm::dvec3 n = vectorOf(1);
  Model model = tilted([](double, double) { return std::array<float, 2>{0, 0}; });
  expectNormal(model, {0, 0, 1});  // neither tangents nor uv that change
  for (Vertex& v : model.vertices) v.tangent = {0, 1, 0, 1};
  expectNormal(model, {-n.y, n.x, n.z});
  for (Vertex& v : model.vertices) v.tangent = {0, 1, 0, -1};
  expectNormal(model, {n.y, n.x, n.z});
}

TEST_F(NormalMap, ScaleAndBackOfADoubleSidedFace) {
  Model model = tilted(upright);
  model.surfaces[0].normalScale = 0.5;
  expectNormal(model, vectorOf(0.5));
  model.surfaces[0].normalScale = 0;
  expectNormal(model, {0, 0, 1});
  model.surfaces[0].normalScale = 1;
  model.surfaces[0].doubleSided = true;
  std::swap(model.indices[1], model.indices[2]);
  std::swap(model.indices[4], model.indices[5]);
  expectNormal(model, -vectorOf(1));  // the whole normal turns round (glTF 2.0, 3.9.5)
}

// The triangles' normals decide what shadows, the map's how much light arrives: no self-shadowing where a
// map leans towards the light more than the surface.
TEST_F(NormalMap, DoesNotMakeShadows) {
  Model model = tilted(upright);
  model.lights = {directional({1, 0, -0.3})};
  const Capture c = capture(model);
  const glm::dvec3 toLight = glm::normalize(glm::dvec3(-1, 0, 0.3));
  Model facing = tilted([](double x, double y) { return upright(-x, y); });
  facing.lights = model.lights;
  const Capture lit = capture(facing);
  const glm::dvec3 n = vectorOf(1) * glm::dvec3(-1, 1, 1);
  for (int x = 5; x < 27; ++x) {
    EXPECT_NEAR(lit.irradiance.at(x, 16)[0], glm::dot(n, toLight), 1e-3);
    EXPECT_EQ(c.irradiance.at(x, 16)[0], 0) << "leans away from the light";
  }
}

}  // namespace
