// The JSON of a glTF file: checked before anything else reads it, and made ready for tinygltf.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace pellucid::harness {

using GltfJson = nlohmann::json;

// True if files that use the extension are drawn as the extension asks.
bool isDrawn(const std::string& extension);

// Parses `text` and throws InputError for what tinygltf would refuse without a field: JSON that is none,
// extensions that are required and not known, and properties that are missing or of another type.
GltfJson parseGltfJson(const std::string& file, std::string_view text);

// True if a buffer only stands in for what its views hold compressed elsewhere (EXT_meshopt_compression).
bool isFallbackBuffer(const GltfJson& buffer);

// The extension of that name; NULL: `value` does not have it as an object.
const GltfJson* extensionOf(const GltfJson& value, const char* name);

// The document without what this program reads itself and tinygltf is stricter about than glTF: animations
// and skins, buffers that only stand in for compressed ones, and indices that lie in a Draco stream.
GltfJson forTinyGltf(const GltfJson& json);

}  // namespace pellucid::harness
