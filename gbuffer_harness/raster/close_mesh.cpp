#include "raster/close_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "raster/places.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// Bodies whose numbers follow the materials are no thin walls.
bool holdsMedium(const Model& model, const Surface& surface) {
  if (surface.material == 0) return false;
  const std::size_t index = surface.material - 1u;
  return index >= model.materials.size() || !std::holds_alternative<ThinWallMaterial>(model.materials[index]);
}

// A vertex of a triangle: its place, and one of the model's vertices there.
struct Corner {
  std::uint32_t place, vertex;
};

// A directed edge that no triangle of its object runs through in the other direction.
struct LooseEdge {
  Corner from, to;
  std::uint32_t surface;
};

struct ObjectEdges {
  std::string surface;
  std::vector<std::vector<LooseEdge>> loops;
  std::size_t loose = 0;  // edges on no loop
};

// Follows loose edges from one to the next until they come back.
void findLoops(std::vector<LooseEdge> edges, ObjectEdges& result) {
  std::multimap<std::uint32_t, LooseEdge> next;
  for (const LooseEdge& edge : edges) next.emplace(edge.from.place, edge);
  while (!next.empty()) {
    std::vector<LooseEdge> chain = {next.begin()->second};
    next.erase(next.begin());
    std::map<std::uint32_t, std::size_t> seen = {{chain[0].from.place, 0}};
    for (;;) {
      const std::uint32_t end = chain.back().to.place;
      if (const auto again = seen.find(end); again != seen.end()) {
        result.loops.emplace_back(chain.begin() + static_cast<std::ptrdiff_t>(again->second), chain.end());
        for (std::size_t i = 0; i < again->second; ++i) next.emplace(chain[i].from.place, chain[i]);
        break;
      }
      const auto follow = next.find(end);
      if (follow == next.end()) {
        result.loose += chain.size();
        break;
      }
      seen[end] = chain.size();
      chain.push_back(follow->second);
      next.erase(follow);
    }
  }
}

std::map<std::uint32_t, ObjectEdges> looseEdges(const Model& model) {
  const std::vector<std::uint32_t> places = placesOf(model);
  std::map<std::uint32_t, std::vector<const Part*>> objects;
  for (const Part& part : model.parts) objects[part.object].push_back(&part);
  std::map<std::uint32_t, ObjectEdges> result;
  for (const auto& [object, parts] : objects) {
    const auto translucent = std::find_if(parts.begin(), parts.end(), [&](const Part* p) {
      return holdsMedium(model, model.surfaces[p->surface]);
    });
    if (translucent == parts.end()) continue;
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<LooseEdge>> edges;
    for (const Part* part : parts)
      for (std::uint32_t i = 0; i + 2 < part->indexCount; i += 3) {
        Corner corners[3];
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::uint32_t vertex = model.indices[part->firstIndex + i + k];
          corners[k] = {places[vertex], vertex};
        }
        if (corners[0].place == corners[1].place || corners[1].place == corners[2].place ||
            corners[2].place == corners[0].place)
          continue;  // no area
        for (int k = 0; k < 3; ++k) {
          const Corner &a = corners[k], &b = corners[(k + 1) % 3];
          if (const auto opposite = edges.find({b.place, a.place}); opposite != edges.end()) {
            opposite->second.pop_back();
            if (opposite->second.empty()) edges.erase(opposite);
          } else {
            edges[{a.place, b.place}].push_back({a, b, part->surface});
          }
        }
      }
    std::vector<LooseEdge> loose;
    for (const auto& [key, same] : edges) loose.insert(loose.end(), same.begin(), same.end());
    if (loose.empty()) continue;
    ObjectEdges& open = result[object];
    open.surface = model.surfaces[(*translucent)->surface].name;
    findLoops(std::move(loose), open);
  }
  return result;
}

glm::dvec3 position(const Vertex& v) { return {v.position[0], v.position[1], v.position[2]}; }

// Triangles from the loop's center to its edges, turned so that each edge is run through backwards.
void fill(Model& model, std::uint32_t object, const std::vector<LooseEdge>& loop) {
  Vertex center = model.vertices[loop[0].from.vertex];
  glm::dvec3 middle(0), normal(0);
  for (const LooseEdge& edge : loop) middle += position(model.vertices[edge.from.vertex]);
  middle /= static_cast<double>(loop.size());
  for (const LooseEdge& edge : loop)
    normal += glm::cross(position(model.vertices[edge.to.vertex]) - middle,
                         position(model.vertices[edge.from.vertex]) - middle);
  const double length = glm::length(normal);
  normal = length > 0 ? normal / length : glm::dvec3(0, 0, 1);
  for (int i = 0; i < 3; ++i) {
    center.position[static_cast<std::size_t>(i)] = static_cast<float>(middle[i]);
    center.normal[static_cast<std::size_t>(i)] = static_cast<float>(normal[i]);
  }
  const auto add = [&](Vertex vertex) {
    vertex.normal = center.normal;
    model.vertices.push_back(vertex);
    return static_cast<std::uint32_t>(model.vertices.size() - 1);
  };
  const std::uint32_t hub = add(center);
  Part part;
  part.firstIndex = static_cast<std::uint32_t>(model.indices.size());
  part.surface = loop[0].surface;
  part.object = object;
  for (const LooseEdge& edge : loop) {
    const std::uint32_t to = add(model.vertices[edge.to.vertex]),
                        from = add(model.vertices[edge.from.vertex]);
    model.indices.insert(model.indices.end(), {to, from, hub});
  }
  part.indexCount = static_cast<std::uint32_t>(model.indices.size()) - part.firstIndex;
  model.parts.push_back(part);
}

}  // namespace

std::vector<OpenObject> openObjects(const Model& model) {
  std::vector<OpenObject> result;
  for (const auto& [object, edges] : looseEdges(model))
    result.push_back({object, edges.surface, edges.loops.size(), edges.loose});
  return result;
}

std::size_t fillHoles(Model& model) {
  std::size_t filled = 0;
  for (const auto& [object, edges] : looseEdges(model))
    for (const std::vector<LooseEdge>& loop : edges.loops) {
      fill(model, object, loop);
      ++filled;
    }
  return filled;
}

}  // namespace pellucid::harness
