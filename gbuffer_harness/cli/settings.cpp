#include "cli/settings.h"

#include <algorithm>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "capture/json_field.h"
#include "common/error.h"
#include "common/number.h"
#include "common/split.h"

namespace pellucid::harness {
namespace {

template <class T>
using Names = std::map<std::string, T>;

const Names<PellucidDebugView> kDebugViews = {{"thickness", PELLUCID_DEBUG_THICKNESS},
                                              {"transmittance", PELLUCID_DEBUG_TRANSMITTANCE},
                                              {"occlusion", PELLUCID_DEBUG_OCCLUSION},
                                              {"irradiance", PELLUCID_DEBUG_IRRADIANCE}};
const Names<uint32_t> kFeatures = {
    {"none", 0}, {"translucency", PELLUCID_FEATURE_TRANSLUCENCY}, {"diffusion", PELLUCID_FEATURE_DIFFUSION}};
const Names<bool> kThickness = {{"light", false}, {"camera", true}};
const Names<VkFormat> kFormats = {{"rgba16f", VK_FORMAT_R16G16B16A16_SFLOAT},
                                  {"rgba32f", VK_FORMAT_R32G32B32A32_SFLOAT},
                                  {"rg11b10f", VK_FORMAT_B10G11R11_UFLOAT_PACK32}};
const Names<TransmittanceChoice> kTransmittance = {
    {"material", TransmittanceChoice::Material},
    {"linear", TransmittanceChoice::Linear},
    {"gaussians", TransmittanceChoice::Gaussians},
    {"gaussians-as-printed", TransmittanceChoice::GaussiansAsPrinted}};
const Names<PellucidAngleModel> kAngles = {{"normal", PELLUCID_ANGLE_NORMAL},
                                           {"cosine", PELLUCID_ANGLE_COSINE},
                                           {"inverse-cosine", PELLUCID_ANGLE_INVERSE_COSINE},
                                           {"polynomial", PELLUCID_ANGLE_POLYNOMIAL},
                                           {"minimum-dot", PELLUCID_ANGLE_MINIMUM_DOT},
                                           {"minimum-dot-azimuth", PELLUCID_ANGLE_MINIMUM_DOT_AZIMUTH},
                                           {"minimum-dot-sphere", PELLUCID_ANGLE_MINIMUM_DOT_SPHERE}};
const Names<PellucidReuse> kReuse = {{"none", PELLUCID_REUSE_NONE},
                                     {"alternate", PELLUCID_REUSE_ALTERNATE},
                                     {"coherence", PELLUCID_REUSE_COHERENCE}};
const Names<bool> kIndirect = {{"none", false}, {"material", true}};
// Whelan 2009, eqs. 4.4 and 4.5.
const Names<std::array<float, 4>> kPolynomials = {{"quadratic", {2.14506f, -2.27844f, 0.595752f, 0}},
                                                  {"cubic", {-5.07621f, 7.75534f, -3.9017f, 0.650897f}}};
const Names<bool> kViews = {{"pixel", false}, {"constant", true}};
const Names<std::optional<bool>> kAmbient = {{"0", false}, {"1", true}, {"auto", std::nullopt}};
const Names<bool> kBooleans = {{"0", false}, {"1", true}};

template <class T>
T lookUp(const Names<T>& names, const std::string& key, const std::string& value) {
  if (const auto found = names.find(value); found != names.end()) return found->second;
  std::string known;
  for (const auto& [name, unused] : names) known += (known.empty() ? "" : ", ") + name;
  throw UsageError(key + ": \"" + value + "\" is not one of " + known);
}

uint32_t number(const std::string& key, const std::string& text) {
  const std::optional<uint32_t> value = numberIn<uint32_t>(text);
  if (!value) throw UsageError(key + ": \"" + text + "\" is not a whole number");
  return *value;
}

float real(const std::string& key, const std::string& text) {
  const std::optional<float> value = numberIn<float>(text);
  if (!value) throw UsageError(key + ": \"" + text + "\" is not a number");
  return *value;
}

template <size_t N>
std::array<float, N> reals(const std::string& key, const std::string& text) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != N)
    throw UsageError(key + ": \"" + text + "\" is not " + std::to_string(N) + " numbers with commas");
  std::array<float, N> values;
  for (size_t i = 0; i < N; ++i) values[i] = real(key, parts[i]);
  return values;
}

struct Key {
  std::string help;
  std::function<void(const std::string& key, const std::string& value, ReplaySettings&)> set;
};

const std::map<std::string, Key> kKeys = {
    {"features",
     {"translucency,diffusion or none",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.features = 0;
        for (const std::string& name : split(value, ',')) s.features |= lookUp(kFeatures, key, name);
      }}},
    {"thickness",
     {"light|camera, of lights with a shadow map",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.cameraThickness = lookUp(kThickness, key, value);
      }}},
    {"transmittance",
     {"material|linear|gaussians|gaussians-as-printed",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.transmittance = lookUp(kTransmittance, key, value);
      }}},
    {"angle",
     {"normal|cosine|inverse-cosine|polynomial|minimum-dot|minimum-dot-azimuth|minimum-dot-sphere",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.angleModel = lookUp(kAngles, key, value);
      }}},
    {"polynomial",
     {"c0,c1,c2,c3 of angle=polynomial, in radians, or quadratic|cubic",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        const bool named = value.find_first_of(",0123456789") == std::string::npos;
        s.translucency.anglePolynomial = named ? lookUp(kPolynomials, key, value) : reals<4>(key, value);
      }}},
    {"minimum-dot",
     {"of angle=minimum-dot and prescale=1, -1..0",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.minimumDot = real(key, value);
      }}},
    {"prescale",
     {"0|1: cosine, inverse-cosine and polynomial begin at minimum-dot",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.prescaleAngle = lookUp(kBooleans, key, value);
      }}},
    {"view",
     {"pixel|constant",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.constantViewDirection = lookUp(kViews, key, value);
      }}},
    {"chord",
     {"0|1: camera thickness without the cosine correction",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.chordThickness = lookUp(kBooleans, key, value);
      }}},
    {"max-thickness",
     {"mm, 0 for no limit", [](const auto& key, const auto& value,
                               ReplaySettings& s) { s.translucency.maximumThickness = real(key, value); }}},
    {"filter",
     {"r,g,b that multiply T",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.transmittanceFilter = reals<3>(key, value);
      }}},
    {"gather",
     {"samples of the shadow map, a multiple of 4, 0..64; default 8, 0: one thickness a pixel",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.gatherSamples = number(key, value);
      }}},
    {"gather-spacing",
     {"pixels a side of a probe's cell: 1, 2, 4, or 0: by the image's size",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.gatherSpacing = number(key, value);
      }}},
    {"minimum-dots",
     {"m0,m1,.. of angle=minimum-dot-azimuth (thesis: 36) or -sphere (rows of a square)",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.minimumDotTable.clear();
        for (const std::string& entry : split(value, ','))
          s.translucency.minimumDotTable.push_back(real(key, entry));
      }}},
    {"face",
     {"x,y,z the object looks along, world",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.faceVector = reals<3>(key, value);
      }}},
    {"up",
     {"x,y,z of the object, world", [](const auto& key, const auto& value,
                                       ReplaySettings& s) { s.translucency.upAxis = reals<3>(key, value); }}},
    {"center",
     {"x,y,z of the object, world",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.objectCenter = reals<3>(key, value);
      }}},
    {"mark-bit",
     {"of material values without translucency, 0 for none",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.translucency.materialMarkBit = number(key, value);
      }}},
    {"reuse",
     {"none|alternate|coherence of what came through; a single frame always computes it",
      [](const auto& key, const auto& value, ReplaySettings& s) { s.reuse = lookUp(kReuse, key, value); }}},
    {"coherence-threshold",
     {"change of the cosine between camera and light",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.coherenceThreshold = real(key, value);
      }}},
    {"nearest-distance",
     {"of what diffuses from the camera's plane, scene units, 0 for not known",
      [](const auto& key, const auto& value, ReplaySettings& s) { s.nearestDistance = real(key, value); }}},
    {"format",
     {"rgba16f|rgba32f|rg11b10f", [](const auto& key, const auto& value,
                                     ReplaySettings& s) { s.outputFormat = lookUp(kFormats, key, value); }}},
    {"ambient",
     {"0|1|auto: light from all around comes through thin parts; auto (default): where the capture has "
      "hidden irradiance",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.ambient = lookUp(kAmbient, key, value);
      }}},
    {"alias",
     {"0|1: output is the irradiance image",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.aliasOutput = lookUp(kBooleans, key, value);
      }}},
    {"indirect",
     {"none|material: passes run everywhere, or where the GPU finds material",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        s.indirectDispatches = lookUp(kIndirect, key, value);
      }}},
    {"rect",
     {"x,y,width,height",
      [](const auto& key, const auto& value, ReplaySettings& s) {
        const auto parts = split(value, ',');
        if (parts.size() != 4) throw UsageError(key + ": \"" + value + "\" is not x,y,width,height");
        for (size_t i = 0; i < 4; ++i) s.renderRect[i] = number(key, parts[i]);
      }}},
};

template <class T>
std::string nameOf(const Names<T>& names, const T& value) {
  const auto found =
      std::find_if(names.begin(), names.end(), [&](const auto& name) { return name.second == value; });
  return found == names.end() ? "" : found->first;
}

// As --set takes it: a string, a number, or an array's numbers with commas.
std::string valueText(const Field& field) {
  if (field.value().is_string()) return field.text();
  if (!field.value().is_array()) return field.number(), field.value().dump();
  std::string text;
  for (const Field& item : field.items()) {
    item.number();
    text += (text.empty() ? "" : ",") + item.value().dump();
  }
  return text;
}

std::vector<std::string> assignmentsIn(const std::string& path) {
  const nlohmann::json json = readJson(path);
  const Field root(path, json);
  if (!json.is_object()) root.fail("is not an object of settings");
  std::vector<std::string> assignments;
  for (const auto& [key, field] : root.members()) {
    if (kKeys.count(key) == 0) field.fail("is not a key of --set");
    assignments.push_back(key + "=" + valueText(field));
  }
  return assignments;
}

}  // namespace

std::vector<std::string> SettingsOptions::assignments() const {
  std::vector<std::string> all;
  for (const std::string& s : set) {
    if (s.empty() || s.front() != '@') {
      all.push_back(s);
      continue;
    }
    const std::vector<std::string> read = assignmentsIn(s.substr(1));
    all.insert(all.end(), read.begin(), read.end());
  }
  return all;
}

void SettingsOptions::addTo(CLI::App& command) {
  std::string help = "key=value, or @FILE with a JSON object of them, repeatable:";
  for (const auto& [name, key] : kKeys) help += " " + name + "=" + key.help + ";";
  command.add_option("--mode", mode, "physical (default) or thesis: Whelan 2009's; --set changes either");
  command.add_option("--set", set, help);
  command.add_option(
      "--debug", debug,
      std::string("write an intermediate: thickness (mm), transmittance, occlusion, irradiance") +
          (blocks ? "; blocks: the result, and a PNG of it under the blocks by what ran" : ""));
}

ReplaySettings SettingsOptions::parse() const {
  ReplaySettings settings;
  settings.translucency.gatherSamples = kDefaultGatherSamples;
  if (mode == "thesis")
    settings = thesisSettings();
  else if (mode != "physical")
    throw UsageError("--mode: \"" + mode + "\" is not one of physical, thesis");
  settings.preExposure = 0;  // captures of physical units are brighter than halves hold
  Names<PellucidDebugView> views = kDebugViews;
  if (blocks) views["blocks"] = PELLUCID_DEBUG_NONE;
  if (!debug.empty()) settings.debugView = lookUp(views, "--debug", debug);
  for (const std::string& assignment : assignments()) {
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos) throw UsageError("--set: \"" + assignment + "\" is not key=value");
    const std::string key = assignment.substr(0, equals);
    const auto found = kKeys.find(key);
    if (found == kKeys.end()) {
      std::string known;
      for (const auto& [name, unused] : kKeys) known += (known.empty() ? "" : ", ") + name;
      throw UsageError("--set: unknown key \"" + key + "\"; there are " + known);
    }
    found->second.set("--set " + key, assignment.substr(equals + 1), settings);
  }
  return settings;
}

void resolveGather(ReplaySettings& settings, const Capture& capture,
                   const std::vector<PellucidMaterial>& materials) {
  FrameData data;
  makeFrame(capture, materials, settings, data);
  // The plan that chooses samples has one light with a shadow map, because a plan has no room for any number
  // of lights.
  const auto mapped = std::find_if(data.lights.begin(), data.lights.end(),
                                   [](const PellucidLight& light) { return light.shadowMapCount > 0; });
  data.frame.lightCount = mapped != data.lights.end();
  data.frame.lights = data.lights.data() + (mapped - data.lights.begin());
  const auto plan = std::make_unique<PellucidPlan>();
  requireOk(pellucidBuildPlan(&data.frame, nullptr, plan.get()), data.frame, capture.name);
  settings.translucency.gatherSamples = plan->gatherSamples;
}

std::string settingsJson(const ReplaySettings& s) {
  const TranslucencySettings& t = s.translucency;
  std::string features;
  for (const auto& [name, bit] : kFeatures)
    if (s.features & bit) features += (features.empty() ? "" : ",") + name;
  nlohmann::ordered_json json = {{"features", features.empty() ? "none" : features},
                                 {"thickness", nameOf(kThickness, t.cameraThickness)},
                                 {"transmittance", nameOf(kTransmittance, s.transmittance)},
                                 {"angle", nameOf(kAngles, t.angleModel)},
                                 {"polynomial", t.anglePolynomial},
                                 {"minimum-dot", t.minimumDot},
                                 {"prescale", t.prescaleAngle ? "1" : "0"},
                                 {"view", nameOf(kViews, t.constantViewDirection)},
                                 {"chord", t.chordThickness ? "1" : "0"},
                                 {"max-thickness", t.maximumThickness},
                                 {"filter", t.transmittanceFilter},
                                 {"gather", t.gatherSamples},
                                 {"gather-spacing", t.gatherSpacing},
                                 {"face", t.faceVector},
                                 {"up", t.upAxis},
                                 {"center", t.objectCenter},
                                 {"mark-bit", t.materialMarkBit},
                                 {"reuse", nameOf(kReuse, s.reuse)},
                                 {"coherence-threshold", s.coherenceThreshold},
                                 {"nearest-distance", s.nearestDistance},
                                 {"format", nameOf(kFormats, s.outputFormat)},
                                 {"ambient", nameOf(kAmbient, s.ambient)},
                                 {"alias", s.aliasOutput ? "1" : "0"},
                                 {"indirect", nameOf(kIndirect, s.indirectDispatches)},
                                 {"rect", s.renderRect}};
  if (!t.minimumDotTable.empty()) json["minimum-dots"] = t.minimumDotTable;
  return json.dump(2) + "\n";
}

std::string debugOption(const ReplaySettings& settings) { return nameOf(kDebugViews, settings.debugView); }

std::string SettingsOptions::text() const {
  std::string all = "mode=" + mode;
  for (const std::string& s : assignments()) all += " " + s;
  return all;
}

}  // namespace pellucid::harness
