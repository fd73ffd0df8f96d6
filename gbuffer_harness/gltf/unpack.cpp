#include "gltf/accessor.h"

#include <draco/compression/decode.h>
#include <meshoptimizer.h>

#include <cstring>

namespace pellucid::harness {

namespace {

constexpr const char *kMeshopt = "EXT_meshopt_compression", *kDraco = "KHR_draco_mesh_compression";

std::string text(const GltfDocument& document, const GltfJson& object, const char* key,
                 const std::string& field, const char* absent) {
  const auto found = object.find(key);
  if (found == object.end()) return absent;
  if (!found->is_string()) document.fail(field + "." + key, found->dump() + " is not a string");
  return *found;
}

struct MeshoptStream {
  const unsigned char* data;
  std::size_t bytes, count, stride;
};

int decode(const MeshoptStream& stream, const std::string& mode, std::vector<unsigned char>& to) {
  if (mode == "ATTRIBUTES")
    return meshopt_decodeVertexBuffer(to.data(), stream.count, stream.stride, stream.data, stream.bytes);
  if (mode == "TRIANGLES")
    return meshopt_decodeIndexBuffer(to.data(), stream.count, stream.stride, stream.data, stream.bytes);
  return meshopt_decodeIndexSequence(to.data(), stream.count, stream.stride, stream.data, stream.bytes);
}

// Checks that the decoders assert instead of refusing.
bool isStride(const std::string& mode, std::size_t stride) {
  return mode == "ATTRIBUTES" ? stride > 0 && stride % 4 == 0 && stride <= 256 : stride == 2 || stride == 4;
}
bool isFilterStride(const std::string& filter, std::size_t stride) {
  return filter == "OCTAHEDRAL"    ? stride == 4 || stride == 8
         : filter == "QUATERNION"  ? stride == 8
         : filter == "EXPONENTIAL" ? stride % 4 == 0
                                   : filter == "NONE";
}

void unpackView(GltfDocument& document, int index, const GltfJson& extension) {
  const std::string field = "bufferViews[" + std::to_string(index) + "].extensions." + kMeshopt;
  const std::size_t offset =
      extension.contains("byteOffset") ? document.integer(extension, "byteOffset", field) : 0;
  const GltfDocument::Bytes source =
      document.bytesOf(document.reference(extension, "buffer", field), offset,
                       document.integer(extension, "byteLength", field), field);
  const MeshoptStream stream{source.data, source.size, document.integer(extension, "count", field),
                             document.integer(extension, "byteStride", field)};
  const std::string mode = text(document, extension, "mode", field, "");
  const std::string filter = text(document, extension, "filter", field, "NONE");
  if (mode != "ATTRIBUTES" && mode != "TRIANGLES" && mode != "INDICES")
    document.fail(field + ".mode", "\"" + mode + "\" is not ATTRIBUTES, TRIANGLES or INDICES");
  if (!isStride(mode, stream.stride))
    document.fail(field + ".byteStride", std::to_string(stream.stride) + " is no stride of mode " + mode);
  if (!isFilterStride(filter, stream.stride))
    document.fail(field + ".filter", "\"" + filter + "\" is not known for elements of " +
                                         std::to_string(stream.stride) + " bytes");
  if (mode == "TRIANGLES" && stream.count % 3 != 0)
    document.fail(field + ".count", std::to_string(stream.count) + " is not a multiple of 3");
  // Two bits stand for 16 bytes at best: a stream that claims more is damaged, and memory would be taken for
  // it.
  constexpr std::size_t kMostPerByte = 64, kSlack = 65536;
  if (stream.count > (stream.bytes * kMostPerByte + kSlack) / stream.stride)
    document.fail(field + ".count", std::to_string(stream.count) + " elements cannot be in " +
                                        std::to_string(stream.bytes) + " bytes");
  const std::size_t claimed = document.model.bufferViews[static_cast<std::size_t>(index)].byteLength;
  if (claimed != stream.count * stream.stride)
    document.fail(field + ".count", std::to_string(stream.count) + " elements of " +
                                        std::to_string(stream.stride) +
                                        " bytes are not the view's byteLength of " + std::to_string(claimed));
  std::vector<unsigned char> bytes(claimed);
  if (const int error = decode(stream, mode, bytes); error != 0)
    document.fail(field, "its stream cannot be decoded (meshoptimizer's code " + std::to_string(error) + ")");
  if (filter == "OCTAHEDRAL") meshopt_decodeFilterOct(bytes.data(), stream.count, stream.stride);
  if (filter == "QUATERNION") meshopt_decodeFilterQuat(bytes.data(), stream.count, stream.stride);
  if (filter == "EXPONENTIAL") meshopt_decodeFilterExp(bytes.data(), stream.count, stream.stride);
  document.views[index] = std::move(bytes);
}

template <class T>
void append(std::vector<unsigned char>& bytes, const T* values, std::size_t count) {
  const std::size_t size = bytes.size();
  bytes.resize(size + count * sizeof(T));
  std::memcpy(bytes.data() + size, values, count * sizeof(T));
}

template <class T>
bool convert(const draco::Mesh& mesh, const draco::PointAttribute& attribute, int components,
             std::vector<unsigned char>& bytes) {
  T values[16];
  for (draco::PointIndex i(0); i < mesh.num_points(); ++i) {
    if (!attribute.ConvertValue<T>(attribute.mapped_index(i), static_cast<std::int8_t>(components), values))
      return false;
    append(bytes, values, static_cast<std::size_t>(components));
  }
  return true;
}

template <class T>
void convertFaces(const draco::Mesh& mesh, std::vector<unsigned char>& bytes) {
  for (draco::FaceIndex i(0); i < mesh.num_faces(); ++i)
    for (const draco::PointIndex& point : mesh.face(i)) {
      const auto index = static_cast<T>(point.value());
      append(bytes, &index, 1);
    }
}

// An accessor that a stream fills; its own count has to be what the stream holds.
const tinygltf::Accessor& filled(const GltfDocument& document, int accessor, std::size_t count,
                                 const std::string& field) {
  const auto& accessors = document.model.accessors;
  const tinygltf::Accessor& result =
      accessors[document.index(accessor, accessors.size(), field, "accessors")];
  if (result.count != count)
    document.fail(
        "accessors[" + std::to_string(accessor) + "].count",
        std::to_string(result.count) + " are not the " + std::to_string(count) + " of the Draco stream");
  return result;
}

void unpackPrimitive(GltfDocument& document, const tinygltf::Primitive& primitive, const GltfJson& extension,
                     const std::string& primitiveField) {
  const std::string field = primitiveField + ".extensions." + kDraco;
  if (primitive.mode != TINYGLTF_MODE_TRIANGLES)
    document.fail(primitiveField + ".mode", "a Draco stream of other than triangles is not supported");
  const GltfDocument::Bytes data =
      document.bufferView(document.reference(extension, "bufferView", field), field);
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data.data), data.size);
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok())
    document.fail(field, "its stream cannot be decoded: " + decoded.status().error_msg_string());
  const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();

  if (primitive.indices >= 0) {
    const tinygltf::Accessor& accessor =
        filled(document, primitive.indices, 3 * std::size_t(mesh->num_faces()), field);
    std::vector<unsigned char>& bytes = document.accessors[primitive.indices];
    bytes.clear();
    if (!withType(accessor.componentType, [&](auto type) {
          convertFaces<decltype(type)>(*mesh, bytes);
          return true;
        }))
      document.fail(primitiveField + ".indices", "have no component type that there is");
  }
  const auto attributes = extension.find("attributes");
  if (attributes == extension.end() || !attributes->is_object())
    document.fail(field + ".attributes", "is missing or not an object");
  for (const auto& [name, id] : attributes->items()) {
    const std::string attributeField = field + ".attributes." + name;
    const auto own = primitive.attributes.find(name);
    if (own == primitive.attributes.end()) document.fail(attributeField, "is no attribute of the primitive");
    const draco::PointAttribute* attribute =
        id.is_number_unsigned() ? mesh->GetAttributeByUniqueId(id.get<std::uint32_t>()) : nullptr;
    if (!attribute) document.fail(attributeField, id.dump() + " is not in the stream");
    const tinygltf::Accessor& accessor = filled(document, own->second, mesh->num_points(), attributeField);
    const int components = tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type));
    std::vector<unsigned char>& bytes = document.accessors[own->second];
    bytes.clear();
    if (components < 1 || components > 4 || !withType(accessor.componentType, [&](auto type) {
          return convert<decltype(type)>(*mesh, *attribute, components, bytes);
        }))
      document.fail(attributeField,
                    "does not fit the type of accessors[" + std::to_string(own->second) + "]");
  }
}

}  // namespace

void unpack(GltfDocument& document) {
  const auto buffers = document.json.find("buffers"), views = document.json.find("bufferViews");
  if (buffers != document.json.end() && views != document.json.end())
    for (std::size_t i = 0; i < views->size(); ++i) {
      const std::size_t buffer = (*views)[i]["buffer"];
      const GltfJson* extension = extensionOf((*views)[i], kMeshopt);
      if (extension && buffer < buffers->size() && isFallbackBuffer((*buffers)[buffer]))
        unpackView(document, static_cast<int>(i), *extension);
    }
  const auto meshes = document.json.find("meshes");
  if (meshes == document.json.end()) return;
  for (std::size_t m = 0; m < meshes->size(); ++m) {
    const GltfJson& primitives = (*meshes)[m]["primitives"];
    if (document.model.meshes.at(m).primitives.size() != primitives.size())
      document.fail("meshes[" + std::to_string(m) + "].primitives", "cannot all be read");
    for (std::size_t p = 0; p < primitives.size(); ++p)
      if (const GltfJson* extension = extensionOf(primitives[p], kDraco))
        unpackPrimitive(document, document.model.meshes[m].primitives[p], *extension,
                        "meshes[" + std::to_string(m) + "].primitives[" + std::to_string(p) + "]");
  }
}

}  // namespace pellucid::harness
