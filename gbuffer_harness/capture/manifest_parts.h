// Lights and materials of a manifest as JSON, which other files than captures hold, too.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "capture/json_field.h"

namespace pellucid::harness {

// Numbers of an object of a manifest, which a table lists once for reading and writing.
template <class T>
struct NumberField {
  const char* key;
  double T::*member;
  double least, most;
};

// Absent keys leave their members. Throws InputError for a value out of range.
template <class T, std::size_t N>
void readNumbers(const Field& field, const NumberField<T> (&numbers)[N], T& object) {
  for (const NumberField<T>& n : numbers)
    if (const auto value = field.find(n.key)) object.*n.member = value->number(n.least, n.most);
}

// ---- Lights

// The light without its shadow maps, and a map without its images.
nlohmann::ordered_json lightJson(const Light& light);
void addMapJson(const ShadowMap& map, nlohmann::ordered_json& json);

// With its shadow maps, but for their images. Throws InputError for what it does not know.
Light readLight(const Field& field);

// Clamps what lies a rounding beyond its bound (common/bounds.h), so that the light keeps the domains of
// PellucidLight as floats, too, and longer ranges to the longest. Calls fail with the manifest's key and a
// sentence for a value further out; fail must throw.
void fitLight(Light& light, const std::function<void(const char* key, const std::string& sentence)>& fail);

// A sentence for each table of the capture's lights whose profile has narrower lobes than the module's steps.
std::vector<std::string> coarseTables(const Capture& capture);

// ---- Materials

nlohmann::ordered_json materialJson(const MaterialSource& source);

// One material; docs/materials.md has its keys. Throws InputError for what it does not know.
MaterialSource readMaterial(const Field& field);

// A material of the command line: a preset's name, or a manifest's object in braces. Throws InputError naming
// `option`.
MaterialSource parseMaterial(const std::string& option, const std::string& text);

}  // namespace pellucid::harness
