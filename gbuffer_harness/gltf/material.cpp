#include "gltf/material.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "capture/material.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

using Rgb = std::array<double, 3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// An attenuation color of 0 or 1 would be an infinite or no coefficient.
constexpr double kDarkest = 1e-4, kClearest = 0.999;

// A profile too narrow to see, for media that do not scatter, mm.
constexpr double kNoDiffusion = 1e-3;
// T(d) has to fall to 0 in the end, 1/mm.
constexpr double kSlowestDecay = 1e-6;

// Base colors that nobody chose: glTF's default, and that of Blender's Principled BSDF, which its exporter
// writes.
constexpr double kDefaultBaseColors[] = {1, 0.8};

// Far steeper than any map, and its square still is a float.
constexpr double kLargestNormalScale = 1000;

// The numbers of one extension object.
class Extension {
public:
  Extension(const GltfDocument& document, std::string field, const tinygltf::Value& value)
      : document_(document), field_(std::move(field)), value_(value) {
    if (!value.IsObject()) document.fail(field_, "is not an object");
  }

  double number(const char* key, double absent, double least, double most) const {
    if (!value_.Has(key)) return absent;
    return checked(key, value_.Get(key), least, most);
  }
  Rgb color(const char* key, const Rgb& absent) const {
    if (!value_.Has(key)) return absent;
    const tinygltf::Value& array = value_.Get(key);
    if (array.ArrayLen() != 3) document_.fail(field_ + "." + key, "is not an array of 3 numbers");
    Rgb rgb;
    for (int i = 0; i < 3; ++i) rgb[static_cast<std::size_t>(i)] = checked(key, array.Get(i), 0, 1);
    return rgb;
  }
  bool has(const char* key) const { return value_.Has(key); }

private:
  double checked(const char* key, const tinygltf::Value& value, double least, double most) const {
    if (!value.IsNumber()) document_.fail(field_ + "." + key, "is not a number");
    const double number = value.GetNumberAsDouble();
    if (!(number >= least && number <= most)) {
      const std::string range = most < kInfinity ? std::to_string(least) + " .. " + std::to_string(most)
                                                 : std::to_string(least) + " upwards";
      document_.fail(field_ + "." + key, std::to_string(number) + " is outside " + range);
    }
    return number;
  }

  const GltfDocument& document_;
  std::string field_;
  const tinygltf::Value& value_;
};

// What the extensions of one material say.
struct Volume {
  bool diffuse = false;  // KHR_materials_diffuse_transmission is there
  double transmission = 0;
  Rgb transmissionColor = {1, 1, 1};
  bool volume = false;  // KHR_materials_volume with a thickness
  double distance = kInfinity;
  Rgb color = {1, 1, 1};
  bool scatter = false;
  Rgb multiscatter = {0, 0, 0};
  double g = 0;
  double ior = 1.5;
};

Volume readVolume(const GltfDocument& document, const tinygltf::Material& material, const std::string& field,
                  const std::string& name, std::vector<std::string>& warnings) {
  Volume v;
  const auto find = [&](const char* extension) -> std::optional<Extension> {
    const auto found = material.extensions.find(extension);
    if (found == material.extensions.end()) return std::nullopt;
    return Extension(document, field + ".extensions." + extension, found->second);
  };
  const auto textured = [&](const Extension& e, std::initializer_list<const char*> keys) {
    for (const char* key : keys)
      if (e.has(key))
        warnings.push_back("material \"" + name + "\": " + key + " is ignored, its factor is not");
  };
  if (const auto e = find("KHR_materials_diffuse_transmission")) {
    v.diffuse = true;
    v.transmission = e->number("diffuseTransmissionFactor", 0, 0, 1);
    v.transmissionColor = e->color("diffuseTransmissionColorFactor", v.transmissionColor);
    textured(*e, {"diffuseTransmissionTexture", "diffuseTransmissionColorTexture"});
  } else if (const auto t = find("KHR_materials_transmission")) {
    v.transmission = t->number("transmissionFactor", 0, 0, 1);
  }
  if (const auto e = find("KHR_materials_ior")) v.ior = e->number("ior", 1.5, 0, 3);
  if (const auto e = find("KHR_materials_volume")) {
    v.volume = e->number("thicknessFactor", 0, 0, kInfinity) > 0;
    v.distance = e->number("attenuationDistance", kInfinity, 0, kInfinity);
    v.color = e->color("attenuationColor", v.color);
    if (!(v.distance > 0))
      document.fail(field + ".extensions.KHR_materials_volume.attenuationDistance", "is 0");
    if (!v.volume)
      warnings.push_back("material \"" + name +
                         "\": KHR_materials_volume.thicknessFactor is 0, which means a "
                         "thin wall without a medium");
  }
  if (const auto e = find("KHR_materials_volume_scatter")) {
    v.scatter = true;
    v.multiscatter = e->color("multiscatterColor", v.multiscatter);
    v.g = e->number("scatterAnisotropy", 0, -0.999, 0.999);
  }
  return v;
}

// Extinction, 1/mm, from the fraction of light that gets through attenuationDistance.
Rgb extinction(const Volume& volume, double metersPerUnit) {
  const double millimeters = volume.distance * metersPerUnit * 1000;
  Rgb sigma;
  for (std::size_t i = 0; i < 3; ++i)
    sigma[i] = -std::log(std::clamp(volume.color[i], kDarkest, kClearest)) / millimeters;
  return sigma;
}

CoefficientMaterial scatteringMedium(const Volume& volume, double metersPerUnit) {
  CoefficientMaterial medium{};
  const Rgb sigma = extinction(volume, metersPerUnit);
  for (std::size_t i = 0; i < 3; ++i) {
    const double albedo = singleScatteringAlbedo(volume.multiscatter[i]);
    medium.scattering[i] = albedo * sigma[i];
    medium.absorption[i] = (1 - albedo) * sigma[i];
  }
  medium.g = volume.g;
  // A diffuse boundary does not refract, and multiscatterColor is defined without one.
  medium.ior = volume.diffuse ? 1 : std::max(volume.ior, 1.0);
  return medium;
}

// Light enters and leaves diffusely and is only absorbed on the way: T = factor color e^{-sigma_a d}.
BurleyMaterial absorbingMedium(const Volume& volume, double metersPerUnit) {
  const bool absorbs = volume.volume && volume.distance < kInfinity;
  const Rgb sigma = absorbs ? extinction(volume, metersPerUnit) : Rgb{};
  BurleyMaterial medium{{kNoDiffusion, kNoDiffusion, kNoDiffusion}, {{}}};
  for (std::size_t i = 0; i < 3; ++i)
    (*medium.transmittance)[i] = {volume.transmission * volume.transmissionColor[i],
                                  std::max(sigma[i], kSlowestDecay), 0, kSlowestDecay};
  return medium;
}

void setMedium(GltfMaterial& result, const Volume& volume, const std::string& name, double metersPerUnit,
               std::vector<std::string>& warnings) {
  if (volume.scatter) {
    if (!volume.volume || !(volume.distance < kInfinity)) {
      warnings.push_back("material \"" + name +
                         "\": KHR_materials_volume_scatter needs KHR_materials_volume "
                         "with thicknessFactor > 0 and a finite attenuationDistance; it is drawn opaque");
      return;
    }
    result.medium = scatteringMedium(volume, metersPerUnit);
    // The fraction that enters comes back with the medium's color, the rest with the base color.
    const double entering = volume.transmission > 0 ? volume.transmission : 1;
    for (std::size_t i = 0; i < 3; ++i) {
      result.surface.baseColor[i] *= 1 - entering;
      result.surface.addedColor[i] = entering * volume.transmissionColor[i] * volume.multiscatter[i];
    }
  } else if (volume.diffuse && volume.transmission > 0) {
    result.medium = absorbingMedium(volume, metersPerUnit);
  } else if (volume.volume) {
    warnings.push_back("material \"" + name +
                       "\": a clear medium without KHR_materials_diffuse_transmission or "
                       "_volume_scatter is not subsurface scattering; it is drawn opaque");
  }
}

bool hasColor(const GltfMaterial& material) {
  const Rgb& color = material.surface.baseColor;
  const auto isGray = [&](double gray) {
    return std::all_of(color.begin(), color.end(), [&](double v) { return std::abs(v - gray) < 1e-6; });
  };
  return material.texture >= 0 ||
         std::none_of(std::begin(kDefaultBaseColors), std::end(kDefaultBaseColors), isGray);
}

const std::string* presetFor(const std::string& name, const GltfOptions& options) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = options.presets.find(key); found != options.presets.end()) return &found->second;
  return nullptr;
}

}  // namespace

std::string materialName(const GltfDocument& document, int index) {
  if (index < 0) return "default";
  const std::string& name = document.model.materials[static_cast<std::size_t>(index)].name;
  return name.empty() ? "materials[" + std::to_string(index) + "]" : name;
}

double singleScatteringAlbedo(double multiscatter) {
  const double m = std::clamp(multiscatter, 0.0, 1.0);
  const double s = 4.09712 + 4.20863 * m - std::sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
  return std::clamp(1 - s * s, 0.0, 1.0);
}

GltfMaterial readMaterial(const GltfDocument& document, int index, const GltfOptions& options,
                          std::vector<std::string>& warnings) {
  GltfMaterial result;
  const std::string name = materialName(document, index);
  result.surface.name = name;
  if (index >= 0) {
    const std::string field = "materials[" + std::to_string(index) + "]";
    const tinygltf::Material& material = document.model.materials[static_cast<std::size_t>(index)];
    const auto& factor = material.pbrMetallicRoughness.baseColorFactor;
    if (factor.size() != 4 ||
        !std::all_of(factor.begin(), factor.end(), [](double v) { return v >= 0 && v <= 1; }))
      document.fail(field + ".pbrMetallicRoughness.baseColorFactor", "is not 4 numbers within 0 .. 1");
    std::copy_n(factor.begin(), 3, result.surface.baseColor.begin());
    result.surface.doubleSided = material.doubleSided;
    if (material.alphaMode == "MASK") {
      if (!(material.alphaCutoff >= 0 && std::isfinite(material.alphaCutoff)))
        document.fail(field + ".alphaCutoff", std::to_string(material.alphaCutoff) + " is not >= 0");
      // The factor multiplies the texel's alpha; 2 is above any of them.
      result.surface.alphaCutoff = factor[3] > 0 ? std::min(material.alphaCutoff / factor[3], 2.0) : 2;
    } else if (material.alphaMode == "BLEND") {
      warnings.push_back("material \"" + name + "\": alphaMode BLEND is drawn opaque");
    }
    result.texture = material.pbrMetallicRoughness.baseColorTexture.index;
    result.texCoord = material.pbrMetallicRoughness.baseColorTexture.texCoord;
    const tinygltf::NormalTextureInfo& normal = material.normalTexture;
    if (!(std::abs(normal.scale) <= kLargestNormalScale))
      document.fail(field + ".normalTexture.scale",
                    std::to_string(normal.scale) + " is outside -1000 .. 1000");
    result.normalTexture = normal.index;
    result.normalTexCoord = normal.texCoord;
    result.surface.normalScale = normal.scale;
    if (!presetFor(name, options))
      setMedium(result, readVolume(document, material, field, name, warnings), name, options.metersPerUnit,
                warnings);
  }
  if (const std::string* preset = presetFor(name, options)) {
    PellucidMaterialDesc desc;
    if (pellucidFindPreset(preset->c_str(), &desc) != PELLUCID_OK)
      document.fail("material \"" + name + "\"", "there is no preset \"" + *preset + "\"");
    result.medium = PresetMaterial{*preset};
  }
  const std::string where = document.file + ": material \"" + name + "\"";
  if (result.medium && options.ior > 0) result.medium = withIor(*result.medium, options.ior, where);
  if (presetFor(name, options) && !hasColor(result)) {
    const PellucidMaterial compiled = compileMaterial(*result.medium, where);
    result.reflectance.emplace();
    std::copy_n(compiled.reflectance, 3, result.reflectance->begin());
  }
  return result;
}

}  // namespace pellucid::harness
