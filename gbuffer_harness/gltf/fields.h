// Every field and extension of glTF that this program knows, and what becomes of it: the one list from which
// docs/captures.md has its table.
#pragma once

#include <string>
#include <vector>

#include "gltf/document.h"

namespace pellucid::harness {

enum class FieldUse {
  Used,
  NoEffect,      // on triangles, cameras, lights and the diffuse color of a still
  Approximated,  // a sentence says how
  LeftOut,       // a sentence says what is missing
  Refused        // where the file requires the extension
};

// path: keys, where * is any element or key, a comma separates keys, and ** a whole subtree. That of a field
// of an extension begins with the extension's name.
struct GltfField {
  const char* path;
  FieldUse use;
  const char* sentence = "";  // of all but Used
  const char* silent = "";    // JSON of a value that needs no sentence
};
const std::vector<GltfField>& gltfFields();

struct GltfExtension {
  const char* name;
  FieldUse use;
  const char* sentence = "";  // of all but Used; of Refused: the command that exports without it
  const char* places = "";    // of Used: keys of the root below which objects have it, with commas; "extensions": the root
};
const std::vector<GltfExtension>& gltfExtensions();

// One sentence for each kind of field and extension in the file that is not drawn as the file asks, or that
// neither list has.
std::vector<std::string> unusedFields(const GltfJson& json);

// Throws InputError for an extension that the file requires and that cannot be left out.
void checkRequiredExtensions(const std::string& file, const GltfJson& json);

// Rows of both lists, for the documents.
std::string gltfTable();

}  // namespace pellucid::harness
