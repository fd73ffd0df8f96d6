#include "gltf/material.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <string_view>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "common/error.h"
#include "common/parse.h"
#include "pellucid/pellucid_material.h"

namespace pellucid::harness {

namespace {

// Result of KHR_materials_volume, _volume_scatter, _diffuse_transmission and _transmission;
// docs/captures.md.
struct Scattering {
  std::optional<MaterialSource> medium;  // nothing: opaque
  std::optional<LobeMap> map;
};

using Rgb = std::array<double, 3>;


constexpr const char *kDiffuse = "KHR_materials_diffuse_transmission",
                     *kTransmission = "KHR_materials_transmission", *kVolume = "KHR_materials_volume",
                     *kVolumeScatter = "KHR_materials_volume_scatter", *kIor = "KHR_materials_ior";

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

Rgb colorOr(const Field& object, const char* key, const Rgb& absent) {
  const auto found = object.find(key);
  return found ? found->numbers<3>(0, 1) : absent;
}

void multiply(Rgb& color, const Rgb& by) {
  for (std::size_t i = 0; i < 3; ++i) color[i] *= by[i];
}
void scale(Rgb& color, double by) { multiply(color, {by, by, by}); }

// Reads the extensions of one material, and gives its surface, which has the base color, its lobes. Adds a sentence
// to `warnings` for a property by which a scattering material ends up black, opaque or otherwise than asked.
class Reader {
public:
  Reader(const GltfDocument& document, const Field& material, const std::string& name, double metersPerUnit,
         Surface& surface, std::vector<std::string>& warnings)
      : document_(document),
        material_(material),
        name_(name),
        metersPerUnit_(metersPerUnit),
        surface_(surface),
        warnings_(warnings) {}

  Scattering read();

private:
  std::optional<Field> find(const char* extension) const { return extensionOf(material_, extension); }
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
  void readDiffuse(const Field& diffuse);
  void readVolumeScatter(const Field& scatter, const std::optional<Field>& diffuse);

  const GltfDocument& document_;
  const Field& material_;
  std::string name_;
  double metersPerUnit_;
  Surface& surface_;
  std::vector<std::string>& warnings_;
  Scattering result_;
  bool isVolume_ = false;  // KHR_materials_volume with a thickness
  double distance_ = kUnbounded;
  Rgb attenuation_ = {1, 1, 1};
};

void Reader::readVolume() {
  const auto volume = find(kVolume);
  if (!volume) return;
  isVolume_ = numberOr(*volume, "thicknessFactor", 0, 0, kUnbounded) > 0;
  distance_ = numberOr(*volume, "attenuationDistance", kUnbounded, 0, kUnbounded);
  attenuation_ = colorOr(*volume, "attenuationColor", attenuation_);
  if (!(distance_ > 0)) (*volume)["attenuationDistance"].fail("is 0");
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
  return ior ? std::max(numberOr(*ior, "ior", 1.5, 0, 3), 1.0) : 1.5;
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
  const Rgb sigma = distance_ < kUnbounded ? extinction() : Rgb{};
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
void Reader::readDiffuse(const Field& diffuse) {
  const double factor = numberOr(diffuse, "diffuseTransmissionFactor", 0, 0, 1);
  surface_.addedColor = colorOr(diffuse, "diffuseTransmissionColorFactor", {1, 1, 1});
  if (factor == 0) warn("diffuseTransmissionFactor is 0, its default: no light comes through");
  if (isBlack(surface_.addedColor)) warn("diffuseTransmissionColorFactor is black: no light comes through");
  if (factor == 0) {
    surface_.addedColor = {0, 0, 0};
    return;
  }
  setMap({readTextureUse(document_, diffuse, "diffuseTransmissionColorTexture")},
         readTextureUse(document_, diffuse, "diffuseTransmissionTexture"));
  scale(surface_.addedColor, factor);
  surface_.displaced = factor;
  isVolume_ ? setAbsorbing() : setThinWall();
}

void Reader::readVolumeScatter(const Field& scatter, const std::optional<Field>& diffuse) {
  // The name before the extension was ratified.
  const bool old = scatter.has("multiscatterColor") && !scatter.has("multiscatterColorFactor");
  const Rgb multiscatter = colorOr(scatter, old ? "multiscatterColor" : "multiscatterColorFactor", {0, 0, 0});
  const double g = numberOr(scatter, "scatterAnisotropy", 0, -kLargestG, kLargestG);
  if (!isVolume_ || !(distance_ < kUnbounded)) {
    warn(
        "KHR_materials_volume_scatter needs KHR_materials_volume with thicknessFactor > 0 and a finite "
        "attenuationDistance; it is drawn opaque");
    return;
  }
  double entering = 1;
  std::optional<TextureUse> strength, color;
  surface_.addedColor = {1, 1, 1};
  if (diffuse) {
    entering = numberOr(*diffuse, "diffuseTransmissionFactor", 0, 0, 1);
    surface_.addedColor = colorOr(*diffuse, "diffuseTransmissionColorFactor", {1, 1, 1});
    strength = readTextureUse(document_, *diffuse, "diffuseTransmissionTexture");
    color = readTextureUse(document_, *diffuse, "diffuseTransmissionColorTexture");
  } else if (const auto transmission = find(kTransmission)) {
    entering = numberOr(*transmission, "transmissionFactor", 0, 0, 1);
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
  const auto scatterTexture = readTextureUse(document_, scatter, "multiscatterColorTexture");
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

Scattering Reader::read() {
  readVolume();
  const auto diffuse = find(kDiffuse), volumeScatter = find(kVolumeScatter);
  if (volumeScatter)
    readVolumeScatter(*volumeScatter, diffuse);
  else if (diffuse)
    readDiffuse(*diffuse);
  else if (isVolume_)
    warn(
        "a clear medium without KHR_materials_diffuse_transmission or _volume_scatter is not subsurface "
        "scattering; it is drawn opaque");
  return std::move(result_);
}

// A thin wall that transmits this color, and reflects the base color of the rest.
Scattering thinWall(const std::array<double, 3>& transmittance, Surface& surface) {
  for (std::size_t i = 0; i < 3; ++i) surface.baseColor[i] *= 1 - transmittance[i];
  surface.addedColor = transmittance;
  surface.lobes = SurfaceLobes::Apart;
  return {ThinWallMaterial{kHalf, kHalf, {}}, {}};
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

const std::string* presetFor(const std::string& name, const GltfOptions& options) {
  for (const std::string& key : {name, std::string("*")})
    if (const auto found = options.presets.find(key); found != options.presets.end()) return &found->second;
  return nullptr;
}

// Reads "thin:R,G,B".
std::optional<Rgb> thinTransmittance(const std::string& where, const std::string& text) {
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
    throw InputError(where, "", "\"" + text + "\" is not thin:R,G,B with a transmittance from 0 to 1 of each");
  return color;
}

}  // namespace

double singleScatteringAlbedo(double multiscatter) {
  const double m = std::clamp(multiscatter, 0.0, 1.0);
  const double s = 4.09712 + 4.20863 * m - std::sqrt(9.59217 + 41.6808 * m + 17.7126 * m * m);
  return std::clamp(1 - s * s, 0.0, 1.0);
}

std::string materialName(const GltfDocument& document, std::optional<std::size_t> index) {
  if (!index) return "default";
  const Field& material = document.list("materials")[*index];
  return nameOf(material).value_or(material.path());
}

GltfMaterial readMaterial(const GltfDocument& document, std::optional<std::size_t> index,
                          const GltfOptions& options, std::vector<std::string>& warnings) {
  GltfMaterial result;
  const std::string name = materialName(document, index);
  const std::string* const preset = presetFor(name, options);
  Surface& surface = result.surface;
  surface.name = name;
  if (index) {
    const Field& material = document.list("materials")[*index];
    double alpha = 1;
    if (const auto metallic = material.find("pbrMetallicRoughness")) {
      if (const auto factor = metallic->find("baseColorFactor")) {
        const auto rgba = factor->numbers<4>(0, 1);
        std::copy_n(rgba.begin(), 3, surface.baseColor.begin());
        alpha = rgba[3];
      }
      result.color = readTextureUse(document, *metallic, "baseColorTexture");
    }
    if (const auto sides = material.find("doubleSided")) surface.doubleSided = sides->boolean();
    const auto mode = material.find("alphaMode");
    const std::size_t alphaMode = mode ? mode->choice({"OPAQUE", "MASK", "BLEND"}) : 0;
    // The factor multiplies the texel's alpha; 2 is above any of them.
    if (alphaMode == 1)
      surface.alphaCutoff = alpha > 0 ? std::min(numberOr(material, "alphaCutoff", 0.5, 0, kUnbounded) / alpha, 2.0) : 2;
    if (alphaMode == 2) warnings.push_back("material \"" + name + "\": alphaMode BLEND is drawn opaque");
    result.normal = readTextureUse(document, material, "normalTexture");
    if (result.normal)
      surface.normalScale = numberOr(result.normal->info, "scale", 1, -kLargestNormalScale, kLargestNormalScale);
    if (!preset) {
      Scattering scattering =
          Reader(document, material, name, options.metersPerUnit, surface, warnings).read();
      result.medium = scattering.medium;
      result.lobeMap = std::move(scattering.map);
    }
  }
  const std::string where = document.file + ": material \"" + name + "\"";
  if (const auto transmittance = preset ? thinTransmittance(where, *preset) : std::nullopt) {
    result.medium = thinWall(*transmittance, surface).medium;
    return result;
  }
  if (preset) result.medium = parseMaterial(where, *preset);
  if (result.medium && options.ior > 0) result.medium = withIor(*result.medium, options.ior, where);
  if (preset) {
    const PellucidMaterial compiled = compileMaterial(*result.medium, where);
    if (!hasColor(result)) std::copy_n(compiled.reflectance, 3, result.reflectance.emplace().begin());
  }
  return result;
}

}  // namespace pellucid::harness
