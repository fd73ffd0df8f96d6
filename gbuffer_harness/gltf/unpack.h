// Compressed contents of glTF files: EXT_meshopt_compression and KHR_draco_mesh_compression.
#pragma once

#include "gltf/document.h"

namespace pellucid::harness {

// Fills document.views and document.accessors with what the two extensions hold compressed. Throws InputError
// naming the view or primitive whose stream does not decode to what the file says of it.
void unpack(GltfDocument& document);

}  // namespace pellucid::harness
