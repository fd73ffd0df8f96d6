#include "gltf/gltf.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <glm/glm.hpp>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "common/error.h"
#include "common/far_origin.h"
#include "gltf/document.h"
#include "gltf/fields.h"
#include "gltf/material.h"
#include "gltf/mesh.h"
#include "gltf/pose.h"
#include "gltf/texture.h"
#include "raster/model.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// A place around which the scene has to be drawn finely, and the distance from the place that counts.
struct Anchor {
  glm::dvec3 position;
  double distance;
};

Anchor anchorOf(const Model& model, const std::vector<glm::dvec3>& positions, const std::string& camera) {
  glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (const std::uint32_t i : model.indices) {
    low = glm::min(low, positions[i]);
    high = glm::max(high, positions[i]);
  }
  const Anchor center{0.5 * (low + high), 0.5 * glm::length(high - low)};
  auto found = std::find_if(model.cameras.begin(), model.cameras.end(), [&](const ModelCamera& c) { return camera.empty() || c.node == camera; });
  if (found == model.cameras.end())
    found = std::find_if(model.cameras.begin(), model.cameras.end(), [&](const ModelCamera& c) { return c.name == camera; });
  if (found == model.cameras.end()) return center;
  const glm::dvec3 eye = glm::inverse(toGlm(found->viewFromWorld))[3];
  // An orthographic camera's near plane may lie at its eye.
  const double seen = found->orthographic ? found->height : kNearPlanes * found->range.nearPlane;
  return {eye, std::min(center.distance, seen)};
}

// Gives the model's vertices their positions, of which `positions` has the file's. Far from the file's
// origin, they, cameras and lights become relative to model.origin, near the camera named so
// (GltfOptions::camera). Returns whether they did.
bool moveOrigin(Model& model, const std::vector<glm::dvec3>& positions, const std::string& camera) {
  const Anchor anchor = anchorOf(model, positions, camera);
  glm::dvec3 origin(0);
  if (glm::length(anchor.position) > kFarthest * anchor.distance && anchor.distance > 0)
    origin = toGlm(originNear(fromGlm(anchor.position), anchor.distance));
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const glm::vec3 p(positions[i] - origin);
    model.vertices[i].position = {p.x, p.y, p.z};
  }
  if (origin == glm::dvec3(0)) return false;
  model.origin = fromGlm(origin);
  for (ModelCamera& c : model.cameras) c.viewFromWorld = fromOrigin(c.viewFromWorld, model.origin);
  for (Light& light : model.lights) light.position = fromGlm(toGlm(light.position) - origin);
  return true;
}

// A sentence for a person.
std::string originNote(const Model& model) {
  char text[160];
  std::snprintf(text, sizeof text,
                "the scene is far from its origin: the capture's world begins at %.9g, %.9g, %.9g",
                model.origin[0], model.origin[1], model.origin[2]);
  return text;
}

std::string sceneName(const GltfDocument& document, std::size_t scene) {
  const std::string& name = document.model.scenes[scene].name;
  return std::to_string(scene) + (name.empty() ? "" : " \"" + name + "\"");
}

// The scene of that name or number; of an empty one the file's default scene, which a sentence names if there
// are several.
std::size_t chooseScene(const GltfDocument& document, const std::string& wanted,
                        std::vector<std::string>& warnings) {
  const auto& scenes = document.model.scenes;
  if (scenes.empty()) document.fail("scenes", "the file has none: there is nothing to draw");
  std::string list;
  for (std::size_t i = 0; i < scenes.size(); ++i) list += (i ? ", " : "") + sceneName(document, i);
  if (wanted.empty()) {
    const std::size_t chosen =
        document.model.defaultScene < 0
            ? 0
            : document.index(document.model.defaultScene, scenes.size(), "scene", "scenes");
    if (scenes.size() > 1)
      warnings.push_back("scene " + sceneName(document, chosen) + " is drawn; --scene chooses among " + list);
    return chosen;
  }
  for (std::size_t i = 0; i < scenes.size(); ++i)
    if (scenes[i].name == wanted || std::to_string(i) == wanted) return i;
  document.fail("scenes", "none is \"" + wanted + "\"; there are " + list);
}

struct PlacedNode {
  std::size_t node;
  glm::dmat4 world;  // worldFromNode
  bool isVisible;    // KHR_node_visibility, its own and of all nodes above
};

bool isVisible(const GltfDocument& document, std::size_t node) {
  const GltfJson* extension = extensionOf(document.json["nodes"][node], "KHR_node_visibility");
  if (!extension || !extension->contains("visible")) return true;
  const GltfJson& visible = (*extension)["visible"];
  if (!visible.is_boolean())
    document.fail("nodes[" + std::to_string(node) + "].extensions.KHR_node_visibility.visible",
                  "is not true or false");
  return visible;
}

// Every node of a scene, parents before children. Throws InputError when a
// transform is not made of finite numbers, and when a node is reached twice, as in a cycle.
std::vector<PlacedNode> placeNodes(const GltfDocument& document, std::size_t scene) {
  const tinygltf::Model& model = document.model;
  std::vector<PlacedNode> pending;  // each with the matrix of its parent
  std::vector<PlacedNode> placed;
  std::vector<bool> reached(model.nodes.size(), false);
  const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& world, bool visible,
                        const std::string& field) {
    // Backwards, so that the stack gives them in the file's order.
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
      const std::size_t node = document.index(*i, model.nodes.size(), field, "nodes");
      if (reached[node])
        document.fail(field, "nodes[" + std::to_string(*i) + "] is reached twice; nodes have to form a tree");
      reached[node] = true;
      pending.push_back({node, world, visible && isVisible(document, node)});
    }
  };
  push(model.scenes[scene].nodes, glm::dmat4(1), true, "scenes[" + std::to_string(scene) + "].nodes");
  while (!pending.empty()) {
    PlacedNode next = pending.back();
    pending.pop_back();
    next.world *= parentFromNode(document, next.node);
    placed.push_back(next);
    push(model.nodes[next.node].children, next.world, next.isVisible,
         "nodes[" + std::to_string(next.node) + "].children");
  }
  return placed;
}

constexpr std::size_t kMaxMaterials = 255;  // 8 bits, 0 is none

// Rotation and position of a node, whatever its scale.
struct Frame {
  glm::dvec3 position, up, backward;
};
Frame frameOf(const glm::dmat4& world) {
  return {glm::dvec3(world[3]), glm::dvec3(world[1]), glm::dvec3(world[2])};
}

// A glTF material, read.
struct Drawn {
  Surface surface;
  TexCoords texCoords;
  std::optional<std::array<double, 3>> reflectance;  // see GltfMaterial
  // Into Model::surfaces: of primitives in the file's color, and in that of the reflectance.
  std::optional<std::uint32_t> colored, reflecting;
  bool leftOut = false;
};

bool isBound(const tinygltf::Primitive& primitive) {
  return primitive.attributes.count("JOINTS_0") && primitive.attributes.count("WEIGHTS_0");
}

class Loader {
public:
  Loader(const GltfDocument& document, const GltfOptions& options) : document_(document), options_(options) {}

  GltfScene load();

private:
  void sayIgnored();
  void checkVertices() const;
  void addMesh(std::size_t node, const glm::dmat4& world);
  void addPrimitive(const tinygltf::Primitive& primitive, const std::string& field, const MeshPose& pose,
                    std::uint32_t object);
  void addCamera(std::size_t node, const glm::dmat4& world);
  void addLight(std::size_t node, const glm::dmat4& world);
  Drawn& read(int material);
  std::uint8_t indexOf(const MaterialSource& medium, const std::string& name);
  std::uint32_t surfaceOf(Drawn& drawn, bool hasVertexColors);
  int textureOf(const std::optional<TextureUse>& use, bool isNormalMap);
  void checkPresetNames();

  const GltfDocument& document_;
  const GltfOptions& options_;
  GltfScene scene_;
  std::vector<std::optional<glm::dmat4>> worldFromNode_;  // of the nodes in the scene
  std::vector<glm::dvec3> positions_;                     // of scene_.model.vertices
  std::map<int, Drawn> drawn_;                            // by glTF material
  std::vector<PellucidMaterial> compiled_;                // of scene_.model.materials
  std::map<std::pair<int, bool>, int> textures_;          // by glTF texture and whether it is a normal map
};

void Loader::sayIgnored() {
  for (std::string& sentence : unusedFields(document_.json)) scene_.warnings.push_back(std::move(sentence));
}

void Loader::checkPresetNames() {
  std::vector<std::string>& names = scene_.materialNames;
  for (std::size_t i = 0; i < document_.model.materials.size(); ++i)
    names.push_back(materialName(document_, static_cast<int>(i)));
  names.push_back(materialName(document_, -1));
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  for (const auto& [name, preset] : options_.presets)
    if (name != "*" && std::find(names.begin(), names.end(), name) == names.end())
      document_.fail("materials", "none is named \"" + name + "\"; there are " + list);
}

// Into Model::textures; -1 without one.
int Loader::textureOf(const std::optional<TextureUse>& use, bool isNormalMap) {
  if (!use) return -1;
  std::vector<Texture>& textures = scene_.model.textures;
  const auto [entry, isNew] =
      textures_.try_emplace({use->texture, isNormalMap}, static_cast<int>(textures.size()));
  if (isNew) {
    textures.push_back(readTexture(document_, use->texture, use->field + ".index"));
    textures.back().isNormalMap = isNormalMap;
  }
  return entry->second;
}

// Parts of one medium diffuse into each other, whatever their materials' names are: they share a number.
std::uint8_t Loader::indexOf(const MaterialSource& medium, const std::string& name) {
  const PellucidMaterial compiled = compileMaterial(medium, document_.file + ": material \"" + name + "\"");
  for (std::size_t i = 0; i < compiled_.size(); ++i)
    if (std::memcmp(&compiled_[i], &compiled, sizeof compiled) == 0) return static_cast<std::uint8_t>(i + 1);
  if (compiled_.size() == kMaxMaterials) document_.fail("materials", "more than 255 of them are translucent");
  compiled_.push_back(compiled);
  scene_.model.materials.push_back(medium);
  return static_cast<std::uint8_t>(compiled_.size());
}

Drawn& Loader::read(int material) {
  if (const auto known = drawn_.find(material); known != drawn_.end()) return known->second;
  Model& model = scene_.model;
  GltfMaterial read = readMaterial(document_, material, options_, scene_.warnings);
  if (read.leftOut) {
    drawn_[material].leftOut = true;
    return drawn_[material];
  }
  read.surface.texture = textureOf(read.color, false);
  read.surface.normalMap = textureOf(read.normal, true);
  if (read.lobeMap) {
    read.surface.lobeMap = static_cast<int>(model.textures.size());
    model.textures.push_back(std::move(read.lobeMap->texture));
  }
  if (read.medium) read.surface.material = indexOf(*read.medium, read.surface.name);
  Drawn& drawn = drawn_[material];
  drawn.surface = read.surface;
  if (read.color) drawn.texCoords.color = read.color->coord;
  if (read.normal) drawn.texCoords.normal = read.normal->coord;
  if (read.lobeMap) drawn.texCoords.lobe = read.lobeMap->coord;
  drawn.reflectance = read.reflectance;
  return drawn;
}

std::uint32_t Loader::surfaceOf(Drawn& drawn, bool hasVertexColors) {
  const bool reflecting = drawn.reflectance && !hasVertexColors;
  std::optional<std::uint32_t>& index = reflecting ? drawn.reflecting : drawn.colored;
  if (index) return *index;
  Model& model = scene_.model;
  index = static_cast<std::uint32_t>(model.surfaces.size());
  model.surfaces.push_back(drawn.surface);
  if (reflecting) {
    const std::array<double, 3>& rho = *drawn.reflectance;
    model.surfaces.back().baseColor = rho;
    model.surfaces.back().hasReflectance = true;
    char numbers[64];
    std::snprintf(numbers, sizeof numbers, "%.3g %.3g %.3g", rho[0], rho[1], rho[2]);
    scene_.notes.push_back("material \"" + drawn.surface.name +
                           "\" has no color in the file: its albedo is " + numbers +
                           ", the reflectance of its medium");
  }
  return *index;
}

// Nodes multiply a small file's meshes: too many vertices are refused before the first one is read.
void Loader::checkVertices() const {
  const tinygltf::Model& model = document_.model;
  std::size_t vertices = 0;
  for (std::size_t node = 0; node < worldFromNode_.size(); ++node) {
    const auto mesh = static_cast<std::size_t>(model.nodes[node].mesh);  // -1: none
    if (!worldFromNode_[node] || mesh >= model.meshes.size()) continue;
    for (std::size_t i = 0; i < model.meshes[mesh].primitives.size(); ++i) {
      const tinygltf::Primitive& primitive = model.meshes[mesh].primitives[i];
      if (primitive.mode < TINYGLTF_MODE_TRIANGLES) continue;
      // Without normals each triangle gets vertices of its own.
      const auto position = primitive.attributes.find("POSITION");
      const bool flat = primitive.attributes.count("NORMAL") == 0 && primitive.indices != -1;
      const auto accessor =
          static_cast<std::size_t>(flat                                     ? primitive.indices
                                   : position == primitive.attributes.end() ? -1
                                                                            : position->second);
      // An accessor of too many vertices is refused where it is read: that error names the accessor.
      if (accessor < model.accessors.size() && model.accessors[accessor].count <= kMaxVertices)
        vertices += model.accessors[accessor].count;
      if (vertices > kMaxVertices)
        document_.fail("meshes[" + std::to_string(mesh) + "].primitives[" + std::to_string(i) + "]",
                       "with it the scene has more than 2^24 vertices or triangles");
    }
  }
}

void Loader::addMesh(std::size_t node, const glm::dmat4& world) {
  const tinygltf::Node& source = document_.model.nodes[node];
  const std::string nodeName = "nodes[" + std::to_string(node) + "]";
  const std::size_t index =
      document_.index(source.mesh, document_.model.meshes.size(), nodeName + ".mesh", "meshes");
  const tinygltf::Mesh& mesh = document_.model.meshes[index];
  MeshPose pose;
  pose.weights = source.weights.empty() ? mesh.weights : source.weights;
  if (source.skin != -1) pose.joints = readJoints(document_, source.skin, worldFromNode_, nodeName + ".skin");
  pose.worldFromMesh = world;
  for (std::size_t i = 0; i < mesh.primitives.size(); ++i) {
    const std::string field = "meshes[" + std::to_string(index) + "].primitives[" + std::to_string(i) + "]";
    if (source.skin != -1 && !isBound(mesh.primitives[i]))
      document_.fail(nodeName + ".skin",
                     field + " has no JOINTS_0 and WEIGHTS_0 by which it would be bound; bake the pose");
    addPrimitive(mesh.primitives[i], field, pose, static_cast<std::uint32_t>(node));
  }
}

void Loader::addPrimitive(const tinygltf::Primitive& primitive, const std::string& field,
                          const MeshPose& pose, std::uint32_t object) {
  Model& model = scene_.model;
  if (primitive.material != -1)
    document_.index(primitive.material, document_.model.materials.size(), field + ".material", "materials");
  Drawn& drawn = read(primitive.material);
  if (drawn.leftOut) return;
  const auto first = static_cast<std::uint32_t>(model.indices.size());
  const auto firstVertex = static_cast<std::ptrdiff_t>(model.vertices.size());
  if (!appendPrimitive(document_, primitive, field, pose, drawn.texCoords, model, positions_,
                       scene_.warnings))
    return;
  const bool hasVertexColors = std::any_of(model.vertices.begin() + firstVertex, model.vertices.end(),
                                           [](const Vertex& v) { return v.color != Vertex{}.color; });
  const std::uint32_t surface = surfaceOf(drawn, hasVertexColors);
  model.parts.push_back({first, static_cast<std::uint32_t>(model.indices.size()) - first, surface, object});
}

void Loader::addCamera(std::size_t node, const glm::dmat4& world) {
  const tinygltf::Node& source = document_.model.nodes[node];
  const std::size_t index = document_.index(source.camera, document_.model.cameras.size(),
                                            "nodes[" + std::to_string(node) + "].camera", "cameras");
  const tinygltf::Camera& camera = document_.model.cameras[index];
  const std::string field = "cameras[" + std::to_string(index) + "]";
  const auto require = [&](bool holds, const char* key, double value, const char* range) {
    if (!holds) document_.fail(field + key, std::to_string(value) + " is not " + range);
  };
  ModelCamera result;
  result.node = source.name;
  result.name = !camera.name.empty() ? camera.name : !source.name.empty() ? source.name : field;
  result.orthographic = camera.type == "orthographic";
  if (result.orthographic) {
    const tinygltf::OrthographicCamera& o = camera.orthographic;
    require(o.ymag > 0 && o.ymag < 1e18, ".orthographic.ymag", o.ymag, "> 0");
    require(o.znear >= 0 && o.znear < 1e18, ".orthographic.znear", o.znear, ">= 0");
    require(o.zfar > o.znear && o.zfar < 1e18, ".orthographic.zfar", o.zfar, "> znear");
    result.height = 2 * o.ymag;
    if (o.xmag > 0 && o.xmag < 1e18) result.aspect = o.xmag / o.ymag;
    result.range = {o.znear, o.zfar, true};
  } else {
    const tinygltf::PerspectiveCamera& p = camera.perspective;
    require(p.yfov > 0 && p.yfov < std::numbers::pi, ".perspective.yfov", p.yfov, "within 0 .. pi");
    require(p.znear > 0 && p.znear < 1e18, ".perspective.znear", p.znear, "> 0");
    require(p.zfar == 0 || (p.zfar > p.znear && p.zfar < 1e18), ".perspective.zfar", p.zfar, "> znear");
    result.verticalFov = p.yfov;
    require(p.aspectRatio >= 0 && p.aspectRatio < 1e18, ".perspective.aspectRatio", p.aspectRatio, "> 0");
    result.aspect = p.aspectRatio;
    result.range = {p.znear, p.zfar > 0 ? p.zfar : std::numeric_limits<double>::infinity(), true};
  }
  const Frame frame = frameOf(world);
  if (!(glm::length(frame.backward) > 0))
    document_.fail("nodes[" + std::to_string(node) + "]", "a camera is scaled by 0");
  result.viewFromWorld = lookAt(fromGlm(frame.position),
                                fromGlm(frame.position - glm::normalize(frame.backward)), fromGlm(frame.up));
  if (glm::determinant(glm::dmat3(world)) < 0)
    scene_.warnings.push_back("nodes[" + std::to_string(node) +
                              "]: a negative scale mirrors its camera, whose picture is drawn unmirrored");
  scene_.model.cameras.push_back(result);
}

void Loader::addLight(std::size_t node, const glm::dmat4& world) {
  const auto& extensions = document_.model.nodes[node].extensions;
  const auto extension = extensions.find("KHR_lights_punctual");
  if (extension == extensions.end()) return;
  const std::string reference = "nodes[" + std::to_string(node) + "].extensions.KHR_lights_punctual.light";
  if (!extension->second.IsObject() || !extension->second.Get("light").IsInt())
    document_.fail(reference, "is not an integer");
  const std::size_t index = document_.index(extension->second.Get("light").GetNumberAsInt(),
                                            document_.model.lights.size(), reference, "lights");
  const tinygltf::Light& source = document_.model.lights[index];
  const std::string field = "extensions.KHR_lights_punctual.lights[" + std::to_string(index) + "].";
  const auto fail = [&](const char* key, const std::string& sentence) {
    document_.fail(field + key, sentence);
  };
  Light light;
  const std::map<std::string, PellucidLightType> types = {{"directional", PELLUCID_LIGHT_DIRECTIONAL},
                                                          {"point", PELLUCID_LIGHT_POINT},
                                                          {"spot", PELLUCID_LIGHT_SPOT}};
  if (!types.count(source.type)) fail("type", "is not directional, point or spot");
  light.type = types.at(source.type);
  if (!source.color.empty() && source.color.size() != 3) fail("color", "is not 3 numbers");
  std::copy(source.color.begin(), source.color.end(), light.color.begin());
  light.intensity = source.intensity;
  light.range = source.range;
  if (light.type == PELLUCID_LIGHT_SPOT) {
    light.innerConeAngle = source.spot.innerConeAngle;
    light.outerConeAngle = source.spot.outerConeAngle;
  }
  const Frame frame = frameOf(world);
  if (!(glm::length(frame.backward) > 0)) fail("direction", "is not defined: its node is scaled by 0");
  light.position = fromGlm(frame.position);
  light.direction = fromGlm(-glm::normalize(frame.backward));
  fitLight(light, fail);
  scene_.model.lights.push_back(light);
}

GltfScene Loader::load() {
  Model& model = scene_.model;
  model.name = document_.file;
  model.metersPerUnit = options_.metersPerUnit;
  sayIgnored();
  checkPresetNames();
  worldFromNode_.resize(document_.model.nodes.size());
  const std::vector<PlacedNode> placed =
      placeNodes(document_, chooseScene(document_, options_.scene, scene_.warnings));
  for (const PlacedNode& node : placed) worldFromNode_[node.node] = node.world;
  checkVertices();
  for (const auto& [node, world, isShown] : placed) {
    const tinygltf::Node& source = document_.model.nodes[node];
    if (!source.matrix.empty() && source.translation.size() + source.rotation.size() + source.scale.size() > 0)
      scene_.warnings.push_back("nodes[" + std::to_string(node) + "].matrix: takes the place of the node's translation, rotation and scale");
    if (source.camera != -1) addCamera(node, world);
    if (!isShown) continue;
    if (source.mesh != -1) addMesh(node, world);
    addLight(node, world);
  }
  if (model.indices.empty()) document_.fail("meshes", "the scene has no triangles");
  if (moveOrigin(model, positions_, options_.camera)) scene_.notes.push_back(originNote(model));
  return std::move(scene_);
}

}  // namespace

GltfScene loadGltf(const std::filesystem::path& path, const GltfOptions& options) {
  return withinMemory(path.string(), [&] {
    const GltfDocument document = readGltf(path);
    return Loader(document, options).load();
  });
}

}  // namespace pellucid::harness
