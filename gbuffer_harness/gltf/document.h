// A glTF file parsed by tinygltf, with what it refers to in memory and nothing of it trusted. Its JSON is
// checked before anything else reads it, and made ready for tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pellucid::harness {

using GltfJson = nlohmann::json;

// The extension of that name; NULL: `value` does not have it as an object.
const GltfJson* extensionOf(const GltfJson& value, const char* name);

struct GltfDocument {
  std::string file;  // for messages
  GltfJson json;     // the whole file's; the model is without animations and skins
  tinygltf::Model model;
  std::vector<std::vector<unsigned char>> images;  // encoded, for those with a URI; as model.images

  // Throws InputError: file, field, sentence.
  [[noreturn]] void fail(const std::string& field, const std::string& sentence) const;

  // The bytes of a buffer view, all of them inside its buffer. `field` is what refers to the view.
  struct Bytes {
    const unsigned char* data;
    std::size_t size;
  };
  Bytes bufferView(int index, const std::string& field) const;

  // Throws InputError unless 0 <= index < size; "nodes[3].mesh: 7 is not one of the 2 meshes".
  std::size_t index(int index, std::size_t size, const std::string& field, const char* plural) const;

  // A property of `field`'s object as an index; beyond 2^30 it is 2^30, which no list has. Throws InputError where
  // the property is missing or no integer >= 0.
  int reference(const GltfJson& object, const char* key, const std::string& field) const;
};

// Throws InputError for files that are not glTF 2.0, truncated, nested too deeply or larger than 1 GiB, and
// for URIs that leave the file's folder.
GltfDocument readGltf(const std::filesystem::path& path);

}  // namespace pellucid::harness
