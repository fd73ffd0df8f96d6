#include "cli/scene_hash.h"

#include <cstdio>
#include <type_traits>

#include "capture/material.h"

namespace pellucid::harness {

void SceneHash::bytes(const void* data, std::size_t size) {
  for (std::size_t i = 0; i < size; ++i)
    hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3u;
}

template <class T>
void SceneHash::value(const T& value) {
  static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>);
  bytes(&value, sizeof value);
}

void SceneHash::add(const Model& model) {
  for (const Vertex& vertex : model.vertices) {
    for (const float x : vertex.position) value(x);
    for (const float x : vertex.normal) value(x);
    for (const float x : vertex.uv) value(x);
    for (const float x : vertex.color) value(x);
    value(vertex.mark);
    if (vertex.alpha != 1) value(vertex.alpha);
  }
  for (const std::uint32_t index : model.indices) value(index);
  for (const Part& part : model.parts) {
    value(part.firstIndex);
    value(part.indexCount);
    value(part.object);
    value(part.surface);
  }
  for (const Surface& surface : model.surfaces) {
    for (const auto& color : {surface.baseColor, surface.addedColor})
      for (const double x : color) value(x);
    value(surface.texture);
    value(surface.alphaCutoff);
    value(surface.doubleSided);
    value(surface.material);
    if (surface.lobeMap < 0 && surface.lobes == SurfaceLobes::Together) continue;
    value(surface.lobeMap);
    value(surface.displaced);
    value(surface.backscatter);
    value(static_cast<int>(surface.lobes));
  }
  for (const Texture& texture : model.textures) bytes(texture.rgba.data(), texture.rgba.size());
  value(model.metersPerUnit);
}

void SceneHash::add(const SceneParameters& parameters) {
  add(parameters.name);
  for (const auto& [name, number] : parameters.options) {
    add(name);
    value(number);
  }
  value(parameters.seed);
}

void SceneHash::add(const reference::Emitters& emitters, const Capture& capture) {
  for (const Light& light : emitters.lights) {
    value(static_cast<int>(light.type));
    for (const auto& triple : {light.position, light.direction, light.color})
      for (const double x : triple) value(x);
    for (const double x :
         {light.intensity, light.range, light.radius, light.innerConeAngle, light.outerConeAngle})
      value(x);
  }
  if (emitters.environment)
    for (const auto& color : {emitters.environment->up, emitters.environment->down})
      for (const double x : color) value(x);
  value(capture.width);
  value(capture.height);
  for (const double x : capture.clipFromView) value(x);
  for (const double x : capture.viewFromWorld) value(x);
  for (const MaterialSource& source : capture.materials) {
    if (const auto* wall = std::get_if<ThinWallMaterial>(&source)) {
      for (const auto& color : {wall->reflectance, wall->transmittance})
        for (const double x : color) value(x);
      continue;
    }
    const CoefficientMaterial material = coefficientsOf(source, capture.name + ": materials");
    for (const auto& color : {material.scattering, material.absorption})
      for (const double x : color) value(x);
    value(material.g);
    value(material.ior);
  }
}

void SceneHash::addImages(const Capture& capture) {
  bytes(capture.material.data(), capture.material.size());
  bytes(capture.hiddenIrradiance.data.data(), capture.hiddenIrradiance.data.size() * sizeof(float));
  bytes(capture.albedo.data.data(), capture.albedo.data.size() * sizeof(float));
}

void SceneHash::add(const std::string& option) { bytes(option.data(), option.size()); }

std::string SceneHash::text() const {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash_));
  return text;
}

}  // namespace pellucid::harness
