// Shadow maps that contradict the G-buffer: a map holds the surface nearest to its light, so that no surface lies in front of it.
#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>

#include "cli/capture_checks.h"
#include "reference/camera.h"
#include "scene/vector.h"

namespace pellucid::harness {
namespace {

// Texels' sides by which a surface lies in front of a map for certain: slopes across the light's ray and half texels need less.
constexpr double kTexels = 8;

class MapView {
public:
  MapView(const Light& light, const ShadowMap& map)
      : light_(light), map_(map), clipFromWorld_(toGlm(map.clipFromWorld)) {
    if (map.viewFromWorld) viewFromWorld_ = toGlm(*map.viewFromWorld);
  }

  // Nothing outside of the map; true where the map and the texels around have a surface behind `world`, or none at all.
  std::optional<bool> lacks(const glm::dvec3& world) const {
    const glm::dvec4 clip = clipFromWorld_ * glm::dvec4(world, 1);
    const Image& image = map_.depth.image;
    const glm::dvec2 at = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(image.width, image.height);
    if (!(clip.w > 0 && at.x >= 0 && at.y >= 0 && at.x < image.width && at.y < image.height)) return std::nullopt;
    const glm::dvec3 ray = rayAt(world);
    const double side = texelSide(clip.w), own = depthOf(world), sign = depthOf(world + ray * side) > own ? 1 : -1;
    const bool device = map_.depth.encoding == PELLUCID_DEPTH_DEVICE;
    const double farthest = std::max(sign, 0.0);  // of device depths
    if (device && sign * own > sign * farthest) return std::nullopt;  // of another cascade
    const double tolerance = kTexels * side * (1 + std::abs(map_.depthBiasSlope)) + map_.offsetLength;
    // Engines clamp to the near plane what lies before it.
    const double drawn = std::max(sign * depthOf(world + ray * tolerance), device ? std::min(sign, 0.0) : 0.0);
    const double most = drawn + sign * map_.depthBiasConstant + map_.depthStep;
    const auto isNear = [&](int x, int y) {
      const double stored = double(*image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1)));
      const bool holds = device ? sign * stored < sign * farthest : stored > 0 && stored < double(kLeastNoDepth);
      return holds && sign * stored <= most;
    };
    for (int i = 0; i < 9; ++i)
      if (isNear(static_cast<int>(at.x) + i % 3 - 1, static_cast<int>(at.y) + i / 3 - 1)) return false;
    return true;
  }

private:
  glm::dvec3 rayAt(const glm::dvec3& world) const {
    const glm::dvec3 to(light_.direction[0], light_.direction[1], light_.direction[2]),
        from(light_.position[0], light_.position[1], light_.position[2]);
    return glm::normalize(light_.type == PELLUCID_LIGHT_DIRECTIONAL ? to : world - from);
  }

  // The larger side of a texel.
  double texelSide(double w) const {
    const auto side = [&](int row, int texels) {
      const glm::dvec3 across(clipFromWorld_[0][row], clipFromWorld_[1][row], clipFromWorld_[2][row]);
      return 2 * w / (glm::length(across) * texels);
    };
    return std::max(side(0, map_.depth.image.width), side(1, map_.depth.image.height));
  }

  // As the map stores it.
  double depthOf(const glm::dvec3& world) const {
    if (map_.depth.encoding == PELLUCID_DEPTH_DEVICE) {
      const glm::dvec4 clip = clipFromWorld_ * glm::dvec4(world, 1);
      return clip.z / clip.w;
    }
    const glm::dvec3 view = viewFromWorld_ * glm::dvec4(world, 1);
    const bool planar = map_.depth.encoding == PELLUCID_DEPTH_VIEW_Z || light_.type == PELLUCID_LIGHT_DIRECTIONAL;
    return planar ? std::abs(view.z) : glm::length(view);
  }

  const Light& light_;
  const ShadowMap& map_;
  glm::dmat4 clipFromWorld_, viewFromWorld_{1.0};
};

// Positions of surfaces with a material, some thousand at most.
std::vector<glm::dvec3> surfacesOf(const Capture& capture) {
  constexpr std::size_t kMost = 4096;
  const reference::Camera camera(capture.clipFromView, capture.width, capture.height);
  const glm::dmat4 worldFromView = glm::inverse(toGlm(capture.viewFromWorld));
  const std::size_t pixels = capture.material.size() - static_cast<std::size_t>(std::count(capture.material.begin(), capture.material.end(), 0));
  const std::size_t step = pixels / kMost + 1;
  std::vector<glm::dvec3> surfaces;
  std::size_t seen = 0;
  for (std::size_t i = 0; i < capture.material.size(); ++i) {
    if (capture.material[i] == 0 || seen++ % step != 0) continue;
    const auto width = static_cast<std::size_t>(capture.width);
    const int x = static_cast<int>(i % width), y = static_cast<int>(i / width);
    const auto front = camera.planarDepth(*capture.frontDepth.image.at(x, y), capture.frontDepth.encoding);
    if (front) surfaces.emplace_back(worldFromView * glm::dvec4(camera.position({x + 0.5, y + 0.5}, *front), 1));
  }
  return surfaces;
}

}  // namespace

std::vector<std::string> strangeMaps(const Capture& capture) {
  std::vector<std::string> sentences;
  const std::vector<glm::dvec3> surfaces = surfacesOf(capture);
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    std::vector<MapView> views;
    for (const ShadowMap& map : light.shadowMaps)
      if (!map.backFaces) views.emplace_back(light, map);
    if (views.empty() || surfaces.empty()) continue;
    std::size_t inside = 0, lacking = 0;
    for (const glm::dvec3& surface : surfaces)
      for (const MapView& view : views)
        if (const auto lacks = view.lacks(surface)) {
          ++inside;
          lacking += *lacks;
          break;
        }
    const std::string name = "lights[" + std::to_string(i) + (light.shadowMaps.size() > 1 ? "].shadowMaps: " : "].shadowMap: ");
    // Silhouettes, hair and undrawn bodies are fewer. Maps of back faces lack what is lit.
    constexpr double kMostLacking = 0.2;
    constexpr std::size_t kFewest = 16;  // of fewer, a silhouette decides
    if (inside >= kFewest && double(lacking) > kMostLacking * double(inside))
      sentences.push_back(name + std::to_string(100 * lacking / inside) +
                          " % of the surfaces in it lie in front of what it shows: another frame, matrix, unit or encoding, a bias that no "
                          "field states, culled front faces (\"faces\": \"back\"), or bodies that the map lacks");
    else if (inside == 0 && light.type == PELLUCID_LIGHT_DIRECTIONAL)
      sentences.push_back(name + "no surface with a material lies in it: another matrix or unit");
  }
  return sentences;
}

}  // namespace pellucid::harness
