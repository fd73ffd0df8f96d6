// glTF: what becomes of each field and extension, and that none passes in silence.
#include "gltf/fields.h"

#include <meshoptimizer.h>

#include "gltf_fixture.h"

namespace {

using namespace pellucid::test;

std::vector<std::string> said(const GltfBuilder& b) { return unusedFields(GltfJson::parse(b.json.dump())); }

TEST_F(Gltf, KnownFieldsAreUsedWithoutASentence) { EXPECT_TRUE(said(square()).empty()); }

TEST_F(Gltf, UnknownFieldsAndExtensionsAreNamed) {
  const char* const places[] = {"",
                                "/nodes/0",
                                "/meshes/0",
                                "/meshes/0/primitives/0",
                                "/meshes/0/primitives/0/attributes",
                                "/materials/0",
                                "/materials/0/pbrMetallicRoughness",
                                "/accessors/0",
                                "/bufferViews/0",
                                "/scenes/0"};
  for (const char* place : places) {
    GltfBuilder b = square();
    b.json["materials"][0]["pbrMetallicRoughness"] = {{"baseColorFactor", {1, 1, 1, 1}}};
    b.json[Json::json_pointer(place)]["glitter"] = 1;
    EXPECT_TRUE(says(said(b), "glitter: the field is not known")) << place;
    b.json[Json::json_pointer(place)].erase("glitter");
    b.json[Json::json_pointer(place)]["extensions"]["VENDOR_glitter"] = {{"amount", 1}};
    EXPECT_TRUE(says(said(b), "extension VENDOR_glitter is not known")) << place;
  }
}

// A light in a scene, as an old draft has it, lights nothing.
TEST_F(Gltf, KnownExtensionsAtOtherPlacesAreNamed) {
  GltfBuilder b = square();
  b.json["scenes"][0]["extensions"]["KHR_lights_punctual"] = {{"light", 0}};
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_materials_volume"] = {{"thicknessFactor", 1}};
  EXPECT_TRUE(says(said(b), "scenes[0].extensions.KHR_lights_punctual: objects there do not have this extension"));
  EXPECT_TRUE(says(said(b), "meshes[0].primitives[0].extensions.KHR_materials_volume: objects there"));
}

TEST_F(Gltf, FieldsOfKnownExtensionsAreCheckedToo) {
  GltfBuilder b = square();
  b.json["materials"][0]["extensions"]["KHR_materials_ior"] = {{"ior", 1.3}, {"glitter", 1}};
  EXPECT_EQ(said(b), (std::vector<std::string>{
                         "materials[0].extensions.KHR_materials_ior.glitter: the field is not known, "
                         "and what it says is left out"}));
}

// Put where the list says, with a value that is not nothing.
TEST_F(Gltf, EveryFieldThatIsLeftOutIsNamed) {
  for (const GltfField& field : gltfFields()) {
    if (field.use == FieldUse::Used || field.use == FieldUse::NoEffect) continue;
    const std::string path = field.path;
    std::vector<std::string> steps;
    for (std::size_t at = 0, dot; at < path.size(); at = dot + 1) {
      dot = std::min(path.find('.', at), path.size());
      const std::string step = path.substr(at, dot - at);
      steps.push_back(step.substr(0, step.find(',')));
    }
    for (Json value : {Json(3), Json(0)}) {  // 0 is an index, too
      for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
        const std::size_t number = step->find("_n");
        const std::string key = number == std::string::npos ? *step : step->substr(0, number) + "_1";
        value = key == "*" || key == "**" ? Json::array({value}) : Json{{key, value}};
      }
      if (path.rfind("KHR_", 0) == 0) value = {{"materials", Json::array({{{"extensions", value}}})}};
      EXPECT_TRUE(says(unusedFields(GltfJson::parse(value.dump())), field.sentence))
          << path << " in " << value.dump();
    }
  }
}

TEST_F(Gltf, EveryExtensionThatIsNotDrawnHasASentence) {
  for (const GltfExtension& extension : gltfExtensions()) {
    GltfBuilder b = square();
    b.json["extensionsUsed"] = {extension.name};
    const bool silent = extension.use == FieldUse::Used || extension.use == FieldUse::NoEffect;
    EXPECT_EQ(said(b).empty(), silent) << extension.name;
    b.json["extensionsRequired"] = {extension.name};
    const std::string refused = refusal(b.glb());
    if (extension.use != FieldUse::Refused) {
      EXPECT_EQ(refused, "accepted") << extension.name;
      continue;
    }
    EXPECT_NE(refused.find(extension.name), std::string::npos) << refused;
    EXPECT_NE(refused.find(extension.sentence), std::string::npos) << refused;
  }
}

TEST_F(Gltf, HiddenNodesAreNotDrawn) {
  GltfBuilder b = square();
  b.json["nodes"] = {{{"children", {1, 2}}, {"extensions", {{"KHR_node_visibility", {{"visible", false}}}}}},
                     {{"mesh", 0}},
                     {{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                     {{"mesh", 0}}};
  b.json["scenes"][0]["nodes"] = {0, 3};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "point"}}};
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  EXPECT_EQ(scene.model.parts.size(), 1u);
  EXPECT_TRUE(scene.model.lights.empty());
}

TEST_F(Gltf, AnySceneCanBeChosen) {
  GltfBuilder b = square();
  b.json["nodes"].push_back({{"mesh", 0}, {"translation", {5, 0, 0}}});
  b.json["scenes"] = {{{"name", "near"}, {"nodes", {0}}}, {{"name", "far"}, {"nodes", {1}}}};
  const fs::path file = write("t.glb", b.glb());
  const GltfScene first = loadGltf(file);
  EXPECT_EQ(corner(first.model, 0).x, 0);
  EXPECT_TRUE(says(first.warnings, "scene 0 \"near\" is drawn; --scene chooses among 0 \"near\", 1 \"far\""));
  GltfOptions options;
  for (const char* scene : {"far", "1"}) {
    options.scene = scene;
    const GltfScene far = loadGltf(file, options);
    EXPECT_EQ(corner(far.model, 0).x, 5);
    EXPECT_TRUE(far.warnings.empty());
  }
  options.scene = "2";
  expectRefused(b.glb(), {"scenes", "\"2\"", "1 \"far\""}, "t.glb", options);
}

// ---- Clear and blended materials

struct Look {
  const char* material;  // JSON
  const char* option;    // of --material
  bool isDrawn;
  const char* sentence;  // "": none
};

TEST_F(Gltf, ClearMaterialsAreLeftOutByName) {
  constexpr const char* kGlass =
      R"({"name": "m", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}})";
  constexpr const char* kFaint =
      R"({"name": "m", "alphaMode": "BLEND", "pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 0.2]}})";
  const Look looks[] = {
      {kGlass, "", false, "clear glass, which is left out; --material m=opaque"},
      {R"({"name": "m", "extensions": {"KHR_materials_transmission": {"transmissionFactor": 0.2}}})", "",
       true, "drawn opaque; --material m=none"},
      {kGlass, "opaque", true, ""},
      {kFaint, "", false, "alphaMode BLEND of an alpha below 0.5 is left out"},
      {R"({"name": "m", "alphaMode": "BLEND"})", "", true, "holes where alpha is below 0.5"},
      {kFaint, "opaque", true, ""},
      {R"({"name": "m"})", "none", false, ""},
  };
  for (const Look& look : looks) {
    GltfBuilder b = square();
    b.json["materials"] = {Json::parse(look.material), {{"name", "other"}}};
    b.json["meshes"].push_back(b.json["meshes"][0]);
    b.json["meshes"][1]["primitives"][0]["material"] = 1;
    b.json["nodes"].push_back({{"mesh", 1}});
    b.json["scenes"][0]["nodes"] = {0, 1};
    GltfOptions options;
    if (*look.option) options.presets["m"] = look.option;
    const GltfScene scene = loadGltf(write("t.glb", b.glb()), options);
    EXPECT_EQ(scene.model.parts.size(), look.isDrawn ? 2u : 1u) << look.material << look.option;
    if (*look.sentence)
      EXPECT_TRUE(says(scene.warnings, look.sentence)) << testing::PrintToString(scene.warnings);
    else
      EXPECT_TRUE(scene.warnings.empty()) << testing::PrintToString(scene.warnings);
  }
}

// ---- EXT_meshopt_compression

TEST_F(Gltf, MeshoptsViewsAreDecoded) {
  GltfBuilder b = square();
  const Model plain = loadGltf(write("t.glb", b.glb())).model;
  const std::vector<float> positions = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
  std::vector<unsigned char> bytes(meshopt_encodeVertexBufferBound(4, 12));
  bytes.resize(meshopt_encodeVertexBuffer(bytes.data(), bytes.size(), positions.data(), 4, 12));
  const int view = b.view(bytes.data(), bytes.size());
  const Json source = b.json["bufferViews"][static_cast<std::size_t>(view)];
  b.json["bufferViews"].erase(static_cast<std::size_t>(view));
  b.json["buffers"] = {
      Json(), {{"byteLength", 48}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
  b.json["bufferViews"][0] = {{"buffer", 1},
                              {"byteLength", 48},
                              {"byteStride", 12},
                              {"extensions",
                               {{"EXT_meshopt_compression",
                                 {{"buffer", 0},
                                  {"byteOffset", source["byteOffset"]},
                                  {"byteLength", source["byteLength"]},
                                  {"byteStride", 12},
                                  {"count", 4},
                                  {"mode", "ATTRIBUTES"}}}}}};
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"EXT_meshopt_compression"};
  const GltfScene scene = loadGltf(write("t.glb", b.glb()));
  EXPECT_TRUE(scene.warnings.empty()) << testing::PrintToString(scene.warnings);
  ASSERT_EQ(scene.model.vertices.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(scene.model.vertices[i].position, plain.vertices[i].position);

  Json& extension = b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"];
  for (const auto& [key, value] : {std::pair("mode", Json("LINES")), std::pair("byteStride", Json(13)),
                                   std::pair("count", Json(1 << 30)), std::pair("filter", Json("BLUR"))}) {
    const Json kept = extension.value(key, Json("NONE"));
    extension[key] = value;
    expectRefused(b.glb(), {"bufferViews[0].extensions.EXT_meshopt_compression", key});
    extension[key] = kept;
  }
  b.buffer.back() = '\x7f';
  b.buffer[b.buffer.size() - bytes.size()] = '\x7f';
  expectRefused(b.glb(), {"bufferViews[0].extensions.EXT_meshopt_compression", "cannot be decoded"});
}

}  // namespace
