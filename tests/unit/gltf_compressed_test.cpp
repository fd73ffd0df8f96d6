// glTF: compressed and sparse accessors, and texture transforms.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include <cmath>
#include <cstring>
#include <numbers>

#include "common/png.h"
#include "gltf_fixture.h"

namespace {

using namespace pellucid::test;

void expectSquare(const Model& m) {
  ASSERT_EQ(m.indices.size(), 6u);
  for (const std::size_t triangle : {0u, 1u}) EXPECT_NEAR(winding(m, triangle).z, 4, 1e-3);
  for (std::size_t i = 0; i < 6; ++i) {
    const glm::dvec3 p = corner(m, i);
    EXPECT_NEAR(std::abs(p.x - 1), 1, 1e-3);
    EXPECT_NEAR(std::abs(p.y - 1), 1, 1e-3);
    expectVector(m.vertices[m.indices[i]].normal, 0, 0, 1, 0.01);
  }
}

// ---- KHR_draco_mesh_compression

GltfBuilder dracoSquare() {
  draco::TriangleSoupMeshBuilder soup;
  soup.Start(2);
  const int position = soup.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
  const int normal = soup.AddAttribute(draco::GeometryAttribute::NORMAL, 3, draco::DT_FLOAT32);
  const float corners[4][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}}, up[3] = {0, 0, 1};
  const int triangles[2][3] = {{0, 1, 2}, {0, 2, 3}};
  for (int i = 0; i < 2; ++i) {
    soup.SetAttributeValuesForFace(position, draco::FaceIndex(static_cast<std::uint32_t>(i)),
                                   corners[triangles[i][0]], corners[triangles[i][1]],
                                   corners[triangles[i][2]]);
    soup.SetAttributeValuesForFace(normal, draco::FaceIndex(static_cast<std::uint32_t>(i)), up, up, up);
  }
  const std::unique_ptr<draco::Mesh> mesh = soup.Finalize();
  draco::EncoderBuffer bytes;
  EXPECT_TRUE(draco::Encoder().EncodeMeshToBuffer(*mesh, &bytes).ok());
  GltfBuilder b;
  const int view = b.view(bytes.data(), bytes.size());
  b.json["accessors"] = {{{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}},
                         {{"componentType", 5126}, {"count", mesh->num_points()}, {"type", "VEC3"}},
                         {{"componentType", 5123}, {"count", 6}, {"type", "SCALAR"}}};
  const auto id = [&](int attribute) { return mesh->attribute(attribute)->unique_id(); };
  b.json["meshes"] = {{{"primitives",
                        {{{"attributes", {{"POSITION", 0}, {"NORMAL", 1}}},
                          {"indices", 2},
                          {"extensions",
                           {{"KHR_draco_mesh_compression",
                             {{"bufferView", view},
                              {"attributes", {{"POSITION", id(position)}, {"NORMAL", id(normal)}}}}}}}}}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  return b;
}

TEST_F(Gltf, DracoStreamsAreDecoded) { expectSquare(loadGltf(write("t.glb", dracoSquare().glb())).model); }

TEST_F(Gltf, DracoStreamsThatDoNotFitAreRefused) {
  expectRefusals(dracoSquare, R"(
/accessors/0/count | 5 | accessors[0].count | 5 | Draco stream
/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/attributes/POSITION | 77 | KHR_draco_mesh_compression.attributes.POSITION | 77
/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression/bufferView | removed | KHR_draco_mesh_compression.bufferView | is missing
/bufferViews/0/byteLength | 30 | KHR_draco_mesh_compression
)");
  GltfBuilder b = dracoSquare();
  b.buffer[0] = 'X';
  expectRefused(b.glb(),
                {"meshes[0].primitives[0].extensions.KHR_draco_mesh_compression", "Not a Draco file"});
}

// ---- EXT_meshopt_compression

// Puts the bytes of each of the square's views into a stream and a buffer that is not there.
GltfBuilder meshoptSquare() {
  const GltfBuilder plain = square();
  GltfBuilder b = plain;
  b.buffer.clear();
  b.json["bufferViews"] = Json::array();
  const auto add = [&](std::size_t view, std::size_t count, std::size_t stride, const char* mode) {
    const auto& source = plain.json["bufferViews"][view];
    const char* data = plain.buffer.data() + source["byteOffset"].get<std::size_t>();
    std::vector<unsigned char> stream(1000);
    if (std::strcmp(mode, "ATTRIBUTES") == 0) {
      stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), data, count, stride));
    } else {
      std::vector<unsigned> indices;
      for (std::size_t i = 0; i < count; ++i)
        indices.push_back(reinterpret_cast<const std::uint16_t*>(data)[i]);
      stream.resize(meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), count));
    }
    const std::size_t offset = b.buffer.size();
    b.buffer.append(stream.begin(), stream.end());
    b.json["bufferViews"].push_back({{"buffer", 1},
                                     {"byteLength", count * stride},
                                     {"extensions",
                                      {{"EXT_meshopt_compression",
                                        {{"buffer", 0},
                                         {"byteOffset", offset},
                                         {"byteLength", stream.size()},
                                         {"byteStride", stride},
                                         {"count", count},
                                         {"mode", mode}}}}}});
  };
  add(0, 4, 12, "ATTRIBUTES");
  add(1, 4, 12, "ATTRIBUTES");
  add(2, 6, 2, "TRIANGLES");
  b.json["buffers"] = {
      Json::object(),
      {{"byteLength", 108}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  return b;
}

TEST_F(Gltf, MeshoptStreamsAreDecoded) {
  expectSquare(loadGltf(write("t.glb", meshoptSquare().glb())).model);
}

TEST_F(Gltf, MeshoptStreamsThatDoNotFitAreRefused) {
  expectRefusals(meshoptSquare, R"(
/bufferViews/0/extensions/EXT_meshopt_compression/byteLength | 16 | bufferViews[0].extensions.EXT_meshopt_compression
/bufferViews/0/extensions/EXT_meshopt_compression/byteLength | 1048576 | EXT_meshopt_compression
/bufferViews/0/extensions/EXT_meshopt_compression/count | 5 | EXT_meshopt_compression.count | 48
/bufferViews/0/extensions/EXT_meshopt_compression/count | 1073741824 | EXT_meshopt_compression.count
/bufferViews/0/extensions/EXT_meshopt_compression/byteStride | 3 | EXT_meshopt_compression.byteStride | 3
/bufferViews/0/extensions/EXT_meshopt_compression/mode | "FANCY" | EXT_meshopt_compression.mode | FANCY
/bufferViews/0/extensions/EXT_meshopt_compression/filter | "OCTAHEDRAL" | EXT_meshopt_compression.filter | 12 bytes
/bufferViews/0/extensions/EXT_meshopt_compression/buffer | 9 | EXT_meshopt_compression.buffer | 9
)");
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

}  // namespace
