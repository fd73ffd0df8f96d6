#include "capture/blender.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <numbers>
#include <vector>

#include "capture/exr.h"
#include "capture/json_field.h"
#include "common/error.h"

namespace pellucid::harness {

namespace {


// Blender prints matrices as four rows.
glm::dmat4 matrix(const Field& field) {
  const std::vector<Field> rows = field.items();
  if (rows.size() != 4) field.fail("needs 4 rows of 4 numbers, has " + std::to_string(rows.size()) + " rows");
  glm::dmat4 m;
  for (int row = 0; row < 4; ++row) {
    const auto numbers = rows[static_cast<std::size_t>(row)].numbers<4>();
    for (int column = 0; column < 4; ++column) m[column][row] = numbers[static_cast<std::size_t>(column)];
  }
  return m;
}

nlohmann::json columnMajor(const glm::dmat4& m) {
  nlohmann::json numbers = nlohmann::json::array();
  for (int i = 0; i < 16; ++i) numbers.push_back(m[i / 4][i % 4]);
  return numbers;
}

nlohmann::json vector(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

// Inverse of an object's matrix_world without its scale: lengths in view space are those of the scene.
glm::dmat4 viewFromWorld(const Field& field) {
  const glm::dmat4 world = matrix(field);
  glm::dmat3 axes(world);
  for (int i = 0; i < 3; ++i) {
    if (!(glm::length(axes[i]) > 0)) field.fail("an axis has no length: " + field.shown());
    axes[i] = glm::normalize(axes[i]);
  }
  const glm::dmat3 rotation = glm::transpose(axes);
  glm::dmat4 view(rotation);
  view[3] = glm::dvec4(-(rotation * glm::dvec3(world[3])), 1);
  return view;
}

// OpenGL clip space (y up, z from -w to w) to Vulkan's (y down, z from 0 to w).
glm::dmat4 vulkanFromOpenGl() {
  glm::dmat4 m(1);
  m[1][1] = -1;
  m[2][2] = m[3][2] = 0.5;
  return m;
}

nlohmann::json lightJson(const Field& field) {
  field.allowKeys({"name", "type", "matrixWorld", "color", "energy", "spotSize", "spotBlend"});
  const std::size_t type = field["type"].choice({"SUN", "POINT", "SPOT"});
  const glm::dmat4 world = matrix(field["matrixWorld"]);
  const double energy = field["energy"].number(0, 1e30);
  nlohmann::json light = {{"color", field["color"].numbers<3>()}};
  constexpr const char* kTypes[] = {"directional", "point", "spot"};
  light["type"] = kTypes[type];
  // A sun's strength is its irradiance; of the others energy is the power of a full sphere, also of spots.
  light["intensity"] = type == 0 ? energy : energy / (4 * std::numbers::pi);
  if (type != 0) light["position"] = vector(world[3]);
  if (type != 1) light["direction"] = vector(-glm::dvec3(world[2]));  // lights shine along their own -z
  if (type == 2) {
    const double outer = field["spotSize"].number(0, std::numbers::pi) / 2;
    light["outerConeAngle"] = outer;
    light["innerConeAngle"] = outer * (1 - std::max(field["spotBlend"].number(0, 1), 1e-3));
  }
  return light;
}

// The passes of one view layer in the EXR.
class Passes {
public:
  Passes(const std::filesystem::path& exr, const Field& scene) : file_(exr) {
    for (int part = 0; part < file_.partCount(); ++part)
      for (const std::string& channel : file_.channels(part)) channels_.push_back(channel);
    constexpr std::string_view kDepth = ".Depth.Z";
    std::vector<std::string> layers;
    for (const std::string& channel : channels_)
      if (channel.ends_with(kDepth)) layers.push_back(channel.substr(0, channel.size() - kDepth.size()));
    if (const auto name = scene.find("viewLayer"))
      layer_ = name->text();
    else if (layers.size() == 1)
      layer_ = layers.front();
    else
      throw InputError(
          exr.string(), "passes",
          layers.empty()
              ? "no view layer has a Depth pass (channel \"*.Depth.Z\")"
              : "several view layers have a Depth pass; name one as \"viewLayer\" in " + scene.file());
  }

  bool has(const std::string& pass, const char* component) const {
    return std::find(channels_.begin(), channels_.end(), name(pass, component)) != channels_.end();
  }
  std::string name(const std::string& pass, const std::string& component) const {
    return layer_ + "." + pass + "." + component;
  }
  nlohmann::json names(const std::string& pass, const char* components) const {
    nlohmann::json result = nlohmann::json::array();
    for (const char* c = components; *c; ++c) result.push_back(name(pass, std::string(1, *c)));
    return result;
  }

private:
  ExrFile file_;
  std::vector<std::string> channels_;
  std::string layer_;
};

}  // namespace

nlohmann::json blenderManifest(const std::filesystem::path& exr, const std::filesystem::path& scene,
                     const std::string& sceneText) {
  const nlohmann::json document = parseJson(scene.string(), sceneText);
  const Field root(scene.string(), document);
  if (root["blender"].number() != 1)
    root["blender"].fail("must be 1, the version of the script's file, is " + root["blender"].shown());
  root.allowKeys({"blender", "viewLayer", "metersPerUnit", "camera", "lights", "materials", "backDepth"});
  const Field camera = root["camera"];
  camera.allowKeys({"matrixWorld", "projection"});
  const Passes passes(exr, root);

  nlohmann::json manifest = {{"pellucid", 1}, {"metersPerUnit", root["metersPerUnit"].number()}};
  manifest["camera"] = {{"clipFromView", columnMajor(vulkanFromOpenGl() * matrix(camera["projection"]))},
                        {"viewFromWorld", columnMajor(viewFromWorld(camera["matrixWorld"]))}};
  const std::string file = exr.filename().string();
  nlohmann::json& buffers = manifest["buffers"];
  const std::string depth = passes.name("Depth", "Z");
  buffers["frontDepth"] = {{"file", file}, {"channel", depth}, {"encoding", "viewZ"}};
  buffers["irradiance"] = {
      {"file", file}, {"channels", passes.names("DiffDir", "RGB")}, {"scale", kIrradiancePerDiffDir}};
  buffers["normal"] = {{"file", file}, {"channels", passes.names("Normal", "XYZ")}, {"space", "world"}};
  if (passes.has("DiffCol", "R"))
    buffers["albedo"] = {{"file", file}, {"channels", passes.names("DiffCol", "RGB")}};
  if (const auto back = root.find("backDepth"))
    buffers["backDepth"] = {{"file", back->text()}, {"channel", depth}, {"encoding", "viewZ"}};

  nlohmann::json map = {{"0", 0}};
  manifest["materials"] = nlohmann::json::array();
  for (const Field& material : root["materials"].items()) {
    material.allowKeys({"passIndex", "material"});
    const int passIndex = material["passIndex"].integer(1, 32767);
    if (map.contains(std::to_string(passIndex)))
      material["passIndex"].fail("pass index " + std::to_string(passIndex) + " stands twice");
    manifest["materials"].push_back(material["material"].value());
    map[std::to_string(passIndex)] = manifest["materials"].size();
  }
  // Without an index pass everything is the first material; the background has no depth.
  nlohmann::json& material = buffers["material"] = {{"constant", {1}}};
  for (const char* pass : {"IndexOB", "IndexMA"})
    if (passes.has(pass, "X")) material = {{"file", file}, {"channel", passes.name(pass, "X")}, {"map", map}};

  manifest["lights"] = nlohmann::json::array();
  for (const Field& light : root["lights"].items()) manifest["lights"].push_back(lightJson(light));
  return manifest;
}

}  // namespace pellucid::harness
