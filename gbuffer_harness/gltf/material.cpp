#include "gltf/material.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>

#include "capture/manifest_material.h"
#include "capture/material.h"
#include "common/parse.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

using Rgb = std::array<double, 3>;

// Base colors that nobody chose: glTF's default, and that of Blender's Principled BSDF, which its exporter
// writes.
constexpr double kDefaultBaseColors[] = {1, 0.8};

// Far steeper than any map, and its square still is a float.
constexpr double kLargestNormalScale = 1000;

bool hasColor(const GltfMaterial& material) {
  const Rgb& color = material.surface.baseColor;
  const auto isGray = [&](double gray) {
    return std::all_of(color.begin(), color.end(), [&](double v) { return std::abs(v - gray) < 1e-6; });
  };
  return material.color || std::none_of(std::begin(kDefaultBaseColors), std::end(kDefaultBaseColors), isGray);
}

const std::string* presetFor(const std::string& name, const GltfOptions& options) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = options.presets.find(key); found != options.presets.end()) return &found->second;
  return nullptr;
}

// Reads "thin:R,G,B".
std::optional<Rgb> thinTransmittance(const GltfDocument& document, const std::string& name,
                                     const std::string& text) {
  constexpr std::string_view kThin = "thin:";
  if (text.rfind(kThin, 0) != 0) return std::nullopt;
  const std::vector<std::string> parts = split(text.substr(kThin.size()), ',');
  Rgb color{};
  bool isColor = parts.size() == 3;
  for (std::size_t c = 0; c < 3 && isColor; ++c) {
    color[c] = numberIn<double>(parts[c]).value_or(-1);
    isColor = color[c] >= 0 && color[c] <= 1;
  }
  if (!isColor)
    document.fail("material \"" + name + "\"",
                  "\"" + text + "\" is not thin:R,G,B with a transmittance from 0 to 1 of each");
  return color;
}

}  // namespace

std::string materialName(const GltfDocument& document, int index) {
  if (index < 0) return "default";
  const std::string& name = document.model.materials[static_cast<std::size_t>(index)].name;
  return name.empty() ? "materials[" + std::to_string(index) + "]" : name;
}

GltfMaterial readMaterial(const GltfDocument& document, int index, const GltfOptions& options,
                          std::vector<std::string>& warnings) {
  GltfMaterial result;
  const std::string name = materialName(document, index);
  const std::string* const preset = presetFor(name, options);
  result.surface.name = name;
  if (index >= 0) {
    const std::string field = "materials[" + std::to_string(index) + "]";
    const tinygltf::Material& material = document.model.materials[static_cast<std::size_t>(index)];
    const auto& factor = material.pbrMetallicRoughness.baseColorFactor;
    if (factor.size() != 4 ||
        !std::all_of(factor.begin(), factor.end(), [](double v) { return v >= 0 && v <= 1; }))
      document.fail(field + ".pbrMetallicRoughness.baseColorFactor", "is not 4 numbers within 0 .. 1");
    std::copy_n(factor.begin(), 3, result.surface.baseColor.begin());
    result.surface.doubleSided = material.doubleSided;
    if (material.alphaMode == "MASK") {
      if (!(material.alphaCutoff >= 0 && std::isfinite(material.alphaCutoff)))
        document.fail(field + ".alphaCutoff", std::to_string(material.alphaCutoff) + " is not >= 0");
      // The factor multiplies the texel's alpha; 2 is above any of them.
      result.surface.alphaCutoff = factor[3] > 0 ? std::min(material.alphaCutoff / factor[3], 2.0) : 2;
    } else if (material.alphaMode == "BLEND") {
      warnings.push_back("material \"" + name + "\": alphaMode BLEND is drawn opaque");
    }
    const GltfJson& json = document.json["materials"][static_cast<std::size_t>(index)];
    result.color = readTextureUse(document, json.value("pbrMetallicRoughness", GltfJson::object()),
                                  "baseColorTexture", field + ".pbrMetallicRoughness");
    result.normal = readTextureUse(document, json, "normalTexture", field);
    result.surface.normalScale = material.normalTexture.scale;
    if (!(std::abs(result.surface.normalScale) <= kLargestNormalScale))
      document.fail(field + ".normalTexture.scale",
                    std::to_string(result.surface.normalScale) + " is outside -1000 .. 1000");
    if (!preset) {
      Scattering scattering = readScattering(document, static_cast<std::size_t>(index), name,
                                             options.metersPerUnit, result.surface, warnings);
      result.medium = scattering.medium;
      result.lobeMap = std::move(scattering.map);
    }
  }
  if (const auto transmittance = preset ? thinTransmittance(document, name, *preset) : std::nullopt) {
    result.medium = thinWall(*transmittance, result.surface).medium;
    return result;
  }
  const std::string where = document.file + ": material \"" + name + "\"";
  if (preset) result.medium = parseMaterial(where, *preset);
  if (result.medium && options.ior > 0) result.medium = withIor(*result.medium, options.ior, where);
  if (preset) {
    const PellucidMaterial compiled = compileMaterial(*result.medium, where);
    if (!hasColor(result)) std::copy_n(compiled.reflectance, 3, result.reflectance.emplace().begin());
  }
  return result;
}

}  // namespace pellucid::harness
