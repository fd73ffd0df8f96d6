#include "raster/bodies.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <numeric>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "common/error.h"
#include "scene/vector.h"

namespace pellucid::harness {

namespace {

// One number for all vertices at one position, so that seams of texture coordinates do not cut a mesh.
std::vector<std::uint32_t> placesOf(const Model& model) {
  std::map<std::array<float, 3>, std::uint32_t> numbers;
  std::vector<std::uint32_t> places;
  for (const Vertex& vertex : model.vertices) {
    std::array<float, 3> position = vertex.position;
    for (float& x : position) x += 0.0f;  // -0 is 0
    places.push_back(numbers.emplace(position, static_cast<std::uint32_t>(numbers.size())).first->second);
  }
  return places;
}

// Of Model::indices[index].
glm::dvec3 cornerOf(const Model& model, std::uint32_t index) {
  return positionOf(model.vertices[model.indices[index]]);
}

// Signed solid angle of the triangle of Model::indices from `first` on, as seen from the point. Van Oosterom
// & Strackee 1983, "The solid angle of a plane triangle".
double solidAngle(const Model& model, std::uint32_t first, const glm::dvec3& from) {
  const glm::dvec3 a = cornerOf(model, first) - from, b = cornerOf(model, first + 1) - from,
                   c = cornerOf(model, first + 2) - from;
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double divisor = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2 * std::atan2(glm::dot(a, glm::cross(b, c)), divisor);
}

// Of a whole part.
double solidAngle(const Model& model, const Part& part, const glm::dvec3& from) {
  double angle = 0;
  for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
    angle += solidAngle(model, i, from);
  return angle;
}

// A closed surface spans 4 pi from each point inside and 0 from outside or from a hollow. A bowl spans up to
// half of it where nothing encloses a point; the eighth that may be missing is that of meshes with small
// holes.
constexpr double kEnclosed = 0.875 * 4 * std::numbers::pi;

// Parts that are closer than this share of the smaller one's diagonal touch: seams err by what their meshes
// miss of one curve.
constexpr double kTouching = 1e-3;

// Numbers of one medium. Each takes constants; the far bodies of a crowd share numbers.
constexpr std::size_t kMostNumbers = 16;
constexpr std::size_t kMostMaterials = 255;  // 8 bits, 0 is none

struct Box {
  glm::dvec3 low = glm::dvec3(std::numeric_limits<double>::infinity()), high = -low;

  void add(const glm::dvec3& point) {
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  void add(const Box& box) {
    low = glm::min(low, box.low);
    high = glm::max(high, box.high);
  }
  Box grown(double by) const { return {low - by, high + by}; }
  bool meets(const Box& box) const {
    return glm::all(glm::lessThanEqual(low, box.high)) && glm::all(glm::lessThanEqual(box.low, high));
  }
  bool contains(const Box& box) const {
    return glm::all(glm::lessThanEqual(low, box.low)) && glm::all(glm::lessThanEqual(box.high, high));
  }
  double diagonal() const { return glm::length(high - low); }
};

double distance(const Box& a, const Box& b) {
  return glm::length(glm::max(glm::max(a.low - b.high, b.low - a.high), glm::dvec3(0)));
}

class Sets {
public:
  explicit Sets(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }

  std::uint32_t of(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[of(a)] = of(b); }

private:
  std::vector<std::uint32_t> parent_;
};

using Triangle = std::array<glm::dvec3, 3>;

Box boxOf(const Triangle& t) {
  Box box;
  for (const glm::dvec3& corner : t) box.add(corner);
  return box;
}

// Ericson, "Real-Time Collision Detection", 5.1.5.
glm::dvec3 closestPoint(const glm::dvec3& p, const Triangle& t) {
  const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], ap = p - t[0], bp = p - t[1], cp = p - t[2];
  const double d1 = glm::dot(ab, ap), d2 = glm::dot(ac, ap);
  if (d1 <= 0 && d2 <= 0) return t[0];
  const double d3 = glm::dot(ab, bp), d4 = glm::dot(ac, bp);
  if (d3 >= 0 && d4 <= d3) return t[1];
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? t[0] + d1 / (d1 - d3) * ab : t[0];
  const double d5 = glm::dot(ab, cp), d6 = glm::dot(ac, cp);
  if (d6 >= 0 && d5 <= d6) return t[2];
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 > d6 ? t[0] + d2 / (d2 - d6) * ac : t[0];
  const double va = d3 * d6 - d5 * d4, toC = d4 - d3, toB = d5 - d6;
  if (va <= 0 && toC >= 0 && toB >= 0) return toC + toB > 0 ? t[1] + toC / (toC + toB) * (t[2] - t[1]) : t[1];
  const double sum = va + vb + vc;
  return sum > 0 ? t[0] + vb / sum * ab + vc / sum * ac : t[0];
}

// True where the segment runs through the triangle.
bool pierces(const glm::dvec3& from, const glm::dvec3& to, const Triangle& t) {
  const glm::dvec3 along = to - from, ab = t[1] - t[0], ac = t[2] - t[0], cross = glm::cross(along, ac);
  const double determinant = glm::dot(ab, cross);
  if (determinant == 0) return false;
  const glm::dvec3 off = from - t[0], other = glm::cross(off, ab);
  const double u = glm::dot(off, cross) / determinant, v = glm::dot(along, other) / determinant,
               at = glm::dot(ac, other) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && at >= 0 && at <= 1;
}

bool touch(const Triangle& a, const Triangle& b, double tolerance) {
  for (const auto& [one, other] : {std::pair(&a, &b), std::pair(&b, &a)})
    for (std::size_t i = 0; i < 3; ++i) {
      const glm::dvec3& corner = (*one)[i];
      if (glm::distance(corner, closestPoint(corner, *other)) <= tolerance) return true;
      if (pierces(corner, (*one)[(i + 1) % 3], *other)) return true;
    }
  return false;
}

// Triangles that share corners, of one medium.
struct Piece {
  std::uint8_t material = 0;
  Box box;
  std::vector<std::uint32_t> triangles;  // first places in Model::indices
};

class Bodies {
public:
  explicit Bodies(const Model& model, bool opaque = false) : model_(model) {
    std::vector<std::uint32_t> triangles;
    std::vector<std::uint8_t> materials;
    for (const Part& part : model.parts) {
      const std::uint8_t material = model.surfaces[part.surface].material;
      if ((material == 0) != opaque) continue;
      for (std::uint32_t i = 0; i + 2 < part.indexCount; i += 3) {
        triangles.push_back(part.firstIndex + i);
        materials.push_back(material);
      }
    }
    findPieces(triangles, materials);
  }

  const std::vector<Piece>& pieces() const { return pieces_; }

  // The body of each piece, numbered in the order of their first triangles.
  std::vector<std::uint32_t> bodies() {
    Sets sets(pieces_.size());
    std::vector<std::uint32_t> byX(pieces_.size());
    std::iota(byX.begin(), byX.end(), 0u);
    std::sort(byX.begin(), byX.end(),
              [&](std::uint32_t a, std::uint32_t b) { return pieces_[a].box.low.x < pieces_[b].box.low.x; });
    for (std::size_t i = 0; i < byX.size(); ++i)
      for (std::size_t k = i + 1; k < byX.size(); ++k) {
        const Piece &a = pieces_[byX[i]], &b = pieces_[byX[k]];
        const double tolerance = kTouching * std::min(a.box.diagonal(), b.box.diagonal());
        if (b.box.low.x > a.box.high.x + kTouching * a.box.diagonal()) break;
        if (a.material != b.material || sets.of(byX[i]) == sets.of(byX[k])) continue;
        if (hangTogether(a, b, tolerance)) sets.join(byX[i], byX[k]);
      }
    std::map<std::uint32_t, std::uint32_t> numbers;
    std::vector<std::uint32_t> result;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i)
      result.push_back(numbers.emplace(sets.of(i), static_cast<std::uint32_t>(numbers.size())).first->second);
    return result;
  }

private:
  Triangle triangle(std::uint32_t first) const {
    return {cornerOf(model_, first), cornerOf(model_, first + 1), cornerOf(model_, first + 2)};
  }

  void findPieces(const std::vector<std::uint32_t>& triangles, const std::vector<std::uint8_t>& materials) {
    const std::vector<std::uint32_t> places = placesOf(model_);
    Sets sets(triangles.size());
    std::map<std::uint8_t, std::vector<std::uint32_t>> firstAt;  // of a medium, by place: a triangle + 1
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      std::vector<std::uint32_t>& first = firstAt[materials[i]];
      if (first.empty()) first.resize(model_.vertices.size());
      for (std::uint32_t k = 0; k < 3; ++k) {
        std::uint32_t& known = first[places[model_.indices[triangles[i] + k]]];
        if (known == 0)
          known = i + 1;
        else
          sets.join(i, known - 1);
      }
    }
    std::vector<std::uint32_t> pieceOf(triangles.size());  // + 1
    for (std::uint32_t i = 0; i < triangles.size(); ++i) {
      std::uint32_t& piece = pieceOf[sets.of(i)];
      if (piece == 0) {
        pieces_.push_back({materials[i], {}, {}});
        piece = static_cast<std::uint32_t>(pieces_.size());
      }
      pieces_[piece - 1].triangles.push_back(triangles[i]);
      pieces_[piece - 1].box.add(boxOf(triangle(triangles[i])));
    }
  }

  bool hangTogether(const Piece& a, const Piece& b, double tolerance) const {
    if (!a.box.grown(tolerance).meets(b.box)) return false;
    return isInside(a, b) || isInside(b, a) || touchEachOther(a, b, tolerance);
  }

  // The hollow of a body is a piece of its own.
  bool isInside(const Piece& inner, const Piece& outer) const {
    if (!outer.box.contains(inner.box)) return false;
    const glm::dvec3 point = cornerOf(model_, inner.triangles.front());
    double angle = 0;
    for (const std::uint32_t first : outer.triangles) angle += solidAngle(model_, first, point);
    return std::abs(angle) > kEnclosed;
  }

  // Sweeps along x over the triangles that lie where both pieces are.
  bool touchEachOther(const Piece& a, const Piece& b, double tolerance) const {
    struct Entry {
      Box box;
      Triangle triangle;
    };
    std::array<std::vector<Entry>, 2> near;
    for (const std::size_t side : {0u, 1u}) {
      const Box other = (side == 0 ? b : a).box.grown(tolerance);
      for (const std::uint32_t first : (side == 0 ? a : b).triangles) {
        const Triangle t = triangle(first);
        const Box box = boxOf(t);
        if (box.meets(other)) near[side].push_back({box.grown(0.5 * tolerance), t});
      }
      std::sort(near[side].begin(), near[side].end(),
                [](const Entry& x, const Entry& y) { return x.box.low.x < y.box.low.x; });
    }
    for (const std::size_t side : {0u, 1u}) {
      // Each pair comes up once: where the second triangle begins within the first.
      auto next = near[1 - side].begin();
      for (const Entry& entry : near[side]) {
        while (next != near[1 - side].end() && next->box.low.x < entry.box.low.x) ++next;
        for (auto other = next; other != near[1 - side].end() && other->box.low.x <= entry.box.high.x;
             ++other)
          if (entry.box.meets(other->box) && touch(entry.triangle, other->triangle, tolerance)) return true;
      }
    }
    return false;
  }

  const Model& model_;
  std::vector<Piece> pieces_;
};

// Numbers of bodies: those within `reach` of another body have another number where there are enough.
class Numbers {
public:
  Numbers(Model& model, const std::vector<double>& reach)
      : model_(model), reach_(reach), numbers_(reach.size()), holders_(reach.size()) {
    for (std::size_t i = 0; i < numbers_.size(); ++i) numbers_[i] = {static_cast<std::uint8_t>(i + 1)};
  }

  std::uint8_t of(std::uint8_t material, const Box& box) {
    std::vector<std::uint8_t>& numbers = numbers_[material - 1u];
    const double reach = reach_.at(material - 1u) / (1000 * model_.metersPerUnit);
    if (!(reach > 0)) return material;
    std::uint8_t best = material;
    double farthest = -1;
    for (const std::uint8_t number : numbers) {
      double nearest = std::numeric_limits<double>::infinity();
      for (const Box& held : holders_[number - 1u]) nearest = std::min(nearest, distance(held, box));
      if (nearest > farthest) {
        farthest = nearest;
        best = number;
      }
      if (nearest > reach) break;  // the first that will do
    }
    if (farthest <= reach && numbers.size() < kMostNumbers && holders_.size() < kMostMaterials) {
      model_.bodies.push_back(static_cast<std::uint8_t>(material - 1));
      holders_.emplace_back();
      best = static_cast<std::uint8_t>(holders_.size());
      numbers.push_back(best);
    }
    holders_[best - 1u].push_back(box);
    return best;
  }

private:
  Model& model_;
  const std::vector<double>& reach_;
  std::vector<std::vector<std::uint8_t>> numbers_;  // by medium
  std::vector<std::vector<Box>> holders_;           // by number
};

// Cuts parts where their triangles have other numbers. `numberOf`: of triangles, by their first places; 0:
// their own.
void renumber(Model& model, const std::vector<std::uint8_t>& numberOf) {
  std::map<std::pair<std::uint32_t, std::uint8_t>, std::uint32_t> copies;
  std::vector<Part> parts;
  for (const Part& part : model.parts) {
    const std::uint8_t material = model.surfaces[part.surface].material;
    std::map<std::uint8_t, std::vector<std::uint32_t>> byNumber;
    for (std::uint32_t i = part.firstIndex; i + 2 < part.firstIndex + part.indexCount; i += 3) {
      const std::uint8_t number = numberOf[i] == 0 ? material : numberOf[i];
      for (std::uint32_t k = 0; k < 3; ++k) byNumber[number].push_back(model.indices[i + k]);
    }
    std::uint32_t first = part.firstIndex;
    for (const auto& [number, indices] : byNumber) {
      Part cut = part;
      cut.firstIndex = first;
      cut.indexCount = static_cast<std::uint32_t>(indices.size());
      if (number != material) {
        const auto [copy, isNew] =
            copies.try_emplace({part.surface, number}, static_cast<std::uint32_t>(model.surfaces.size()));
        if (isNew) {
          model.surfaces.push_back(Surface(model.surfaces[part.surface]));
          model.surfaces.back().material = number;
        }
        cut.surface = copy->second;
      }
      std::copy(indices.begin(), indices.end(), model.indices.begin() + first);
      first += cut.indexCount;
      parts.push_back(cut);
    }
  }
  model.parts = std::move(parts);
}

}  // namespace

BodySeparation separateBodies(Model& model, const std::vector<double>& reach) {
  Bodies found(model);
  const std::vector<std::uint32_t> bodyOf = found.bodies();
  BodySeparation result;
  for (const std::uint32_t body : bodyOf) result.bodies = std::max<std::size_t>(result.bodies, body + 1u);
  std::vector<Box> boxes(result.bodies);
  std::vector<std::uint8_t> numbers(result.bodies);
  for (std::size_t i = 0; i < bodyOf.size(); ++i) {
    boxes[bodyOf[i]].add(found.pieces()[i].box);
    numbers[bodyOf[i]] = found.pieces()[i].material;
  }
  Numbers chosen(model, reach);
  for (std::size_t i = 0; i < numbers.size(); ++i) numbers[i] = chosen.of(numbers[i], boxes[i]);
  result.added = model.bodies.size();
  if (result.added == 0) return result;
  std::vector<std::uint8_t> numberOf(model.indices.size());
  for (std::size_t i = 0; i < bodyOf.size(); ++i)
    for (const std::uint32_t first : found.pieces()[i].triangles) numberOf[first] = numbers[bodyOf[i]];
  renumber(model, numberOf);
  return result;
}

void joinBodies(Model& model) {
  const std::size_t media = model.materials.size();
  for (Surface& surface : model.surfaces)
    if (surface.material > media)
      surface.material = static_cast<std::uint8_t>(model.bodies.at(surface.material - media - 1) + 1);
  model.bodies.clear();
}

std::vector<MaterialSource> withBodies(std::vector<MaterialSource> materials,
                                       const std::vector<std::uint8_t>& bodies) {
  for (const std::uint8_t of : bodies) materials.push_back(MaterialSource(materials.at(of)));
  return materials;
}

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

// Triangles from the loop's center to its edges, turned so that each edge is run through backwards.
void fill(Model& model, std::uint32_t object, const std::vector<LooseEdge>& loop) {
  Vertex center = model.vertices[loop[0].from.vertex];
  glm::dvec3 middle(0), normal(0);
  for (const LooseEdge& edge : loop) middle += positionOf(model.vertices[edge.from.vertex]);
  middle /= static_cast<double>(loop.size());
  for (const LooseEdge& edge : loop)
    normal += glm::cross(positionOf(model.vertices[edge.to.vertex]) - middle,
                         positionOf(model.vertices[edge.from.vertex]) - middle);
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

std::optional<std::string> enclosingBody(const Model& model, const std::array<double, 3>& point) {
  struct Body {
    double angle = 0;
    std::optional<std::string> surface;
  };
  std::map<std::uint32_t, Body> bodies;
  for (const Part& part : model.parts) {
    Body& body = bodies[part.object];
    const Surface& surface = model.surfaces[part.surface];
    if (holdsMedium(model, surface) && !body.surface) body.surface = surface.name;
    body.angle += solidAngle(model, part, toGlm(point));
  }
  for (const auto& [object, body] : bodies) {
    if (body.surface && body.angle > kEnclosed) return body.surface;
  }
  return std::nullopt;
}

std::vector<std::string> opaqueInside(const Model& model) {
  struct Shell {
    Box box;
    std::vector<const Part*> parts;
  };
  std::map<std::uint32_t, Shell> shells;
  for (const Part& part : model.parts) {
    if (model.surfaces[part.surface].material == 0) continue;
    Shell& shell = shells[part.object];
    shell.parts.push_back(&part);
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i)
      shell.box.add(cornerOf(model, i));
  }
  std::set<std::string> sentences;
  for (const Part& part : model.parts) {
    const Surface& opaque = model.surfaces[part.surface];
    if (opaque.material != 0 || part.indexCount == 0) continue;
    const glm::dvec3 from = cornerOf(model, part.firstIndex);
    for (const auto& [object, shell] : shells) {
      if (!shell.box.contains({from, from})) continue;
      double angle = 0;
      for (const Part* around : shell.parts) angle += solidAngle(model, *around, from);
      if (angle > kEnclosed)
        sentences.insert(
            model.name + ": opaque \"" + opaque.name + "\" lies inside \"" +
            model.surfaces[shell.parts.front()->surface].name +
            "\": what is narrower than 4 times the body's thickness there blocks too little light in a "
            "replay, up to 14 % of what comes through without it; `pellucid truth` has the right light");
    }
  }
  return {sentences.begin(), sentences.end()};
}

void refuseEnclosedLights(const Model& model) {
  for (std::size_t i = 0; i < model.lights.size(); ++i) {
    const Light& light = model.lights[i];
    if (light.type == PELLUCID_LIGHT_DIRECTIONAL) continue;
    if (const auto surface = enclosingBody(model, light.position))
      throw InputError(model.name, "lights[" + std::to_string(i) + "].position",
                       "lies inside the translucent body \"" + *surface +
                           "\": shadow maps hold the faces where light enters, and this light enters none; "
                           "move it outside, or give the body a hollow around it");
  }
}

namespace {

// A glowing surface that spans a quarter of what a light sees is the lamp that the light stands for.
constexpr double kLamp = std::numbers::pi;

struct Lamp {
  std::string surface;            // name of a glowing one, or of the first
  double glowing = 0, whole = 0;  // solid angles, as the light sees them
};

// Light reaches a translucent surface in the room that a piece encloses.
bool holdsTranslucent(const Model& model, const Piece& piece) {
  return std::any_of(model.parts.begin(), model.parts.end(), [&](const Part& part) {
    if (model.surfaces[part.surface].material == 0 || part.indexCount == 0) return false;
    double angle = 0;
    for (const std::uint32_t first : piece.triangles)
      angle += solidAngle(model, first, cornerOf(model, part.firstIndex));
    return std::abs(angle) > kEnclosed;
  });
}

void removeTriangles(Model& model, const std::set<std::uint32_t>& removed) {
  std::vector<std::uint32_t> indices;
  for (Part& part : model.parts) {
    const auto first = static_cast<std::uint32_t>(indices.size());
    for (std::uint32_t i = part.firstIndex; i + 2 < part.firstIndex + part.indexCount; i += 3)
      if (!removed.count(i)) indices.insert(indices.end(), &model.indices[i], &model.indices[i] + 3);
    part.firstIndex = first;
    part.indexCount = static_cast<std::uint32_t>(indices.size()) - first;
  }
  model.indices = std::move(indices);
  std::erase_if(model.parts, [](const Part& part) { return part.indexCount == 0; });
}

}  // namespace

std::vector<std::string> openLamps(Model& model) {
  const Bodies opaque(model, true);
  std::vector<const Surface*> surfaceAt(model.indices.size());
  for (const Part& part : model.parts)
    std::fill_n(surfaceAt.begin() + part.firstIndex, part.indexCount, &model.surfaces[part.surface]);
  std::vector<std::string> sentences;
  std::set<std::uint32_t> removed;
  for (std::size_t i = 0; i < model.lights.size(); ++i) {
    if (model.lights[i].type == PELLUCID_LIGHT_DIRECTIONAL) continue;
    const glm::dvec3 at = toGlm(model.lights[i].position);
    for (const Piece& piece : opaque.pieces()) {
      Lamp lamp{surfaceAt[piece.triangles.front()]->name};
      for (const std::uint32_t first : piece.triangles) {
        const double angle = solidAngle(model, first, at);
        lamp.whole += angle;
        if (!surfaceAt[first]->isEmissive) continue;
        lamp.glowing += angle;
        lamp.surface = surfaceAt[first]->name;
      }
      const bool isLamp = std::abs(lamp.glowing) > kLamp;
      if (!isLamp && !(std::abs(lamp.whole) > kEnclosed)) continue;
      if (!isLamp && holdsTranslucent(model, piece)) continue;
      const std::string begin = model.name + ": lights[" + std::to_string(i) + "] lies inside ";
      if (isLamp) removed.insert(piece.triangles.begin(), piece.triangles.end());
      sentences.push_back(isLamp ? begin + "or beside glowing \"" + lamp.surface +
                                       "\", which is left out, as it would block the light that stands for it"
                                 : begin + "opaque \"" + lamp.surface +
                                       "\", which lets no light out; --material " + lamp.surface +
                                       "=none leaves it out, and =thin:R,G,B lets light through");
    }
  }
  if (!removed.empty()) removeTriangles(model, removed);
  return sentences;
}

}  // namespace pellucid::harness
