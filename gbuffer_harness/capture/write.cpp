#include "capture/write.h"

#include <algorithm>
#include <deque>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "capture/exr.h"
#include "capture/manifest.h"
#include "capture/manifest_parts.h"
#include "capture/shadow_images.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

// Collects the channels of one part and says where they are.
struct PartWriter {
  ExrPart part;
  int index;

  Json add(const Image& image, const std::string& layer, const char* components, ExrFormat format) {
    Json names = Json::array();
    for (int i = 0; i < image.channels; ++i) {
      const std::string name = layer + "." + components[i];
      part.channels.push_back({name, format, &image, i});
      names.push_back(name);
    }
    Json buffer = {{"part", index}};
    if (image.channels == 1)
      buffer["channel"] = names[0];
    else
      buffer["channels"] = names;
    return buffer;
  }
  Json addDepth(const DepthImage& depth, const std::string& layer) {
    Json buffer = add(depth.image, layer, "Z", ExrFormat::Float);
    buffer["encoding"] = encodingName(depth.encoding);
    return buffer;
  }
};

Json truthJson(const Truth& truth, PartWriter& screen, ExrFormat format) {
  Json json = screen.add(truth.image, "truth", "RGB", format);
  if (!truth.standardError.empty())
    json["standardError"] = screen.add(truth.standardError, "truthStandardError", "RGB", format);
  if (!truth.scene.empty()) {
    json["samples"] = std::to_string(truth.samples);
    json["seed"] = std::to_string(truth.seed);
    json["scene"] = truth.scene;
  }
  return json;
}

Image imageOf(const std::vector<std::uint8_t>& indices, int width, int height) {
  Image image(width, height, 1);
  for (std::size_t i = 0; i < indices.size(); ++i) image.data[i] = indices[i];
  return image;
}

// Shadow maps, each image and layer a part. This object owns the data that parts point to.
class ShadowWriter {
public:
  explicit ShadowWriter(const std::vector<Light>& lights) : shared_(shadowImages(lights)) {}

  // The manifest's entry of the next map in order.
  Json add(const ShadowMap& map, const std::string& name, std::vector<ExrPart>& parts) {
    const std::array<int, 3>& of = shared_.ofMap[next_++];
    const Json& written = part({of[0], map.layer}, of, name, parts);
    Json entry = written["depth"];
    addMapJson(map, entry);
    const ShadowImageSource& image = shared_.images[static_cast<std::size_t>(of[0])];
    if (map.sharedImage >= 0) {
      entry["offset"] = map.offset;
      entry["size"] = {map.depth.image.width, map.depth.image.height};
      if (image.layers > 1) entry["layer"] = map.layer;
    }
    if (!map.exitDepth.empty()) entry["exit"] = written["exit"];
    if (!map.casterMaterial.empty()) entry["casterMaterial"] = written["caster"];
    return entry;
  }

private:
  using Place = std::pair<int, int>;  // image and layer

  const Json& part(const Place& place, const std::array<int, 3>& of, const std::string& name,
                   std::vector<ExrPart>& parts) {
    const auto found = written_.find(place);
    if (found != written_.end()) return found->second;
    PartWriter writer{{name, {}, {}}, static_cast<int>(parts.size())};
    Json& json = written_[place];
    const auto layer = [&](int image) -> const Image& {
      return images_.emplace_back(shared_.images[static_cast<std::size_t>(image)].layer(place.second));
    };
    json["depth"] = writer.add(layer(of[0]), "shadow", "Z", ExrFormat::Float);
    // All maps of the image, not only the first.
    int exit = -1, caster = -1;
    for (const std::array<int, 3>& other : shared_.ofMap)
      if (other[0] == of[0]) {
        exit = std::max(exit, other[1]);
        caster = std::max(caster, other[2]);
      }
    if (exit >= 0) json["exit"] = writer.add(layer(exit), "exit", "Z", ExrFormat::Float);
    if (caster >= 0) json["caster"] = writer.add(layer(caster), "caster", "I", ExrFormat::Uint);
    parts.push_back(std::move(writer.part));
    return json;
  }

  ShadowImages shared_;
  std::size_t next_ = 0;
  std::map<Place, Json> written_;
  std::deque<Image> images_;
};

}  // namespace

void writeCapture(const Capture& capture, const std::filesystem::path& exr, ColorFormat color) {
  const ExrFormat format = color == ColorFormat::Half ? ExrFormat::Half : ExrFormat::Float;
  const Image material = imageOf(capture.material, capture.width, capture.height);

  PartWriter screen{{"screen", {}, {}}, 0};
  Json manifest = {
      {"pellucid", 1},
      {"metersPerUnit", capture.metersPerUnit},
      {"camera", {{"clipFromView", capture.clipFromView}, {"viewFromWorld", capture.viewFromWorld}}}};
  Json& buffers = manifest["buffers"];
  buffers["frontDepth"] = screen.addDepth(capture.frontDepth, "front");
  if (!capture.backDepth.image.empty()) buffers["backDepth"] = screen.addDepth(capture.backDepth, "back");
  buffers["irradiance"] = screen.add(capture.irradiance, "irradiance", "RGB", format);
  if (!capture.hiddenIrradiance.empty())
    buffers["hiddenIrradiance"] = screen.add(capture.hiddenIrradiance, "hidden", "RGB", format);
  if (!capture.motion.empty())
    buffers["motion"] = screen.add(capture.motion, "motion", "XY", ExrFormat::Float);
  if (!capture.albedo.empty()) buffers["albedo"] = screen.add(capture.albedo, "albedo", "RGB", format);
  buffers["material"] = screen.add(material, "material", "I", ExrFormat::Uint);
  if (capture.truth) manifest["truth"] = truthJson(*capture.truth, screen, format);

  std::vector<ExrPart> parts = {std::move(screen.part)};
  ShadowWriter shadows(capture.lights);
  manifest["lights"] = Json::array();
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    Json json = lightJson(light);
    const bool several = light.shadowMaps.size() > 1;
    for (std::size_t k = 0; k < light.shadowMaps.size(); ++k) {
      std::string name = "shadowMap" + std::to_string(i);
      if (several) name.append(".").append(std::to_string(k));
      Json& entry = several ? json["shadowMaps"].emplace_back() : json["shadowMap"];
      entry = shadows.add(light.shadowMaps[k], name, parts);
    }
    manifest["lights"].push_back(std::move(json));
  }
  if (capture.environment) manifest["environment"] = *capture.environment;
  manifest["materials"] = Json::array();
  for (const MaterialSource& source : capture.materials)
    manifest["materials"].push_back(materialJson(source));
  parts.front().attributes[kManifestAttribute] = manifest.dump();
  writeExrParts(exr, parts);
}

}  // namespace pellucid::harness
