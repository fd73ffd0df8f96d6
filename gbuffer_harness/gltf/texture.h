// Images of glTF textures.
#pragma once

#include "gltf/document.h"
#include "raster/model.h"

namespace pellucid::harness {

// Texture `index` decoded: PNG or JPEG, at most 2^26 pixels. Throws InputError naming the texture or image.
Texture readTexture(const GltfDocument& document, int index, const std::string& field);

}  // namespace pellucid::harness
