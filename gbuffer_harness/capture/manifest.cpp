#include "capture/manifest.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <glm/glm.hpp>
#include <numbers>
#include <sstream>
#include <tuple>

#include "capture/capture.h"
#include "capture/exr.h"
#include "capture/json_field.h"
#include "capture/manifest_parts.h"
#include "common/bounds.h"
#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

namespace {

// Throw InputError naming the field: for a matrix that is singular, and for one that is no rotation and
// translation.
Matrix invertible(const Field& field) {
  const Matrix matrix = field.numbers<16>();
  // Units differ between rows and columns; scale them away before judging the determinant.
  glm::dmat4 scaled;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      scaled[column][row] = matrix[static_cast<std::size_t>(column * 4 + row)];
  const auto largest = [](const glm::dvec4& v) {
    return std::max(std::max(std::abs(v.x), std::abs(v.y)), std::max(std::abs(v.z), std::abs(v.w)));
  };
  for (int pass = 0; pass < 2; ++pass) {  // first rows, then columns
    scaled = glm::transpose(scaled);
    for (int i = 0; i < 4; ++i)
      if (largest(scaled[i]) > 0) scaled[i] /= largest(scaled[i]);
  }
  if (!(std::abs(glm::determinant(scaled)) > 1e-10)) field.fail("the matrix is singular: " + field.shown());
  return matrix;
}

// A perspective has w = -z or z, and near and far planes in number 15. Transposed, it has them in number 12.
Matrix projection(const Field& field) {
  const Matrix m = invertible(field);
  if (m[11] != 0 && m[15] == 0 && std::abs(m[14]) == 1 && std::abs(m[11]) != 1)
    field.fail("looks transposed, as number 15 is " + std::string(m[14] > 0 ? "1" : "-1") +
               "; matrices are column-major, and number 12 of a perspective is 1 or -1");
  return m;
}

Matrix rigid(const Field& field) {
  Matrix m = field.numbers<16>();
  constexpr double kTolerance = 1e-3;  // matrices that went through float32 and a few products
  if (std::abs(m[3]) + std::abs(m[7]) + std::abs(m[11]) + std::abs(m[15] - 1) > kTolerance)
    field.fail(
        "the last row must be 0 0 0 1; matrices are column-major, with the translation in numbers 13 to 15");
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      const double dot = m[a * 4] * m[b * 4] + m[a * 4 + 1] * m[b * 4 + 1] + m[a * 4 + 2] * m[b * 4 + 2];
      if (std::abs(dot - (a == b ? 1 : 0)) > kTolerance)
        field.fail("must be rigid (rotation and translation, no scale), so that view units are scene units");
    }
  m[3] = m[7] = m[11] = 0;
  m[15] = 1;
  if (glm::determinant(glm::dmat3(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10])) < 0)
    field.fail("is mirrored, and no rotation: negate the row of one axis, as that of z for a left-handed view, here and the column "
               "of this axis in clipFromView");
  return m;
}

constexpr int kVersion = 1;
constexpr int kMaxMaterials = 255;  // the module's material image has 8 bits

// Reads one buffer of `components` values per pixel; `directory` is where relative names start and
// `embedded` the EXR that holds the manifest, or empty.
struct BufferReader {
  std::filesystem::path directory, embedded;

  BufferSource operator()(const Field& field, std::size_t components) const {
    BufferSource source;
    source.field = field.path();
    if (const auto scale = field.find("scale")) {
      source.scale = scale->number();
      // Depths may be negative before the camera.
      const bool isDepth = field.has("encoding") || source.field.ends_with(".exit");
      if (!(source.scale > 0) && !(isDepth && source.scale < 0))
        scale->fail((isDepth ? "must not be 0, is " : "must be above 0, is ") + scale->shown());
    }
    if (field.has("constant")) {
      for (const char* key : {"file", "part", "channel", "channels"})
        if (const auto other = field.find(key)) other->fail("a constant has no " + std::string(key));
      const Field constant = field["constant"];
      source.constant = constant.numbers();
      if (source.constant.size() != components)
        constant.fail("needs " + std::to_string(components) + " number(s), has " +
                      std::to_string(source.constant.size()));
      return source;
    }
    if (const auto file = field.find("file"))
      source.file = directory / file->text();
    else if (!embedded.empty())
      source.file = embedded;
    else
      field["file"];  // throws: missing
    if (const auto part = field.find("part")) source.part = part->integer(0, 65535);
    if (components == 1) {
      source.channels = {field["channel"].text()};
    } else {
      const Field channels = field["channels"];
      for (const Field& channel : channels.items()) source.channels.push_back(channel.text());
      if (source.channels.size() != components)
        channels.fail("needs " + std::to_string(components) + " channel names, has " +
                      std::to_string(source.channels.size()));
    }
    return source;
  }
};

// Names of PellucidDepthEncoding and PellucidLightType, by their values.
const std::vector<std::string> kEncodings = {"device", "viewZ", "distance"},
                               kBackEncodings = {"device", "viewZ", "distance", "thickness"},
                               kLightTypes = {"directional", "point", "spot"};
static_assert(PELLUCID_DEPTH_DEVICE == 0 && PELLUCID_DEPTH_VIEW_Z == 1 && PELLUCID_DEPTH_DISTANCE == 2 &&
              PELLUCID_DEPTH_THICKNESS == 3);
static_assert(PELLUCID_LIGHT_DIRECTIONAL == 0 && PELLUCID_LIGHT_POINT == 1 && PELLUCID_LIGHT_SPOT == 2);

// Nothing: neither a whole number that a float holds nor "*".
std::optional<int> storedValueOf(const std::string& key) {
  if (key == "*") return kOtherValues;
  const std::optional<int> value = numberIn<int>(key);
  return value && *value >= -kMaxStoredMaterial && *value <= kMaxStoredMaterial ? value : std::nullopt;
}

MaterialMap readMaterialMap(const Field& field, int materialCount) {
  MaterialMap map;
  for (const auto& [key, value] : field.members()) {
    const std::optional<int> stored = storedValueOf(key);
    if (!stored)
      value.fail("the key must be a whole number of at most " + std::to_string(kMaxStoredMaterial) +
                 " and either sign, or \"*\" for all other values");
    const int index = value.integer(0, kMaxMaterials);
    if (index > materialCount)
      value.fail("material " + std::to_string(index) + ", but there are " + std::to_string(materialCount) +
                 " materials");
    if (!map.emplace(*stored, index).second) value.fail("the same stored value stands twice");
  }
  if (map.empty()) field.fail("must not be empty");
  return map;
}

constexpr int kMostTexels = 65536, kMostLayers = 2047;  // of the module and of devices

std::array<int, 2> pairOf(const Field& field, int least) {
  const std::vector<Field> items = field.items();
  if (items.size() != 2) field.fail("needs 2 whole numbers, has " + std::to_string(items.size()));
  return {items[0].integer(least, kMostTexels), items[1].integer(least, kMostTexels)};
}

void refuseScaleOfDevice(const Field& field, PellucidDepthEncoding encoding) {
  if (encoding != PELLUCID_DEPTH_DEVICE) return;
  if (const auto scale = field.find("scale"))
    scale->fail("a device depth has no unit; the matrix says what it means");
}

constexpr double kLargest = 1e15, kMostSlope = 1e6;  // of the module
constexpr NumberField<ShadowMap> kMapNumbers[] = {
    {"depthBiasConstant", &ShadowMap::depthBiasConstant, -kLargest, kLargest},
    {"depthBiasSlope", &ShadowMap::depthBiasSlope, -kMostSlope, kMostSlope},
    {"offsetLength", &ShadowMap::offsetLength, 0, kLargest},
    {"depthStep", &ShadowMap::depthStep, 0, kLargest}};

ShadowMap readShadowMap(const Field& field) {
  field.allowKeys({"file", "part", "channel", "constant", "scale", "encoding", "clipFromWorld",
                   "viewFromWorld", "exit", "casterMaterial", "offset", "size", "layer", "faces",
                   "depthBiasConstant", "depthBiasSlope", "offsetLength", "depthStep"});
  ShadowMap map;
  map.depth.encoding = static_cast<PellucidDepthEncoding>(field["encoding"].choice(kEncodings));
  refuseScaleOfDevice(field, map.depth.encoding);
  map.clipFromWorld = invertible(field["clipFromWorld"]);
  if (field.has("viewFromWorld") || map.depth.encoding != PELLUCID_DEPTH_DEVICE)
    map.viewFromWorld = rigid(field["viewFromWorld"]);
  if (const auto faces = field.find("faces")) map.backFaces = faces->choice({"front", "back"}) == 1;
  readNumbers(field, kMapNumbers, map);
  if (const auto layer = field.find("layer")) map.layer = layer->integer(0, kMostLayers);
  if (const auto offset = field.find("offset")) {
    if (!field.has("size")) offset->fail("needs \"size\", the tile's size");
    map.offset = pairOf(*offset, 0);
  }
  return map;
}

ShadowSources readShadowSources(const Field& map, const BufferReader& read, int materialCount) {
  ShadowSources sources;
  sources.depth = read(map, 1);
  if (const auto size = map.find("size")) {
    if (sources.depth.isConstant()) size->fail("a constant has no tiles");
    sources.tile = pairOf(*size, 1);
  }
  if (const auto exit = map.find("exit")) {
    exit->allowKeys({"file", "part", "channel", "constant", "scale"});
    sources.exit = read(*exit, 1);
  }
  if (const auto caster = map.find("casterMaterial")) {
    caster->allowKeys({"file", "part", "channel", "constant", "map", "scale"});
    sources.casterMaterial = read(*caster, 1);
    if (const auto names = caster->find("map"))
      sources.casterMaterialMap = readMaterialMap(*names, materialCount);
  }
  return sources;
}

// A light's maps: "shadowMap" is one, "shadowMaps" are several.
std::vector<Field> shadowMapsOf(const Field& light) {
  const auto one = light.find("shadowMap"), several = light.find("shadowMaps");
  if (one && several) several->fail("a light has either \"shadowMap\" or \"shadowMaps\", not both");
  if (one) return {*one};
  if (!several) return {};
  std::vector<Field> maps = several->items();
  if (maps.empty() || maps.size() > PELLUCID_MAX_LIGHT_SHADOW_MAPS)
    several->fail("needs 1 to " + std::to_string(PELLUCID_MAX_LIGHT_SHADOW_MAPS) + " shadow maps, has " +
                  std::to_string(maps.size()));
  return maps;
}

// Linear between the table's factors, at a place from 0 to 1.
double between(const std::vector<double>& table, double place) {
  const double at = place * static_cast<double>(table.size() - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(at), table.size() - 2);
  return std::lerp(table[below], table[below + 1], at - static_cast<double>(below));
}

double placeOf(std::size_t i, std::size_t count) {
  return static_cast<double>(i) / static_cast<double>(count - 1);
}

// Reads factors 0..1 at equal steps, two or more, as the PELLUCID_LIGHT_TABLE_ENTRIES of the module between
// which they are linear. `error`: the largest difference from the factors that were given. Throws InputError
// for other values, and for a light of that type.
std::vector<double> readLightTable(const Field& field, PellucidLightType type, double& error) {
  if (type == PELLUCID_LIGHT_DIRECTIONAL) field.fail("is of point and spot lights; the light is directional");
  const std::vector<double> given = field.numbers(0, 1);
  if (given.size() < 2) field.fail("needs two factors or more, has " + std::to_string(given.size()));
  std::vector<double> table(PELLUCID_LIGHT_TABLE_ENTRIES);
  for (std::size_t i = 0; i < table.size(); ++i) table[i] = between(given, placeOf(i, table.size()));
  error = 0;
  for (std::size_t i = 0; i < given.size(); ++i)
    error = std::max(error, std::abs(between(table, placeOf(i, given.size())) - given[i]));
  return table;
}

constexpr double kLongest = 1e15;  // of the module's lengths and intensities

std::string shown(double value) {
  std::ostringstream number;
  number.precision(9);  // as many as tell two floats apart
  number << value;
  return number.str();
}

}  // namespace

nlohmann::ordered_json lightJson(const Light& light) {
  nlohmann::ordered_json json = {{"type", kLightTypes[light.type]}, {"position", light.position},
                                 {"direction", light.direction},    {"color", light.color},
                                 {"intensity", light.intensity},    {"range", light.range}};
  if (light.radius > 0) json["radius"] = light.radius;
  if (!light.angleTable.empty()) json["angleTable"] = light.angleTable;
  if (!light.distanceTable.empty()) json["distanceTable"] = light.distanceTable;
  if (light.type == PELLUCID_LIGHT_SPOT) {
    json["innerConeAngle"] = light.innerConeAngle;
    json["outerConeAngle"] = light.outerConeAngle;
  }
  return json;
}

void addMapJson(const ShadowMap& map, nlohmann::ordered_json& json) {
  json["encoding"] = encodingName(map.depth.encoding);
  json["clipFromWorld"] = map.clipFromWorld;
  if (map.viewFromWorld) json["viewFromWorld"] = *map.viewFromWorld;
  if (map.backFaces) json["faces"] = "back";
  for (const NumberField<ShadowMap>& n : kMapNumbers)
    if (map.*n.member != 0) json[n.key] = map.*n.member;
}

void fitLight(Light& light, const std::function<void(const char* key, const std::string& sentence)>& fail) {
  const auto fit = [&](const char* key, double& value, double most) {
    value = fitted(value, 0, most);
    if (!(value >= 0)) fail(key, "must not be negative, is " + shown(value));
    if (!(value <= most)) fail(key, "must be at most " + shown(most) + ", is " + shown(value));
  };
  for (double& component : light.color) fit("color", component, kLongest);
  fit("intensity", light.intensity, kLongest);
  light.range = std::min(light.range, kLongest);  // exporters write up to FLT_MAX for unlimited lights
  fit("range", light.range, kLongest);
  fit("radius", light.radius, kLongest);
  if (light.radius > 0 && light.type != PELLUCID_LIGHT_POINT)
    fail("radius", "only a point light has one, is " + shown(light.radius));
  if ((light.type != PELLUCID_LIGHT_POINT || !light.angleTable.empty()) &&
      !(std::hypot(light.direction[0], light.direction[1], light.direction[2]) > 0))
    fail("direction", "must have a length above 0");
  if (light.type != PELLUCID_LIGHT_SPOT) return;
  double &inner = light.innerConeAngle, &outer = light.outerConeAngle;
  outer = fitted(outer, 0, std::numbers::pi / 2);
  if (!(outer > roundingAt(0) && outer <= std::numbers::pi / 2))
    fail("outerConeAngle", "must be above 0 and at most pi/2 radians, is " + shown(outer));
  // The bound is below the outer angle by what floats can tell apart.
  inner = fitted(inner, 0, outer);
  if (!(inner >= 0 && inner <= outer))
    fail("innerConeAngle",
         "must be at least 0 and less than outerConeAngle, " + shown(outer) + ", is " + shown(inner));
  inner = std::min(inner, outer - roundingAt(outer));
}

std::vector<std::string> coarseTables(const Capture& capture) {
  constexpr double kVisible = 0.01;
  std::vector<std::string> sentences;
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    for (const auto& [key, error, step] :
         {std::tuple("angleTable", light.angleTableError, "180 degrees"),
          std::tuple("distanceTable", light.distanceTableError, "the range")}) {
      if (!(error > kVisible)) continue;
      char sentence[200];
      std::snprintf(sentence, sizeof sentence,
                    "lights[%zu].%s: factors at 1/%d of %s miss the file's by up to %.2g of the most: its "
                    "lobes are narrower",
                    i, key, PELLUCID_LIGHT_TABLE_ENTRIES - 1, step, error);
      sentences.emplace_back(sentence);
    }
  }
  return sentences;
}

Light readLight(const Field& field) {
  field.allowKeys({"type", "position", "direction", "color", "intensity", "range", "radius", "innerConeAngle",
                   "outerConeAngle", "angleTable", "distanceTable", "shadowMap", "shadowMaps"});
  Light light;
  light.type = static_cast<PellucidLightType>(field["type"].choice(kLightTypes));
  if (field.has("position") || light.type != PELLUCID_LIGHT_DIRECTIONAL)
    light.position = field["position"].numbers<3>();
  if (field.has("direction") || field.has("angleTable") || light.type != PELLUCID_LIGHT_POINT)
    light.direction = field["direction"].numbers<3>();
  if (const auto color = field.find("color")) light.color = color->numbers<3>();
  const auto number = [&](const char* key, double& value) {
    if (const auto given = field.find(key)) value = given->number();
  };
  for (const char* key : {"innerConeAngle", "outerConeAngle"})
    if (const auto given = field.find(key); given && light.type != PELLUCID_LIGHT_SPOT)
      given->fail("is of spot lights; the light is " + kLightTypes[light.type]);
  number("intensity", light.intensity);
  number("range", light.range);
  if (const auto range = field.find("range"); light.range > 0 && light.type == PELLUCID_LIGHT_DIRECTIONAL)
    range->fail("is of point and spot lights; the light is directional");
  number("radius", light.radius);
  number("innerConeAngle", light.innerConeAngle);
  number("outerConeAngle", light.outerConeAngle);
  if (const auto table = field.find("angleTable"))
    light.angleTable = readLightTable(*table, light.type, light.angleTableError);
  if (const auto table = field.find("distanceTable"))
    light.distanceTable = readLightTable(*table, light.type, light.distanceTableError);
  fitLight(light, [&](const char* key, const std::string& sentence) {
    throw InputError(field.file(), field.path() + "." + key, sentence);
  });
  if (const auto table = field.find("distanceTable"))
    if (!(light.range > 0)) table->fail("needs a range above 0, over which its factors lie");
  for (const Field& map : shadowMapsOf(field)) light.shadowMaps.push_back(readShadowMap(map));
  return light;
}

namespace {

// The color that a pass of light was divided by.
std::optional<BufferSource> readTimes(const Field& light, const BufferReader& read) {
  const auto times = light.find("times");
  if (!times) return std::nullopt;
  times->allowKeys({"file", "part", "channels", "scale"});
  return read(*times, 3);
}

void readBuffers(const Field& buffers, const BufferReader& read, Manifest& manifest) {
  buffers.allowKeys({"frontDepth", "backDepth", "irradiance", "hiddenIrradiance", "motion", "normal",
                     "albedo", "material"});
  const auto depth = [&](const Field& field, DepthImage& image, const std::vector<std::string>& encodings) {
    field.allowKeys({"file", "part", "channel", "encoding", "constant", "scale"});
    image.encoding = static_cast<PellucidDepthEncoding>(field["encoding"].choice(encodings));
    refuseScaleOfDevice(field, image.encoding);
    return read(field, 1);
  };
  manifest.frontDepth = depth(buffers["frontDepth"], manifest.capture.frontDepth, kEncodings);
  if (const auto field = buffers.find("backDepth"))
    manifest.backDepth = depth(*field, manifest.capture.backDepth, kBackEncodings);

  const Field irradiance = buffers["irradiance"];
  irradiance.allowKeys({"file", "part", "channels", "constant", "scale", "times", "includesAlbedo"});
  manifest.irradiance = read(irradiance, 3);
  manifest.irradianceTimes = readTimes(irradiance, read);
  if (const auto includes = irradiance.find("includesAlbedo")) {
    manifest.irradianceIncludesAlbedo = includes->boolean();
    if (manifest.irradianceIncludesAlbedo && !buffers.has("albedo"))
      includes->fail("needs the buffer \"albedo\", by which the irradiance is divided");
  }
  if (const auto field = buffers.find("hiddenIrradiance")) {
    field->allowKeys({"file", "part", "channels", "constant", "scale"});
    if (!manifest.backDepth) field->fail("needs the buffer \"backDepth\", where the light arrives");
    manifest.hiddenIrradiance = read(*field, 3);
  }
  if (const auto field = buffers.find("motion")) {
    field->allowKeys({"file", "part", "channels", "constant", "motionScale"});
    manifest.motion = read(*field, 2);
    if (const auto scale = field->find("motionScale")) manifest.motionScale = scale->numbers<2>();
  }
  if (const auto field = buffers.find("albedo")) {
    field->allowKeys({"file", "part", "channels", "constant", "scale"});
    manifest.albedo = read(*field, 3);
  }
  manifest.hasNormal = buffers.has("normal");

  const Field material = buffers["material"];
  material.allowKeys({"file", "part", "channel", "map", "constant", "scale"});
  manifest.material = read(material, 1);
  if (const auto map = material.find("map"))
    manifest.materialMap = readMaterialMap(*map, static_cast<int>(manifest.capture.materials.size()));
}

// A whole number as text: JSON's own lose digits above 2^53 on their way through other tools.
std::uint64_t wholeNumber(const Field& field) {
  const std::string text = field.text();
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    field.fail("must be a whole number in quotes, is " + field.shown());
  return value;
}

Truth readTruth(const Field& field) {
  Truth truth;
  if (const auto samples = field.find("samples")) truth.samples = wholeNumber(*samples);
  if (const auto seed = field.find("seed")) truth.seed = wholeNumber(*seed);
  if (const auto scene = field.find("scene")) truth.scene = scene->text();
  return truth;
}

Harmonics readHarmonics(const Field& field) {
  const std::vector<Field> items = field.items();
  Harmonics result;
  if (items.size() != result.size())
    field.fail("needs 9 coefficients of three numbers, has " + std::to_string(items.size()));
  std::transform(items.begin(), items.end(), result.begin(),
                 [](const Field& item) { return item.numbers<3>(); });
  return result;
}

// Maps with a layer share one array image, each of whose layers is one image; those with a size share the image of that part and
// channel.
void numberSharedImages(const Field& lights, Manifest& manifest) {
  using Key = std::tuple<std::filesystem::path, int, std::vector<std::string>>;
  std::map<Key, int> numbers;
  std::map<int, std::pair<Key, std::string>> layers;  // image and field of the first map
  const std::vector<Field> all = lights.items();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::vector<Field> maps = shadowMapsOf(all[i]);
    for (std::size_t k = 0; k < maps.size(); ++k) {
      const ShadowSources& sources = manifest.shadowMaps[i][k];
      Key key = {sources.depth.file, sources.depth.part.value_or(-1), sources.depth.channels};
      if (const auto layer = maps[k].find("layer")) {
        const auto& [image, first] =
            layers.emplace(manifest.capture.lights[i].shadowMaps[k].layer, std::pair(key, layer->path())).first->second;
        if (image != key) layer->fail("is " + layer->shown() + ", as " + first + ", whose image is another; all lights share one array: number the layers of all files on");
        key = {};
      } else if (!sources.tile) {
        continue;
      }
      manifest.capture.lights[i].shadowMaps[k].sharedImage =
          numbers.emplace(key, static_cast<int>(numbers.size())).first->second;
    }
  }
}

void parse(const Field& root, const BufferReader& read, Manifest& manifest) {
  // The version comes first: another version's keys are not "unknown".
  if (const Field version = root["pellucid"]; version.number() != kVersion)
    version.fail("manifest version " + version.shown() + "; this program reads version " +
                 std::to_string(kVersion));
  root.allowKeys(
      {"pellucid", "metersPerUnit", "camera", "buffers", "lights", "environment", "materials", "truth"});
  Capture& capture = manifest.capture;
  if (const auto meters = root.find("metersPerUnit"))
    capture.metersPerUnit = meters->number(1e-9, 1e9);  // of the module
  else
    capture.warnings.push_back("metersPerUnit: missing: a scene unit is taken for 1 m; materials are as translucent as lengths say");
  const Field camera = root["camera"];
  camera.allowKeys({"clipFromView", "viewFromWorld"});
  capture.clipFromView = projection(camera["clipFromView"]);
  capture.viewFromWorld = rigid(camera["viewFromWorld"]);
  if (capture.clipFromView[5] > 0)
    capture.warnings.push_back("camera.clipFromView: has y up, as OpenGL's and Direct3D's; Vulkan's clip space has y down: negate the "
                               "second row, here and in each clipFromWorld, unless the images are upside down");

  const Field materials = root["materials"];
  for (const Field& material : materials.items()) capture.materials.push_back(readMaterial(material));
  if (capture.materials.empty() || capture.materials.size() > kMaxMaterials)
    materials.fail("needs 1 to " + std::to_string(kMaxMaterials) + " materials, has " +
                   std::to_string(capture.materials.size()));
  readBuffers(root["buffers"], read, manifest);
  if (const auto lights = root.find("lights")) {
    for (const Field& light : lights->items()) {
      capture.lights.push_back(readLight(light));
      manifest.shadowMaps.emplace_back();
      for (const Field& map : shadowMapsOf(light))
        manifest.shadowMaps.back().push_back(
            readShadowSources(map, read, static_cast<int>(capture.materials.size())));
    }
    numberSharedImages(*lights, manifest);
  }
  if (const auto environment = root.find("environment")) capture.environment = readHarmonics(*environment);
  if (const auto truth = root.find("truth")) {
    truth->allowKeys({"file", "part", "channels", "constant", "scale", "times", "standardError", "samples",
                      "seed", "scene"});
    manifest.truth = read(*truth, 3);
    manifest.truthTimes = readTimes(*truth, read);
    manifest.capture.truth = readTruth(*truth);
    if (const auto error = truth->find("standardError")) {
      error->allowKeys({"file", "part", "channels", "constant"});
      manifest.truthStandardError = read(*error, 3);
      manifest.truthStandardError->scale = manifest.truth->scale;
    }
  }
}

std::string readText(const std::filesystem::path& path) {
  constexpr std::uintmax_t kMaxBytes = 64u << 20;  // a manifest has a few kilobytes
  if (std::filesystem::file_size(path) > kMaxBytes)
    throw InputError(path.string(), "", "too large for a manifest: more than 64 MiB");
  std::ifstream file(path, std::ios::binary);
  std::ostringstream text;
  text << file.rdbuf();
  if (!file) throw InputError(path.string(), "", "cannot be read");
  return text.str();
}

}  // namespace

const char* encodingName(PellucidDepthEncoding encoding) { return kBackEncodings[encoding].c_str(); }

Manifest readManifest(const std::filesystem::path& path) {
  Manifest manifest;
  manifest.path = path;
  manifest.capture.name = path.string();
  BufferReader read{path.parent_path(), {}};
  std::string text;
  if (isExr(path)) {
    const auto embedded = ExrFile(path).findText(kManifestAttribute);
    if (!embedded)
      throw InputError(path.string(), kManifestAttribute,
                       "the EXR has no such string attribute; give the JSON manifest instead");
    text = *embedded;
    read.embedded = path;
  } else {
    text = readText(path);
  }
  const nlohmann::json document = parseJson(path.string(), text);
  parse(Field(path.string(), document), read, manifest);
  return manifest;
}

}  // namespace pellucid::harness
