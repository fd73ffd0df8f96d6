// `pellucid info`: what a capture holds, what its missing parts switch off, what looks wrong.
#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <sstream>

#include "capture/exr.h"
#include "capture/material.h"
#include "capture/read.h"
#include "cli/capture_checks.h"
#include "cli/commands.h"
#include "cli/settings.h"
#include "reference/camera.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;
using reference::Camera;

constexpr const char* kLightTypes[] = {"directional", "point", "spot"};

struct Range {
  float least = std::numeric_limits<float>::infinity(), most = -least;

  void add(double value) {
    least = std::min(least, static_cast<float>(value));
    most = std::max(most, static_cast<float>(value));
  }
  Json json() const { return least > most ? Json() : Json{least, most}; }
};

// Where the numbers come from; `constant`, or file, part, channels and their format.
Json sourceJson(const BufferSource& source) {
  Json json;
  if (source.isConstant()) {
    json["constant"] = source.constant;
  } else {
    const ExrFile file(source.file);
    const int part = file.findPart(source.channels, source.part, source.field);
    json = {{"file", source.file.string()},
            {"part", part},
            {"channels", source.channels},
            {"format", file.channelFormat(part, source.channels.front())}};
  }
  if (source.scale != 1) json["scale"] = source.scale;
  return json;
}

Json imageJson(const BufferSource& source, const Image& image) {
  Json json = sourceJson(source);
  Range range;
  for (const float value : image.data)
    if (std::isfinite(value)) range.add(value);
  json["range"] = range.json();
  return json;
}

// The range of a screen depth is planar distance in scene units, whatever the encoding; that of a thickness
// is in mm.
Json depthJson(const BufferSource& source, const DepthImage& depth, const Camera& camera) {
  Json json = sourceJson(source);
  json["encoding"] = encodingName(depth.encoding);
  Range range;
  std::size_t surfaces = 0;
  for (const float value : depth.image.data) {
    const bool isThickness = depth.encoding == PELLUCID_DEPTH_THICKNESS;
    if (isThickness && !holdsThickness(value)) continue;
    const auto planar =
        isThickness ? std::optional(double(value)) : camera.planarDepth(value, depth.encoding);
    if (!planar) continue;
    ++surfaces;
    range.add(*planar);
  }
  json["range"] = range.json();
  json["pixels"] = surfaces;
  return json;
}

Json storedRange(const Image& depths, PellucidDepthEncoding encoding) {
  Range range;
  for (const float value : depths.data)
    if (encoding == PELLUCID_DEPTH_DEVICE ? std::isfinite(value) : reference::holdsSurface(value))
      range.add(value);
  return range.json();
}

Json shadowJson(const ShadowSources& sources, const ShadowMap& map) {
  const PellucidDepthEncoding encoding = map.depth.encoding;
  Json json = sourceJson(sources.depth);
  json["encoding"] = encodingName(encoding);
  json["size"] = {map.depth.image.width, map.depth.image.height};
  json["range"] = storedRange(map.depth.image, encoding);
  if (sources.exit) {
    json["exit"] = sourceJson(*sources.exit);
    json["exit"]["range"] = storedRange(map.exitDepth, encoding);
  }
  if (sources.casterMaterial) {
    json["casterMaterial"] = sourceJson(*sources.casterMaterial);
    const std::set<int> indices(map.casterMaterial.begin(), map.casterMaterial.end());
    json["casterMaterial"]["materials"] = indices;
  }
  return json;
}

const char* materialKind(const MaterialSource& source) {
  constexpr const char* kKinds[] = {"preset",    "coefficients", "burley", "gaussians",
                                    "thin wall", "OpenPBR",      "skin"};
  return kKinds[source.index()];
}

Json materialsJson(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  Json json = Json::array();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const auto index = static_cast<std::uint8_t>(i + 1);
    Json entry = {{"index", index}, {"kind", materialKind(capture.materials[i])}};
    if (const auto* preset = std::get_if<PresetMaterial>(&capture.materials[i]))
      entry["preset"] = preset->preset;
    entry["pixels"] = std::count(capture.material.begin(), capture.material.end(), index);
    entry["reflectance"] = materials[i].reflectance;
    if (materials[i].thinWalled) entry["transmittance"] = materials[i].wallTransmittance;
    entry["radius"] = materials[i].radius;
    json.push_back(std::move(entry));
  }
  return json;
}

// Mean errors in docs/accuracy.md#lights-without-a-shadow-map.
constexpr const char* kErrorWithoutMap =
    "lit from behind, a slab is right, an ear 2, 6 and 6 % (R, G, B) too dark, a ball 1.2, 2.3 and 3.2 times";

// True where a pixel has a material with thickness.
bool showsSolids(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  return std::any_of(capture.material.begin(), capture.material.end(),
                     [&](std::uint8_t index) { return index > 0 && !materials[index - 1u].thinWalled; });
}

// Optional parts that are missing with the effect on the result, the most harmful first.
std::vector<std::string> missingParts(const Capture& capture,
                                      const std::vector<PellucidMaterial>& materials) {
  std::vector<std::string> missing;
  if (capture.lights.empty() && !capture.environment) missing.push_back("no lights: no translucency");
  if (capture.backDepth.image.empty())
    missing.push_back(
        "no backDepth: no camera-space thickness; lights without a shadow map and environments add no "
        "translucency, and gathers let thin parts return as much light as thick ones");
  if (capture.albedo.empty()) missing.push_back("no albedo: the output is not multiplied by a surface color");
  const bool solids = showsSolids(capture, materials);
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const std::vector<ShadowMap>& maps = capture.lights[i].shadowMaps;
    const std::string light = "lights[" + std::to_string(i) + "]";
    if (maps.empty() && !solids)
      missing.push_back(light + " has no shadow map: nothing shadows its light behind thin walls");
    else if (maps.empty() && !capture.backDepth.image.empty())
      missing.push_back(light +
                        " has no shadow map: thickness from the camera's depths, nothing shadows it; " +
                        kErrorWithoutMap);
    const auto some = [&maps](const auto& isMissing) {
      return std::any_of(maps.begin(), maps.end(), isMissing);
    };
    if (some([](const ShadowMap& map) { return map.exitDepth.empty(); }))
      missing.push_back(
          light +
          " has no exit depth: air behind an occluder counts as medium, which adds 5 % to a knot of "
          "tubes and nothing to an ear; one more draw of the map's faces fills exitImage");
    if (some([](const ShadowMap& map) { return map.casterMaterial.empty(); }))
      missing.push_back(light +
                        " has no caster material: light enters through opaque bodies and other materials");
  }
  if (!capture.truth) missing.push_back("no truth: compare needs another image to compare with");
  return missing;
}

Json describe(const std::filesystem::path& path) {
  const Manifest manifest = readManifest(path);
  const Capture capture = readCapture(manifest);
  const std::vector<PellucidMaterial> materials = compileMaterials(capture);
  const Camera camera(capture.clipFromView, capture.width, capture.height);

  Json json = {{"capture", path.string()},
               {"size", {capture.width, capture.height}},
               {"metersPerUnit", capture.metersPerUnit}};
  Json& buffers = json["buffers"];
  buffers["frontDepth"] = depthJson(manifest.frontDepth, capture.frontDepth, camera);
  if (manifest.backDepth) buffers["backDepth"] = depthJson(*manifest.backDepth, capture.backDepth, camera);
  buffers["irradiance"] = imageJson(manifest.irradiance, capture.irradiance);
  if (manifest.hiddenIrradiance)
    buffers["hiddenIrradiance"] = imageJson(*manifest.hiddenIrradiance, capture.hiddenIrradiance);
  if (manifest.motion) buffers["motion"] = imageJson(*manifest.motion, capture.motion);
  if (manifest.albedo) buffers["albedo"] = imageJson(*manifest.albedo, capture.albedo);
  buffers["material"] = sourceJson(manifest.material);
  buffers["material"]["pixels"] =
      capture.material.size() -
      static_cast<std::size_t>(std::count(capture.material.begin(), capture.material.end(), 0));
  if (manifest.truth) buffers["truth"] = imageJson(*manifest.truth, capture.truth->image);
  json["lights"] = Json::array();
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    Json entry = {{"type", kLightTypes[light.type]}, {"color", light.color}, {"intensity", light.intensity}};
    for (const auto& [name, table] :
         {std::pair("angle", &light.angleTable), std::pair("distance", &light.distanceTable)})
      if (!table->empty()) entry["tables"].push_back(name);
    for (std::size_t k = 0; k < light.shadowMaps.size(); ++k)
      entry["shadowMaps"].push_back(shadowJson(manifest.shadowMaps[i][k], light.shadowMaps[k]));
    json["lights"].push_back(std::move(entry));
  }
  if (capture.environment) json["environment"] = *capture.environment;
  json["materials"] = materialsJson(capture, materials);
  json["missing"] = missingParts(capture, materials);
  std::vector<std::string> warnings = warningsOf(capture, materials);
  for (const std::string& sentence : findingsOf(capture, materials, PELLUCID_SEVERITY_ERROR)) warnings.push_back("cannot be replayed: " + sentence);
  if (manifest.hasNormal)
    warnings.push_back(
        "the buffer \"normal\" is not needed: surfaces come from front depth, and nothing reads normals");
  json["warnings"] = warnings;
  return json;
}

// "key value, key value" of an object's scalars and lists of them; lists without brackets.
std::string line(const Json& object) {
  std::ostringstream text;
  text.precision(6);
  for (const auto& [key, value] : object.items()) {
    const auto isObject = [](const Json& item) { return item.is_object(); };
    if (isObject(value) || (value.is_array() && std::any_of(value.begin(), value.end(), isObject))) continue;
    text << (text.str().empty() ? "" : ", ") << key;
    const auto print = [&](const Json& item) {
      if (item.is_string())
        text << ' ' << item.get<std::string>();
      else if (item.is_number_float())
        text << ' ' << item.get<double>();
      else
        text << ' ' << item.dump(-1, ' ', false, Json::error_handler_t::replace);
    };
    if (value.is_array())
      for (const Json& item : value) print(item);
    else
      print(value);
  }
  return text.str();
}

std::string toText(const Json& json) {
  std::ostringstream text;
  text << json["capture"].get<std::string>() << ": " << json["size"][0] << "x" << json["size"][1]
       << " pixels, " << json["metersPerUnit"] << " meters per unit\n";
  for (const auto& [name, buffer] : json["buffers"].items())
    text << "  " << name << ": " << line(buffer) << "\n";
  for (std::size_t i = 0; i < json["lights"].size(); ++i) {
    const Json& light = json["lights"][i];
    text << "  lights[" << i << "]: " << line(light) << "\n";
    if (!light.contains("shadowMaps")) continue;
    for (const Json& map : light["shadowMaps"]) {
      text << "    shadowMap: " << line(map) << "\n";
      for (const char* beside : {"exit", "casterMaterial"})
        if (map.contains(beside)) text << "      " << beside << ": " << line(map[beside]) << "\n";
    }
  }
  if (json.contains("environment"))
    text << "  environment: nine coefficients, of which the first is "
         << line({{"radiance", json["environment"][0]}}) << "\n";
  for (const Json& material : json["materials"]) text << "  material: " << line(material) << "\n";
  const char* word = "missing most: ";
  for (const Json& sentence : json["missing"]) {
    text << word << sentence.get<std::string>() << "\n";
    word = "missing: ";
  }
  for (const Json& sentence : json["warnings"]) text << "warning: " << sentence.get<std::string>() << "\n";
  return text.str();
}

}  // namespace

void addInfoCommand(const Command& app) {
  struct Options {
    std::string input;
    bool json = false;
  };
  const auto options = std::make_shared<Options>();
  const Command command =
      app.subcommand("info", "Say what a capture holds, lacks, and what looks wrong in it");
  command.option("capture", options->input, "manifest (.json) or EXR with an embedded one").required();
  command.flag("--json", options->json, "print JSON");
  command.run([options] {
    const Json json = describe(options->input);
    std::cout << (options->json ? json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n" : toText(json));
  });
}

}  // namespace pellucid::harness
