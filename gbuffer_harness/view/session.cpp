#include "view/session.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "capture/json_field.h"
#include "capture/manifest_parts.h"
#include "common/error.h"

namespace pellucid::harness {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kKey = "pellucidView";
constexpr int kVersion = 1;

bool flag(const Field& field) {
  if (!field.value().is_boolean()) field.fail("must be true or false, is " + field.shown());
  return field.value().get<bool>();
}

Json cameraJson(const ViewCamera& camera) {
  const ModelCamera& lens = camera.lens;
  return {{"name", lens.name},
          {"viewFromWorld", lens.viewFromWorld},
          {"orthographic", lens.orthographic},
          {"verticalFov", lens.verticalFov},
          {"height", lens.height},
          {"near", lens.range.nearPlane},
          {"far", lens.range.farPlane},
          {"pivot", camera.pivot}};
}

ViewCamera readCamera(const Field& field) {
  field.allowKeys({"name", "viewFromWorld", "orthographic", "verticalFov", "height", "near", "far", "pivot"});
  ViewCamera camera;
  ModelCamera& lens = camera.lens;
  if (field.has("name") && field["name"].value().is_string()) lens.name = field["name"].value();
  lens.viewFromWorld = field["viewFromWorld"].numbers<16>();
  lens.orthographic = flag(field["orthographic"]);
  lens.verticalFov = field["verticalFov"].number(1e-4, std::numbers::pi - 1e-4);
  lens.height = field["height"].number(1e-12, 1e12);
  lens.range.nearPlane = field["near"].number();
  lens.range.farPlane = field["far"].number();
  if (!(lens.range.farPlane > lens.range.nearPlane))
    field["far"].fail("must be beyond near, is " + field["far"].shown());
  if (!lens.orthographic && !(lens.range.nearPlane > 0))
    field["near"].fail("of a perspective must be above 0, is " + field["near"].shown());
  camera.pivot = field["pivot"].numbers<3>();
  return camera;
}

Json displayJson(const Display& display) {
  const auto name = [](Shown shown) { return shownNames()[static_cast<std::size_t>(shown)]; };
  return {
      {"exposure", display.exposure}, {"toneMap", toneMapNames()[static_cast<std::size_t>(display.toneMap)]},
      {"shown", name(display.shown)}, {"split", display.split},
      {"left", name(display.left)},   {"splitAt", display.splitAt},
      {"channel", display.channel},   {"falseColors", {display.falseLow, display.falseHigh}}};
}

Display readDisplay(const Field& field) {
  field.allowKeys({"exposure", "toneMap", "shown", "split", "left", "splitAt", "channel", "falseColors"});
  Display display;
  display.exposure = static_cast<float>(field["exposure"].number(0, 1e9));
  display.toneMap = static_cast<ToneMap>(field["toneMap"].choice(toneMapNames()));
  display.shown = static_cast<Shown>(field["shown"].choice(shownNames()));
  display.split = flag(field["split"]);
  display.left = static_cast<Shown>(field["left"].choice(shownNames()));
  display.splitAt = static_cast<float>(field["splitAt"].number(0, 1));
  display.channel = field["channel"].integer(0, 2);
  const auto ends = field["falseColors"].numbers<2>();
  display.falseLow = static_cast<float>(ends[0]);
  display.falseHigh = static_cast<float>(ends[1]);
  return display;
}

}  // namespace

SavedFiles savedFiles(const std::filesystem::path& capture) {
  if (capture.extension() != ".exr" || capture.stem().empty())
    throw InputError(capture.string(), "", "captures are saved as .exr");
  const auto beside = [&](const char* extension) {
    return std::filesystem::path(capture).replace_extension(extension);
  };
  return {capture, beside(".settings.json"), beside(".view.json"), beside(".pellucid.exr"), beside(".png")};
}

std::string sessionJson(const Session& session) {
  const ViewState& state = session.state;
  Json json = {{kKey, kVersion},
               {"scene", session.scene},
               {"settings", session.settings},
               {"size", {state.width, state.height}},
               {"camera", cameraJson(state.camera)}};
  json["lights"] = Json::array();
  for (const ViewLight& light : state.lights)
    json["lights"].push_back({{"light", lightJson(light.light)}, {"on", light.on}});
  json["materials"] = Json::array();
  for (const MaterialSource& material : state.materials) json["materials"].push_back(materialJson(material));
  json["display"] = displayJson(state.display);
  return json.dump(2) + "\n";
}

Session readSession(const std::filesystem::path& path, const ViewState& start) {
  const nlohmann::json json = readJson(path);
  const Field root(path.string(), json);
  root.allowKeys({kKey, "scene", "settings", "size", "camera", "lights", "materials", "display"});
  root[kKey].integer(kVersion, kVersion);
  Session session;
  session.state = start;
  for (const Field& argument : root["scene"].items()) session.scene.push_back(argument.text());
  session.settings = root["settings"].text();
  ViewState& state = session.state;
  const std::vector<Field> size = root["size"].items();
  if (size.size() != 2) root["size"].fail("is not width and height, but " + root["size"].shown());
  state.width = size[0].integer(1, kLargestSide);
  state.height = size[1].integer(1, kLargestSide);
  state.camera = readCamera(root["camera"]);
  state.lights.clear();
  for (const Field& light : root["lights"].items()) {
    light.allowKeys({"light", "on"});
    state.lights.push_back({readLight(light["light"]), flag(light["on"])});
  }
  state.materials.clear();
  for (const Field& material : root["materials"].items()) state.materials.push_back(readMaterial(material));
  if (!start.materials.empty() && state.materials.size() != start.materials.size())
    root["materials"].fail("the scene has " + std::to_string(start.materials.size()) + ", not " +
                           std::to_string(state.materials.size()));
  state.display = readDisplay(root["display"]);
  return session;
}

bool isSession(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string begin(256, '\0');
  file.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(std::max<std::streamsize>(file.gcount(), 0)));
  return begin.find(std::string("\"") + kKey + "\"") != std::string::npos;
}

}  // namespace pellucid::harness
