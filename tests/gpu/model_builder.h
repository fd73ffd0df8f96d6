// Models of squares, cubes and spheres for tests of the rasterizer, and the rays of their cameras.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "raster/model.h"
#include "raster/raster.h"
#include "scene/camera.h"

namespace pellucid::test {

using namespace pellucid::harness;

inline Vertex vertexAt(const Vector3& position, const Vector3& normal) {
  Vertex v{};
  for (std::size_t i = 0; i < 3; ++i) {
    v.position[i] = static_cast<float>(position[i]);
    v.normal[i] = static_cast<float>(normal[i]);
  }
  return v;
}

// Square frames of `side` pixels, with maps that cost little.
inline RasterOptions smallRaster(int side) {
  const RasterOptions options{.width = side, .height = side, .shadowSize = 64};
  return options;
}

// Model of one surface of material 1, "skin1"; 1 unit is 1 mm.
inline Model emptyModel() {
  Model model;
  model.name = "test";
  model.metersPerUnit = 0.001;
  model.surfaces.resize(1);
  model.surfaces[0].baseColor = {0.5, 0.25, 0.125};
  model.surfaces[0].material = 1;
  model.materials = {PresetMaterial{"skin1"}};
  return model;
}

// A part of everything that was added since the last one.
inline void endPart(Model& model, std::uint32_t object, std::uint32_t surface = 0) {
  const std::uint32_t first =
      model.parts.empty() ? 0 : model.parts.back().firstIndex + model.parts.back().indexCount;
  model.parts.push_back({first, static_cast<std::uint32_t>(model.indices.size()) - first, surface, object});
}

// Corners counterclockwise as seen from the side the normal points to.
inline void addQuad(Model& model, const Vector3 (&corners)[4], const Vector3& normal) {
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  for (const Vector3& corner : corners) model.vertices.push_back(vertexAt(corner, normal));
  for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) model.indices.push_back(first + i);
}

// Axis-aligned square facing +z.
inline void addSquare(Model& model, double x, double y, double z, double half) {
  addQuad(
      model,
      {{x - half, y - half, z}, {x + half, y - half, z}, {x + half, y + half, z}, {x - half, y + half, z}},
      {0, 0, 1});
}

inline void addCube(Model& model, double half) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Vector3 n{}, u{}, v{};
      n[axis] = sign;
      u[(axis + 1) % 3] = sign;
      v[(axis + 2) % 3] = 1;
      const auto corner = [&](double a, double b) {
        Vector3 p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = half * (n[i] + a * u[i] + b * v[i]);
        return p;
      };
      addQuad(model, {corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}, n);
    }
}

// Turns the triangles to be seen from the other side.
inline void turnOver(Model& model, std::size_t firstIndex) {
  for (std::size_t i = firstIndex; i < model.indices.size(); i += 3)
    std::swap(model.indices[i], model.indices[i + 1]);
}

inline void addSphere(Model& model, const Vector3& center, double radius, std::uint32_t rings) {
  const auto first = static_cast<std::uint32_t>(model.vertices.size());
  const std::uint32_t segments = 2 * rings;
  for (std::uint32_t i = 0; i <= rings; ++i)
    for (std::uint32_t j = 0; j < segments; ++j) {
      const double theta = std::numbers::pi * i / rings, phi = 2 * std::numbers::pi * j / segments;
      const Vector3 n{std::sin(theta) * std::cos(phi), std::cos(theta), std::sin(theta) * std::sin(phi)};
      model.vertices.push_back(
          vertexAt({center[0] + radius * n[0], center[1] + radius * n[1], center[2] + radius * n[2]}, n));
    }
  for (std::uint32_t i = 0; i < rings; ++i)
    for (std::uint32_t j = 0; j < segments; ++j) {
      const std::uint32_t next = (j + 1) % segments;
      const std::uint32_t a = first + i * segments + j, b = first + i * segments + next;
      for (const std::uint32_t k : {a, b, a + segments, b, b + segments, a + segments})
        model.indices.push_back(k);
    }
}

// Looks at the origin, along -z from z = 100 by default; 20 mm tall.
inline ModelCamera frontCamera(bool orthographic, const Vector3& eye = {0, 0, 100}) {
  ModelCamera camera;
  camera.viewFromWorld = lookAt(eye, {0, 0, 0}, {0, 1, 0});
  camera.orthographic = orthographic;
  camera.verticalFov = 2 * std::atan(0.1);
  camera.height = 20;
  camera.range = {50, 150};
  return camera;
}

inline Light directional(const Vector3& direction, double intensity = 1) {
  Light light;
  light.direction = direction;
  light.intensity = intensity;
  return light;
}

// A lit ball, and a ball 1 mm behind it that lies in its shadow; the light travels along +x.
inline Model ballInShadow(std::uint32_t rings) {
  Model model = emptyModel();
  addSphere(model, {-6.5, 0, 0}, 6, rings);
  addSphere(model, {4.5, 0, 0}, 4, rings);
  endPart(model, 0);
  model.lights = {directional({1, 0, 0}, 3)};
  return model;
}

// A ball of 6 mm and beside it an ear, 8 mm high and 2.4 mm thick. A key light from the front and a rim
// light.
inline Model ballAndEar() {
  Model model = emptyModel();
  addSphere(model, {-3, 0, 0}, 6, 48);
  endPart(model, 0);
  const std::size_t first = model.vertices.size();
  addSphere(model, {0, 0, 0}, 1, 48);
  endPart(model, 1);
  constexpr std::array<float, 3> kRadii = {2.5f, 4, 1.2f}, kCenter = {6.2f, 0, 0};
  for (std::size_t i = first; i < model.vertices.size(); ++i) {
    Vertex& v = model.vertices[i];
    float squared = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      v.position[c] = kCenter[c] + kRadii[c] * v.position[c];
      v.normal[c] /= kRadii[c];
      squared += v.normal[c] * v.normal[c];
    }
    for (float& n : v.normal) n /= std::sqrt(squared);
  }
  model.lights = {directional({0.6, -0.4, -0.7}, 2), directional({0.5, -0.2, 0.85}, 2)};
  return model;
}

inline Light pointLight(const Vector3& position, double intensity = 1) {
  Light light;
  light.type = PELLUCID_LIGHT_POINT;
  light.position = position;
  light.intensity = intensity;
  return light;
}

// Planar distances of a capture's depth image through its matrix; < 0: nothing there.
inline double planar(const Capture& capture, const DepthImage& depth, int x, int y) {
  if (depth.image.empty()) return -1;
  const double d = *depth.image.at(x, y);
  if (depth.encoding == PELLUCID_DEPTH_VIEW_Z) return d < 1e9 ? d : -1;
  if (d == clearDepth(capture.clipFromView)) return -1;
  const Matrix& m = capture.clipFromView;
  return -(d * m[15] - m[14]) / (m[10] - d * m[11]);
}

// The view ray through a pixel of frontCamera: world position at planar distance 0 and 1.
struct PixelRay {
  Vector3 origin, direction;
};
inline PixelRay rayOf(const Capture& capture, int x, int y) {
  const double u = ((x + 0.5) / capture.width * 2 - 1) / capture.clipFromView[0];
  const double v = ((y + 0.5) / capture.height * 2 - 1) / capture.clipFromView[5];
  if (capture.clipFromView[15] == 0) return {{0, 0, 100}, {u, v, -1}};
  return {{u, v, 100}, {0, 0, -1}};
}

// Planar distances where the ray meets a sphere about the origin; false: it misses.
inline bool meetSphere(const PixelRay& ray, double radius, double (&t)[2]) {
  double a = 0, b = 0, c = -radius * radius;
  for (std::size_t i = 0; i < 3; ++i) {
    a += ray.direction[i] * ray.direction[i];
    b += ray.origin[i] * ray.direction[i];
    c += ray.origin[i] * ray.origin[i];
  }
  if (b * b < a * c) return false;
  const double root = std::sqrt(b * b - a * c);
  t[0] = (-b - root) / a;
  t[1] = (-b + root) / a;
  return true;
}

}  // namespace pellucid::test
