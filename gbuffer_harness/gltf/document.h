// A glTF file parsed by tinygltf, with what it refers to in memory and nothing of it trusted. Its JSON is
// checked before anything else reads it, and made ready for tinygltf.
#pragma once

#include <tiny_gltf.h>

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pellucid::harness {

using GltfJson = nlohmann::json;

// True if files that use the extension are drawn as the extension asks.
bool isDrawn(const std::string& extension);

// True if a buffer only stands in for what its views hold compressed elsewhere (EXT_meshopt_compression).
bool isFallbackBuffer(const GltfJson& buffer);

// The extension of that name; NULL: `value` does not have it as an object.
const GltfJson* extensionOf(const GltfJson& value, const char* name);

struct GltfDocument {
  std::string file;  // for messages
  GltfJson json;     // the whole file's; the model is without animations and skins
  tinygltf::Model model;
  std::vector<std::vector<unsigned char>> images;  // encoded, for those with a URI; as model.images

  // Decompressed: the bytes of buffer views, and those of accessors, one element after the other.
  std::map<int, std::vector<unsigned char>> views, accessors;

  // Throws InputError: file, field, sentence.
  [[noreturn]] void fail(const std::string& field, const std::string& sentence) const;

  // The bytes of a buffer view, all of them inside its buffer. `field` is what refers to the view.
  struct Bytes {
    const unsigned char* data;
    std::size_t size;
  };
  Bytes bufferView(int index, const std::string& field) const;
  // Part of a buffer, all of it inside. `field` is what holds "buffer", "byteOffset" and "byteLength".
  Bytes bytesOf(int buffer, std::size_t byteOffset, std::size_t byteLength, const std::string& field) const;

  // Throws InputError unless 0 <= index < size; "nodes[3].mesh: 7 is not one of the 2 meshes".
  std::size_t index(int index, std::size_t size, const std::string& field, const char* plural) const;

  // A property of `field`'s object. Throws InputError where the property is missing or no integer >= 0.
  std::size_t integer(const GltfJson& object, const char* key, const std::string& field) const;
  // Such a property as an index; beyond 2^30 it is 2^30, which no list has.
  int reference(const GltfJson& object, const char* key, const std::string& field) const;
};

// Throws InputError for files that are not glTF 2.0, truncated, nested too deeply or larger than 1 GiB, and
// for URIs that leave the file's folder.
GltfDocument readGltf(const std::filesystem::path& path);

// Fills document.views and document.accessors with what EXT_meshopt_compression and
// KHR_draco_mesh_compression hold compressed. Throws InputError naming the view or primitive whose stream
// does not decode to what the file says of it.
void unpack(GltfDocument& document);

}  // namespace pellucid::harness
