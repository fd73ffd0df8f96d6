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
  const auto found = std::find_if(model.cameras.begin(), model.cameras.end(),
                                  [&](const ModelCamera& c) { return camera.empty() || c.name == camera; });
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

struct PlacedNode {
  std::size_t node;
  glm::dmat4 world;  // worldFromNode
};

// Every node of the default scene, parents before children. Throws InputError when a
// transform is not made of finite numbers, and when a node is reached twice, as in a cycle.
std::vector<PlacedNode> placeNodes(const GltfDocument& document) {
  const std::vector<Field>& scenes = document.list("scenes");
  if (scenes.empty()) document.root()["scenes"].fail("has none: there is nothing to draw");
  const auto chosen = document.root().find("scene");
  struct Pending {
    std::size_t node;
    glm::dmat4 worldFromParent;
  };
  std::vector<Pending> pending;
  std::vector<PlacedNode> placed;
  std::vector<bool> reached(document.list("nodes").size(), false);
  const auto push = [&](const std::optional<Field>& list, const glm::dmat4& world) {
    if (!list) return;
    // Backwards, so that the stack gives them in the file's order.
    const std::vector<Field> nodes = list->items();
    for (auto i = nodes.rbegin(); i != nodes.rend(); ++i) {
      const std::size_t node = document.index("nodes", *i);
      if (reached[node]) list->fail("nodes[" + std::to_string(node) + "] is reached twice; nodes have to form a tree");
      reached[node] = true;
      pending.push_back({node, world});
    }
  };
  push((chosen ? document.element("scenes", *chosen) : scenes.front()).find("nodes"), glm::dmat4(1));
  while (!pending.empty()) {
    const Pending next = pending.back();
    pending.pop_back();
    const Field& node = document.list("nodes")[next.node];
    const glm::dmat4 world = next.worldFromParent * parentFromNode(node);
    placed.push_back({next.node, world});
    push(node.find("children"), world);
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
};

bool isBound(const Field& primitive) {
  const Field attributes = primitive["attributes"];
  return attributes.has("JOINTS_0") && attributes.has("WEIGHTS_0");
}

class Loader {
public:
  Loader(const GltfDocument& document, const GltfOptions& options) : document_(document), options_(options) {}

  GltfScene load();

private:
  void sayIgnored();
  void addMesh(std::size_t node, const glm::dmat4& world);
  void addPrimitive(const Field& primitive, const MeshPose& pose, std::uint32_t object);
  void addCamera(std::size_t node, const glm::dmat4& world);
  void addLight(std::size_t node, const glm::dmat4& world);
  Drawn& read(std::optional<std::size_t> material);
  std::uint8_t indexOf(const MaterialSource& medium, const std::string& name);
  std::uint32_t surfaceOf(Drawn& drawn, bool hasVertexColors);
  int textureOf(const std::optional<TextureUse>& use, bool isNormalMap);
  void checkPresetNames();

  const GltfDocument& document_;
  const GltfOptions& options_;
  GltfScene scene_;
  std::vector<std::optional<glm::dmat4>> worldFromNode_;  // of the nodes in the scene
  std::vector<glm::dvec3> positions_;                     // of scene_.model.vertices
  std::map<std::optional<std::size_t>, Drawn> drawn_;     // by glTF material
  std::vector<PellucidMaterial> compiled_;        // of scene_.model.materials
  std::map<std::pair<std::size_t, bool>, int> textures_;  // by glTF texture and whether it is a normal map
};

void Loader::sayIgnored() {
  const auto used = document_.root().find("extensionsUsed");
  for (const Field& name : used ? used->items() : std::vector<Field>())
    if (!isDrawn(name.text())) scene_.warnings.push_back("extension " + name.text() + " is ignored");
}

void Loader::checkPresetNames() {
  std::vector<std::string>& names = scene_.materialNames;
  for (std::size_t i = 0; i < document_.list("materials").size(); ++i) names.push_back(materialName(document_, i));
  names.push_back(materialName(document_, std::nullopt));
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  for (const auto& [name, preset] : options_.presets)
    if (name != "*" && std::find(names.begin(), names.end(), name) == names.end())
      throw InputError(document_.file, "materials", "none is named \"" + name + "\"; there are " + list);
}

// Into Model::textures; -1 without one.
int Loader::textureOf(const std::optional<TextureUse>& use, bool isNormalMap) {
  if (!use) return -1;
  std::vector<Texture>& textures = scene_.model.textures;
  const auto [entry, isNew] =
      textures_.try_emplace({use->texture, isNormalMap}, static_cast<int>(textures.size()));
  if (isNew) {
    textures.push_back(readTexture(document_, use->texture));
    textures.back().isNormalMap = isNormalMap;
  }
  return entry->second;
}

// Parts of one medium diffuse into each other, whatever their materials' names are: they share a number.
std::uint8_t Loader::indexOf(const MaterialSource& medium, const std::string& name) {
  const PellucidMaterial compiled = compileMaterial(medium, document_.file + ": material \"" + name + "\"");
  for (std::size_t i = 0; i < compiled_.size(); ++i)
    if (std::memcmp(&compiled_[i], &compiled, sizeof compiled) == 0) return static_cast<std::uint8_t>(i + 1);
  if (compiled_.size() == kMaxMaterials) 
    throw InputError(document_.file, "materials", "more than 255 of them are translucent");
  compiled_.push_back(compiled);
  scene_.model.materials.push_back(medium);
  return static_cast<std::uint8_t>(compiled_.size());
}

Drawn& Loader::read(std::optional<std::size_t> material) {
  if (const auto known = drawn_.find(material); known != drawn_.end()) return known->second;
  Model& model = scene_.model;
  GltfMaterial read = readMaterial(document_, material, options_, scene_.warnings);
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

void Loader::addMesh(std::size_t node, const glm::dmat4& world) {
  const Field& source = document_.list("nodes")[node];
  const Field& mesh = document_.element("meshes", source["mesh"]);
  MeshPose pose;
  pose.worldFromMesh = world;
  for (const Field& weighted : {source, mesh})
    if (const auto weights = weighted.find("weights"); weights && pose.weights.empty()) pose.weights = weights->numbers();
  const auto skin = source.find("skin");
  if (skin) pose.joints = readJoints(document_, *skin, worldFromNode_);
  for (const Field& primitive : mesh["primitives"].items()) {
    if (skin && !isBound(primitive))
      skin->fail(primitive.path() + " has no JOINTS_0 and WEIGHTS_0 by which it would be bound; bake the pose");
    addPrimitive(primitive, pose, static_cast<std::uint32_t>(node));
  }
}

void Loader::addPrimitive(const Field& primitive, const MeshPose& pose, std::uint32_t object) {
  Model& model = scene_.model;
  const auto material = primitive.find("material");
  Drawn& drawn = read(material ? std::optional(document_.index("materials", *material)) : std::nullopt);
  const auto first = static_cast<std::uint32_t>(model.indices.size());
  const auto firstVertex = static_cast<std::ptrdiff_t>(model.vertices.size());
  if (!appendPrimitive(document_, primitive, pose, drawn.texCoords, model, positions_, scene_.warnings)) return;
  const bool hasVertexColors = std::any_of(model.vertices.begin() + firstVertex, model.vertices.end(),
                                           [](const Vertex& v) { return v.color != Vertex{}.color; });
  const std::uint32_t surface = surfaceOf(drawn, hasVertexColors);
  model.parts.push_back({first, static_cast<std::uint32_t>(model.indices.size()) - first, surface, object});
}

void Loader::addCamera(std::size_t node, const glm::dmat4& world) {
  constexpr double kMost = 1e18;
  const Field& source = document_.list("nodes")[node];
  const Field& camera = document_.element("cameras", source["camera"]);
  ModelCamera result;
  result.name = nameOf(camera).value_or(nameOf(source).value_or(camera.path()));
  result.orthographic = camera["type"].choice({"perspective", "orthographic"}) == 1;
  const Field lens = camera[result.orthographic ? "orthographic" : "perspective"];
  const double nearPlane = lens["znear"].number(0, kMost), farPlane = numberOr(lens, "zfar", kUnbounded, 0, kMost);
  if (!(farPlane > nearPlane)) lens["zfar"].fail(lens["zfar"].shown() + " is not > znear");
  result.range = {nearPlane, farPlane, true};
  if (result.orthographic) {
    constexpr double kLeast = 1e-18;
    result.height = 2 * lens["ymag"].number(kLeast, kMost);
    result.aspect = lens["xmag"].number(kLeast, kMost) / lens["ymag"].number();
    lens["zfar"].number();
  } else {
    result.verticalFov = lens["yfov"].number(0, std::numbers::pi);
    if (!(result.verticalFov > 0 && result.verticalFov < std::numbers::pi)) lens["yfov"].fail("is not within 0 .. pi");
    if (!(nearPlane > 0)) lens["znear"].fail("is not > 0");
    result.aspect = numberOr(lens, "aspectRatio", 0, 0, kMost);
  }
  const Frame frame = frameOf(world);
  if (!(glm::length(frame.backward) > 0))
    source.fail("a camera is scaled by 0");
  result.viewFromWorld = lookAt(fromGlm(frame.position),
                                fromGlm(frame.position - glm::normalize(frame.backward)), fromGlm(frame.up));
  scene_.model.cameras.push_back(result);
}

void Loader::addLight(std::size_t node, const glm::dmat4& world) {
  const auto extension = extensionOf(document_.list("nodes")[node], "KHR_lights_punctual");
  if (!extension) return;
  const Field& source = document_.element("lights", (*extension)["light"]);
  const auto fail = [&](const char* key, const std::string& sentence) {
    throw InputError(document_.file, source.path() + "." + key, sentence);
  };
  constexpr double kMost = std::numeric_limits<float>::max();
  constexpr PellucidLightType kTypes[] = {PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT};
  Light light;
  light.type = kTypes[source["type"].choice({"directional", "point", "spot"})];
  if (const auto color = source.find("color")) light.color = color->numbers<3>();
  light.intensity = numberOr(source, "intensity", 1, -kMost, kMost);
  light.range = numberOr(source, "range", 0, -kMost, kMost);
  if (light.type == PELLUCID_LIGHT_SPOT) {
    const Field spot = source["spot"];
    light.innerConeAngle = numberOr(spot, "innerConeAngle", 0, -kMost, kMost);
    light.outerConeAngle = numberOr(spot, "outerConeAngle", std::numbers::pi / 4, -kMost, kMost);
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
  worldFromNode_.resize(document_.list("nodes").size());
  const std::vector<PlacedNode> placed = placeNodes(document_);
  for (const auto& [node, world] : placed) worldFromNode_[node] = world;
  for (const auto& [node, world] : placed) {
    const Field& source = document_.list("nodes")[node];
    if (source.has("mesh")) addMesh(node, world);
    if (source.has("camera")) addCamera(node, world);
    addLight(node, world);
  }
  if (model.indices.empty()) throw InputError(document_.file, "meshes", "the scene has no triangles");
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
