#include "raster/mesh.h"

#include <meshoptimizer.h>
#include <cmath>
#include <string>

#include "common/error.h"
#include "common/parallel.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

constexpr int kBlock = 8;  // corners along a side of what is skipped where no surface is near

// Adds the surface within the cube of that half side around `center`.
void addMesh(const DistanceField& field, const glm::dvec3& center, double half, double cell, Model& model) {
  const int blocks = static_cast<int>(std::ceil(2 * half / (cell * kBlock))), n = blocks * kBlock;
  const glm::dvec3 origin = center - 0.5 * n * cell;
  const auto index = [n](int x, int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(n) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(n) +
           static_cast<std::size_t>(x);
  };
  const auto at = [&](double x, double y, double z) { return origin + cell * glm::dvec3(x, y, z); };
  std::vector<float> distance(index(n - 1, n - 1, n - 1) + 1);
  parallelRows(blocks * blocks, 0, [&](int row) {
    for (int b = 0; b < blocks; ++b) {
      const int x0 = b * kBlock, y0 = row % blocks * kBlock, z0 = row / blocks * kBlock;
      const double middle = field.distance(at(x0 + 3.5, y0 + 3.5, z0 + 3.5));
      const bool far = std::abs(middle) > 0.5 * std::sqrt(3.0) * kBlock * cell;
      for (int i = 0; i < kBlock * kBlock * kBlock; ++i) {
        const int x = x0 + i % kBlock, y = y0 + i / kBlock % kBlock, z = z0 + i / kBlock / kBlock;
        distance[index(x, y, z)] = static_cast<float>(far ? middle : field.distance(at(x, y, z)));
      }
    }
  });

  // One vertex in each cell that the surface passes through.
  std::vector<glm::dvec3> points;
  std::vector<std::uint32_t> vertexOf(distance.size(), UINT32_MAX);
  for (int z = 0; z + 1 < n; ++z)
    for (int y = 0; y + 1 < n; ++y)
      for (int x = 0; x + 1 < n; ++x) {
        glm::dvec3 sum(0);
        int crossings = 0;
        for (int e = 0; e < 12; ++e) {  // an edge: along axis e / 4, at one of four places across
          const int axis = e / 4, u = (axis + 1) % 3, v = (axis + 2) % 3;
          glm::ivec3 a(x, y, z);
          a[u] += e & 1;
          a[v] += e >> 1 & 1;
          glm::ivec3 b = a;
          ++b[axis];
          const double da = distance[index(a.x, a.y, a.z)], db = distance[index(b.x, b.y, b.z)];
          if ((da < 0) == (db < 0)) continue;
          sum += glm::mix(glm::dvec3(a), glm::dvec3(b), da / (da - db));
          ++crossings;
        }
        if (crossings == 0) continue;
        vertexOf[index(x, y, z)] = static_cast<std::uint32_t>(points.size());
        points.push_back(at(sum.x / crossings, sum.y / crossings, sum.z / crossings));
      }
  const std::size_t first = model.vertices.size();
  model.vertices.resize(first + points.size());
  parallelRows(static_cast<int>(points.size()), 0, [&](int row) {
    const auto i = static_cast<std::size_t>(row);
    glm::dvec3 p = points[i];
    for (int step = 0; step < 2; ++step) p -= field.distance(p) * field.normal(p);
    const glm::vec3 position(p), normal(field.normal(p));
    model.vertices[first + i] = {{position.x, position.y, position.z}, {normal.x, normal.y, normal.z}};
  });

  // One square across each edge that the surface passes through.
  for (int z = 1; z + 1 < n; ++z)
    for (int y = 1; y + 1 < n; ++y)
      for (int x = 1; x + 1 < n; ++x)
        for (int axis = 0; axis < 3; ++axis) {
          glm::ivec3 b(x, y, z), u(0), v(0);
          ++b[axis];
          --u[(axis + 1) % 3];
          --v[(axis + 2) % 3];
          const bool inside = distance[index(x, y, z)] < 0;
          if (inside == (distance[index(b.x, b.y, b.z)] < 0)) continue;
          const auto vertex = [&](const glm::ivec3& o) { return vertexOf[index(x + o.x, y + o.y, z + o.z)]; };
          const auto base = static_cast<std::uint32_t>(first);
          const std::uint32_t c[] = {vertex({0, 0, 0}), vertex(u), vertex(u + v), vertex(v)};
          for (const int k : {0, 1, 2, 0, 2, 3}) model.indices.push_back(base + c[inside ? k : (4 - k) % 4]);
        }
}

}  // namespace

Model meshOf(const SceneModel& scene, const std::string& name, double cell) {
  Model model;
  model.name = name;
  model.metersPerUnit = 0.001;
  model.materials = scene.materials;
  for (const Object& object : scene.objects) {
    const auto* field = dynamic_cast<const DistanceField*>(object.solid.get());
    if (!field || object.materialAt)
      throw InputError(name, "objects", "not all are distance fields of one material: they have no mesh");
    Part part{static_cast<std::uint32_t>(model.indices.size())};
    part.surface = part.object = static_cast<std::uint32_t>(model.parts.size());
    const std::size_t first = model.vertices.size();
    addMesh(*field, scene.center, scene.radius, cell, model);
    part.indexCount = static_cast<std::uint32_t>(model.indices.size()) - part.firstIndex;
    model.parts.push_back(part);
    model.surfaces.emplace_back().material = object.material;
    for (std::size_t i = first; scene.albedo && i < model.vertices.size(); ++i) {
      const std::array<float, 3>& p = model.vertices[i].position;
      const glm::vec3 color(scene.albedo({p[0], p[1], p[2]}));
      model.vertices[i].color = {color.x, color.y, color.z};
    }
  }
  return model;
}

Model simplified(const Model& model, double ratio) {
  if (!(ratio > 0 && ratio <= 1))
    throw InputError(model.name, "simplify", std::to_string(ratio) + " is not above 0 and at most 1");
  Model result = model;
  if (ratio == 1) return result;
  constexpr float kAnyError = 1;  // of the model's extents: the ratio alone ends the collapse
  result.indices.clear();
  for (Part& part : result.parts) {
    const std::uint32_t* const triangles = model.indices.data() + part.firstIndex;
    const std::size_t wanted = static_cast<std::size_t>(ratio * part.indexCount / 3) * 3;
    std::vector<std::uint32_t> kept(part.indexCount);
    // A part is not emptied: it would let all light through.
    if (const std::size_t count =
            meshopt_simplify(kept.data(), triangles, part.indexCount, &model.vertices[0].position[0],
                             model.vertices.size(), sizeof(Vertex), wanted, kAnyError, 0, nullptr);
        count > 0)
      kept.resize(count);
    else
      kept.assign(triangles, triangles + part.indexCount);
    part.firstIndex = static_cast<std::uint32_t>(result.indices.size());
    part.indexCount = static_cast<std::uint32_t>(kept.size());
    result.indices.insert(result.indices.end(), kept.begin(), kept.end());
  }
  return result;
}

}  // namespace pellucid::harness
