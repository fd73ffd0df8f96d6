// Points inside bodies, and the lights that are refused for lying there.
#include "raster/bodies.h"

#include <gtest/gtest.h>

#include "gpu/model_builder.h"
#include "refusal.h"

namespace pellucid::test {
namespace {

Model sphere(double radius) {
  Model model = emptyModel();
  model.surfaces[0].name = "wax";
  addSphere(model, {0, 0, 0}, radius, 12);
  endPart(model, 0);
  return model;
}

// Turns the triangles to be seen from the other side.
void turnOver(Model& model, std::size_t firstIndex) {
  for (std::size_t i = firstIndex; i < model.indices.size(); i += 3)
    std::swap(model.indices[i], model.indices[i + 1]);
}

TEST(Enclosing, PointsInASolid) {
  const Model model = sphere(10);
  EXPECT_EQ(enclosingBody(model, {0, 0, 0}), "wax");
  EXPECT_EQ(enclosingBody(model, {0, 9.5, 0}), "wax");
  EXPECT_FALSE(enclosingBody(model, {0, 10.5, 0}));
  EXPECT_FALSE(enclosingBody(model, {30, 0, 0}));
}

TEST(Enclosing, HollowsAndLeavesEncloseNothing) {
  Model shell = sphere(10);
  const std::size_t inner = shell.indices.size();
  addSphere(shell, {0, 0, 0}, 8, 12);
  turnOver(shell, inner);
  endPart(shell, 0);
  EXPECT_FALSE(enclosingBody(shell, {0, 0, 0})) << "the hollow";
  EXPECT_EQ(enclosingBody(shell, {0, 9, 0}), "wax") << "the wall";

  Model leaf = emptyModel();
  addSquare(leaf, 0, 0, 0, 10);
  endPart(leaf, 0);
  for (const double z : {-0.01, 0.01}) EXPECT_FALSE(enclosingBody(leaf, {0, 0, z}));
}

TEST(Enclosing, OpaqueBodiesAreNotLookedAt) {
  Model model = sphere(10);
  model.surfaces[0].material = 0;
  EXPECT_FALSE(enclosingBody(model, {0, 0, 0}));
}

// As an object of its own or as a part of the body's; outside, and where the body is open, there is nothing
// to say.
TEST(Enclosing, OpaqueSurfacesInsideAreNamed) {
  for (const std::uint32_t object : {0u, 1u})
    for (const double z : {0.0, 30.0}) {
      Model model = sphere(10);
      model.surfaces.resize(2);
      model.surfaces[1].name = "bone";
      addSquare(model, 0, 0, z, 2);
      endPart(model, object, 1);
      const std::vector<std::string> said = opaqueInside(model);
      ASSERT_EQ(said.size(), z == 0 ? 1u : 0u) << object;
      for (const char* name : {"\"bone\"", "\"wax\""})
        if (z == 0) {
          EXPECT_NE(said[0].find(name), std::string::npos) << said[0];
        }
      model.parts[0].indexCount /= 2;
      EXPECT_TRUE(opaqueInside(model).empty()) << "half a ball";
    }
}

TEST(Enclosing, LightsInsideAreRefusedByName) {
  Model model = sphere(10);
  model.lights = {directional({0, 0, -1}), pointLight({0, 0, 20})};
  EXPECT_NO_THROW(refuseEnclosedLights(model));
  model.lights[1].position = {0, 0, 2};
  const std::string text = refusalOf([&] { refuseEnclosedLights(model); });
  EXPECT_NE(text.find("lights[1].position"), std::string::npos) << text;
  EXPECT_NE(text.find("wax"), std::string::npos) << text;
}

TEST(Enclosing, ThinWallsEncloseNoLight) {
  Model model = sphere(10);
  model.materials[0] = ThinWallMaterial{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}, {}};
  EXPECT_FALSE(enclosingBody(model, {0, 0, 0}));
}

// Wax at the origin, and a lamp's opaque ball around a light beside it.
Model lamp(bool glows) {
  Model model = sphere(10);
  model.surfaces.push_back({});
  model.surfaces[1].name = "bulb";
  model.surfaces[1].isEmissive = glows;
  addSphere(model, {30, 0, 0}, 3, 12);
  endPart(model, 1, 1);
  model.lights = {directional({0, 0, -1}), pointLight({30, 0, 0})};
  return model;
}

TEST(Enclosing, GlowingSurfacesAroundALightAreLeftOut) {
  Model model = lamp(true);
  const std::size_t wax = model.parts[0].indexCount;
  const std::vector<std::string> said = openLamps(model);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("lights[1] lies inside or beside glowing \"bulb\""), std::string::npos) << said[0];
  EXPECT_EQ(model.indices.size(), wax);
  EXPECT_EQ(model.parts.size(), 1u);
}

TEST(Enclosing, OpaqueSurfacesAroundALightAreNamed) {
  Model model = lamp(false);
  const std::size_t before = model.indices.size();
  const std::vector<std::string> said = openLamps(model);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_NE(said[0].find("lights[1] lies inside opaque \"bulb\""), std::string::npos) << said[0];
  EXPECT_NE(said[0].find("--material bulb=none"), std::string::npos) << said[0];
  EXPECT_EQ(model.indices.size(), before);
  // A room around the light holds the wax, too.
  addSphere(model, {0, 0, 0}, 100, 12);
  endPart(model, 2, 1);
  model.lights[1].position = {50, 0, 0};
  EXPECT_TRUE(openLamps(model).empty());
}

}  // namespace
}  // namespace pellucid::test
