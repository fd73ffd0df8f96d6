#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <limits>
#include <numbers>

#include "scene/vector.h"
#include "stress/random_parts.h"

namespace pellucid::harness::stress {

namespace {

glm::dvec3 randomDirection(Random& random) {
  const double z = random.real(-1, 1), angle = random.real(0, 2 * std::numbers::pi);
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(angle), r * std::sin(angle), z};
}

// The point that a light shines at: where the middle of the image looks.
struct Target {
  glm::dvec3 center;
  double size;  // of what the image shows there
  double mm;    // of a scene unit
  int materials;
};

// Looks from `eye` along `direction`, right-handed.
glm::dmat4 lightView(const glm::dvec3& eye, const glm::dvec3& direction) {
  const glm::dvec3 up = std::abs(direction.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
  glm::dmat4 view = glm::lookAt(eye, eye + direction, up);
  for (int c = 0; c < 3; ++c) view[c][3] = 0;
  view[3][3] = 1;
  return view;
}

// The light's camera: planar distances of what is at ndc 0, and where the map ends.
struct MapCamera {
  glm::dmat4 view, clip;  // clip from view
  bool perspective;
  double surface;  // planar distance of the target
  double slope;    // of a ray's length over its planar distance, at ndc 1; 0: parallel rays
  double near, far;
  bool reversed;

  float store(PellucidDepthEncoding encoding, double p, double u, double v) const {
    if (encoding == PELLUCID_DEPTH_VIEW_Z) return static_cast<float>(p);
    if (encoding == PELLUCID_DEPTH_DISTANCE)
      return static_cast<float>(p * std::sqrt(1 + slope * slope * (u * u + v * v)));
    const double depth = perspective ? far / (far - near) * (1 - near / p) : (p - near) / (far - near);
    return static_cast<float>(reversed ? 1 - depth : depth);
  }
};

MapCamera mapCamera(Random& random, const Target& target, const glm::dvec3& eye, const glm::dvec3& direction,
                    bool perspective, double tangent) {
  MapCamera m{};
  m.perspective = perspective;
  m.reversed = random.chance(0.4);
  m.view = lightView(eye, direction);
  m.surface = glm::length(target.center - eye);
  m.near = m.surface * (perspective ? 0.01 : 0.1);
  m.far = m.surface * random.real(3, 30);
  m.slope = perspective ? tangent : 0;
  m.clip = glm::dmat4(0);
  m.clip[0][0] = m.clip[1][1] = perspective ? 1 / tangent : 1 / (target.size * random.real(0.4, 1.5));
  const double range = m.far - m.near;
  if (perspective) {
    m.clip[2][2] = m.reversed ? m.near / range : -m.far / range;
    m.clip[3][2] = m.reversed ? m.far * m.near / range : -m.far * m.near / range;
    m.clip[2][3] = -1;
  } else {
    m.clip[2][2] = m.reversed ? 1 / range : -1 / range;
    m.clip[3][2] = m.reversed ? m.far / range : -m.near / range;
    m.clip[3][3] = 1;
  }
  return m;
}

// Adds what an engine's rasterizer adds to the depths, up to as much as the part is thick.
void addOffsets(Random& random, bool wild, const Target& target, const MapCamera& camera, ShadowMap& map) {
  const double thickness = random.magnitude(0.01, 3) / target.mm;
  const double unit = std::abs(static_cast<double>(
      camera.store(map.depth.encoding, std::min(camera.surface + thickness, camera.far), 0, 0) -
      camera.store(map.depth.encoding, camera.surface, 0, 0)));
  if (random.chance(0.5)) map.depthBiasConstant = random.real(-1, 1) * unit;
  if (random.chance(0.5)) map.depthBiasSlope = random.real(-4, 4);
  if (random.chance(0.3)) map.offsetLength = random.real() * thickness;
  if (random.chance(0.3)) map.depthStep = random.magnitude(1e-4, 0.3) * unit;
  if (!wild || !random.chance(0.2)) return;
  map.depthBiasConstant = random.of({0.0, 1e15, -1e15});
  map.depthBiasSlope = random.of({0.0, 1e6, -1e6});
  map.offsetLength = random.of({0.0, 1e-30, 1e15});
  map.depthStep = random.of({0.0, 1e-30, 1e15});
}

ShadowMap randomMap(Random& random, bool wild, const Target& target, const MapCamera& camera, bool sidecars) {
  ShadowMap map;
  map.depth.encoding = random.of({PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z, PELLUCID_DEPTH_DISTANCE});
  map.clipFromWorld = fromGlm(camera.clip * camera.view);
  if (map.depth.encoding != PELLUCID_DEPTH_DEVICE || random.chance(0.3))
    map.viewFromWorld = fromGlm(camera.view);
  const int side = random.chance(0.05) ? random.whole(1, 4) : random.of({16, 32, 64});
  map.depth.image = Image(side, side, 1);
  const bool exits = sidecars && random.chance(0.3), casters = sidecars && random.chance(0.3);
  if (exits) map.exitDepth = Image(side, side, 1);
  if (casters) map.casterMaterial.resize(map.depth.image.pixels());
  const double thickness = random.magnitude(0.1, 30) / target.mm, rough = thickness * random.real(0, 0.8);
  const double slopeX = random.real(-0.5, 0.5) * target.size, slopeY = random.real(-0.5, 0.5) * target.size;
  const double waves = random.real(1, 20), holes = random.chance(0.3) ? random.real(0, 0.5) : 0;
  const double gap = random.magnitude(0.3, 3) * thickness;
  const double share = wild && random.chance(0.5) ? random.magnitude(1e-3, 1) : 0;
  const bool device = map.depth.encoding == PELLUCID_DEPTH_DEVICE;
  const float nothing = device ? (camera.reversed ? 0.0f : 1.0f) : kNoDepth;
  std::size_t i = 0;
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x, ++i) {
      const double u = (x + 0.5) / side * 2 - 1, v = (y + 0.5) / side * 2 - 1;
      double p = camera.surface - thickness + slopeX * u + slopeY * v + rough * std::sin(waves * (u + 2 * v));
      p = std::clamp(p, camera.near * 1.001, camera.far * 0.999);
      const bool empty = holes > 0 && random.chance(holes);
      map.depth.image.data[i] = empty ? nothing : camera.store(map.depth.encoding, p, u, v);
      if (exits)
        map.exitDepth.data[i] =
            empty || random.chance(0.2)
                ? nothing
                : camera.store(map.depth.encoding, std::min(p + gap, camera.far * 0.999), u, v);
      if (casters && !empty)
        map.casterMaterial[i] = static_cast<std::uint8_t>(random.whole(0, target.materials));
      if (share == 0 || !random.chance(share)) continue;
      map.depth.image.data[i] = badFloat(random);
      if (exits) map.exitDepth.data[i] = badFloat(random);
    }
  if (random.chance(0.3)) addOffsets(random, wild, target, camera, map);
  if (wild && random.chance(0.1)) {  // nearly a line: x and y differ by many magnitudes
    const double squeeze = random.magnitude(1e-12, 1e-3);
    for (std::size_t c = 0; c < 4; ++c) map.clipFromWorld[4 * c] *= squeeze;
  }
  return map;
}

// Gives all maps places in one image, with texels between them that belong to none.
void shareImage(Random& random, std::vector<Light>& lights) {
  const bool layers = random.chance(0.2);
  int count = 0, right = 0;
  for (Light& light : lights)
    for (ShadowMap& map : light.shadowMaps) {
      map.sharedImage = 0;
      if (layers) map.layer = count;
      map.offset = {layers ? random.whole(0, 3) : right + random.whole(0, 3), random.whole(0, 9)};
      right = map.offset[0] + map.depth.image.width;
      ++count;
    }
}

void addMaps(Random& random, bool wild, const Target& target, Light& light) {
  const glm::dvec3 direction = toGlm(light.direction);
  if (light.type == PELLUCID_LIGHT_DIRECTIONAL) {
    const int cascades = random.chance(0.8) ? 1 : random.whole(2, 3);
    const glm::dvec3 eye = target.center - direction * target.size * random.real(1, 4);
    for (int i = 0; i < cascades; ++i)
      light.shadowMaps.push_back(
          randomMap(random, wild, target, mapCamera(random, target, eye, direction, false, 0), cascades < 3));
    return;
  }
  const glm::dvec3 eye = toGlm(light.position);
  if (light.type == PELLUCID_LIGHT_POINT && random.chance(0.2)) {
    for (const glm::dvec3 axis : {glm::dvec3(1, 0, 0), glm::dvec3(-1, 0, 0), glm::dvec3(0, 1, 0),
                                  glm::dvec3(0, -1, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, 0, -1)})
      light.shadowMaps.push_back(
          randomMap(random, wild, target, mapCamera(random, target, eye, axis, true, 1), false));
    return;
  }
  light.shadowMaps.push_back(randomMap(
      random, wild, target, mapCamera(random, target, eye, direction, true, random.magnitude(0.2, 2)), true));
}

Light randomLight(Random& random, bool wild, const Target& target, const glm::dvec3& viewAxis) {
  Light light;
  light.type = random.of({PELLUCID_LIGHT_DIRECTIONAL, PELLUCID_LIGHT_POINT, PELLUCID_LIGHT_SPOT});
  // Mostly from behind, from where it comes through.
  glm::dvec3 direction = randomDirection(random);
  if (random.chance(0.7)) direction = glm::normalize(direction - 1.5 * viewAxis);
  const double away =
      target.size * (wild && random.chance(0.2) ? random.magnitude(1e-6, 1e6) : random.magnitude(0.6, 10));
  light.direction = fromGlm(direction);
  const glm::dvec3 position = wild && random.chance(0.1) ? target.center : target.center - direction * away;
  light.position = fromGlm(position);
  for (double& c : light.color) c = random.real(0.1, 1);
  light.intensity = random.magnitude(0.1, 20);
  if (light.type != PELLUCID_LIGHT_DIRECTIONAL) {
    light.intensity = std::min(light.intensity * away * away, 1e15);
    if (random.chance(0.3)) light.range = std::min(away * random.magnitude(0.5, 10), 1e15);
    light.outerConeAngle = random.real(0.2, 1.57);
    light.innerConeAngle = light.outerConeAngle * random.real(0, 0.95);
  }
  if (wild && random.chance(0.3)) light.intensity = random.of({0.0, 1e-30, 1e15});
  if (wild && random.chance(0.1)) light.color = {0, 1e15, 1e-30};
  // No camera looks from where it looks to.
  if (random.chance(0.75) && glm::length(target.center - position) > 0) addMaps(random, wild, target, light);
  if (random.chance(0.1))
    for (ShadowMap& map : light.shadowMaps) map.backFaces = true;
  if (wild && random.chance(0.2)) {
    const double length = random.magnitude(1e-10, 1e10);
    for (double& d : light.direction) d *= length;
  }
  return light;
}

// Irradiance that the light brings to the surfaces that face it, as an engine's irradiance has it, shadows
// left out: a gather takes its share of that from there.
void addDirectLight(const Light& light, const View& view, Capture& c) {
  const glm::dmat3 toWorld(view.worldFromView);
  const glm::dvec3 position = toGlm(light.position), travel = glm::normalize(toGlm(light.direction));
  std::size_t i = 0;
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x, ++i) {
      if (view.planar[i] == 0) continue;
      glm::dvec3 toLight = -travel;
      double falloff = 1;
      if (light.type != PELLUCID_LIGHT_DIRECTIONAL) {
        toLight = position - glm::dvec3(view.worldFromView * glm::dvec4(view.point(x, y, view.planar[i]), 1));
        const double square = std::max(glm::dot(toLight, toLight), 1e-12);
        falloff = 1 / square;
        toLight /= std::sqrt(square);
      }
      const double cosine = std::clamp(glm::dot(toWorld * view.normal(x, y), toLight), 0.0, 1.0);
      for (std::size_t k = 0; k < 3; ++k)
        c.irradiance.data[4 * i + k] +=
            static_cast<float>(light.intensity * falloff * cosine * light.color[k]);
    }
}

}  // namespace

void addRandomLights(Random& random, bool wild, const View& view, Capture& capture) {
  const glm::dvec3 center = glm::dvec3(
      view.worldFromView * glm::dvec4(view.point(view.width * 0.5, view.height * 0.5, view.distance), 1));
  const Target target{center, view.pixel * std::max(view.width, view.height), view.mm,
                      static_cast<int>(capture.materials.size())};
  const glm::dvec3 axis = glm::dmat3(view.worldFromView) * glm::dvec3(0, 0, view.sign);
  int count = random.of({0, 1, 1, 1, 2, 2, 3});
  if (random.chance(0.03)) count = random.whole(4, wild ? 12 : 6);
  for (int i = 0; i < count; ++i) capture.lights.push_back(randomLight(random, wild, target, axis));
  if (random.chance(0.2)) shareImage(random, capture.lights);
  if (wild && random.chance(0.3)) return;
  for (const Light& light : capture.lights) addDirectLight(light, view, capture);
}

}  // namespace pellucid::harness::stress
