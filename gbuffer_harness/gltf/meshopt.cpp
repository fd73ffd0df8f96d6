#include "gltf/meshopt.h"

#include <meshoptimizer.h>

#include "gltf/mesh.h"

namespace pellucid::harness {

namespace {

constexpr const char* kMeshopt = "EXT_meshopt_compression";

// Largest byteStride of an attribute that the encoder takes.
constexpr std::size_t kMostStride = 256;

}  // namespace

bool isMeshoptFallback(const GltfJson& buffer) {
  const GltfJson* extension = extensionOf(buffer, kMeshopt);
  return extension && !buffer.contains("uri") && extension->value("fallback", GltfJson()) == true;
}

void pointToCompressed(GltfJson& json) {
  if (!json.contains("bufferViews") || !json.contains("buffers")) return;
  for (GltfJson& buffer : json["buffers"])
    if (isMeshoptFallback(buffer)) {
      buffer["uri"] = "data:application/octet-stream;base64,AA==";
      buffer["byteLength"] = 1;
    }
  for (GltfJson& view : json["bufferViews"])
    if (const GltfJson* extension = extensionOf(view, kMeshopt))
      for (const char* key : {"buffer", "byteOffset", "byteLength"})
        view[key] = extension->value(key, GltfJson(0));
}

void decodeMeshopt(GltfDocument& document) {
  for (std::size_t i = 0; i < document.model.bufferViews.size(); ++i) {
    const GltfJson* extension = extensionOf(document.json["bufferViews"][i], kMeshopt);
    if (!extension) continue;
    const std::string field = "bufferViews[" + std::to_string(i) + "].extensions." + kMeshopt;
    const GltfDocument::Bytes bytes = document.bufferView(static_cast<int>(i), field);
    const auto count = static_cast<std::size_t>(document.reference(*extension, "count", field)),
               stride = static_cast<std::size_t>(document.reference(*extension, "byteStride", field));
    const GltfJson mode = extension->value("mode", GltfJson()),
                   filter = extension->value("filter", GltfJson("NONE"));
    const bool isAttribute = mode == "ATTRIBUTES", isTriangles = mode == "TRIANGLES";
    if (!isAttribute && !isTriangles && mode != "INDICES")
      document.fail(field + ".mode", mode.dump() + " is not ATTRIBUTES, TRIANGLES or INDICES");
    if (isAttribute ? stride == 0 || stride % 4 != 0 || stride > kMostStride : stride != 2 && stride != 4)
      document.fail(field + ".byteStride", std::to_string(stride) + " is not one of this mode");
    if (count > 3 * kMaxVertices || (isTriangles && count % 3 != 0))
      document.fail(field + ".count",
                    std::to_string(count) + " is more than 2^24 triangles, or no triangles");
    std::vector<unsigned char> decoded(count * stride);
    const int error =
        isAttribute   ? meshopt_decodeVertexBuffer(decoded.data(), count, stride, bytes.data, bytes.size)
        : isTriangles ? meshopt_decodeIndexBuffer(decoded.data(), count, stride, bytes.data, bytes.size)
                      : meshopt_decodeIndexSequence(decoded.data(), count, stride, bytes.data, bytes.size);
    if (error != 0) document.fail(field, "its bytes cannot be decoded; export the file again");
    if (filter == "OCTAHEDRAL" && (stride == 4 || stride == 8))
      meshopt_decodeFilterOct(decoded.data(), count, stride);
    else if (filter == "QUATERNION" && stride == 8)
      meshopt_decodeFilterQuat(decoded.data(), count, stride);
    else if (filter == "EXPONENTIAL")
      meshopt_decodeFilterExp(decoded.data(), count, stride);
    else if (filter != "NONE")
      document.fail(field + ".filter",
                    filter.dump() + " with a byteStride of " + std::to_string(stride) + " is not known");
    tinygltf::BufferView& view = document.model.bufferViews[i];
    view.buffer = static_cast<int>(document.model.buffers.size());
    view.byteOffset = 0;
    view.byteLength = decoded.size();
    document.model.buffers.emplace_back().data = std::move(decoded);
  }
}

}  // namespace pellucid::harness
