// EXT_meshopt_compression, as gltfpack writes it.
#pragma once

#include "gltf/document.h"

namespace pellucid::harness {

// True of a buffer that holds nothing: only readers without the extension would need it.
bool isMeshoptFallback(const GltfJson& buffer);

// Points compressed views to their compressed bytes, and gives empty buffers a byte, so that tinygltf reads
// both.
void pointToCompressed(GltfJson& json);

// Decodes compressed views into buffers of their own. Throws InputError naming the view.
void decodeMeshopt(GltfDocument& document);

}  // namespace pellucid::harness
