// glTF: skins, morph targets, sparse accessors, texture transforms, and scenes far from the origin.
#include <cmath>
#include <numbers>

#include "common/png.h"
#include "gltf_fixture.h"
#include "raster/framing.h"

namespace {

using namespace pellucid::test;

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

// ---- Sparse accessors

TEST_F(Gltf, SparseAccessorsReplaceElements) {
  GltfBuilder b = square();
  const std::vector<std::uint16_t> where = {1, 2};
  const std::vector<float> what = {4, 0, 0, 4, 2, 0};
  const int indices = b.view(where.data(), where.size() * 2), values = b.view(what.data(), what.size() * 4);
  const Json sparse = {{"count", 2},
                       {"indices", {{"bufferView", indices}, {"componentType", 5123}}},
                       {"values", {{"bufferView", values}}}};
  b.json["accessors"][0]["sparse"] = sparse;
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[0].position, 0, 0, 0);
  expectVector(m.vertices[1].position, 4, 0, 0);
  expectVector(m.vertices[2].position, 4, 2, 0);
  expectVector(m.vertices[3].position, 0, 2, 0);
  // Without a buffer view, everything else is 0.
  b.json["accessors"][0].erase("bufferView");
  expectVector(loadGltf(write("t.glb", b.glb())).model.vertices[3].position, 0, 0, 0);

  b.json["accessors"][0]["sparse"]["indices"]["componentType"] = 5121;  // 1, 0: they do not grow
  expectRefused(b.glb(), {"accessors[0].sparse.indices", "0 at 1"});
  b.json["accessors"][0]["sparse"] = sparse;
  b.json["accessors"][0]["count"] = 2;
  b.json["meshes"][0]["primitives"][0]["attributes"].erase("NORMAL");
  expectRefused(b.glb(), {"accessors[0].sparse.indices", "2 at 1", "2 elements"});
  b.json["accessors"][0]["count"] = 1LL << 40;
  expectRefused(b.glb(), {"accessors[0].count", "2^24"});
}

// ---- KHR_texture_transform

// The example of the extension: the lower left quarter, turned clockwise.
TEST_F(Gltf, TextureTransformsMoveTheCoordinates) {
  GltfBuilder b = square();
  const int uv = b.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
  b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = uv;
  writePng(folder_ / "c.png", 1, 1, {255, 0, 0});
  b.json["images"] = {{{"uri", "c.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  const Json transform = {
      {"offset", {0, 1}}, {"rotation", std::numbers::pi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
  b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {
      {"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}};
  b.json["extensionsRequired"] = {"KHR_texture_transform"};
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  EXPECT_FALSE(says(scene.warnings, "ignored"));
  const float expected[4][2] = {{0, 1}, {0, 0.5f}, {0.5f, 0.5f}, {0.5f, 1}};
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t c = 0; c < 2; ++c) EXPECT_NEAR(scene.model.vertices[i].uv[c], expected[i][c], 1e-6);
  b.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"]["KHR_texture_transform"]
        ["scale"] = {1};
  expectRefused(b.glb(), {"baseColorTexture.extensions.KHR_texture_transform.scale", "2 numbers"});
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

// A scene may have cameras in several places: the origin lies near the chosen camera, whose picture then is
// exact.
TEST_F(Gltf, TheOriginIsNearTheChosenOfSeveralCameras) {
  GltfBuilder b = square();
  b.json["nodes"] = {{{"mesh", 0}},
                     {{"mesh", 0}, {"translation", {4e6, 0, 0}}},
                     {{"name", "here"}, {"camera", 0}, {"translation", {0, 0, 5}}},
                     {{"name", "there"}, {"camera", 0}, {"translation", {4e6, 0, 5}}}};
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3};
  b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}}};
  for (const auto& [camera, x] : {std::pair("here", 0.0), std::pair("there", 4e6)}) {
    GltfOptions options;
    options.camera = camera;
    EXPECT_NEAR(loadGltf(write("t.glb", b.glb()), options).model.origin[0], x, 16) << camera;
  }
}

}  // namespace
