#include "gltf/document.h"

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <new>
#include <optional>
#include <set>
#include <string_view>

#include "common/error.h"
#include "common/parse.h"
#include "gltf/fields.h"
#include "gltf/meshopt.h"

namespace pellucid::harness {

namespace {

constexpr std::size_t kMaxDepth = 100;  // tinygltf reads extensions and extras recursively

struct Type {
  const char* name;
  bool (*holds)(const GltfJson& value);
};
const Type kObject{"an object", [](const GltfJson& v) { return v.is_object(); }};
const Type kArray{"an array", [](const GltfJson& v) { return v.is_array(); }};
const Type kString{"a string", [](const GltfJson& v) { return v.is_string(); }};
const Type kNumber{"a number", [](const GltfJson& v) { return v.is_number(); }};
const Type kBoolean{"true or false", [](const GltfJson& v) { return v.is_boolean(); }};
const Type kIndex{"an integer >= 0", [](const GltfJson& v) {
                    return v.is_number_unsigned() || (v.is_number_integer() && v.get<std::int64_t>() >= 0);
                  }};

template <std::size_t N>
bool holdsNumbers(const GltfJson& v) {
  return v.is_array() && v.size() == N && std::all_of(v.begin(), v.end(), [](const GltfJson& e) { return e.is_number(); });
}
const Type kThree{"3 numbers", &holdsNumbers<3>}, kFour{"4 numbers", &holdsNumbers<4>}, kSixteen{"16 numbers", &holdsNumbers<16>};
const Type kAlphaMode{"OPAQUE, MASK or BLEND", [](const GltfJson& v) { return v == "OPAQUE" || v == "MASK" || v == "BLEND"; }};
const Type kCameraType{"perspective or orthographic",
                       [](const GltfJson& v) { return v == "perspective" || v == "orthographic"; }};
const Type kLightType{"directional, point or spot",
                      [](const GltfJson& v) { return v == "directional" || v == "point" || v == "spot"; }};
const Type kStride{"a multiple of 4 from 4 to 252", [](const GltfJson& v) {
                     return v.is_number_unsigned() && v >= 4 && v <= 252 && v.get<std::uint64_t>() % 4 == 0;
                   }};

enum class Need { None, Always, OfType };  // OfType: where the object's "type" is the path's last key

// Paths that tinygltf needs to be there, or to be of a type. A step of a path is a key, keys with commas, or
// *: every element of an array or object.
struct Rule {
  const char* path;
  const Type& type;
  Need need = Need::None;
};

constexpr Need kRequired = Need::Always;

const Rule kRules[] = {
    {"asset", kObject, kRequired},
    {"asset.version", kString, kRequired},
    {"scene", kIndex},
    {"extensionsUsed,extensionsRequired", kArray},
    {"extensionsUsed,extensionsRequired.*", kString},
    {"scenes,nodes,meshes,accessors,bufferViews,buffers,cameras,images,textures,samplers,materials", kArray},
    {"scenes,nodes,meshes,accessors,bufferViews,buffers,cameras,images,textures,samplers,materials.*",
     kObject},
    {"skins", kArray},
    {"skins.*", kObject},
    {"scenes.*.nodes", kArray},
    {"scenes.*.nodes.*", kIndex},
    {"nodes.*.children", kArray},
    {"nodes.*.children.*", kIndex},
    {"nodes.*.mesh,skin,camera", kIndex},
    {"nodes.*.matrix", kSixteen},
    {"nodes.*.translation,scale", kThree},
    {"nodes.*.rotation", kFour},
    {"nodes,meshes.*.weights", kArray},
    {"nodes,meshes.*.weights.*", kNumber},
    {"meshes.*.primitives", kArray, kRequired},
    {"meshes.*.primitives.*", kObject},
    {"meshes.*.primitives.*.attributes", kObject, kRequired},
    {"meshes.*.primitives.*.attributes.*", kIndex},
    {"meshes.*.primitives.*.indices,material,mode", kIndex},
    {"meshes.*.primitives.*.targets", kArray},
    {"meshes.*.primitives.*.targets.*", kObject},
    {"meshes.*.primitives.*.targets.*.*", kIndex},
    {"accessors.*.bufferView,byteOffset", kIndex},
    {"accessors.*.componentType,count", kIndex, kRequired},
    {"accessors.*.type", kString, kRequired},
    {"accessors.*.normalized", kBoolean},
    {"accessors.*.sparse", kObject},
    {"accessors.*.sparse.count", kIndex, kRequired},
    {"accessors.*.sparse.indices,values", kObject, kRequired},
    {"accessors.*.sparse.indices,values.bufferView", kIndex, kRequired},
    {"accessors.*.sparse.indices.componentType", kIndex, kRequired},
    {"accessors.*.sparse.indices,values.byteOffset", kIndex},
    {"bufferViews.*.buffer,byteLength", kIndex, kRequired},
    {"bufferViews.*.byteOffset", kIndex},
    {"bufferViews.*.byteStride", kStride},
    {"buffers.*.byteLength", kIndex, kRequired},
    {"buffers.*.uri", kString},
    {"cameras.*.type", kCameraType, kRequired},
    {"cameras.*.perspective,orthographic", kObject, Need::OfType},
    {"cameras.*.perspective.yfov,znear", kNumber, kRequired},
    {"cameras.*.perspective.zfar,aspectRatio", kNumber},
    {"cameras.*.orthographic.xmag,ymag,zfar,znear", kNumber, kRequired},
    {"images.*.uri", kString},
    {"images.*.bufferView", kIndex},
    {"textures.*.source,sampler", kIndex},
    {"samplers.*.wrapS,wrapT,minFilter,magFilter", kIndex},
    {"materials.*.pbrMetallicRoughness,normalTexture,extensions", kObject},
    {"materials.*.pbrMetallicRoughness.baseColorFactor", kFour},
    {"materials.*.pbrMetallicRoughness.baseColorTexture", kObject},
    {"materials.*.pbrMetallicRoughness.baseColorTexture.index", kIndex, kRequired},
    {"materials.*.normalTexture.index", kIndex, kRequired},
    {"materials.*.normalTexture.scale", kNumber},
    {"materials.*.alphaMode", kAlphaMode},
    {"materials.*.alphaCutoff", kNumber},
    {"materials.*.doubleSided", kBoolean},
    {"extensions", kObject},
    {"extensions.KHR_lights_punctual", kObject},
    {"extensions.KHR_lights_punctual.lights", kArray},
    {"extensions.KHR_lights_punctual.lights.*", kObject},
    {"extensions.KHR_lights_punctual.lights.*.type", kLightType, kRequired},
    {"extensions.KHR_lights_punctual.lights.*.color", kThree},
    {"extensions.KHR_lights_punctual.lights.*.intensity,range", kNumber},
    {"extensions.KHR_lights_punctual.lights.*.spot", kObject, Need::OfType},
    {"extensions.KHR_lights_punctual.lights.*.spot.innerConeAngle,outerConeAngle", kNumber},
};

std::string shown(const GltfJson& value) {
  constexpr std::size_t kLongest = 40;
  std::string text = value.dump(-1, ' ', false, GltfJson::error_handler_t::replace);
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
  return text;
}

// `rest`: the rule's path below `value`, whose own path is `field`.
void apply(const std::string& file, const Rule& rule, const GltfJson& value, std::string_view rest,
           const std::string& field) {
  if (rest.empty()) {
    if (!rule.type.holds(value)) throw InputError(file, field, shown(value) + " is not " + rule.type.name);
    return;
  }
  const std::size_t dot = rest.find('.');
  const std::string_view step = rest.substr(0, dot);
  const std::string_view below = dot == std::string_view::npos ? std::string_view() : rest.substr(dot + 1);
  if (step == "*") {
    std::size_t i = 0;
    if (value.is_array())
      for (const GltfJson& element : value)
        apply(file, rule, element, below, field + "[" + std::to_string(i++) + "]");
    else if (value.is_object())
      for (const auto& [name, element] : value.items()) apply(file, rule, element, below, field + "." + name);
    return;
  }
  if (!value.is_object()) return;  // a rule of its own says so
  for (const std::string& key : split(std::string(step), ',')) {
    const std::string path = field.empty() ? key : field + "." + key;
    const auto found = value.find(key);
    if (found != value.end())
      apply(file, rule, *found, below, path);
    else if (below.empty() &&
             (rule.need == Need::Always || (rule.need == Need::OfType && value["type"] == key)))
      throw InputError(file, path, "is missing");
  }
}

// Depth of brackets outside strings.
void checkNesting(const std::string& file, std::string_view json) {
  std::size_t depth = 0;
  bool inString = false;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (inString && c == '\\')
      ++i;
    else if (c == '"')
      inString = !inString;
    else if (!inString && (c == '[' || c == '{') && ++depth > kMaxDepth)
      throw InputError(file, "", "its JSON is nested deeper than " + std::to_string(kMaxDepth) + " levels");
    else if (!inString && (c == ']' || c == '}') && depth > 0)
      --depth;
  }
}

// Files of glTF 1.0 differ in all else.
void checkVersion(const std::string& file, const GltfJson& json) {
  const GltfJson asset = json.value("asset", GltfJson());
  for (const char* key : {"version", "minVersion"}) {
    const GltfJson version = asset.is_object() ? asset.value(key, GltfJson()) : GltfJson();
    const bool fits = std::string_view(key) == "version" ? version.is_string() && version.get<std::string>().starts_with("2.")
                                                         : version == "2.0";
    if (!version.is_null() && !fits) throw InputError(file, std::string("asset.") + key, shown(version) + " is not 2.0; export glTF 2.0");
  }
}

// Parses `text` and throws InputError for what tinygltf would refuse without a field: JSON that is none,
// extensions that are required and not known, and properties that are missing or of another type.
GltfJson parseGltfJson(const std::string& file, std::string_view text) {
  const std::size_t first = text.find_first_not_of("\xEF\xBB\xBF \t\r\n");  // behind a mark of UTF-8
  if (first == std::string_view::npos || text[first] != '{')
    throw InputError(file, "", "is no glTF file, which begins with \"{\" or \"glTF\"; export one as .glb");
  checkNesting(file, text);
  GltfJson json;
  try {
    json = GltfJson::parse(text);
  } catch (const GltfJson::exception& e) {
    throw InputError(file, "", std::string("its JSON cannot be parsed: ") + e.what());
  }
  if (!json.is_object()) throw InputError(file, "", "its JSON is not an object");
  checkVersion(file, json);
  checkRequiredExtensions(file, json);
  for (const Rule& rule : kRules) apply(file, rule, json, rule.path, "");
  return json;
}

// The data URI of a MIME type that tinygltf takes: it takes other types for names of files. The bytes say what they are.
void setDataType(GltfJson& object, const char* type) {
  const auto uri = object.find("uri");
  if (uri == object.end() || !uri->is_string()) return;
  const std::string text = *uri, mark = ";base64,";
  const std::size_t at = text.find(mark);
  if (text.starts_with("data:") && at != std::string::npos) *uri = "data:" + std::string(type) + text.substr(at);
}

// The document without animations, which captures have none of, and without skins, which this program reads
// itself: tinygltf is stricter about both than glTF. `bytes`: of the buffers, which may be longer than they say.
GltfJson forTinyGltf(const GltfJson& json, const std::vector<std::size_t>& bytes) {
  GltfJson result = json;
  result.erase("animations");
  result.erase("skins");
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    result["buffers"][i]["byteLength"] = bytes[i];
    setDataType(result["buffers"][i], "application/octet-stream");
  }
  if (const auto images = result.find("images"); images != result.end())
    for (GltfJson& image : *images) setDataType(image, "image/png");
  pointToCompressed(result);
  return result;
}

namespace fs = std::filesystem;

constexpr std::uintmax_t kMaxFileBytes = 1u << 30;  // tinygltf counts in 32 bits
constexpr std::size_t kGlbHeader = 20;

// Why the file cannot be read, or nothing.
std::optional<std::string> readFile(const fs::path& path, std::vector<unsigned char>& bytes) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return "is not a file that can be read";
  const std::uintmax_t size = fs::file_size(path, error);
  if (error) return error.message();
  if (size > kMaxFileBytes)
    return "has " + std::to_string(size) + " bytes; " + std::to_string(kMaxFileBytes) + " are the most";
  bytes.resize(static_cast<std::size_t>(size));
  std::ifstream in(path, std::ios::binary);
  in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (!in) return "cannot be read";
  return std::nullopt;
}

// What tinygltf's callbacks need and leave behind.
struct Session {
  fs::path folder;  // canonical
  std::string refusal;
  std::vector<std::vector<unsigned char>> images;
};

// tinygltf also looks in the working directory; only the file's folder counts here.
bool isInFolder(const std::string& name, Session& session) {
  if (name.rfind(session.folder.string(), 0) != 0) return false;
  std::error_code error;
  const fs::path real = fs::weakly_canonical(name, error);
  const fs::path relative = real.lexically_relative(session.folder);
  if (!error && !relative.empty() && *relative.begin() != "..") return true;
  session.refusal = "\"" + name.substr(std::min(name.size(), session.folder.string().size() + 1)) +
                    "\" leaves the file's folder";
  return false;
}

tinygltf::FsCallbacks fileAccess(Session& session) {
  tinygltf::FsCallbacks callbacks{};
  callbacks.user_data = &session;
  callbacks.FileExists = [](const std::string& name, void* user) {
    std::error_code error;
    return isInFolder(name, *static_cast<Session*>(user)) && fs::is_regular_file(name, error);
  };
  callbacks.ExpandFilePath = [](const std::string& name, void*) { return name; };
  callbacks.ReadWholeFile = [](std::vector<unsigned char>* bytes, std::string* problem,
                               const std::string& name, void*) {
    const std::optional<std::string> why = readFile(name, *bytes);
    if (why && problem) *problem = *why;
    return !why;
  };
  callbacks.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&, void*) {
    return false;
  };
  return callbacks;
}

// Keeps the encoded bytes: which images are decoded is decided later. Those of a buffer view are left
// alone, because tinygltf has not checked that the view lies in its buffer.
bool keepImage(tinygltf::Image* image, const int index, std::string*, std::string*, int, int,
               const unsigned char* bytes, int size, void* user) {
  if (image->bufferView >= 0) return true;
  auto& images = static_cast<Session*>(user)->images;
  images.resize(std::max(images.size(), static_cast<std::size_t>(index) + 1));
  images[static_cast<std::size_t>(index)].assign(bytes, bytes + size);
  return true;
}

std::uint32_t word(const std::vector<unsigned char>& bytes, std::size_t offset) {
  std::uint32_t value = 0;  // GLB is little-endian
  for (std::size_t i = 0; i < 4; ++i) value |= static_cast<std::uint32_t>(bytes[offset + i]) << (8 * i);
  return value;
}

bool isBinary(const std::vector<unsigned char>& bytes) {
  return bytes.size() >= 4 && std::memcmp(bytes.data(), "glTF", 4) == 0;
}

// The JSON text of either container.
std::string_view jsonText(const std::string& file, const std::vector<unsigned char>& bytes) {
  const auto* text = reinterpret_cast<const char*>(bytes.data());
  if (!isBinary(bytes)) return {text, bytes.size()};
  if (bytes.size() < kGlbHeader) throw InputError(file, "", "is truncated: a GLB header has 20 bytes");
  if (word(bytes, 4) != 2)
    throw InputError(file, "", "is GLB version " + std::to_string(word(bytes, 4)) + "; 2 is known");
  if (word(bytes, 8) > bytes.size())
    throw InputError(file, "",
                     "is truncated: its header says " + std::to_string(word(bytes, 8)) +
                         " bytes, there are " + std::to_string(bytes.size()));
  if (word(bytes, 12) > bytes.size() - kGlbHeader)
    throw InputError(file, "",
                     "its JSON chunk says " + std::to_string(word(bytes, 12)) + " bytes, there are " +
                         std::to_string(bytes.size() - kGlbHeader));
  return {text + kGlbHeader, word(bytes, 12)};
}

// The length of what a GLB holds behind its JSON: its first buffer.
std::size_t binaryBytes(const std::vector<unsigned char>& bytes, std::string_view json) {
  constexpr std::size_t kChunkHeader = 8;
  const std::size_t chunk = kGlbHeader + json.size();
  return bytes.size() - chunk < kChunkHeader
             ? 0
             : std::min<std::size_t>(word(bytes, chunk), bytes.size() - chunk - kChunkHeader);
}

void setWord(std::vector<unsigned char>& bytes, std::size_t offset, std::size_t value) {
  for (std::size_t i = 0; i < 4; ++i) bytes[offset + i] = static_cast<unsigned char>(value >> (8 * i));
}

// The file with another JSON text.
std::vector<unsigned char> withJson(std::vector<unsigned char> bytes, std::size_t oldSize, std::string text) {
  if (!isBinary(bytes)) return {text.begin(), text.end()};
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const auto first = bytes.begin() + kGlbHeader;
  const std::size_t shared = std::min(oldSize, text.size());
  std::copy_n(text.begin(), shared, first);
  const auto end = first + static_cast<std::ptrdiff_t>(shared);
  if (text.size() > oldSize)
    bytes.insert(end, text.begin() + static_cast<std::ptrdiff_t>(shared), text.end());
  else
    bytes.erase(end, first + static_cast<std::ptrdiff_t>(oldSize));
  setWord(bytes, 8, bytes.size());
  setWord(bytes, 12, text.size());
  return bytes;
}

// tinygltf's lines as one sentence.
std::string sentenceOf(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  for (std::size_t i = text.find('\n'); i != std::string::npos; i = text.find('\n', i))
    text.replace(i, 1, "; ");
  constexpr std::size_t kLongest = 300;
  if (text.size() > kLongest) text = text.substr(0, kLongest) + " ...";
  return text.empty() ? "cannot be parsed" : text;
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

std::size_t base64Bytes(const std::string& uri) {
  const std::size_t comma = uri.find(',');
  std::size_t digits = comma == std::string::npos ? 0 : uri.size() - comma - 1;
  for (std::size_t end = uri.size(); digits > 0 && uri[end - 1] == '='; --end) --digits;
  return digits * 3 / 4;
}

// Bytes of each buffer. Refuses by name the buffers that tinygltf would refuse without a name. `binary`: bytes of a GLB's own
// buffer.
std::vector<std::size_t> checkBuffers(const GltfDocument& document, Session& session, std::size_t binary) {
  std::vector<std::size_t> all;
  const auto buffers = document.json.find("buffers");
  if (buffers == document.json.end()) return all;
  for (std::size_t i = 0; i < buffers->size(); ++i) {
    const GltfJson& buffer = (*buffers)[i];
    const std::size_t claimed = buffer["byteLength"];
    all.push_back(claimed);
    if (isMeshoptFallback(buffer)) continue;
    const std::string field = "buffers[" + std::to_string(i) + "].";
    const std::string uri = buffer.value("uri", "");
    std::size_t bytes = binary;
    std::string where = "BIN chunk";
    if (uri.empty()) {
      if (binary == 0) document.fail(field + "uri", "is missing");
      if (claimed <= binary) continue;  // the chunk is padded
    } else if (uri.starts_with("data:") && uri.find(";base64,") == std::string::npos) {
      document.fail(field + "uri", "\"" + uri.substr(0, 40) + "\" is a data URI that is not base64");
    } else if (uri.starts_with("data:")) {
      bytes = base64Bytes(uri);
      where = "data URI";
    } else {
      const std::string name = session.folder.string() + "/" + percentDecoded(uri);
      if (!isInFolder(name, session)) document.fail(field + "uri", session.refusal);
      std::error_code error;
      if (!fs::is_regular_file(name, error)) document.fail(field + "uri", "\"" + uri + "\" is not found");
      bytes = static_cast<std::size_t>(fs::file_size(name, error));
      where = "\"" + uri + "\"";
    }
    if (claimed > bytes)
      document.fail(field + "byteLength", std::to_string(claimed) + " are more than the " + std::to_string(bytes) +
                                              " bytes of its " + where);
    all.back() = bytes;
  }
  return all;
}

}  // namespace

const GltfJson* extensionOf(const GltfJson& value, const char* name) {
  const auto extensions = value.find("extensions");
  if (extensions == value.end() || !extensions->is_object()) return nullptr;
  const auto found = extensions->find(name);
  return found != extensions->end() && found->is_object() ? &*found : nullptr;
}

void GltfDocument::fail(const std::string& field, const std::string& sentence) const {
  throw InputError(file, field, sentence);
}

std::size_t GltfDocument::index(int index, std::size_t size, const std::string& field,
                                const char* plural) const {
  if (index < 0 || static_cast<std::size_t>(index) >= size)
    fail(field, std::to_string(index) + " is not one of the " + std::to_string(size) + " " + plural);
  return static_cast<std::size_t>(index);
}

int GltfDocument::reference(const GltfJson& object, const char* key, const std::string& field) const {
  const auto found = object.find(key);
  if (found == object.end()) fail(field + "." + key, "is missing");
  if (!found->is_number_unsigned()) fail(field + "." + key, found->dump() + " is not an integer >= 0");
  return static_cast<int>(std::min<std::size_t>(found->get<std::size_t>(), 1u << 30));
}

GltfDocument::Bytes GltfDocument::bufferView(int viewIndex, const std::string& field) const {
  const tinygltf::BufferView& view =
      model.bufferViews[index(viewIndex, model.bufferViews.size(), field + ".bufferView", "buffer views")];
  const std::string name = "bufferViews[" + std::to_string(viewIndex) + "]";
  const auto& data = model.buffers[index(view.buffer, model.buffers.size(), name + ".buffer", "buffers")].data;
  if (view.byteOffset > data.size() || view.byteLength > data.size() - view.byteOffset)
    fail(name, "byteOffset " + std::to_string(view.byteOffset) + " and byteLength " +
                   std::to_string(view.byteLength) + " leave the " + std::to_string(data.size()) +
                   " bytes of buffers[" + std::to_string(view.buffer) + "]");
  return {data.data() + view.byteOffset, view.byteLength};
}

GltfDocument readGltf(const fs::path& path) {
  GltfDocument document;
  document.file = path.string();
  std::vector<unsigned char> bytes;
  if (const std::optional<std::string> why = readFile(path, bytes)) document.fail("", *why);
  const std::string_view text = jsonText(document.file, bytes);
  document.json = parseGltfJson(document.file, text);

  Session session;
  std::error_code error;
  session.folder = fs::canonical(path, error).parent_path();
  const std::vector<std::size_t> buffers = checkBuffers(document, session, isBinary(bytes) ? binaryBytes(bytes, text) : 0);
  bytes = withJson(std::move(bytes), text.size(), forTinyGltf(document.json, buffers).dump());
  tinygltf::TinyGLTF loader;
  loader.SetFsCallbacks(fileAccess(session));
  loader.SetImageLoader(keepImage, &session);
  std::string problems, warnings;
  bool loaded = false;
  try {
    const auto size = static_cast<unsigned int>(bytes.size());
    const std::string folder = session.folder.string();
    loaded =
        isBinary(bytes)
            ? loader.LoadBinaryFromMemory(&document.model, &problems, &warnings, bytes.data(), size, folder)
            : loader.LoadASCIIFromString(&document.model, &problems, &warnings,
                                         reinterpret_cast<const char*>(bytes.data()), size, folder);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& e) {
    problems = e.what();
  }
  if (!session.refusal.empty()) document.fail("", session.refusal);
  // Some mistakes only leave a message, and the object out.
  if (!loaded || !problems.empty()) document.fail("", sentenceOf(problems));
  document.images = std::move(session.images);
  document.images.resize(document.model.images.size());
  decodeMeshopt(document);
  return document;
}

}  // namespace pellucid::harness
