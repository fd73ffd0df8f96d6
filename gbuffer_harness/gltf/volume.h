// The light that enters a surface, by glTF's extensions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/lobe_map.h"
#include "raster/model.h"

namespace pellucid::harness {

// Result of KHR_materials_volume, _volume_scatter, _diffuse_transmission, _scatter and _transmission;
// docs/captures.md.
struct Scattering {
  std::optional<MaterialSource> medium;  // nothing: opaque
  std::optional<LobeMap> map;
};

// `name`: the material's, for warnings. `surface`: with the base color; gets its lobes. Adds a sentence to
// `warnings` for a property by which a scattering material ends up black, opaque or otherwise than asked.
// Throws InputError naming the field.
Scattering readScattering(const GltfDocument& document, std::size_t material, const std::string& name,
                          double metersPerUnit, Surface& surface, std::vector<std::string>& warnings);

// A thin wall that transmits this color, and reflects the base color of the rest.
Scattering thinWall(const std::array<double, 3>& transmittance, Surface& surface);

// The texture of an object in the file's JSON, as "baseColorTexture" of pbrMetallicRoughness; nothing without
// one.
std::optional<TextureUse> readTextureUse(const GltfDocument& document, const GltfJson& object,
                                         const char* key, const std::string& field);

// Kulla & Conty 2017, as KHR_materials_scatter prints it: the single-scattering albedo whose half-space,
// without Fresnel boundaries, reflects `multiscatter`, in [0, 1], where the phase function has the mean
// cosine `g`.
double singleScatteringAlbedo(double multiscatter, double g = 0);

}  // namespace pellucid::harness
