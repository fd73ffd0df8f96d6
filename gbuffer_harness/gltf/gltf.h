// glTF 2.0 files (.glb, .gltf) as models for the rasterizer. docs/captures.md has the mapping.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "raster/model.h"

namespace pellucid::harness {

struct GltfOptions {
  double metersPerUnit = 1;  // glTF's own unit is the meter
  // glTF material name -> preset of the material compiler, a manifest's material in braces, or "thin:R,G,B",
  // a thin wall's transmittance, "opaque", or "none", which leaves its triangles out, instead of what the
  // file says. "*": every material that is not named; "default": triangles without a material.
  std::map<std::string, std::string> presets;
  std::string scene;  // name or number; empty: the file's default
  double ior = 0;     // of all media, in place of their own, [1, 3]; 0: their own
  // Name of the camera that looks, by which the world's origin is chosen where the scene is far from its own;
  // empty: the file's first, and the model's center without one or for "auto".
  std::string camera;
};

struct GltfScene {
  Model model;
  std::vector<std::string> materialNames;  // as `presets` takes them
  std::vector<std::string> notes;          // sentences for a person: what stands in for what the file lacks
  std::vector<std::string> warnings;       // sentences for a person: what is drawn otherwise than asked
};

// Reads a scene, with every node's transform, skin and morph targets applied. Memory stays within a
// small multiple of the files' size and of 2^24 vertices. External buffers and images must lie in the file's
// own folder or below it. Throws InputError naming file, field and value for what is broken, and for what
// cannot be drawn as asked, as required extensions that are not known.
GltfScene loadGltf(const std::filesystem::path& path, const GltfOptions& options = {});

}  // namespace pellucid::harness
