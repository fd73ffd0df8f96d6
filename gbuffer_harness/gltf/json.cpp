#include "gltf/json.h"

#include <algorithm>
#include <set>

#include "common/error.h"

namespace pellucid::harness {

namespace {

constexpr std::size_t kMaxDepth = 100;  // tinygltf reads extensions and extras recursively

// Read, and drawn as the extension says.
const std::set<std::string> kRead = {
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_ior",
    "KHR_materials_scatter",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_volume_scatter",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
};

// Neither change the triangles nor the diffuse color of a still.
const std::set<std::string> kHarmless = {
    "EXT_lights_image_based",    "KHR_animation_pointer",    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",   "KHR_materials_dispersion", "KHR_materials_emissive_strength",
    "KHR_materials_iridescence", "KHR_materials_sheen",      "KHR_materials_specular",
    "KHR_materials_unlit",       "KHR_materials_variants",   "KHR_xmp_json_ld",
};

enum class Type { Object, Array, String, Number, Index, Boolean };
enum class Need { None, Always, OfType };  // OfType: where the object's "type" is the path's last key

// A path that tinygltf needs to be there, or to be of a type; in it, * is every element of an array or
// object.
struct Rule {
  const char* path;
  Type type;
  Need need = Need::None;
};

constexpr Need kRequired = Need::Always;

const Rule kRules[] = {
    {"asset", Type::Object, kRequired},
    {"asset.version", Type::String, kRequired},
    {"scene", Type::Index},
    {"extensionsUsed", Type::Array},
    {"extensionsUsed.*", Type::String},
    {"extensionsRequired", Type::Array},
    {"extensionsRequired.*", Type::String},
    {"scenes", Type::Array},
    {"scenes.*", Type::Object},
    {"scenes.*.nodes", Type::Array},
    {"scenes.*.nodes.*", Type::Index},
    {"nodes", Type::Array},
    {"nodes.*", Type::Object},
    {"nodes.*.children", Type::Array},
    {"nodes.*.children.*", Type::Index},
    {"nodes.*.mesh", Type::Index},
    {"nodes.*.skin", Type::Index},
    {"nodes.*.camera", Type::Index},
    {"nodes.*.matrix", Type::Array},
    {"nodes.*.translation", Type::Array},
    {"nodes.*.rotation", Type::Array},
    {"nodes.*.scale", Type::Array},
    {"nodes.*.weights", Type::Array},
    {"meshes", Type::Array},
    {"meshes.*", Type::Object},
    {"meshes.*.weights", Type::Array},
    {"meshes.*.primitives", Type::Array, kRequired},
    {"meshes.*.primitives.*", Type::Object},
    {"meshes.*.primitives.*.attributes", Type::Object, kRequired},
    {"meshes.*.primitives.*.attributes.*", Type::Index},
    {"meshes.*.primitives.*.indices", Type::Index},
    {"meshes.*.primitives.*.material", Type::Index},
    {"meshes.*.primitives.*.mode", Type::Index},
    {"meshes.*.primitives.*.targets", Type::Array},
    {"meshes.*.primitives.*.targets.*", Type::Object},
    {"meshes.*.primitives.*.targets.*.*", Type::Index},
    {"accessors", Type::Array},
    {"accessors.*", Type::Object},
    {"accessors.*.bufferView", Type::Index},
    {"accessors.*.byteOffset", Type::Index},
    {"accessors.*.componentType", Type::Index, kRequired},
    {"accessors.*.count", Type::Index, kRequired},
    {"accessors.*.type", Type::String, kRequired},
    {"accessors.*.normalized", Type::Boolean},
    {"accessors.*.sparse", Type::Object},
    {"accessors.*.sparse.count", Type::Index, kRequired},
    {"accessors.*.sparse.indices", Type::Object, kRequired},
    {"accessors.*.sparse.indices.bufferView", Type::Index, kRequired},
    {"accessors.*.sparse.indices.componentType", Type::Index, kRequired},
    {"accessors.*.sparse.values", Type::Object, kRequired},
    {"accessors.*.sparse.values.bufferView", Type::Index, kRequired},
    {"bufferViews", Type::Array},
    {"bufferViews.*", Type::Object},
    {"bufferViews.*.buffer", Type::Index, kRequired},
    {"bufferViews.*.byteLength", Type::Index, kRequired},
    {"bufferViews.*.byteOffset", Type::Index},
    {"bufferViews.*.byteStride", Type::Index},
    {"buffers", Type::Array},
    {"buffers.*", Type::Object},
    {"buffers.*.byteLength", Type::Index, kRequired},
    {"buffers.*.uri", Type::String},
    {"cameras", Type::Array},
    {"cameras.*", Type::Object},
    {"cameras.*.type", Type::String, kRequired},
    {"cameras.*.perspective", Type::Object, Need::OfType},
    {"cameras.*.perspective.yfov", Type::Number, kRequired},
    {"cameras.*.perspective.znear", Type::Number, kRequired},
    {"cameras.*.perspective.zfar", Type::Number},
    {"cameras.*.perspective.aspectRatio", Type::Number},
    {"cameras.*.orthographic", Type::Object, Need::OfType},
    {"cameras.*.orthographic.xmag", Type::Number, kRequired},
    {"cameras.*.orthographic.ymag", Type::Number, kRequired},
    {"cameras.*.orthographic.zfar", Type::Number, kRequired},
    {"cameras.*.orthographic.znear", Type::Number, kRequired},
    {"images", Type::Array},
    {"images.*", Type::Object},
    {"images.*.uri", Type::String},
    {"images.*.bufferView", Type::Index},
    {"textures", Type::Array},
    {"textures.*", Type::Object},
    {"textures.*.source", Type::Index},
    {"textures.*.sampler", Type::Index},
    {"samplers", Type::Array},
    {"samplers.*", Type::Object},
    {"materials", Type::Array},
    {"materials.*", Type::Object},
    {"materials.*.pbrMetallicRoughness", Type::Object},
    {"materials.*.pbrMetallicRoughness.baseColorFactor", Type::Array},
    {"materials.*.pbrMetallicRoughness.baseColorTexture", Type::Object},
    {"materials.*.pbrMetallicRoughness.baseColorTexture.index", Type::Index, kRequired},
    {"materials.*.normalTexture", Type::Object},
    {"materials.*.normalTexture.index", Type::Index, kRequired},
    {"materials.*.alphaMode", Type::String},
    {"materials.*.alphaCutoff", Type::Number},
    {"materials.*.doubleSided", Type::Boolean},
    {"materials.*.extensions", Type::Object},
    {"skins", Type::Array},
    {"skins.*", Type::Object},
    {"animations", Type::Array},
    {"animations.*", Type::Object},
    {"extensions", Type::Object},
    {"extensions.KHR_lights_punctual", Type::Object},
    {"extensions.KHR_lights_punctual.lights", Type::Array},
    {"extensions.KHR_lights_punctual.lights.*", Type::Object},
    {"extensions.KHR_lights_punctual.lights.*.type", Type::String, kRequired},
    {"extensions.KHR_lights_punctual.lights.*.spot", Type::Object, Need::OfType},
};

bool isOf(const GltfJson& value, Type type) {
  switch (type) {
    case Type::Object:
      return value.is_object();
    case Type::Array:
      return value.is_array();
    case Type::String:
      return value.is_string();
    case Type::Number:
      return value.is_number();
    case Type::Index:
      return value.is_number_unsigned() || (value.is_number_integer() && value.get<std::int64_t>() >= 0);
    case Type::Boolean:
      return value.is_boolean();
  }
  return false;
}

const char* nameOf(Type type) {
  switch (type) {
    case Type::Object:
      return "an object";
    case Type::Array:
      return "an array";
    case Type::String:
      return "a string";
    case Type::Number:
      return "a number";
    case Type::Index:
      return "an integer >= 0";
    case Type::Boolean:
      return "true or false";
  }
  return "";
}

std::string shown(const GltfJson& value) {
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', false, GltfJson::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
  return text;
}

// `rest`: the rule's path below `value`, whose own path is `field`.
void apply(const std::string& file, const Rule& rule, const GltfJson& value, std::string_view rest,
           const std::string& field) {
  if (rest.empty()) {
    if (!isOf(value, rule.type)) throw InputError(file, field, shown(value) + " is not " + nameOf(rule.type));
    return;
  }
  const std::size_t dot = rest.find('.');
  const std::string_view key = rest.substr(0, dot);
  const std::string_view below = dot == std::string_view::npos ? std::string_view() : rest.substr(dot + 1);
  if (key == "*") {
    std::size_t i = 0;
    if (value.is_array())
      for (const GltfJson& element : value)
        apply(file, rule, element, below, field + "[" + std::to_string(i++) + "]");
    else if (value.is_object())
      for (const auto& [name, element] : value.items()) apply(file, rule, element, below, field + "." + name);
    return;
  }
  if (!value.is_object()) return;  // a rule of its own says so
  const std::string path = field.empty() ? std::string(key) : field + "." + std::string(key);
  const auto found = value.find(key);
  if (found != value.end())
    apply(file, rule, *found, below, path);
  else if (below.empty() &&
           (rule.need == Need::Always || (rule.need == Need::OfType && value["type"] == key)))
    throw InputError(file, path, "is missing");
}

// Depth of brackets outside strings.
void checkNesting(const std::string& file, std::string_view json) {
  std::size_t depth = 0;
  bool inString = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (inString && c == '\\')
      ++i;
    else if (c == '"')
      inString = !inString;
    else if (!inString && (c == '[' || c == '{') && ++depth > kMaxDepth)
      throw InputError(file, "", "its JSON is nested deeper than " + std::to_string(kMaxDepth) + " levels");
    else if (!inString && (c == ']' || c == '}') && depth > 0)
      --depth;
  }
}

void checkRequired(const std::string& file, const GltfJson& json) {
  const auto required = json.find("extensionsRequired");
  if (required == json.end() || !required->is_array()) return;
  for (const GltfJson& name : *required)
    if (name.is_string() && !kRead.count(name) && !kHarmless.count(name))
      throw InputError(file, "extensionsRequired", "\"" + name.get<std::string>() + "\" is not supported");
}

}  // namespace

const GltfJson* extensionOf(const GltfJson& value, const char* name) {
  const auto extensions = value.find("extensions");
  if (extensions == value.end() || !extensions->is_object()) return nullptr;
  const auto found = extensions->find(name);
  return found != extensions->end() && found->is_object() ? &*found : nullptr;
}

bool isFallbackBuffer(const GltfJson& buffer) {
  return !buffer.contains("uri") && extensionOf(buffer, "EXT_meshopt_compression");
}

bool isDrawn(const std::string& extension) { return kRead.count(extension) != 0; }

GltfJson parseGltfJson(const std::string& file, std::string_view text) {
  checkNesting(file, text);
  GltfJson json;
  try {
    json = GltfJson::parse(text);
  } catch (const GltfJson::exception& e) {
    throw InputError(file, "", std::string("its JSON cannot be parsed: ") + e.what());
  }
  if (!json.is_object()) throw InputError(file, "", "its JSON is not an object");
  checkRequired(file, json);
  for (const Rule& rule : kRules) apply(file, rule, json, rule.path, "");
  return json;
}

GltfJson forTinyGltf(const GltfJson& json) {
  GltfJson result = json;
  result.erase("animations");
  result.erase("skins");
  if (const auto buffers = result.find("buffers"); buffers != result.end())
    for (GltfJson& buffer : *buffers)
      if (isFallbackBuffer(buffer))
        buffer = {{"byteLength", 1}, {"uri", "data:application/octet-stream;base64,AA=="}};
  const auto accessors = result.find("accessors");
  if (accessors == result.end() || !result.contains("meshes")) return result;
  for (const GltfJson& mesh : result["meshes"])
    for (const GltfJson& primitive : mesh["primitives"]) {
      const auto indices = primitive.find("indices");
      if (indices == primitive.end() || !extensionOf(primitive, "KHR_draco_mesh_compression")) continue;
      const std::size_t i = *indices;
      // tinygltf takes no indices without a view. The stream's indices take precedence over the view's.
      if (i < accessors->size() && !(*accessors)[i].contains("bufferView")) (*accessors)[i]["bufferView"] = 0;
    }
  return result;
}

}  // namespace pellucid::harness
