// glTF materials as surfaces to draw and media for the material compiler, and what their extensions say of
// the light that enters.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/gltf.h"
#include "gltf/texture.h"
#include "raster/model.h"

namespace pellucid::harness {

// Kulla & Conty 2017: the single-scattering albedo whose half-space, without Fresnel boundaries, reflects
// `multiscatter`, in [0, 1], where scattering is isotropic.
double singleScatteringAlbedo(double multiscatter);

struct GltfMaterial {
  Surface surface;  // without its material index and textures
  std::optional<MaterialSource> medium;
  std::optional<TextureUse> color, normal;  // base color and normal map
  std::optional<LobeMap> lobeMap;
  // The preset's diffuse reflectance, linear, where the file gives the material no color: the albedo of the
  // primitives that have no vertex colors either.
  std::optional<std::array<double, 3>> reflectance;
  bool leftOut = false;  // clear, or so named: its triangles are not there
};

// A material and what its extensions say, in Pellucid's terms; docs/captures.md. `index` -1: the default
// material of glTF. Adds sentences to `warnings`.
GltfMaterial readMaterial(const GltfDocument& document, int index, const GltfOptions& options,
                          std::vector<std::string>& warnings);

// Name by which options and messages know a material; "default" for -1, "materials[i]" without a name.
std::string materialName(const GltfDocument& document, int index);

}  // namespace pellucid::harness
