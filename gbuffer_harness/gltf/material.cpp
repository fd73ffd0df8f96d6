#include "gltf/material.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "common/parse.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

// Result of KHR_materials_volume, _volume_scatter, _diffuse_transmission and _transmission;
// docs/captures.md.
struct Scattering {
  std::optional<MaterialSource> medium;  // nothing: opaque
  std::optional<LobeMap> map;
  bool leftOut = false;
};

using Rgb = std::array<double, 3>;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

constexpr const char *kDiffuse = "KHR_materials_diffuse_transmission",
                     *kTransmission = "KHR_materials_transmission", *kVolume = "KHR_materials_volume",
                     *kVolumeScatter = "KHR_materials_volume_scatter", *kIor = "KHR_materials_ior";

// Glass that transmits this part of the light or more is left out. Other glass is drawn opaque.
constexpr double kMostlyClear = 0.5;

// An attenuation color of 0 or 1 would be an infinite or no coefficient.
constexpr double kDarkest = 1e-4, kClearest = 0.999;

// The albedo is the color of light that comes through, so that of a thin wall's lobes the ratio counts, which
// is 1.
constexpr Rgb kHalf = {0.5, 0.5, 0.5};

// A profile too narrow to see, for media that do not scatter, mm.
constexpr double kNoDiffusion = 1e-3;
// T(d) has to fall to 0 in the end, 1/mm.
constexpr double kSlowestDecay = 1e-6;
// The compiler's bound on a phase function's mean cosine.
constexpr double kLargestG = 0.999;

bool isBlack(const Rgb& color) {
  return std::all_of(color.begin(), color.end(), [](double v) { return v == 0; });
}

// The texture of an object in the file's JSON, as "baseColorTexture" of pbrMetallicRoughness; nothing without
// one.
std::optional<TextureUse> readTextureUse(const GltfDocument& document, const GltfJson& object,
                                         const char* key, const std::string& field) {
  const auto found = object.find(key);
  if (found == object.end()) return std::nullopt;
  TextureUse use;
  use.field = field + "." + key;
  const auto index = found->is_object() ? found->find("index") : found->end();
  if (!found->is_object() || index == found->end() || !index->is_number_unsigned())
    document.fail(use.field + ".index", "is missing or not an integer >= 0");
  use.texture = static_cast<int>(std::min<std::uint64_t>(index->get<std::uint64_t>(), 1u << 30));
  use.coord = readTexCoord(document, *found, use.field);
  return use;
}

// The numbers of one extension object.
class Extension {
public:
  Extension(const GltfDocument& document, std::string field, const GltfJson& value)
      : document_(document), field_(std::move(field)), value_(value) {}

  double number(const char* key, double absent, double least, double most) const {
    const auto found = value_.find(key);
    return found == value_.end() ? absent : checked(key, *found, least, most);
  }
  Rgb color(const char* key, const Rgb& absent) const {
    const auto found = value_.find(key);
    if (found == value_.end()) return absent;
    if (!found->is_array() || found->size() != 3)
      document_.fail(field_ + "." + key, "is not an array of 3 numbers");
    Rgb rgb;
    for (std::size_t i = 0; i < 3; ++i) rgb[i] = checked(key, (*found)[i], 0, 1);
    return rgb;
  }
  bool has(const char* key) const { return value_.contains(key); }
  std::optional<TextureUse> texture(const char* key) const {
    return readTextureUse(document_, value_, key, field_);
  }
  const std::string& field() const { return field_; }

private:
  double checked(const char* key, const GltfJson& value, double least, double most) const {
    if (!value.is_number()) document_.fail(field_ + "." + key, "is not a number");
    const double number = value;
    if (!(number >= least && number <= most)) {
      const std::string range = most < kInfinity ? std::to_string(least) + " .. " + std::to_string(most)
                                                 : std::to_string(least) + " upwards";
      document_.fail(field_ + "." + key, std::to_string(number) + " is outside " + range);
    }
    return number;
  }

  const GltfDocument& document_;
  std::string field_;
  const GltfJson& value_;
};

void multiply(Rgb& color, const Rgb& by) {
  for (std::size_t i = 0; i < 3; ++i) color[i] *= by[i];
}
void scale(Rgb& color, double by) { multiply(color, {by, by, by}); }

// Reads the extensions of one material.
class Reader {
public:
  Reader(const GltfDocument& document, std::size_t material, const std::string& name, double metersPerUnit,
         Surface& surface, std::vector<std::string>& warnings)
      : document_(document),
        json_(document.json["materials"][material]),
        field_("materials[" + std::to_string(material) + "]"),
        name_(name),
        metersPerUnit_(metersPerUnit),
        surface_(surface),
        warnings_(warnings) {}

  Scattering read();

private:
  std::optional<Extension> find(const char* extension) const {
    const auto extensions = json_.find("extensions");
    if (extensions == json_.end() || !extensions->contains(extension)) return std::nullopt;
    const std::string field = field_ + ".extensions." + extension;
    const GltfJson& value = (*extensions)[extension];
    if (!value.is_object()) document_.fail(field, "is not an object");
    return Extension(document_, field, value);
  }
  void warn(const std::string& sentence) { warnings_.push_back("material \"" + name_ + "\": " + sentence); }
  void readVolume();
  void setMap(const std::vector<std::optional<TextureUse>>& colors,
              const std::optional<TextureUse>& strength);
  Rgb mean() const { return result_.map ? result_.map->mean : Rgb{1, 1, 1}; }
  Rgb extinction() const;
  double boundaryIor() const;
  void setThinWall();
  void setAbsorbing();
  void setScattering(const Rgb& multiscatter, double g, double ior);
  void readDiffuse(const Extension& diffuse);
  void readClear();
  void readVolumeScatter(const Extension& scatter, const std::optional<Extension>& diffuse);

  const GltfDocument& document_;
  const GltfJson& json_;
  std::string field_, name_;
  double metersPerUnit_;
  Surface& surface_;
  std::vector<std::string>& warnings_;
  Scattering result_;
  bool isVolume_ = false;  // KHR_materials_volume with a thickness
  double distance_ = kInfinity;
  Rgb attenuation_ = {1, 1, 1};
};

void Reader::readVolume() {
  const auto volume = find(kVolume);
  if (!volume) return;
  isVolume_ = volume->number("thicknessFactor", 0, 0, kInfinity) > 0;
  distance_ = volume->number("attenuationDistance", kInfinity, 0, kInfinity);
  attenuation_ = volume->color("attenuationColor", attenuation_);
  if (!(distance_ > 0)) document_.fail(volume->field() + ".attenuationDistance", "is 0");
  if (!isVolume_) warn("KHR_materials_volume.thicknessFactor is 0, which means a thin wall without a medium");
}

// Extinction, 1/mm, from the fraction of light that gets through attenuationDistance.
Rgb Reader::extinction() const {
  const double millimeters = distance_ * metersPerUnit_ * 1000;
  Rgb sigma;
  for (std::size_t i = 0; i < 3; ++i)
    sigma[i] = -std::log(std::clamp(attenuation_[i], kDarkest, kClearest)) / millimeters;
  return sigma;
}

double Reader::boundaryIor() const {
  const auto ior = find(kIor);
  return ior ? std::max(ior->number("ior", 1.5, 0, 3), 1.0) : 1.5;
}

void Reader::setMap(const std::vector<std::optional<TextureUse>>& colors,
                    const std::optional<TextureUse>& strength) {
  std::vector<TextureUse> there;
  for (const auto& color : colors)
    if (color) there.push_back(*color);
  result_.map = readLobeMap(document_, there, strength, warnings_);
}

// A thin wall, in the color of the lobe.
void Reader::setThinWall() {
  result_.medium = ThinWallMaterial{kHalf, kHalf, {}};
  surface_.lobes = SurfaceLobes::Apart;
}

// Light enters and leaves diffusely and is only absorbed on the way: T = e^{-sigma_a d}, in the color of the
// lobe.
void Reader::setAbsorbing() {
  const Rgb sigma = distance_ < kInfinity ? extinction() : Rgb{};
  BurleyMaterial medium{{kNoDiffusion, kNoDiffusion, kNoDiffusion}, {{}}};
  for (std::size_t i = 0; i < 3; ++i)
    (*medium.transmittance)[i] = {1, std::max(sigma[i], kSlowestDecay), 0, kSlowestDecay};
  result_.medium = medium;
  surface_.lobes = SurfaceLobes::Apart;
}

// Textures make no difference within a medium: it has their mean.
void Reader::setScattering(const Rgb& multiscatter, double g, double ior) {
  CoefficientMaterial medium{};
  const Rgb sigma = extinction(), textured = mean();
  for (std::size_t i = 0; i < 3; ++i) {
    const double albedo = singleScatteringAlbedo(multiscatter[i] * textured[i]);
    medium.scattering[i] = albedo * sigma[i];
    medium.absorption[i] = (1 - albedo) * sigma[i];
  }
  medium.g = g;
  medium.ior = ior;
  result_.medium = medium;
}

// The light that does not enter is reflected with the base color.
void Reader::readDiffuse(const Extension& diffuse) {
  const double factor = diffuse.number("diffuseTransmissionFactor", 0, 0, 1);
  surface_.addedColor = diffuse.color("diffuseTransmissionColorFactor", {1, 1, 1});
  if (factor == 0) warn("diffuseTransmissionFactor is 0, its default: no light comes through");
  if (isBlack(surface_.addedColor)) warn("diffuseTransmissionColorFactor is black: no light comes through");
  if (factor == 0) {
    surface_.addedColor = {0, 0, 0};
    return;
  }
  setMap({diffuse.texture("diffuseTransmissionColorTexture")}, diffuse.texture("diffuseTransmissionTexture"));
  scale(surface_.addedColor, factor);
  surface_.displaced = factor;
  isVolume_ ? setAbsorbing() : setThinWall();
}

void Reader::readVolumeScatter(const Extension& scatter, const std::optional<Extension>& diffuse) {
  // The name before the extension was ratified.
  const bool old = scatter.has("multiscatterColor") && !scatter.has("multiscatterColorFactor");
  const Rgb multiscatter = scatter.color(old ? "multiscatterColor" : "multiscatterColorFactor", {0, 0, 0});
  const double g = scatter.number("scatterAnisotropy", 0, -kLargestG, kLargestG);
  if (!isVolume_ || !(distance_ < kInfinity)) {
    warn(
        "KHR_materials_volume_scatter needs KHR_materials_volume with thicknessFactor > 0 and a finite "
        "attenuationDistance; it is drawn opaque");
    return;
  }
  double entering = 1;
  std::optional<TextureUse> strength, color;
  surface_.addedColor = {1, 1, 1};
  if (diffuse) {
    entering = diffuse->number("diffuseTransmissionFactor", 0, 0, 1);
    surface_.addedColor = diffuse->color("diffuseTransmissionColorFactor", {1, 1, 1});
    strength = diffuse->texture("diffuseTransmissionTexture");
    color = diffuse->texture("diffuseTransmissionColorTexture");
  } else if (const auto transmission = find(kTransmission)) {
    entering = transmission->number("transmissionFactor", 0, 0, 1);
  }
  if (entering == 0) {
    entering = 1;
    strength.reset();
    if (diffuse)
      warn("diffuseTransmissionFactor is 0, its default: 1 is taken, so that light enters the medium");
  }
  if (isBlack(multiscatter))
    warn(std::string("KHR_materials_volume_scatter.") +
         (old ? "multiscatterColor" : "multiscatterColorFactor") + " is black: the medium only absorbs");
  else if (isBlack(surface_.addedColor))
    warn("diffuseTransmissionColorFactor is black: no light comes back from the medium");
  const auto scatterTexture = scatter.texture("multiscatterColorTexture");
  setMap({scatterTexture}, std::nullopt);
  setScattering(multiscatter, g, diffuse ? 1 : boundaryIor());
  setMap({color, scatterTexture}, strength);
  multiply(surface_.addedColor, multiscatter);
  scale(surface_.addedColor, entering);
  if (strength) {
    surface_.displaced = entering;
  } else {
    scale(surface_.baseColor, 1 - entering);
  }
  if (strength || entering < 1) {
    surface_.lobes = SurfaceLobes::Apart;
    surface_.backscatter = 1;
  }
}

// Glass bends light, which no capture does: what stands behind it is seen as if it were not there.
void Reader::readClear() {
  const auto transmission = find(kTransmission);
  const double factor = transmission ? transmission->number("transmissionFactor", 0, 0, 1) : 0;
  if (factor == 0) return;
  result_.leftOut = factor >= kMostlyClear;
  warn(std::string("KHR_materials_transmission without _volume_scatter is clear glass, which is ") +
       (result_.leftOut ? "left out" : "drawn opaque") + "; --material " + name_ +
       (result_.leftOut ? "=opaque draws it" : "=none leaves it out") + ", and =PRESET gives it a medium");
}

Scattering Reader::read() {
  readVolume();
  const auto diffuse = find(kDiffuse), volumeScatter = find(kVolumeScatter);
  if (volumeScatter)
    readVolumeScatter(*volumeScatter, diffuse);
  else if (diffuse)
    readDiffuse(*diffuse);
  else
    readClear();
  return std::move(result_);
}

// A thin wall that transmits this color, and reflects the base color of the rest.
Scattering thinWall(const std::array<double, 3>& transmittance, Surface& surface) {
  for (std::size_t i = 0; i < 3; ++i) surface.baseColor[i] *= 1 - transmittance[i];
  surface.addedColor = transmittance;
  surface.lobes = SurfaceLobes::Apart;
  return {ThinWallMaterial{kHalf, kHalf, {}}, {}};
}

// `name`: the material's, for warnings. `surface`: with the base color; gets its lobes. Adds a sentence to
// `warnings` for a property by which a scattering material ends up black, opaque or otherwise than asked.
// Throws InputError naming the field.
Scattering readScattering(const GltfDocument& document, std::size_t material, const std::string& name,
                          double metersPerUnit, Surface& surface, std::vector<std::string>& warnings) {
  return Reader(document, material, name, metersPerUnit, surface, warnings).read();
}

// Base colors that nobody chose: glTF's default, and that of Blender's Principled BSDF, which its exporter
// writes.
constexpr double kDefaultBaseColors[] = {1, 0.8};

// Far steeper than any map, and its square still is a float.
constexpr double kLargestNormalScale = 1000;

bool hasColor(const GltfMaterial& material) {
  const Rgb& color = material.surface.baseColor;
  const auto isGray = [&](double gray) {
    return std::all_of(color.begin(), color.end(), [&](double v) { return std::abs(v - gray) < 1e-6; });
  };
  return material.color || std::none_of(std::begin(kDefaultBaseColors), std::end(kDefaultBaseColors), isGray);
}

// Words of --material in place of a medium.
constexpr const char *kNoTriangles = "none", *kDrawnOpaque = "opaque";

// Alpha below which a blended surface has a hole: the coverage of hair cards and leaves is mostly 0 or 1.
constexpr double kBlendCutoff = 0.5;

bool isEmissive(const tinygltf::Material& material) {
  return material.extensions.count("KHR_materials_unlit") != 0 ||
         std::any_of(material.emissiveFactor.begin(), material.emissiveFactor.end(),
                     [](double v) { return v > 0; });
}

const std::string* presetFor(const std::string& name, const GltfOptions& options) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = options.presets.find(key); found != options.presets.end()) return &found->second;
  return nullptr;
}

// Reads "thin:R,G,B".
std::optional<Rgb> thinTransmittance(const GltfDocument& document, const std::string& name,
                                     const std::string& text) {
  constexpr std::string_view kThin = "thin:";
  if (text.rfind(kThin, 0) != 0) return std::nullopt;
  const std::vector<std::string> parts = split(text.substr(kThin.size()), ',');
  Rgb color{};
  bool isColor = parts.size() == 3;
  for (std::size_t c = 0; c < 3 && isColor; ++c) {
    color[c] = numberIn<double>(parts[c]).value_or(-1);
    isColor = color[c] >= 0 && color[c] <= 1;
  }
  if (!isColor)
    document.fail("material \"" + name + "\"",
                  "\"" + text + "\" is not thin:R,G,B with a transmittance from 0 to 1 of each");
  return color;
}

}  // namespace

double singleScatteringAlbedo(double multiscatter) {
  const double m = std::clamp(multiscatter, 0.0, 1.0);
  const double s = 4.09712 + 4.20863 * m - std::sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
  return std::clamp(1 - s * s, 0.0, 1.0);
}

std::string materialName(const GltfDocument& document, int index) {
  if (index < 0) return "default";
  const std::string& name = document.model.materials[static_cast<std::size_t>(index)].name;
  return name.empty() ? "materials[" + std::to_string(index) + "]" : name;
}

GltfMaterial readMaterial(const GltfDocument& document, int index, const GltfOptions& options,
                          std::vector<std::string>& warnings) {
  GltfMaterial result;
  const std::string name = materialName(document, index);
  const std::string* const preset = presetFor(name, options);
  result.surface.name = name;
  result.leftOut = preset && *preset == kNoTriangles;
  const bool isOpaque = preset && *preset == kDrawnOpaque;
  if (result.leftOut) return result;
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
    } else if (material.alphaMode == "BLEND" && !isOpaque) {
      result.leftOut = factor[3] < kBlendCutoff;
      result.surface.alphaCutoff = std::min(kBlendCutoff / std::max(factor[3], kBlendCutoff), 1.0);
      warnings.push_back("material \"" + name + "\": alphaMode BLEND " +
                         (result.leftOut ? "of an alpha below 0.5 is left out"
                                         : "is approximated by holes where alpha is below 0.5; --material " +
                                               name + "=none leaves it out") +
                         "; --material " + name + "=opaque draws all of it");
      if (result.leftOut) return result;
    }
    result.surface.isEmissive = isEmissive(material);
    const GltfJson& json = document.json["materials"][static_cast<std::size_t>(index)];
    result.color = readTextureUse(document, json.value("pbrMetallicRoughness", GltfJson::object()),
                                  "baseColorTexture", field + ".pbrMetallicRoughness");
    result.normal = readTextureUse(document, json, "normalTexture", field);
    result.surface.normalScale = material.normalTexture.scale;
    if (!(std::abs(result.surface.normalScale) <= kLargestNormalScale))
      document.fail(field + ".normalTexture.scale",
                    std::to_string(result.surface.normalScale) + " is outside -1000 .. 1000");
    if (!preset) {
      Scattering scattering = readScattering(document, static_cast<std::size_t>(index), name,
                                             options.metersPerUnit, result.surface, warnings);
      result.medium = scattering.medium;
      result.leftOut = scattering.leftOut;
      result.lobeMap = std::move(scattering.map);
    }
  }
  if (isOpaque) return result;
  if (const auto transmittance = preset ? thinTransmittance(document, name, *preset) : std::nullopt) {
    result.medium = thinWall(*transmittance, result.surface).medium;
    return result;
  }
  const std::string where = document.file + ": material \"" + name + "\"";
  if (preset) result.medium = parseMaterial(where, *preset);
  if (result.medium && options.ior > 0) result.medium = withIor(*result.medium, options.ior, where);
  if (preset) {
    const PellucidMaterial compiled = compileMaterial(*result.medium, where);
    if (!hasColor(result)) std::copy_n(compiled.reflectance, 3, result.reflectance.emplace().begin());
  }
  return result;
}

}  // namespace pellucid::harness
