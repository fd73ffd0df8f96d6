// Images of glTF textures, and those of what scatters under a surface as one.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "gltf/document.h"
#include "gltf/mesh.h"
#include "raster/model.h"

namespace pellucid::harness {

// Texture `index` decoded: PNG or JPEG, at most 2^26 pixels. Throws InputError naming the texture or image.
Texture readTexture(const GltfDocument& document, int index, const std::string& field);

// A texture info of the file.
struct TextureUse {
  int texture = -1;  // into the document's textures
  TexCoord coord;
  std::string field;  // of the texture info, for messages
};

struct LobeMap {
  Texture texture;  // rgb: the product of the colors; alpha: of the strength
  TexCoord coord;
  std::array<double, 3> mean = {1, 1, 1};  // of rgb times alpha, linear
};

// Colors multiply each other, and the strength's alpha everything; nothing where there are neither. One
// texture has one set of coordinates: of a use with others than the first, the mean stands in for the
// texture, and a sentence in `warnings` says so. Throws InputError as readTexture() does.
std::optional<LobeMap> readLobeMap(const GltfDocument& document, const std::vector<TextureUse>& colors,
                                   const std::optional<TextureUse>& strength,
                                   std::vector<std::string>& warnings);

}  // namespace pellucid::harness
