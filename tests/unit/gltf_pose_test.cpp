// glTF: animations, skins, morph targets, and scenes far from the origin.
#include <cmath>

#include "gltf_fixture.h"
#include "raster/framing.h"

namespace {

using namespace pellucid::test;

// Adds an animation of one channel.
void animate(GltfBuilder& b, const char* path, const std::vector<float>& times,
             const std::vector<float>& values, int components, const char* interpolation = "LINEAR",
             int node = 0) {
  const char* const types[] = {"", "SCALAR", "", "VEC3", "VEC4"};
  const int input = b.accessor(times, 5126, "SCALAR", 1);
  const int output = b.accessor(values, 5126, types[components], static_cast<std::size_t>(components));
  b.json["animations"].push_back(
      {{"name", path},
       {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
       {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
}

GltfOptions at(double seconds, const std::string& animation = "") {
  GltfOptions options;
  options.time = seconds;
  options.animation = animation;
  return options;
}

TEST_F(Gltf, NodesStandWhereTheAnimationHasThem) {
  GltfBuilder b = square();
  animate(b, "translation", {1, 3}, {0, 0, 0, 8, 0, 4}, 3);
  const fs::path file = write("t.glb", b.glb());
  const auto x = [&](double seconds) { return loadGltf(file, at(seconds)).model.vertices[0].position[0]; };
  EXPECT_EQ(loadGltf(file).model.vertices[0].position[0], 0);
  EXPECT_EQ(x(0), 0) << "the first key before it";
  EXPECT_NEAR(x(1.5), 2, 1e-6);
  EXPECT_EQ(x(100), 8) << "the last key after it";

  b = square();
  animate(b, "translation", {0, 1}, {1, 0, 0, 2, 0, 0}, 3, "STEP");
  EXPECT_EQ(loadGltf(write("t.glb", b.glb()), at(0.99)).model.vertices[0].position[0], 1);

  // u^3: from 0 with slope 0 to 1 with slope 3.
  b = square();
  animate(b, "translation", {0, 1}, {0, 0, 0, 0, 0, 0, 0, 0, 0, 3, 0, 0, 1, 0, 0, 0, 0, 0}, 3, "CUBICSPLINE");
  EXPECT_NEAR(loadGltf(write("t.glb", b.glb()), at(0.5)).model.vertices[0].position[0], 0.125, 1e-6);

  // Half of a quarter turn about z.
  const float h = std::sqrt(0.5f);
  b = square();
  animate(b, "rotation", {0, 1}, {0, 0, 0, 1, 0, 0, h, h}, 4);
  animate(b, "scale", {0, 1}, {1, 1, 1, 3, 1, 1}, 3);
  const fs::path turned = write("t.glb", b.glb());
  expectVector(loadGltf(turned, at(0.5)).model.vertices[1].position, 2 * h, 2 * h, 0);
  expectVector(loadGltf(turned, at(0.5, "scale")).model.vertices[1].position, 4, 0, 0);
  expectVector(loadGltf(turned, at(0.5, "1")).model.vertices[1].position, 4, 0, 0);
}

TEST_F(Gltf, AnimationsThatCannotBeReadAreNamed) {
  const auto moving = [] {
    GltfBuilder b = square();
    animate(b, "translation", {1, 3}, {0, 0, 0, 8, 0, 4}, 3);
    return b;
  };
  expectRefusals(moving, R"(
/animations | removed | animations | has none
/animations/0/channels/0/target/node | 9 | animations[0].channels[0].target.node | 9
/animations/0/channels/0/sampler | 4 | animations[0].channels[0].sampler | 4
/animations/0/samplers/0/input | removed | animations[0].samplers[0].input | is missing
/animations/0/channels/0/target/path | "color" | channels[0].target.path | color
/animations/0/samplers/0/interpolation | "SMOOTH" | samplers[0].interpolation | SMOOTH
/animations/0/samplers/0/output | 3 | animations[0].channels[0].sampler
/nodes/0/matrix | [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] | nodes[0].matrix | animations[0].channels[0]
)",
                 at(0));
  expectRefused(moving().glb(), {"animations", "\"walk\"", "there are translation"}, "t.glb", at(0, "walk"));

  // A pointer's channel has no part in where nodes stand.
  GltfBuilder b = square();
  animate(b, "translation", {1, 3}, {0, 0, 0, 8, 0, 4}, 3);
  b.json["animations"][0]["channels"].push_back({{"sampler", 0}, {"target", {{"path", "pointer"}}}});
  EXPECT_TRUE(
      says(loadGltf(write("t.glb", b.glb()), at(0)).warnings, "animations[0].channels[1]: path \"pointer\""));
}

TEST_F(Gltf, MorphTargetsAddUp) {
  GltfBuilder b = square();
  const int first = b.vectors({0, 0, 2, 0, 0, 2, 0, 0, 2, 0, 0, 2}),
            second = b.vectors({1, 0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0});
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", first}},
                                                     {{"POSITION", second}, {"NORMAL", second}}};
  b.json["meshes"][0]["weights"] = {0.5, 0};
  expectVector(loadGltf(write("t.glb", b.glb())).model.vertices[0].position, 0, 0, 1);
  b.json["nodes"][0]["weights"] = {0.25, 1};
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[0].position, 1, 0, 0.5);
  expectVector(m.vertices[0].normal, std::sqrt(0.5), 0, std::sqrt(0.5));
  animate(b, "weights", {0, 1}, {0, 0, 1, 0}, 1);
  expectVector(loadGltf(write("t.glb", b.glb()), at(0.5)).model.vertices[0].position, 0, 0, 1);
}

// The square hangs on two joints: its left edge on the first, its right edge on the second.
GltfBuilder skinnedSquare() {
  GltfBuilder b = square();
  const int joints =
      b.accessor(std::vector<std::uint8_t>{0, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0}, 5121, "VEC4", 4);
  const int weights =
      b.accessor(std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0.5f, 0.5f, 0, 0}, 5126, "VEC4", 4);
  b.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = joints;
  b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = weights;
  b.json["skins"] = {{{"joints", {1, 2}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"skin", 0}, {"translation", {100, 0, 0}}},
                     {{"children", {2}}, {"translation", {0, 0, 3}}},
                     {{"translation", {4, 0, 0}}}};
  b.json["scenes"][0]["nodes"] = {0, 1};
  return b;
}

TEST_F(Gltf, SkinsBindVerticesToJoints) {
  GltfBuilder b = skinnedSquare();
  Model m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[0].position, 0, 0, 3);  // the node's own place has no part
  expectVector(m.vertices[1].position, 6, 0, 3);
  expectVector(m.vertices[3].position, 2, 2, 3);  // half of each
  // Bound where the joints stand, nothing moves.
  std::vector<float> inverse = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,  0, -3, 1,
                                1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -4, 0, -3, 1};
  b.json["skins"][0]["inverseBindMatrices"] = b.accessor(inverse, 5126, "MAT4", 16);
  m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[1].position, 2, 0, 0);
  expectVector(m.vertices[3].position, 0, 2, 0);
  animate(b, "translation", {0}, {4, 5, 0}, 3, "LINEAR", 2);
  m = loadGltf(write("t.glb", b.glb()), at(0)).model;
  expectVector(m.vertices[1].position, 2, 5, 0);
  expectVector(m.vertices[0].position, 0, 0, 0);
}

TEST_F(Gltf, SkinsThatCannotBeBoundAreNamed) {
  expectRefusals(skinnedSquare, R"(
/meshes/0/primitives/0/attributes/JOINTS_0 | removed | nodes[0].skin | no JOINTS_0 | bake the pose
/skins/0/joints | [1] | JOINTS_0 | 1 of vertex 1 | 1 joints
/skins/0/joints | [1, 9] | skins[0].joints[1] | 9
/scenes/0/nodes | [0] | skins[0].joints[0] | nodes[1] is not in the scene
/skins/0/inverseBindMatrices | 0 | skins[0].inverseBindMatrices
)");
  GltfBuilder b = skinnedSquare();
  b.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] =
      b.accessor(std::vector<float>(16, 0.0f), 5126, "VEC4", 4);
  expectRefused(b.glb(), {"WEIGHTS_0", "all 0 at vertex 0"});
}

// ---- Far from the origin

// At these distances floats are 0.06 to 0.5 apart.
TEST_F(Gltf, VerticesFarFromTheOriginStayExact) {
  for (const double far : {1e6, 6378000.0}) {
    GltfBuilder b = square();
    b.json["nodes"] = {
        {{"mesh", 0}, {"translation", {far + 0.125, 0, -far / 3}}, {"scale", {0.1, 0.1, 0.1}}}};
    const GltfScene scene = loadGltf(write("t.glb", b.glb()));
    const Model& m = scene.model;
    EXPECT_TRUE(says(scene.notes, "the capture's world begins at"));
    for (std::size_t i = 0; i < 4; ++i) {
      const double x = m.vertices[i].position[0] + m.origin[0] - far - 0.125;
      EXPECT_NEAR(x, i == 1 || i == 2 ? 0.2 : 0, 1e-7);
    }
    expectVector(m.vertices[0].normal, 0, 0, 1);
    EXPECT_NEAR(winding(m, 0).z, 0.04, 1e-7);
    EXPECT_LT(std::abs(boundsOf(m).center[0]), 1);
  }
  const GltfScene near = loadGltf(write("t.glb", square().glb()));
  EXPECT_EQ(near.model.origin, (std::array<double, 3>{0, 0, 0}));
}

// Only the part near a camera that looks counts, however large the scene.
TEST_F(Gltf, TheOriginIsNearTheCameraThatLooks) {
  GltfBuilder b = square();
  b.json["nodes"] = {
      {{"mesh", 0}},
      {{"mesh", 0}, {"translation", {4e6, 0, 0}}},
      {{"name", "far"}, {"camera", 0}, {"translation", {4e6, 0, 5}}},
      {{"translation", {4e6, 0, 9}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  EXPECT_NEAR(m.origin[0], 4e6, 16);
  const glm::dvec3 eye(-m.cameras[0].viewFromWorld[12], -m.cameras[0].viewFromWorld[13],
                       -m.cameras[0].viewFromWorld[14]);
  EXPECT_NEAR(eye.x + m.origin[0], 4e6, 1e-6);
  EXPECT_NEAR(eye.z + m.origin[2], 5, 1e-6);
  EXPECT_NEAR(m.lights[0].position[2] + m.origin[2], 9, 1e-6);
  EXPECT_NEAR(m.vertices[5].position[0] + m.origin[0], 4e6 + 2, 1e-6);
}

}  // namespace
