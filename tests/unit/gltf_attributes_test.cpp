// glTF: sparse accessors and texture transforms.
#include <cmath>
#include <numbers>

#include "common/png.h"
#include "gltf_fixture.h"

namespace {

using namespace pellucid::test;

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

}  // namespace
