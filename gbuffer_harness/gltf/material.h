// glTF materials as surfaces to draw and media for the material compiler.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/gltf.h"

namespace pellucid::harness {

struct GltfMaterial {
  Surface surface;  // without its material index and textures
  std::optional<MaterialSource> medium;
  int texture = -1;  // into the document's textures: the base color
  int texCoord = 0;  // its TEXCOORD_n
  int normalTexture = -1, normalTexCoord = 0;
  // The preset's diffuse reflectance, linear, where the file gives the material no color: the albedo of the
  // primitives that have no vertex colors either.
  std::optional<std::array<double, 3>> reflectance;
};

// What glTF's KHR_materials_volume, _volume_scatter and _diffuse_transmission say, in Pellucid's terms;
// docs/scenes.md. `index` -1: the default material of glTF. Adds sentences to `warnings`.
GltfMaterial readMaterial(const GltfDocument& document, int index, const GltfOptions& options,
                          std::vector<std::string>& warnings);

// Name by which options and messages know a material; "default" for -1, "materials[i]" without a name.
std::string materialName(const GltfDocument& document, int index);

// Kulla & Conty 2017, as KHR_materials_volume_scatter prints it: the single-scattering albedo whose
// half-space, without Fresnel boundaries, reflects `multiscatter`, in [0, 1].
double singleScatteringAlbedo(double multiscatter);

}  // namespace pellucid::harness
