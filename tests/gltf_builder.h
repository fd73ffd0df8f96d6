// Small glTF files made by tests.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pellucid::test {

// A document under construction: JSON and one buffer.
struct GltfBuilder {
  nlohmann::ordered_json json = {
      {"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
  std::string buffer;

  int view(const void* data, std::size_t size) {
    while (buffer.size() % 4 != 0) buffer.push_back('\0');
    json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", size}});
    append(buffer, data, size);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const std::vector<T>& values, int componentType, const char* type, std::size_t components) {
    const int v = view(values.data(), values.size() * sizeof(T));
    json["accessors"].push_back({{"bufferView", v},
                                 {"componentType", componentType},
                                 {"count", values.size() / components},
                                 {"type", type}});
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int vectors(const std::vector<float>& values) { return accessor(values, 5126, "VEC3", 3); }
  int indices(const std::vector<std::uint16_t>& values) { return accessor(values, 5123, "SCALAR", 1); }

  std::string glb() {
    if (!buffer.empty()) json["buffers"][0] = {{"byteLength", buffer.size()}};  // others stay
    std::string text = json.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bin = buffer;
    bin.resize((bin.size() + 3) / 4 * 4, '\0');
    const auto size = static_cast<std::uint32_t>(20 + text.size() + (bin.empty() ? 0 : 8 + bin.size()));
    const std::uint32_t header[] = {0x46546C67, 2, size, static_cast<std::uint32_t>(text.size()), 0x4E4F534A};
    std::string bytes;
    append(bytes, header, sizeof header);
    bytes += text;
    if (!bin.empty()) {
      const std::uint32_t chunk[] = {static_cast<std::uint32_t>(bin.size()), 0x004E4942};
      append(bytes, chunk, sizeof chunk);
      bytes += bin;
    }
    return bytes;
  }

  // A triangle of one material.
  static GltfBuilder triangle(const std::vector<float>& corners, const nlohmann::ordered_json& material) {
    GltfBuilder b;
    const int position = b.vectors(corners);
    b.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", position}}}, {"material", 0}}}}}};
    b.json["materials"] = {material};
    b.json["nodes"] = {{{"name", "body"}, {"mesh", 0}}};
    return b;
  }

private:
  static void append(std::string& bytes, const void* data, std::size_t size) {
    bytes.append(static_cast<const char*>(data), size);
  }
};

}  // namespace pellucid::test
