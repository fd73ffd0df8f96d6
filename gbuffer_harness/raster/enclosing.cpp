#include "raster/enclosing.h"

#include <limits>
#include <map>
#include <set>

#include "common/error.h"
#include "raster/places.h"
#include "scene/vector.h"

namespace pellucid::harness {

std::optional<std::string> enclosingBody(const Model& model, const std::array<double, 3>& point) {
  struct Body {
    double angle = 0;
    std::optional<std::string> surface;
  };
  std::map<std::uint32_t, Body> bodies;
  const glm::dvec3 from = toGlm(point);
  const auto corner = [&](std::uint32_t index) {
    const std::array<float, 3>& p = model.vertices[model.indices[index]].position;
    return glm::dvec3(p[0], p[1], p[2]) - from;
  };
  for (const Part& part : model.parts) {
    Body& body = bodies[part.object];
    const Surface& surface = model.surfaces[part.surface];
    if (surface.material != 0 && !body.surface) body.surface = surface.name;
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; i += 3)
      body.angle += solidAngle(corner(i), corner(i + 1), corner(i + 2));
  }
  for (const auto& [object, body] : bodies) {
    if (body.surface && body.angle > kEnclosed) return body.surface;
  }
  return std::nullopt;
}

std::vector<std::string> opaqueInside(const Model& model) {
  struct Shell {
    glm::dvec3 low = glm::dvec3(std::numeric_limits<double>::infinity()), high = -low;
    std::vector<const Part*> parts;
  };
  const auto position = [&](std::uint32_t index) {
    const std::array<float, 3>& p = model.vertices[model.indices[index]].position;
    return glm::dvec3(p[0], p[1], p[2]);
  };
  std::map<std::uint32_t, Shell> shells;
  for (const Part& part : model.parts) {
    if (model.surfaces[part.surface].material == 0) continue;
    Shell& shell = shells[part.object];
    shell.parts.push_back(&part);
    for (std::uint32_t i = part.firstIndex; i < part.firstIndex + part.indexCount; ++i) {
      shell.low = glm::min(shell.low, position(i));
      shell.high = glm::max(shell.high, position(i));
    }
  }
  std::set<std::string> sentences;
  for (const Part& part : model.parts) {
    const Surface& opaque = model.surfaces[part.surface];
    if (opaque.material != 0 || part.indexCount == 0) continue;
    const glm::dvec3 from = position(part.firstIndex);
    for (const auto& [object, shell] : shells) {
      if (!glm::all(glm::lessThan(shell.low, from)) || !glm::all(glm::lessThan(from, shell.high))) continue;
      double angle = 0;
      for (const Part* around : shell.parts)
        for (std::uint32_t i = around->firstIndex; i < around->firstIndex + around->indexCount; i += 3)
          angle += solidAngle(position(i) - from, position(i + 1) - from, position(i + 2) - from);
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

}  // namespace pellucid::harness
