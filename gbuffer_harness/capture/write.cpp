#include "capture/write.h"

#include <deque>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "capture/exr.h"
#include "capture/manifest.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;  // clang 14 does not deduce it

const char* encodingName(PellucidDepthEncoding encoding) {
  return encoding == PELLUCID_DEPTH_DEVICE   ? "device"
         : encoding == PELLUCID_DEPTH_VIEW_Z ? "viewZ"
                                             : "distance";
}

Json materialJson(const MaterialSource& source) {
  return std::visit(Overloaded{
                        [](const PresetMaterial& m) {
                          return Json{{"preset", m.preset}};
                        },
                        [](const CoefficientMaterial& m) {
                          return Json{{"scattering", m.scattering},
                                      {"absorption", m.absorption},
                                      {"g", m.g},
                                      {"ior", m.ior},
                                      {"unit", "1/mm"}};
                        },
                        [](const BurleyMaterial& m) {
                          Json json = {{"profile", "burley"}, {"distance", m.distance}};
                          if (m.transmittance) {
                            const char* const names[] = {"a1", "k1", "a2", "k2"};
                            for (std::size_t i = 0; i < 4; ++i)
                              for (const auto& channel : *m.transmittance)
                                json["transmittance"][names[i]].push_back(channel[i]);
                          }
                          return json;
                        },
                        [](const GaussianMaterial& m) {
                          return Json{{"gaussians", {{"variance", m.variance}, {"weight", m.weight}}}};
                        },
                    },
                    source);
}

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

Json lightJson(const Light& light) {
  const char* const types[] = {"directional", "point", "spot"};
  Json json = {{"type", types[light.type]}, {"position", light.position},   {"direction", light.direction},
               {"color", light.color},      {"intensity", light.intensity}, {"range", light.range}};
  if (light.radius > 0) json["radius"] = light.radius;
  if (light.type == PELLUCID_LIGHT_SPOT) {
    json["innerConeAngle"] = light.innerConeAngle;
    json["outerConeAngle"] = light.outerConeAngle;
  }
  return json;
}

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
  if (!capture.normal.empty()) {
    buffers["normal"] = screen.add(capture.normal, "normal", "XYZ", format);
    buffers["normal"]["space"] = capture.normalsInViewSpace ? "view" : "world";
  }
  if (!capture.albedo.empty()) buffers["albedo"] = screen.add(capture.albedo, "albedo", "RGB", format);
  buffers["material"] = screen.add(material, "material", "I", ExrFormat::Uint);
  if (capture.truth) manifest["truth"] = truthJson(*capture.truth, screen, format);

  std::vector<ExrPart> parts = {std::move(screen.part)};
  std::deque<Image> casters;  // parts point to them
  manifest["lights"] = Json::array();
  for (std::size_t i = 0; i < capture.lights.size(); ++i) {
    const Light& light = capture.lights[i];
    Json json = lightJson(light);
    const bool several = light.shadowMaps.size() > 1;
    for (std::size_t k = 0; k < light.shadowMaps.size(); ++k) {
      const ShadowMap& map = light.shadowMaps[k];
      std::string name = "shadowMap" + std::to_string(i);
      if (several) name.append(".").append(std::to_string(k));
      PartWriter writer{{name, {}, {}}, static_cast<int>(parts.size())};
      Json& entry = several ? json["shadowMaps"].emplace_back() : json["shadowMap"];
      entry = writer.addDepth(map.depth, "shadow");
      entry["clipFromWorld"] = map.clipFromWorld;
      if (map.viewFromWorld) entry["viewFromWorld"] = *map.viewFromWorld;
      if (!map.exitDepth.empty()) entry["exit"] = writer.add(map.exitDepth, "exit", "Z", ExrFormat::Float);
      if (!map.casterMaterial.empty()) {
        casters.push_back(imageOf(map.casterMaterial, map.depth.image.width, map.depth.image.height));
        entry["casterMaterial"] = writer.add(casters.back(), "caster", "I", ExrFormat::Uint);
      }
      parts.push_back(std::move(writer.part));
    }
    manifest["lights"].push_back(std::move(json));
  }
  manifest["materials"] = Json::array();
  for (const MaterialSource& source : capture.materials)
    manifest["materials"].push_back(materialJson(source));
  parts.front().attributes[kManifestAttribute] = manifest.dump();
  writeExrParts(exr, parts);
}

}  // namespace pellucid::harness
