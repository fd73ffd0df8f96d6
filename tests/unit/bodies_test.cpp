// Which parts of a model are one body, which bodies get numbers of their own, what lies inside them, and the lights
// that are refused for lying there.
#include "raster/bodies.h"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "gpu/model_builder.h"
#include "refusal.h"

namespace pellucid::test {
namespace {

constexpr double kReach = 20;  // mm

// Numbers of the materials of all triangles that begin at x < 0, and of all others.
struct Sides {
  std::set<int> left, right;
};
Sides sidesOf(const Model& model) {
  Sides sides;
  for (const Part& part : model.parts)
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3) {
      const float x = model.vertices[model.indices[i]].position[0];
      (x < 0 ? sides.left : sides.right).insert(model.surfaces[part.surface].material);
    }
  return sides;
}

// Balls of 6 mm whose gap is that wide, as one object or two.
Model twoBalls(double gap, bool oneObject) {
  Model model = emptyModel();
  addSphere(model, {-6 - gap / 2, 0, 0}, 6, 16);
  if (!oneObject) endPart(model, 0);
  addSphere(model, {6 + gap / 2, 0, 0}, 6, 16);
  endPart(model, 1);
  return model;
}

std::size_t added(Model model) {
  return separateBodies(model, std::vector<double>(model.materials.size(), kReach)).added;
}

TEST(Bodies, NearOnesHaveNumbersOfTheirOwn) {
  for (const bool oneObject : {false, true})
    for (const double gap : {0.1, 3.0, 19.0}) {
      Model model = twoBalls(gap, oneObject);
      const std::multiset<std::uint32_t> before(model.indices.begin(), model.indices.end());
      const BodySeparation separated = separateBodies(model, {kReach});
      EXPECT_EQ(separated.bodies, 2u);
      EXPECT_EQ(separated.added, 1u) << gap;
      EXPECT_EQ(model.materials.size(), 1u);
      ASSERT_EQ(model.bodies, std::vector<std::uint8_t>{0});
      EXPECT_EQ(withBodies(model.materials, model.bodies).size(), 2u);
      const Sides sides = sidesOf(model);
      EXPECT_EQ(sides.left, std::set<int>{1});
      EXPECT_EQ(sides.right, std::set<int>{2});
      EXPECT_EQ(std::multiset<std::uint32_t>(model.indices.begin(), model.indices.end()), before);
      joinBodies(model);
      EXPECT_EQ(sidesOf(model).right, std::set<int>{1});
      EXPECT_TRUE(model.bodies.empty());
    }
}

TEST(Bodies, FarOnesShareANumber) {
  EXPECT_EQ(added(twoBalls(21, true)), 0u);
  // Of five in a row each reaches the next alone.
  Model row = emptyModel();
  for (int i = 0; i < 5; ++i) addSphere(row, {25.0 * i, 0, 0}, 6, 8);
  endPart(row, 0);
  EXPECT_EQ(separateBodies(row, {kReach}).bodies, 5u);
  EXPECT_EQ(row.bodies.size(), 1u);
}

TEST(Bodies, MetersPerUnitScalesTheReach) {
  Model model = twoBalls(3, true);
  model.metersPerUnit = 1;  // 3 m apart
  EXPECT_EQ(added(model), 0u);
}

TEST(Bodies, WhatTouchesIsOne) {
  EXPECT_EQ(added(twoBalls(0, false)), 0u) << "at a point";
  EXPECT_EQ(added(twoBalls(-2, false)), 0u) << "they cut each other";
  // Sheets that share an edge whose corners differ: 3 squares on one side, 1 on the other.
  Model seam = emptyModel();
  for (const double y : {-10.0, 0.0, 10.0}) addSquare(seam, -5, y, 0, 5);
  endPart(seam, 0);
  addSquare(seam, 15 + 1e-5, 0, 0, 15);
  endPart(seam, 1);
  EXPECT_EQ(added(seam), 0u);
}

TEST(Bodies, AHollowIsPartOfItsBody) {
  Model shell = emptyModel();
  addSphere(shell, {0, 0, 0}, 10, 16);
  const std::size_t inner = shell.indices.size();
  addSphere(shell, {0, 0, 0}, 8, 16);
  turnOver(shell, inner);
  endPart(shell, 0);
  EXPECT_EQ(separateBodies(shell, {kReach}).bodies, 1u);
}

TEST(Bodies, ThinWallsNeedNoNumbers) {
  Model model = twoBalls(3, false);
  EXPECT_EQ(separateBodies(model, {0}).added, 0u) << "no light goes aside in them";
}

TEST(Bodies, OtherMediaAndOpaqueSurfacesKeepTheirNumbers) {
  Model model = twoBalls(3, false);
  model.surfaces.resize(2, model.surfaces[0]);
  model.parts[1].surface = 1;
  model.surfaces[1].material = 0;
  EXPECT_EQ(added(model), 0u);
  model.surfaces[1].material = 2;
  model.materials.resize(2);
  EXPECT_EQ(added(model), 0u);
}

TEST(Bodies, CrowdsHaveSixteenNumbersAtMost) {
  Model crowd = emptyModel();
  for (int i = 0; i < 40; ++i) addSquare(crowd, 0, 0, 0.1 * i, 5);
  endPart(crowd, 0);
  EXPECT_EQ(separateBodies(crowd, {kReach}).bodies, 40u);
  EXPECT_EQ(crowd.bodies.size(), 15u);
  // Numbers come again as far away as they can: no sheet has that of the next.
  std::map<float, int> numbers;
  for (const Part& part : crowd.parts)
    for (std::uint32_t i = 0; i < part.indexCount; i += 3)
      numbers[crowd.vertices[crowd.indices[part.firstIndex + i]].position[2]] =
          crowd.surfaces[part.surface].material;
  ASSERT_EQ(numbers.size(), 40u);
  for (auto next = std::next(numbers.begin()); next != numbers.end(); ++next)
    EXPECT_NE(next->second, std::prev(next)->second) << next->first;
}

// ---- Enclosing

Model sphere(double radius) {
  Model model = emptyModel();
  model.surfaces[0].name = "wax";
  addSphere(model, {0, 0, 0}, radius, 12);
  endPart(model, 0);
  return model;
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
