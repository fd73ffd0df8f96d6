#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <limits>
#include <nlohmann/json.hpp>

#include "capture/material.h"
#include "cli/capture_options.h"
#include "common/png.h"
#include "gltf/material.h"
#include "gltf_fixture.h"
#include "pellucid/pellucid_material.h"
#include "raster/framing.h"

namespace {

using namespace pellucid::test;
using Rgb = std::array<double, 3>;

TEST_F(Gltf, TrianglesInWorldSpace) {
  GltfBuilder b = square();
  const double h = std::sqrt(0.5);
  b.json["nodes"] = {{{"children", {1}}, {"translation", {10, 0, 0}}},
                     {{"mesh", 0}, {"rotation", {0, h, 0, h}}, {"scale", {1, 2, 3}}}};
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  const Model& m = scene.model;
  ASSERT_EQ(m.vertices.size(), 4u);
  ASSERT_EQ(m.parts.size(), 1u);
  EXPECT_EQ(m.parts[0].indexCount, 6u);
  EXPECT_EQ(m.parts[0].object, 1u);
  EXPECT_EQ(m.surfaces[0].name, "m");
  expectVector(m.vertices[2].position, 10, 4, -2);  // a quarter turn about y takes +x to -z
  expectVector(m.vertices[2].normal, 1, 0, 0);
  EXPECT_NEAR(winding(m, 0).x, 8, 1e-5);
  EXPECT_EQ(m.metersPerUnit, 1);
}

// Exporters that multiply matrices in floats, leave out zeros, and write buffers with padding or any MIME type.
TEST_F(Gltf, OddlyWrittenFilesAreTheModel) {
  GltfBuilder b = square();
  const Model good = loadGltf(write("t.glb", b.glb())).model;
  b.json["nodes"] = {{{"mesh", 0}, {"matrix", {2, 0, 0, 1e-9, 0, 2, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2}}}};
  EXPECT_EQ(loadGltf(write("t.glb", b.glb())).model.vertices[2].position, good.vertices[2].position);

  b = square();
  b.json["accessors"].push_back({{"componentType", 5126}, {"count", 4}, {"type", "VEC3"}});
  b.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 3}}};
  b.json["meshes"][0]["weights"] = {1};
  EXPECT_EQ(loadGltf(write("t.glb", b.glb())).model.vertices[2].position, good.vertices[2].position);

  b = square();
  write("long.bin", b.buffer + "padding");
  b.json["buffers"] = {{{"byteLength", b.buffer.size()}, {"uri", "long.bin"}}};
  EXPECT_EQ(loadGltf(write("t.gltf", b.json.dump())).model.vertices[2].position, good.vertices[2].position);
}

TEST_F(Gltf, MirroredNodesKeepTheirOutside) {
  GltfBuilder b = square();
  b.json["nodes"] = {{{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}}};
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[2].position, -2, 4, 5);
  expectVector(m.vertices[0].normal, 0, 0, 1);
  for (const std::size_t triangle : {0u, 1u}) EXPECT_GT(winding(m, triangle).z, 0);
}

TEST_F(Gltf, EveryContainerGivesTheSameModel) {
  GltfBuilder b = square();
  const Model glb = loadGltf(write("t.glb", b.glb())).model;
  const std::string data = b.buffer;
  b.json["buffers"] = {{{"byteLength", data.size()}, {"uri", "a%20b.bin"}}};
  write("a b.bin", data);
  const Model external = loadGltf(write("t.gltf", b.json.dump())).model;
  const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i < data.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (i + k < data.size() ? static_cast<unsigned char>(data[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k)
      base64 += i + k > data.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
  }
  b.json["buffers"] = {
      {{"byteLength", data.size()}, {"uri", "data:application/octet-stream;base64," + base64}}};
  const Model embedded = loadGltf(write("e.gltf", b.json.dump())).model;
  for (const Model* m : {&external, &embedded}) {
    ASSERT_EQ(m->vertices.size(), 4u);
    EXPECT_EQ(m->indices, glb.indices);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(m->vertices[i].position, glb.vertices[i].position);
  }
}

TEST_F(Gltf, StripsFansAndPlainVertices) {
  for (const int mode : {4, 5, 6}) {
    GltfBuilder b;
    // Corners in the order that each mode needs.
    const std::vector<float> corners =
        mode == 4   ? std::vector<float>{0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 0, 0, 2, 2, 0, 0, 2, 0}
        : mode == 5 ? std::vector<float>{0, 2, 0, 0, 0, 0, 2, 2, 0, 2, 0, 0}
                    : std::vector<float>{0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
    b.json["meshes"] = {
        {{"primitives", {{{"attributes", {{"POSITION", b.vectors(corners)}}}, {"mode", mode}}}}}};
    b.json["nodes"] = {{{"mesh", 0}}};
    const Model m = loadGltf(write("t.glb", b.glb())).model;
    ASSERT_EQ(m.indices.size(), 6u) << mode;
    EXPECT_EQ(m.vertices.size(), 6u) << "without normals each triangle has its own vertices";
    for (const std::size_t triangle : {0u, 1u}) EXPECT_NEAR(winding(m, triangle).z, 4, 1e-6) << mode;
    for (const Vertex& v : m.vertices) expectVector(v.normal, 0, 0, 1);
    EXPECT_EQ(m.surfaces[0].name, "default");
  }
}

TEST_F(Gltf, QuantizedAndOtherAttributes) {
  GltfBuilder b;
  const int position =
      b.accessor(std::vector<std::int16_t>{0, 0, 0, 0, 200, 0, 0, 0, 200, 200, 0, 0}, 5122, "VEC3", 4);
  b.json["bufferViews"].back()["byteStride"] = 8;
  const int normal =
      b.accessor(std::vector<std::int8_t>{0, 0, 127, 0, 0, 0, 127, 0, 0, 0, -128, 0}, 5120, "VEC3", 4);
  b.json["bufferViews"].back()["byteStride"] = 4;
  b.json["accessors"].back()["normalized"] = true;
  const int color =
      b.accessor(std::vector<std::uint8_t>{255, 0, 51, 255, 255, 0, 51, 0, 255, 0, 51, 51}, 5121, "VEC4", 4);
  b.json["accessors"].back()["normalized"] = true;
  const int mark = b.accessor(std::vector<float>{1, 0, 0.5f}, 5126, "SCALAR", 1);
  b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  b.json["meshes"] = {
      {{"primitives",
        {{{"attributes",
           {{"POSITION", position}, {"NORMAL", normal}, {"COLOR_0", color}, {"_TRANSLUCENT", mark}}}}}}}};
  b.json["nodes"] = {{{"mesh", 0}, {"scale", {0.01, 0.01, 0.01}}}};
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  ASSERT_EQ(m.vertices.size(), 3u);
  expectVector(m.vertices[2].position, 2, 2, 0);
  expectVector(m.vertices[0].normal, 0, 0, 1);
  expectVector(m.vertices[2].normal, 0, 0, -1);
  expectVector(m.vertices[1].color, 1, 0, 0.2);
  EXPECT_EQ(m.vertices[0].alpha, 1);
  EXPECT_EQ(m.vertices[1].alpha, 0);
  EXPECT_EQ(m.vertices[2].alpha, 0.2f);
  EXPECT_EQ(m.vertices[1].mark, 0);
  EXPECT_EQ(m.vertices[2].mark, 0.5f);
}

TEST_F(Gltf, NormalsOfNoLengthComeFromTheTriangles) {
  GltfBuilder b = square();
  const int broken = b.vectors({0, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0});
  b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = broken;
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  expectVector(m.vertices[0].normal, 0, 0, 1);
  expectVector(m.vertices[3].normal, 0, 0, 1);
}

TEST_F(Gltf, CamerasAndLights) {
  GltfBuilder b = square();
  b.json["scenes"][0]["nodes"] = {0, 1, 2, 3, 4};
  b.json["cameras"] = {
      {{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}, {"aspectRatio", 1.5}}}},
      {{"name", "ortho"},
       {"type", "orthographic"},
       {"orthographic", {{"xmag", 3}, {"ymag", 2}, {"znear", 0}, {"zfar", 50}}}}};
  b.json["extensionsUsed"] = {"KHR_lights_punctual", "VENDOR_thing"};
  b.json["animations"] = {
      {{"name", "walk"}, {"channels", nlohmann::json::array()}, {"samplers", nlohmann::json::array()}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "directional"}, {"color", {1, 0.5, 0}}, {"intensity", 3}},
      {{"type", "spot"}, {"range", 7}, {"spot", {{"innerConeAngle", 0.1}, {"outerConeAngle", 0.3}}}}};
  const double h = std::sqrt(0.5);
  b.json["nodes"].push_back(
      {{"name", "eye"}, {"camera", 0}, {"translation", {0, 0, 5}}, {"scale", {2, 2, 2}}});
  b.json["nodes"].push_back({{"camera", 1}, {"rotation", {0, h, 0, h}}, {"scale", {-1, 1, 1}}});
  b.json["nodes"].push_back(
      {{"rotation", {-h, 0, 0, h}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  b.json["nodes"].push_back(
      {{"translation", {1, 2, 3}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}});
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  const Model& m = scene.model;
  ASSERT_EQ(m.cameras.size(), 2u);
  EXPECT_EQ(m.cameras[0].name, "eye");
  EXPECT_EQ(m.cameras[0].verticalFov, 0.5);
  EXPECT_EQ(m.cameras[0].range.nearPlane, 0.1);
  EXPECT_TRUE(std::isinf(m.cameras[0].range.farPlane));
  EXPECT_NEAR(m.cameras[0].viewFromWorld[14], -5, 1e-12) << "scale does not belong to a camera";
  EXPECT_NEAR(m.cameras[0].viewFromWorld[0], 1, 1e-12);
  EXPECT_EQ(m.cameras[1].name, "ortho");
  EXPECT_TRUE(m.cameras[1].orthographic);
  EXPECT_EQ(m.cameras[1].height, 4);
  EXPECT_EQ(m.cameras[0].aspect, 1.5);
  EXPECT_EQ(m.cameras[1].aspect, 1.5);
  EXPECT_NEAR(m.cameras[1].viewFromWorld[2], 1, 1e-12) << "it looks along -x";
  ASSERT_EQ(m.lights.size(), 2u);
  EXPECT_EQ(m.lights[0].type, PELLUCID_LIGHT_DIRECTIONAL);
  EXPECT_NEAR(m.lights[0].direction[1], -1, 1e-12) << "a quarter turn about -x takes -z to -y";
  EXPECT_EQ(m.lights[0].color[1], 0.5);
  EXPECT_EQ(m.lights[0].intensity, 3);
  EXPECT_EQ(m.lights[1].type, PELLUCID_LIGHT_SPOT);
  EXPECT_EQ(m.lights[1].position, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(m.lights[1].range, 7);
  EXPECT_EQ(m.lights[1].outerConeAngle, 0.3);
  EXPECT_EQ(scene.warnings,
            (std::vector<std::string>{
                "extension VENDOR_thing is not known, and what it says is left out",
                "animations[0]: animations are left out: nodes stand in their rest pose",
                "nodes[2]: a negative scale mirrors its camera, whose picture is drawn unmirrored"}));
}

TEST_F(Gltf, TexturesAreDecoded) {
  writePng(folder_ / "c.png", 2, 1, {255, 0, 0, 0, 0, 255});
  std::ifstream in(folder_ / "c.png", std::ios::binary);
  const std::string png((std::istreambuf_iterator<char>(in)), {});
  GltfBuilder b = square();
  b.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {0.5, 0.25, 0.125, 0.5}},
                                                    {"baseColorTexture", {{"index", 0}, {"texCoord", 1}}}};
  b.json["materials"][0]["alphaMode"] = "MASK";
  b.json["materials"][0]["alphaCutoff"] = 0.2;
  b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] =
      b.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
  b.json["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
  b.json["textures"] = {{{"source", 0}, {"sampler", 0}}};
  const int view = b.view(png.data(), png.size());
  for (const bool external : {false, true}) {
    b.json["images"] =
        external ? Json{{{"uri", "c.png"}}} : Json{{{"bufferView", view}, {"mimeType", "image/png"}}};
    const Model m = loadGltf(write("t.glb", b.glb())).model;
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].rgba, (std::vector<std::uint8_t>{255, 0, 0, 255, 0, 0, 255, 255}));
    EXPECT_EQ(m.textures[0].wrapU, TextureWrap::Clamp);
    EXPECT_EQ(m.textures[0].wrapV, TextureWrap::Mirror);
    EXPECT_EQ(m.surfaces[0].texture, 0);
    EXPECT_EQ(m.surfaces[0].baseColor[1], 0.25);
    EXPECT_EQ(m.surfaces[0].alphaCutoff, 0.4) << "of the texel, before the factor";
    EXPECT_EQ(m.vertices[2].uv, (std::array<float, 2>{1, 1}));
  }
  b.json["images"] = {{{"uri", "missing.png"}}};
  expectRefused(b.glb(), {"images[0].uri", "missing.png"});
  write("d.png", png.substr(0, png.size() / 2));
  b.json["images"] = {{{"uri", "d.png"}}};
  expectRefused(b.glb(), {"images[0]", "cannot be decoded"});
  write("e.png", "not an image");
  b.json["images"] = {{{"uri", "e.png"}}};
  expectRefused(b.glb(), {"images[0]", "neither PNG nor JPEG"});
  b.json["bufferViews"][static_cast<std::size_t>(view)]["byteLength"] = 1 << 20;
  b.json["images"] = {{{"bufferView", view}, {"mimeType", "image/png"}}};
  expectRefused(b.glb(), {"bufferViews[", "leave the"});
}

TEST_F(Gltf, NormalMapsAreRead) {
  writePng(folder_ / "n.png", 1, 1, {128, 128, 255});
  GltfBuilder b = square();
  // Not a reference: accessors move the document's members.
  const auto attributes = [&b]() -> Json& { return b.json["meshes"][0]["primitives"][0]["attributes"]; };
  const int uv0 = b.accessor(std::vector<float>{0, 1, 1, 1, 1, 0, 0, 0}, 5126, "VEC2", 2);
  attributes()["TEXCOORD_0"] = uv0;
  const int uv1 = b.accessor(std::vector<float>{0, 2, 2, 2, 2, 0, 0, 0}, 5126, "VEC2", 2);
  attributes()["TEXCOORD_1"] = uv1;
  const int tangent =
      b.accessor(std::vector<float>{1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1, 1, 0, 0, -1}, 5126, "VEC4", 4);
  attributes()["TANGENT"] = tangent;
  b.json["images"] = {{{"uri", "n.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
  b.json["materials"][0]["normalTexture"] = {{"index", 0}, {"texCoord", 1}, {"scale", 0.5}};
  // Mirrored in x and stretched: the tangent turns round, and so does the side of the bitangent.
  b.json["nodes"] = {{{"mesh", 0}, {"scale", {-3, 1, 1}}}};
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  const Model& m = scene.model;
  ASSERT_EQ(m.textures.size(), 2u) << "as a color and as vectors";
  EXPECT_FALSE(m.textures[static_cast<std::size_t>(m.surfaces[0].texture)].isNormalMap);
  EXPECT_TRUE(m.textures[static_cast<std::size_t>(m.surfaces[0].normalMap)].isNormalMap);
  EXPECT_EQ(m.surfaces[0].normalScale, 0.5);
  EXPECT_EQ(m.vertices[1].uv, (std::array<float, 2>{1, 1}));
  EXPECT_EQ(m.vertices[1].normalUv, (std::array<float, 2>{2, 2}));
  EXPECT_EQ(m.vertices[1].tangent, (std::array<float, 4>{-1, 0, 0, 1}));

  attributes().erase("TEXCOORD_1");
  const std::vector<std::string> warnings = loadGltf(write("t.glb", b.glb())).warnings;
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& w) {
    return w.find("TEXCOORD_1 for its normal map") != std::string::npos;
  }));
  attributes().erase("TEXCOORD_0");
  EXPECT_TRUE(says(loadGltf(write("t.glb", b.glb())).warnings, "TEXCOORD_0 for its color texture"));
  attributes()["TEXCOORD_0"] = uv0;
  b.json["materials"][0]["normalTexture"]["scale"] = 1e300;
  expectRefused(b.glb(), {"materials[0].normalTexture.scale", "-1000 .. 1000"});
  b.json["materials"][0]["normalTexture"] = {{"index", 7}};
  expectRefused(b.glb(), {"materials[0].normalTexture.index", "7"});
}

// ---- Materials

const Json kVolume = {
    {"thicknessFactor", 1}, {"attenuationDistance", 0.002}, {"attenuationColor", {0.5, 0.25, 0.125}}};

Json scatterExtensions() {
  return {
      {"KHR_materials_volume", kVolume},
      {"KHR_materials_volume_scatter", {{"multiscatterColor", {0.8, 0.5, 0.2}}, {"scatterAnisotropy", 0.25}}},
      {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1.0}}}};
}

TEST_F(Gltf, VolumeScatterBecomesCoefficients) {
  GltfBuilder b = square();
  b.json["materials"][0]["extensions"] = scatterExtensions();
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  ASSERT_EQ(m.materials.size(), 1u);
  EXPECT_EQ(m.surfaces[0].material, 1);
  const auto& medium = std::get<CoefficientMaterial>(m.materials[0]);
  const double colors[] = {0.5, 0.25, 0.125}, albedos[] = {0.8, 0.5, 0.2};
  for (std::size_t i = 0; i < 3; ++i) {
    const double extinction = -std::log(colors[i]) / 2;  // 1/mm: the distance is 2 mm
    EXPECT_NEAR(medium.scattering[i] + medium.absorption[i], extinction, 1e-12);
    EXPECT_NEAR(medium.scattering[i], extinction * singleScatteringAlbedo(albedos[i]), 1e-12);
    EXPECT_NEAR(m.surfaces[0].baseColor[i], 0, 1e-12) << "all light enters";
    EXPECT_NEAR(m.surfaces[0].addedColor[i], albedos[i], 1e-12);
  }
  EXPECT_EQ(medium.g, 0.25);
  EXPECT_EQ(medium.ior, 1) << "a diffuse boundary does not refract";

  GltfOptions options;
  options.metersPerUnit = 0.01;
  const Model scaled = loadGltf(write("t.glb", b.glb()), options).model;
  EXPECT_EQ(scaled.metersPerUnit, 0.01);
  const auto& dense = std::get<CoefficientMaterial>(scaled.materials[0]);
  EXPECT_NEAR(dense.scattering[0] + dense.absorption[0], -std::log(0.5) / 0.02, 1e-9)
      << "0.002 cm are 0.02 mm";
}

TEST_F(Gltf, DiffuseTransmissionBecomesAnExponential) {
  GltfBuilder b = square();
  b.json["materials"][0]["extensions"] = {
      {"KHR_materials_volume",
       {{"thicknessFactor", 1}, {"attenuationDistance", 0.004}, {"attenuationColor", {0.5, 0.25, 1}}}},
      {"KHR_materials_diffuse_transmission",
       {{"diffuseTransmissionFactor", 0.5}, {"diffuseTransmissionColorFactor", {1, 0.5, 0.25}}}}};
  const Model m = loadGltf(write("t.glb", b.glb())).model;
  ASSERT_EQ(m.materials.size(), 1u);
  const PellucidMaterial compiled = compileMaterial(m.materials[0], "test");
  for (const double d : {0.0, 1.0, 4.0, 12.0}) {
    EXPECT_NEAR(pellucidEvaluateTransmittance(&compiled, 0, d), std::pow(0.5, d / 4), 1e-6) << d;
    EXPECT_NEAR(pellucidEvaluateTransmittance(&compiled, 1, d), std::pow(0.25, d / 4), 1e-6) << d;
    EXPECT_NEAR(pellucidEvaluateTransmittance(&compiled, 2, d), std::pow(0.999, d / 4), 1e-6) << d;
  }
  const Surface& surface = m.surfaces[0];
  EXPECT_EQ(surface.lobes, SurfaceLobes::Apart) << "the base color does not multiply what comes through";
  EXPECT_EQ(surface.addedColor, (std::array<double, 3>{0.5, 0.25, 0.125}));
  EXPECT_EQ(surface.baseColor, (std::array<double, 3>{1, 1, 1}));
  EXPECT_EQ(surface.displaced, 0.5);
  EXPECT_EQ(surface.backscatter, 0);
  EXPECT_EQ(compiled.thinWalled, 0u);
  b.json["materials"][0]["extensions"].erase("KHR_materials_volume");
  const PellucidMaterial thin = compileMaterial(loadGltf(write("t.glb", b.glb())).model.materials[0], "test");
  EXPECT_EQ(thin.thinWalled, 1u) << "without a volume";
  for (int c = 0; c < 3; ++c)
    EXPECT_EQ(thin.wallTransmittance[c], thin.reflectance[c]) << "the albedo is addedColor's";
}

TEST_F(Gltf, ThinWallsReplaceMaterialsByName) {
  GltfBuilder b = square();
  b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 1, 0.25, 1};
  b.json["materials"][0]["extensions"] = scatterExtensions();
  GltfOptions options;
  options.presets = {{"m", "thin:0.25,0.5,0"}};
  const Model m = loadGltf(write("t.glb", b.glb()), options).model;
  const PellucidMaterial wall = compileMaterial(m.materials.at(0), "test");
  EXPECT_EQ(wall.thinWalled, 1u);
  EXPECT_EQ(m.surfaces[0].addedColor, (std::array<double, 3>{0.25, 0.5, 0}));
  EXPECT_EQ(m.surfaces[0].baseColor, (std::array<double, 3>{0.375, 0.5, 0.25})) << "of the rest";
  EXPECT_EQ(m.surfaces[0].lobes, SurfaceLobes::Apart);
  for (const char* wrong :
       {"thin:", "thin:1,1", "thin:1,1,2", "thin:1,1,1,1", "thin:0,0,x", "thin:0,0,0,", "thin:nan,0,0"}) {
    options.presets = {{"m", wrong}};
    expectRefused(b.glb(), {"material \"m\"", wrong, "transmittance from 0 to 1"}, "t.glb", options);
  }
}

TEST_F(Gltf, PresetsOverrideByName) {
  GltfBuilder b = square();
  b.json["materials"] = {{{"name", "m"}, {"extensions", scatterExtensions()}}, {{"name", "leaf=2"}}};
  Json second = b.json["meshes"][0];
  second["primitives"][0]["material"] = 1;
  b.json["meshes"].push_back(second);
  b.json["nodes"].push_back({{"mesh", 1}});
  b.json["scenes"][0]["nodes"] = {0, 1};
  const fs::path file = write("t.glb", b.glb());
  const auto presetsOf = [&](const std::map<std::string, std::string>& presets) {
    GltfOptions options;
    options.presets = presets;
    std::string names;
    for (const MaterialSource& material : loadGltf(file, options).model.materials) {
      const auto* preset = std::get_if<PresetMaterial>(&material);
      names += (preset ? preset->preset : std::string("file")) + " ";
    }
    return names;
  };
  EXPECT_EQ(presetsOf({}), "file ");
  EXPECT_EQ(presetsOf({{"m", "skin1"}}), "skin1 ");
  EXPECT_EQ(presetsOf({{"leaf=2", "marble"}}), "file marble ");
  EXPECT_EQ(presetsOf({{"*", "skin2"}, {"m", "ketchup"}}), "ketchup skin2 ");
  GltfOptions options;
  options.presets = {{"absent", "skin1"}};
  expectRefused(b.glb(), {"absent", "m, leaf=2, default"}, "t.glb", options);
  options.presets = {{"m", R"({"subsurface_color": [0.8, 0.5, 0.3]})"}};
  const auto media = loadGltf(file, options).model.materials;
  EXPECT_EQ(std::get<OpenPbrMaterial>(media.at(0)).color, (std::array<double, 3>{0.8, 0.5, 0.3}));
  options.presets = {{"m", R"({"subsurface_radius": 1e30})"}};
  expectRefused(b.glb(), {"material \"m\"", "subsurfaceRadius"}, "t.glb", options);
  options.presets = {{"m", "no such thing"}};
  expectRefused(b.glb(), {"material \"m\"", "no such thing"}, "t.glb", options);
}

// The albedo under a preset: the file's color, else the compiler's reflectance, which stands in a note.
TEST_F(Gltf, PresetsGiveAlbedoToWhatHasNoColor) {
  const std::array<double, 3> rho = [] {
    const PellucidMaterial skin = compileMaterial(PresetMaterial{"skin1"}, "test");
    return std::array<double, 3>{skin.reflectance[0], skin.reflectance[1], skin.reflectance[2]};
  }();
  ASSERT_GT(rho[0], 2 * rho[2]) << "skin is not gray";
  GltfOptions skin;
  skin.presets = {{"*", "skin1"}};
  const auto albedoOf = [&](GltfBuilder b, const GltfOptions& options, std::size_t notes) {
    const GltfScene scene = loadGltf(write("t.glb", b.glb()), options);
    EXPECT_EQ(scene.notes.size(), notes);
    for (const std::string& note : scene.notes)
      EXPECT_NE(note.find("the reflectance of its medium"), std::string::npos) << note;
    EXPECT_EQ(scene.model.parts.size(), 1u);
    return scene.model.surfaces[scene.model.parts[0].surface].baseColor;
  };
  const auto withFactor = [](const Json& factor) {
    GltfBuilder b = square();
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = factor;
    return b;
  };
  EXPECT_EQ(albedoOf(square(), skin, 1), rho);
  EXPECT_EQ(albedoOf(withFactor({1, 1, 1, 1}), skin, 1), rho);
  EXPECT_EQ(albedoOf(withFactor({0.800000011920929, 0.800000011920929, 0.800000011920929, 1}), skin, 1), rho);
  EXPECT_EQ(albedoOf(withFactor({0.5, 0.5, 0.5, 1}), skin, 0), (Rgb{0.5, 0.5, 0.5}));
  EXPECT_EQ(albedoOf(withFactor({1, 1, 0.9, 1}), skin, 0), (Rgb{1, 1, 0.9}));
  EXPECT_EQ(albedoOf(square(), {}, 0), (Rgb{1, 1, 1})) << "opaque";
  GltfBuilder b = square();
  b.json["meshes"][0]["primitives"][0].erase("material");
  EXPECT_EQ(albedoOf(b, skin, 1), rho) << "the default material";

  b = square();
  writePng(folder_ / "c.png", 1, 1, {255, 0, 0});
  b.json["images"] = {{{"uri", "c.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorTexture", {{"index", 0}}}};
  EXPECT_EQ(albedoOf(b, skin, 0), (Rgb{1, 1, 1})) << "the texture's";
}

TEST_F(Gltf, BadMaterialValuesAreNamed) {
  const auto medium = [] {
    GltfBuilder b = square();
    b.json["materials"][0]["extensions"] = scatterExtensions();
    return b;
  };
  expectRefusals(medium, R"(
/materials/0/extensions/KHR_materials_volume/attenuationDistance | -1 | materials[0] | attenuationDistance | -1
/materials/0/extensions/KHR_materials_volume/attenuationDistance | 0 | attenuationDistance | is 0
/materials/0/extensions/KHR_materials_volume/attenuationDistance | "far" | attenuationDistance | not a number
/materials/0/extensions/KHR_materials_volume/attenuationColor | [1, 2, 3] | attenuationColor | 2.0
/materials/0/extensions/KHR_materials_volume/attenuationColor | [1, 1] | attenuationColor | 3 numbers
/materials/0/extensions/KHR_materials_volume_scatter/scatterAnisotropy | 1 | scatterAnisotropy
)");
}

class Scattering : public Gltf {
protected:
  GltfScene read(const Json& extensions, const Json& baseColor = {1, 1, 1, 1}) {
    GltfBuilder b = square();
    b.json["materials"][0]["extensions"] = extensions;
    b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = baseColor;
    return loadGltf(write("t.glb", b.glb()));
  }
  void expectRgb(const Rgb& value, const Rgb& expected, double tolerance = 1e-12) const {
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(value[i], expected[i], tolerance) << i;
  }
  // The square with one texture of 2 x 1 texels, used by "index" 0.
  GltfScene readTextured(const Json& extensions, const std::vector<std::uint8_t>& rgb) {
    GltfBuilder b = square();
    b.json["materials"][0]["extensions"] = extensions;
    b.json["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] =
        b.accessor(std::vector<float>{0, 0, 1, 0, 1, 1, 0, 1}, 5126, "VEC2", 2);
    writePng(folder_ / "c.png", 2, 1, rgb);
    b.json["images"] = {{{"uri", "c.png"}}};
    b.json["textures"] = {{{"source", 0}}};
    return loadGltf(write("t.glb", b.glb()));
  }
};

const Json kAllEnters = {{"transmissionFactor", 1}};

// Kulla & Conty's fit is good to .01.
TEST_F(Scattering, TheAlbedoIsThatOfTheColor) {
  CoefficientMaterial medium{};
  for (std::size_t i = 0; i < 3; ++i) {
    medium.scattering[i] = singleScatteringAlbedo(0.2 + 0.3 * static_cast<double>(i));
    medium.absorption[i] = 1 - medium.scattering[i];
  }
  medium.ior = 1;
  const PellucidMaterial compiled = compileMaterial(medium, "test");
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(compiled.reflectance[i], 0.2 + 0.3 * i, 0.015);
}

// Light that does not enter is reflected with the base color, and has no part in what comes through.
TEST_F(Scattering, LightThatDoesNotEnterHasItsOwnAlbedo) {
  const Model m = read({{"KHR_materials_volume", kVolume},
                        {"KHR_materials_volume_scatter", {{"multiscatterColorFactor", {0.8, 0.5, 0.2}}}},
                        {"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.25}}}},
                       {0.4, 0.4, 0.4, 1})
                      .model;
  const Surface& s = m.surfaces[0];
  EXPECT_EQ(s.lobes, SurfaceLobes::Apart);
  expectRgb(s.baseColor, {0.3, 0.3, 0.3});
  expectRgb(s.addedColor, {0.2, 0.125, 0.05});
  EXPECT_EQ(s.backscatter, 1) << "the medium reflects, too";
}

TEST_F(Scattering, TexturesOfScatteringAreRead) {
  // Linear 1 and 0 in red; the medium has the mean.
  const GltfScene scene =
      readTextured({{"KHR_materials_volume", kVolume},
                    {"KHR_materials_transmission", kAllEnters},
                    {"KHR_materials_volume_scatter",
                     {{"multiscatterColorFactor", {1, 1, 1}}, {"multiscatterColorTexture", {{"index", 0}}}}}},
                   {255, 255, 255, 0, 255, 255});
  const Model& m = scene.model;
  const Surface& s = m.surfaces[0];
  ASSERT_GE(s.lobeMap, 0);
  EXPECT_EQ(m.textures[static_cast<std::size_t>(s.lobeMap)].rgba,
            (std::vector<std::uint8_t>{255, 255, 255, 255, 0, 255, 255, 255}));
  EXPECT_EQ(m.vertices[2].lobeUv, (std::array<float, 2>{1, 1}));
  const auto& medium = std::get<CoefficientMaterial>(m.materials.at(0));
  EXPECT_NEAR(medium.scattering[0], singleScatteringAlbedo(0.5) * std::log(2) / 2, 1e-9);
  EXPECT_NEAR(medium.scattering[1], std::log(4) / 2, 1e-4) << "white";
  EXPECT_FALSE(says(scene.warnings, "ignored"));
}

// ---- Broken files

constexpr const char* kMistakes = R"(
/accessors/0/count | 5 | accessors[0].count | 5 elements | 48 bytes
/accessors/0/count | 1537228672809129302 | accessors[0]
/accessors/0/count | 0 | accessors[0].count | 0 elements
/accessors/0/count | -4 | count
/accessors/0/byteOffset | 100 | accessors[0] | byteOffset 100
/accessors/0/type | "MAT4" | accessors[0]
/accessors/0/type | "VEC2" | POSITION | 2 components
/accessors/0/componentType | 5124 | accessors[0] | 5124
/accessors/0/bufferView | 99 | accessors[0].bufferView | 99
/accessors/0/sparse | {"count": 9, "indices": {"bufferView": 2, "componentType": 5123}, "values": {"bufferView": 0}} | accessors[0].sparse.indices.count | 9 elements
/accessors/0/sparse | {"count": 1, "indices": {"bufferView": 2, "componentType": 5126}, "values": {"bufferView": 0}} | accessors[0].sparse.indices.componentType | unsigned
/accessors/1/componentType | removed | accessors[1].componentType: is missing
/accessors/2/bufferView | "first" | accessors[2].bufferView: "first" is not an integer
/bufferViews/0/byteLength | 1048576 | bufferViews[0] | 1048576
/bufferViews/0/buffer | 3 | bufferViews[0].buffer | 3
/bufferViews/0/byteStride | 4 | bufferViews[0].byteStride | 4
/meshes/0/primitives/0/indices | 0 | indices | unsigned
/meshes/0/primitives/0/material | 4 | material | 4
/meshes/0/primitives/0/mode | 9 | mode | 9
/meshes/0/primitives/0/attributes | {"NORMAL": 1} | POSITION | missing
/meshes/0/primitives | removed | meshes[0].primitives: is missing
/nodes/0/mesh | 7 | nodes[0].mesh | 7
/nodes/0/mesh | -7 | nodes[0].mesh: -7 is not an integer >= 0
/nodes/0/children | [12] | nodes[0].children | 12
/nodes/0/matrix | [1, 2, 3] | nodes[0].matrix | 16
/nodes/0/translation | [1e40, 0, 0] | nodes[0].translation
/nodes/0/scale | [1e25, 1, 1] | POSITION | 1e18
/nodes/0/rotation | [0, 0, 0, 0] | nodes[0].rotation
/nodes/0/skin | 0 | nodes[0].skin | 0 skins
/nodes | [{"children": [1]}, {"children": [0]}] | nodes[0] | twice
/nodes | [{"children": [1, 1]}, {"mesh": 0}] | nodes[0].children | nodes[1] | twice
/nodes/0/extensions/KHR_lights_punctual/light | 2 | KHR_lights_punctual.light | 2
/scene | 3 | scene | 3
/scenes | removed | scenes: the file has none
/scenes/0/nodes | [] | no triangles
/cameras | [{"type": "orthographic"}] | cameras[0].orthographic: is missing
/cameras | [{"perspective": {}}] | cameras[0].type: is missing
/cameras | [{"type": "perspective", "perspective": {"yfov": 4, "znear": 1}}] | cameras[0].perspective.yfov | 4.0
/extensions/KHR_lights_punctual/lights | [{"type": "point"}, {"type": "spot"}] | lights[1].spot: is missing
/extensions/KHR_lights_punctual/lights | [{"type": "point", "intensity": -1}] | lights[0].intensity
/extensions/KHR_lights_punctual/lights | [{"type": "point", "intensity": "2"}] | lights[0].intensity | is not a number
/extensions/KHR_lights_punctual/lights | [{"type": "point", "color": "#ff0000"}] | lights[0].color | is not 3 numbers
/extensions/KHR_lights_punctual/lights | [{"type": "ambient"}] | lights[0].type | is not directional, point or spot
/cameras | [{"type": "fisheye"}] | cameras[0].type | is not perspective or orthographic
/nodes/0/translation | [null, 0, 0] | nodes[0].translation | is not 3 numbers
/materials/0/alphaMode | "mask" | materials[0].alphaMode | is not OPAQUE, MASK or BLEND
/materials/0/pbrMetallicRoughness | {"baseColorFactor": [0.2, null, 0.2, 1]} | materials[0].pbrMetallicRoughness.baseColorFactor | is not 4 numbers
/samplers | [{"wrapS": "33071"}] | samplers[0].wrapS | is not an integer
/bufferViews/0/byteStride | 13 | bufferViews[0].byteStride | is not a multiple of 4
/extensionsRequired | ["KHR_materials_unlit", "VENDOR_thing"] | extensionsRequired | "VENDOR_thing" is not supported
/extensionsRequired | ["KHR_draco_mesh_compression"] | extensionsRequired | "KHR_draco_mesh_compression" is not supported | gltf-transform copy in.glb out.glb
/extensionsRequired | ["EXT_mesh_gpu_instancing"] | extensionsRequired | "EXT_mesh_gpu_instancing" is not supported | Blender
/nodes/0/extensions/KHR_node_visibility | {"visible": 1} | KHR_node_visibility.visible | true or false
/asset/version | "1.0" | asset.version | 1.0
)";

TEST_F(Gltf, WrongValuesAreNamed) {
  // Cameras and lights are read where a node has one.
  const auto seen = [] {
    GltfBuilder b = square();
    b.json["nodes"].push_back({{"camera", 0}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    b.json["scenes"][0]["nodes"] = {0, 1};
    b.json["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}}};
    b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
    return b;
  };
  expectRefusals(seen, kMistakes);
}

TEST_F(Gltf, WrongBuffersAreNamed) {
  const auto refused = [&](const std::function<void(GltfBuilder&)>& breakIt,
                           std::initializer_list<const char*> words) {
    GltfBuilder b = square();
    breakIt(b);
    expectRefused(b.glb(), words);
  };
  const auto primitive = [](GltfBuilder& b) -> Json& { return b.json["meshes"][0]["primitives"][0]; };
  const auto indices = [&](std::vector<std::uint16_t> values) {
    return [=](GltfBuilder& b) {
      const int accessor = b.indices(values);
      primitive(b)["indices"] = accessor;
    };
  };
  refused(indices({0, 1, 4}), {"index 4", "4 vertices"});
  refused(indices({0, 1}), {"multiple of 3"});
  refused(
      [&](GltfBuilder& b) {
        const int few = b.vectors({0, 0, 1});
        primitive(b)["attributes"]["NORMAL"] = few;
      },
      {"attributes", "4 and 1"});
  refused(
      [&](GltfBuilder& b) {
        const int few = b.vectors({0, 0, 1});
        b.json["meshes"][0]["weights"] = {0.5};
        primitive(b)["targets"] = {{{"POSITION", few}}};
      },
      {"meshes[0].primitives[0].targets[0].POSITION", "4 and 1"});
  const float nan = std::numeric_limits<float>::quiet_NaN();
  refused([&](GltfBuilder& b) { std::memcpy(b.buffer.data() + 16, &nan, 4); },
          {"accessors[0]", "element 1", "finite"});
}

TEST_F(Gltf, FilesThatAreNotGltf) {
  expectRefused("", {""}, "empty.glb");
  expectRefused("glTF", {"truncated"});
  expectRefused("{ \"asset\": ", {"parse"}, "t.gltf");
  expectRefused("v 0 0 0\nf 1 2 3\n", {"is no glTF file", "export one"}, "t.gltf");
  expectRefused(R"({"asset": {"version": "1.0"}, "scene": "s"})", {"asset.version", "1.0", "export glTF 2.0"}, "t.gltf");
  expectRefused(R"({"asset": {"version": "2.0", "minVersion": "2.1"}})", {"asset.minVersion", "2.1"}, "t.gltf");
  expectRefused("[1, 2]", {""}, "t.gltf");
  std::string old = square().glb();
  old[4] = 1;
  expectRefused(old, {"version 1"});
  std::string deep = "{\"asset\":{\"version\":\"2.0\",\"extras\":";
  for (int i = 0; i < 200000; ++i) deep += '[';
  expectRefused(deep, {"nested"}, "t.gltf");
  EXPECT_THROW(loadGltf(folder_ / "absent.glb"), InputError);
  EXPECT_THROW(loadGltf(folder_), InputError);
}

TEST_F(Gltf, UrisStayInTheFolder) {
  fs::create_directory(folder_ / "inner");
  GltfBuilder b = square();
  write("secret.bin", b.buffer);
  fs::create_symlink(folder_ / "secret.bin", folder_ / "inner" / "link.bin");
  for (const std::string& uri :
       std::vector<std::string>{"../secret.bin", "%2e%2e/secret.bin", "link.bin", "x/../../secret.bin"}) {
    b.json["buffers"] = {{{"byteLength", b.buffer.size()}, {"uri", uri}}};
    expectRefused(b.json.dump(), {"leaves the file's folder"}, "inner/t.gltf");
  }
  const std::string absolute = (folder_ / "secret.bin").string();
  for (const std::string& uri : {absolute, "file://" + absolute, std::string("http://localhost/x.bin")}) {
    b.json["buffers"] = {{{"byteLength", b.buffer.size()}, {"uri", uri}}};
    expectRefused(b.json.dump(), {"not found"}, "inner/t.gltf");
  }
  // A file of that name in the working directory does not count either.
  const fs::path before = fs::current_path();
  fs::current_path(folder_);
  b.json["buffers"] = {{{"byteLength", b.buffer.size()}, {"uri", "secret.bin"}}};
  expectRefused(b.json.dump(), {"not found"}, "inner/t.gltf");
  fs::current_path(before);
}

// 60 kB that stand for 2^14 times 4096 vertices.
TEST_F(Gltf, InstancesCannotExhaustMemory) {
  GltfBuilder b = square();
  std::vector<float> positions(3 * 4096, 0.0f);
  b.json["meshes"][0]["primitives"][0]["attributes"] = {{"POSITION", b.vectors(positions)}};
  Json nodes = nlohmann::json::array(), roots = nlohmann::json::array();
  for (int i = 0; i < 1 << 14; ++i) {
    nodes.push_back({{"mesh", 0}});
    roots.push_back(i);
  }
  b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = b.vectors(positions);
  b.json["nodes"] = nodes;
  b.json["scenes"][0]["nodes"] = roots;
  expectRefused(b.glb(), {"meshes[0].primitives[0]", "2^24"});
}

// ---- The command's own syntax

TEST_F(Gltf, UnitsAndLightsOfTheCommandLine) {
  EXPECT_EQ(parseUnit("mm"), 0.001);
  EXPECT_EQ(parseUnit("cm"), 0.01);
  EXPECT_EQ(parseUnit("m"), 1);
  EXPECT_EQ(parseUnit("0.052"), 0.052);
  for (const char* bad : {"", "km", "0", "-1", "nan", "1m"}) EXPECT_THROW(parseUnit(bad), UsageError) << bad;

  const Model model = loadGltf(write("t.glb", square().glb())).model;  // centered at (1, 1, 0)
  const ModelCamera camera = frameModel(model, {0, 0, 1}, 0.5, 1, false);
  const Light sun = parseLight("directional:1,-2,0.5:3", model, camera);
  EXPECT_EQ(sun.type, PELLUCID_LIGHT_DIRECTIONAL);
  EXPECT_EQ(sun.direction, (std::array<double, 3>{1, -2, 0.5}));
  EXPECT_EQ(sun.intensity, 3);
  const Light point = parseLight("point:1,1,-5", model, camera);
  EXPECT_EQ(point.type, PELLUCID_LIGHT_POINT);
  EXPECT_EQ(point.intensity, 25) << "E = 1 at the center";
  EXPECT_EQ(parseLight("point:1,1,0:3", model, camera).intensity, 3);
  const Light spot = parseLight("spot:1,1,-5:7", model, camera);
  EXPECT_EQ(spot.direction, (std::array<double, 3>{0, 0, 1}));
  EXPECT_NEAR(std::sin(spot.outerConeAngle), std::sqrt(2.0) / 5, 1e-9) << "the cone holds the model";
  EXPECT_GT(parseLight("back", model, camera).direction[2], 0) << "towards the camera";
  for (const char* bad : {"", "sun", "point", "point:1,1,0", "point:1,2", "point:1,2,x", "point:1,2,3:-1",
                          "directional:0,0,0", "spot:1,1,0", "point:1,2,3:4:5", "point:1,2,inf"})
    EXPECT_THROW(parseLight(bad, model, camera), UsageError) << bad;
}

}  // namespace
