// Tells whether two runs are of one scene.
#pragma once

#include <cstdint>
#include <string>

#include "raster/model.h"
#include "reference/path_tracer/emitters.h"
#include "scene/scene.h"

namespace pellucid::harness {

// FNV-1a (Fowler, Noll & Vo) of the inputs, in order. Images that a device draws are left out, as their last
// bits depend on the device.
class SceneHash {
public:
  void add(const Model& model);  // triangles and surfaces
  void add(const SceneParameters& parameters);
  void add(const reference::Emitters& emitters, const Capture& capture);  // of it size, camera, materials
  void addImages(const Capture& capture);  // of one that a file holds: material and albedo
  void add(const std::string& option);
  std::string text() const;  // 16 hexadecimal digits

private:
  template <class T>
  void value(const T& value);
  void bytes(const void* data, std::size_t size);

  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

}  // namespace pellucid::harness
