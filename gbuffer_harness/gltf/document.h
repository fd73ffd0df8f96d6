// A glTF file: its JSON, whose fields are checked where they are read, and the bytes that it refers to.
#pragma once

#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capture/json_field.h"

namespace pellucid::harness {

using GltfBytes = std::vector<unsigned char>;

// True if files that use the extension are drawn as the extension asks.
bool isDrawn(const std::string& extension);

// The extension of that name; nothing: `object` does not have it.
std::optional<Field> extensionOf(const Field& object, const char* name);

// The object's name; nothing where it is empty.
std::optional<std::string> nameOf(const Field& object);

inline constexpr double kUnbounded = std::numeric_limits<double>::infinity();

// A number of an object, which is `absent` where the object lacks the key.
double numberOr(const Field& object, const char* key, double absent, double least, double most);

struct GltfDocument {
  std::string file;  // for messages
  std::filesystem::path folder;  // canonical
  nlohmann::json json;
  std::map<std::string, std::vector<Field>, std::less<>> lists;  // elements of "nodes" and its like, of "lights"
  std::vector<GltfBytes> buffers;

  Field root() const { return {file, json}; }

  // The elements of a list; none where the file lacks the list.
  const std::vector<Field>& list(const char* name) const;

  // The index that a field holds, and the element there. Throws InputError: "nodes[3].mesh: 7 is not one of the 2
  // meshes".
  std::size_t index(const char* list, const Field& field) const;
  const Field& element(const char* name, const Field& field) const { return list(name)[index(name, field)]; }

  // The bytes of the buffer view whose index a field holds, all of them inside the view's buffer.
  struct Bytes {
    const unsigned char* data;
    std::size_t size;
  };
  Bytes bufferView(const Field& field) const;

  // The bytes of a URI: base64 data, or a file in the folder of the document or below.
  GltfBytes resource(const Field& uri) const;
};

// Throws InputError for files that are not glTF 2.0, truncated or larger than 1 GiB, and for URIs that leave the
// file's folder.
GltfDocument readGltf(const std::filesystem::path& path);

}  // namespace pellucid::harness
