#include "gltf/document.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <set>
#include <string_view>

#include "common/error.h"

namespace pellucid::harness {

namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 1u << 30;
constexpr int kMostBytes = 1 << 30;

// Read, and drawn as the extension says.
const std::set<std::string> kRead = {
    "KHR_lights_punctual",   "KHR_materials_diffuse_transmission", "KHR_materials_ior",
    "KHR_materials_transmission", "KHR_materials_volume",          "KHR_materials_volume_scatter",
    "KHR_mesh_quantization", "KHR_texture_transform",
};

// Neither change the triangles nor the diffuse color of a still.
const std::set<std::string> kHarmless = {
    "EXT_lights_image_based",    "KHR_animation_pointer",    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",   "KHR_materials_dispersion", "KHR_materials_emissive_strength",
    "KHR_materials_iridescence", "KHR_materials_sheen",      "KHR_materials_specular",
    "KHR_materials_unlit",       "KHR_materials_variants",   "KHR_xmp_json_ld",
};

constexpr const char* kLists[] = {"scenes",   "nodes",  "meshes",   "accessors", "bufferViews", "cameras",
                                  "images",   "skins",  "textures", "samplers",  "materials"};

// `fail`: throws.
GltfBytes readFile(const fs::path& path, const std::function<void(const std::string&)>& fail) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) fail("\"" + path.filename().string() + "\" is not found");
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) fail(error.message());
  if (size > kMaxFileBytes)
    fail("has " + std::to_string(size) + " bytes; " + std::to_string(kMaxFileBytes) + " are the most");
  GltfBytes bytes(static_cast<std::size_t>(size));
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) fail("cannot be read");
  return bytes;
}

std::size_t word(const GltfBytes& bytes, std::size_t offset) {
  std::size_t value = 0;  // GLB is little-endian
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::size_t>(bytes[offset + i]) << (8 * i);
  return value;
}

// The JSON of a file of either container, and the buffer that a GLB brings along.
struct Container {
  std::string json;
  GltfBytes binary;
};

Container containerOf(const std::string& file, const GltfBytes& bytes) {
  constexpr std::size_t kHeader = 12, kChunkHeader = 8, kJson = kHeader + kChunkHeader;
  if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {{bytes.begin(), bytes.end()}, {}};
  if (bytes.size() < kJson) throw InputError(file, "", "is truncated: a GLB header has 20 bytes");
  if (word(bytes, 4) != 2)
    throw InputError(file, "", "is GLB version " + std::to_string(word(bytes, 4)) + "; 2 is known");
  const auto chunk = [&](std::size_t first) {
    const std::size_t size = word(bytes, first - kChunkHeader);
    if (size > bytes.size() - first)
      throw InputError(file, "",
                       "is truncated: a chunk says " + std::to_string(size) + " bytes, there are " +
                           std::to_string(bytes.size() - first));
    const auto begin = bytes.begin() + static_cast<std::ptrdiff_t>(first);
    return GltfBytes(begin, begin + static_cast<std::ptrdiff_t>(size));
  };
  const GltfBytes json = chunk(kJson);
  const std::size_t binary = kJson + json.size() + kChunkHeader;
  return {{json.begin(), json.end()}, binary <= bytes.size() ? chunk(binary) : GltfBytes()};
}

std::string percentDecoded(const std::string& uri) {
  std::string result;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const auto isHex = [&](std::size_t k) { return std::isxdigit(static_cast<unsigned char>(uri[k])) != 0; };
    if (uri[i] == '%' && i + 2 < uri.size() && isHex(i + 1) && isHex(i + 2)) {
      result += static_cast<char>(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
      i += 2;
    } else {
      result += uri[i];
    }
  }
  return result;
}

GltfBytes fromBase64(const Field& field, std::string_view text) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  while (text.ends_with('=')) text.remove_suffix(1);
  GltfBytes bytes;
  std::uint32_t bits = 0, count = 0;
  for (const char c : text) {
    const std::size_t digit = kDigits.find(c);
    if (digit == std::string_view::npos) field.fail("is not base64");
    bits = bits << 6 | static_cast<std::uint32_t>(digit);
    count += 6;
    if (count < 8) continue;
    count -= 8;
    bytes.push_back(static_cast<unsigned char>(bits >> count));
  }
  return bytes;
}

// `binary`: a GLB's own buffer, which has no URI and may be padded.
GltfBytes readBuffer(const GltfDocument& document, const Field& buffer, const GltfBytes& binary) {
  const auto uri = buffer.find("uri");
  GltfBytes bytes = uri || binary.empty() ? document.resource(buffer["uri"]) : binary;
  const auto claimed = static_cast<std::size_t>(buffer["byteLength"].integer(1, kMostBytes));
  if (claimed > bytes.size())
    buffer["byteLength"].fail(std::to_string(claimed) + " are not the " + std::to_string(bytes.size()) +
                              " bytes that there are");
  bytes.resize(claimed);
  return bytes;
}

}  // namespace

bool isDrawn(const std::string& extension) { return kRead.count(extension) != 0; }

std::optional<Field> extensionOf(const Field& object, const char* name) {
  const auto extensions = object.find("extensions");
  return extensions ? extensions->find(name) : std::nullopt;
}

std::optional<std::string> nameOf(const Field& object) {
  const auto name = object.find("name");
  if (!name || name->value() == "") return std::nullopt;
  return name->text();
}

double numberOr(const Field& object, const char* key, double absent, double least, double most) {
  const auto found = object.find(key);
  return found ? found->number(least, most) : absent;
}

const std::vector<Field>& GltfDocument::list(const char* name) const {
  static const std::vector<Field> kNone;
  const auto found = lists.find(name);
  return found == lists.end() ? kNone : found->second;
}

std::size_t GltfDocument::index(const char* name, const Field& field) const {
  const auto i = static_cast<std::size_t>(field.integer(0, kMostBytes));
  const std::size_t size = list(name).size();
  if (i >= size) field.fail(std::to_string(i) + " is not one of the " + std::to_string(size) + " " + name);
  return i;
}

GltfDocument::Bytes GltfDocument::bufferView(const Field& field) const {
  const Field& view = element("bufferViews", field);
  const GltfBytes& data = buffers[index("buffers", view["buffer"])];
  const auto offset = view.find("byteOffset");
  const auto first = static_cast<std::size_t>(offset ? offset->integer(0, kMostBytes) : 0),
             size = static_cast<std::size_t>(view["byteLength"].integer(1, kMostBytes));
  if (first > data.size() || size > data.size() - first)
    view.fail("byteOffset " + std::to_string(first) + " and byteLength " + std::to_string(size) + " leave the " +
              std::to_string(data.size()) + " bytes of the buffer");
  return {data.data() + first, size};
}

GltfBytes GltfDocument::resource(const Field& uri) const {
  const std::string text = uri.text();
  if (text.starts_with("data:")) {
    const std::size_t comma = text.find(',');
    return fromBase64(uri, comma == std::string::npos ? "" : std::string_view(text).substr(comma + 1));
  }
  const std::string name = folder.string() + "/" + percentDecoded(text);
  std::error_code error;
  const fs::path relative = fs::weakly_canonical(name, error).lexically_relative(folder);
  if (error || relative.empty() || *relative.begin() == "..")
    uri.fail("\"" + text + "\" leaves the file's folder");
  return readFile(name, [&](const std::string& sentence) { uri.fail(sentence); });
}

GltfDocument readGltf(const fs::path& path) {
  GltfDocument document;
  document.file = path.string();
  const Container container = containerOf(document.file, readFile(path, [&](const std::string& sentence) {
    throw InputError(path.string(), "", sentence);
  }));
  std::error_code error;
  document.folder = fs::canonical(path, error).parent_path();
  document.json = parseJson(document.file, container.json);
  const Field root = document.root();
  const Field version = root["asset"]["version"];
  if (!version.text().starts_with("2.")) version.fail(version.shown() + " is not 2.x");
  if (const auto required = root.find("extensionsRequired"))
    for (const Field& name : required->items())
      if (!kRead.count(name.text()) && !kHarmless.count(name.text()))
        required->fail("\"" + name.text() + "\" is not supported");
  for (const char* name : kLists)
    if (const auto list = root.find(name)) document.lists[name] = list->items();
  if (const auto punctual = extensionOf(root, "KHR_lights_punctual"))
    document.lists["lights"] = (*punctual)["lights"].items();
  if (const auto list = root.find("buffers")) {
    for (const Field& buffer : list->items())
      document.buffers.push_back(readBuffer(document, buffer, container.binary));
    document.lists["buffers"] = list->items();
  }
  return document;
}

}  // namespace pellucid::harness
