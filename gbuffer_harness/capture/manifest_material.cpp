#include "capture/manifest_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>

#include "common/bounds.h"

namespace pellucid::harness {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMost = std::numeric_limits<float>::max();

constexpr NumberField<CoefficientMaterial> kCoefficientNumbers[] = {
    {"g", &CoefficientMaterial::g, -0.999, 0.999}, {"ior", &CoefficientMaterial::ior, 1, 3}};
constexpr NumberField<SkinMaterial> kSkinNumbers[] = {{"melanin", &SkinMaterial::melanin, 0, 1},
                                                      {"melaninType", &SkinMaterial::melaninType, 0, 1},
                                                      {"hemoglobin", &SkinMaterial::hemoglobin, 0, 1},
                                                      {"ior", &SkinMaterial::ior, 1, 3}};

MaterialSource readCoefficients(const Field& field) {
  field.allowKeys({"scattering", "absorption", "g", "ior", "unit"});
  CoefficientMaterial material;
  double perMillimeter = 1;  // what 1 of the file's unit is in 1/mm
  if (const auto unit = field.find("unit")) {
    constexpr double kScales[] = {1, 0.1, 0.001};
    perMillimeter = kScales[unit->choice({"1/mm", "1/cm", "1/m"})];
  }
  const auto coefficients = [&](const char* key) {
    auto values = field[key].numbers<3>(0, kMost);
    for (double& value : values) value *= perMillimeter;
    return values;
  };
  material.scattering = coefficients("scattering");
  material.absorption = coefficients("absorption");
  readNumbers(field, kCoefficientNumbers, material);
  return material;
}

// Burley's d of each channel.
std::array<double, 3> readDistance(const Field& field) {
  const auto distance = field.numbers<3>();
  for (const double d : distance)
    if (!(d > 0)) field.fail("must be positive (mm), is " + field.shown());
  return distance;
}

MaterialSource readBurley(const Field& field) {
  field.allowKeys({"profile", "distance", "transmittance"});
  field["profile"].choice({"burley"});
  BurleyMaterial material;
  material.distance = readDistance(field["distance"]);
  if (const auto transmittance = field.find("transmittance")) {
    transmittance->allowKeys({"a1", "k1", "a2", "k2"});
    std::array<std::array<double, 4>, 3> exponentials = {};
    constexpr const char* kNames[] = {"a1", "k1", "a2", "k2"};
    for (std::size_t i = 0; i < 4; ++i) {
      const Field values = (*transmittance)[kNames[i]];
      const auto rgb = values.numbers<3>();
      for (std::size_t channel = 0; channel < 3; ++channel) {
        if (kNames[i][0] == 'k' && !(rgb[channel] > 0))
          values.fail("must be positive (1/mm), is " + values.shown());
        exponentials[channel][i] = rgb[channel];
      }
    }
    for (const auto& [a1, k1, a2, k2] : exponentials)
      if (const double sum = fitted(a1 + a2, 0, 1); sum < 0 || sum > 1)
        transmittance->fail("T(0) = a1 + a2 must be from 0 to 1, is " + std::to_string(a1 + a2));
    material.transmittance = exponentials;
  }
  return material;
}

MaterialSource readGaussians(const Field& field) {
  field.allowKeys({"gaussians"});
  const Field gaussians = field["gaussians"];
  gaussians.allowKeys({"variance", "weight"});
  GaussianMaterial material;
  material.variance = gaussians["variance"].numbers();
  if (material.variance.size() > PELLUCID_MAX_GAUSSIANS)
    gaussians["variance"].fail("at most " + std::to_string(PELLUCID_MAX_GAUSSIANS) + " Gaussians, has " +
                               std::to_string(material.variance.size()));
  for (const double variance : material.variance)
    if (!(variance > 0))
      gaussians["variance"].fail("must be positive (mm^2), is " + gaussians["variance"].shown());
  const Field weights = gaussians["weight"];
  std::array<double, 3> sum = {0, 0, 0};
  for (const Field& weight : weights.items()) {
    material.weight.push_back(weight.numbers<3>(0, kMost));
    for (std::size_t channel = 0; channel < 3; ++channel) sum[channel] += material.weight.back()[channel];
  }
  if (material.weight.size() != material.variance.size())
    weights.fail("needs one RGB triple per variance (" + std::to_string(material.variance.size()) +
                 "), has " + std::to_string(material.weight.size()));
  for (const double total : sum)
    if (std::abs(total - 1) > 0.01)  // published tables are rounded to three digits
      weights.fail("each channel must sum to 1, one sums to " + std::to_string(total));
  return material;
}

constexpr const char* kColor = "subsurface_color";
constexpr const char* kRadius = "subsurface_radius";
constexpr const char* kRadiusScale = "subsurface_radius_scale";
constexpr const char* kAnisotropy = "subsurface_scatter_anisotropy";
constexpr const char* kSpecularIor = "specular_ior";
constexpr NumberField<OpenPbrMaterial> kOpenPbrNumbers[] = {
    {kAnisotropy, &OpenPbrMaterial::anisotropy, -0.999, 0.999}, {kSpecularIor, &OpenPbrMaterial::ior, 1, 3}};

// Ranges beyond those of JSON's types are the compiler's, which names the field, too.
MaterialSource readOpenPbr(const Field& field) {
  field.allowKeys({kColor, kRadius, kRadiusScale, kAnisotropy, kSpecularIor, "unit"});
  OpenPbrMaterial material;
  double millimeters = 1;
  if (const auto unit = field.find("unit")) {
    constexpr double kScales[] = {1, 10, 1000};
    millimeters = kScales[unit->choice({"mm", "cm", "m"})];
  }
  if (const auto color = field.find(kColor)) material.color = color->numbers<3>(0, 1);
  if (const auto radius = field.find(kRadius)) material.radius = radius->number();
  if (!(material.radius > 0)) field[kRadius].fail("must be above 0, is " + field[kRadius].shown());
  material.radius *= millimeters;
  if (const auto scale = field.find(kRadiusScale)) {
    material.radiusScale = scale->numbers<3>();
    for (const double value : material.radiusScale)
      if (!(value > 0)) scale->fail("must be above 0, is " + scale->shown());
  }
  readNumbers(field, kOpenPbrNumbers, material);
  return material;
}

MaterialSource readSkin(const Field& field) {
  field.allowKeys({"melanin", "melaninType", "hemoglobin", "ior"});
  SkinMaterial material;
  readNumbers(field, kSkinNumbers, material);
  return material;
}

bool hasAny(const Field& field, std::initializer_list<const char*> keys) {
  return std::any_of(keys.begin(), keys.end(), [&](const char* key) { return field.has(key); });
}

MaterialSource readThinWall(const Field& field) {
  field.allowKeys({"thinWalled"});
  const Field wall = field["thinWalled"];
  wall.allowKeys({"reflectance", "transmittance", "distance"});
  ThinWallMaterial material;
  material.reflectance = wall["reflectance"].numbers<3>(0, 1);
  material.transmittance = wall["transmittance"].numbers<3>(0, 1);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const double sum = material.reflectance[channel] + material.transmittance[channel];
    if (fitted(sum, 0, 1) > 1)
      wall["transmittance"].fail("and reflectance must together be at most 1, are " + std::to_string(sum));
    if (sum > 1) material.transmittance[channel] = 1 - material.reflectance[channel];
  }
  if (const auto distance = wall.find("distance")) material.distance = readDistance(*distance);
  return material;
}

template <class... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <class... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;  // clang 14 does not deduce it

template <class T, std::size_t N>
void add(const NumberField<T> (&numbers)[N], const T& object, Json& json) {
  for (const NumberField<T>& n : numbers) json[n.key] = object.*n.member;
}

}  // namespace

Json materialJson(const MaterialSource& source) {
  return std::visit(Overloaded{
                        [](const PresetMaterial& m) {
                          return Json{{"preset", m.preset}};
                        },
                        [](const CoefficientMaterial& m) {
                          Json json = {{"scattering", m.scattering}, {"absorption", m.absorption}};
                          add(kCoefficientNumbers, m, json);
                          json["unit"] = "1/mm";
                          return json;
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
                        [](const OpenPbrMaterial& m) {
                          Json json = {{kColor, m.color}, {kRadius, m.radius}, {kRadiusScale, m.radiusScale}};
                          add(kOpenPbrNumbers, m, json);
                          json["unit"] = "mm";
                          return json;
                        },
                        [](const SkinMaterial& m) {
                          Json json;
                          add(kSkinNumbers, m, json);
                          return json;
                        },
                        [](const GaussianMaterial& m) {
                          return Json{{"gaussians", {{"variance", m.variance}, {"weight", m.weight}}}};
                        },
                        [](const ThinWallMaterial& m) {
                          Json wall = {{"reflectance", m.reflectance}, {"transmittance", m.transmittance}};
                          if (m.distance) wall["distance"] = *m.distance;
                          return Json{{"thinWalled", wall}};
                        },
                    },
                    source);
}

MaterialSource readMaterial(const Field& field) {
  if (field.has("preset")) {
    field.allowKeys({"preset"});
    return PresetMaterial{field["preset"].text()};
  }
  if (field.has("profile")) return readBurley(field);
  if (field.has("gaussians")) return readGaussians(field);
  if (field.has("thinWalled")) return readThinWall(field);
  if (field.has("scattering") || field.has("absorption")) return readCoefficients(field);
  if (hasAny(field, {kColor, kRadius, kRadiusScale, kAnisotropy})) return readOpenPbr(field);
  if (hasAny(field, {"melanin", "melaninType", "hemoglobin"})) return readSkin(field);
  field.fail(
      "must have \"preset\", \"scattering\" and \"absorption\", \"subsurface_color\", \"melanin\", "
      "\"profile\", \"gaussians\" or \"thinWalled\", is " +
      field.shown());
}

MaterialSource parseMaterial(const std::string& option, const std::string& text) {
  if (!text.starts_with('{')) return PresetMaterial{text};
  const nlohmann::json json = parseJson(option, text);
  return readMaterial(Field(option, json));
}

}  // namespace pellucid::harness
