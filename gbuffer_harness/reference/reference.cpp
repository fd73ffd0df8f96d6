#include "reference/reference.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <unordered_set>

#include "common/error.h"
#include "common/parallel.h"
#include "common/progress.h"
#include "reference/ambient.h"
#include "reference/color.h"
#include "reference/surface.h"
#include "reference/translucency.h"

namespace pellucid::harness::reference {
namespace {

glm::dvec3 dividedOrZero(const glm::dvec3& a, const glm::dvec3& b) {
  const auto divide = [](double n, double d) { return d > 0 ? n / d : 0.0; };
  return {divide(a.x, b.x), divide(a.y, b.y), divide(a.z, b.z)};
}

glm::dvec3 debugColor(const Transmission& t, PellucidDebugView view) {
  switch (view) {
    case PELLUCID_DEBUG_THICKNESS:
      return {t.cameraThickness.value_or(-1), t.lightThickness.value_or(-1), t.usedThickness.value_or(-1)};
    case PELLUCID_DEBUG_TRANSMITTANCE:
      return dividedOrZero(t.transmitted, t.unoccluded);
    default:
      return dividedOrZero(t.unoccluded, t.arriving);
  }
}

void validate(const Capture& capture, const std::vector<PellucidMaterial>& materials,
              const Settings& settings) {
  if (!(capture.metersPerUnit > 0) || !std::isfinite(capture.metersPerUnit))
    throw InputError(capture.name, "metersPerUnit",
                     std::to_string(capture.metersPerUnit) + " is not a length");
  if (!settings.wanted.empty() && settings.wanted.size() != capture.material.size())
    throw InputError(capture.name, "wanted",
                     std::to_string(settings.wanted.size()) + " values for " +
                         std::to_string(capture.material.size()) + " pixels");
  const auto highest = std::max_element(capture.material.begin(), capture.material.end());
  if (highest != capture.material.end() && *highest > materials.size())
    throw InputError(
        capture.name, "material",
        "index " + std::to_string(*highest) + " but " + std::to_string(materials.size()) + " materials");
  for (std::size_t i = 0; i < materials.size(); ++i)
    for (const float rho : materials[i].reflectance)
      if (!(rho > 0))
        throw InputError(capture.name, "materials[" + std::to_string(i) + "].reflectance",
                         std::to_string(rho) + " is not positive");
}

// One run over one capture.
class Pass {
public:
  // `marks`: pixels that light does not come through.
  Pass(const Capture& capture, const std::unordered_set<std::size_t>& marks,
       const std::vector<PellucidMaterial>& materials, const Settings& settings)
      : capture_(capture),
        marks_(marks),
        materials_(materials),
        settings_(settings),
        surfaces_(capture),
        translucency_(capture, surfaces_, settings.translucency),
        values_(capture.material.size()) {
    if (settings.ambient) ambient_.emplace(capture, surfaces_, materials);
  }

  Result run() {
    switch (settings_.debugView) {
      case PELLUCID_DEBUG_NONE:
        return diffused();
      case PELLUCID_DEBUG_IRRADIANCE:
        addIrradiance();
        return {toImage(values_)};
      default:
        forEachWanted("debug view", [&](int x, int y, std::size_t i) {
          values_[i] = debugColor(transmission(x, y, i), settings_.debugView);
        });
        return {toImage(values_)};
    }
  }

private:
  // fn(x, y, index) for every pixel with a material.
  template <typename Fn>
  void forEachPixel(const char* label, const Fn& fn) const {
    Progress progress(label, static_cast<std::uint64_t>(capture_.height));
    parallelRows(capture_.height, 0, [&](int y) {
      for (int x = 0; x < capture_.width; ++x)
        if (const std::size_t i = pixelNumber(capture_.irradiance, x, y); capture_.material[i] != 0)
          fn(x, y, i);
      progress.advance();
    });
  }

  bool wanted(std::size_t i) const { return settings_.wanted.empty() || settings_.wanted[i] != 0; }

  // Likewise, for every pixel whose output is wanted.
  template <typename Fn>
  void forEachWanted(const char* label, const Fn& fn) const {
    forEachPixel(label, [&](int x, int y, std::size_t i) {
      if (wanted(i)) fn(x, y, i);
    });
  }

  const PellucidMaterial& material(std::size_t i) const { return materials_[capture_.material[i] - 1u]; }

  Transmission transmission(int x, int y, std::size_t i) const {
    if (marks_.count(i) != 0) return {};
    const std::optional<Surface> surface = surfaces_.at(x, y);
    return surface ? translucency_.at(*surface, material(i), capture_.material[i]) : Transmission{};
  }

  // E + transmitted / rho.
  void addIrradiance() {
    forEachPixel("translucency", [&](int x, int y, std::size_t i) {
      values_[i] = readColor(capture_.irradiance.at(x, y));
      if (settings_.features & PELLUCID_FEATURE_TRANSLUCENCY)
        values_[i] = glm::max(values_[i] + transmitted(x, y, i), 0.0);
    });
  }

  // As irradiance that albedo = rho turns into the exitance.
  glm::dvec3 transmitted(int x, int y, std::size_t i) const {
    const float* rho = material(i).reflectance;
    glm::dvec3 exitance = transmission(x, y, i).transmitted;
    if (const std::optional<Surface> surface = surfaces_.at(x, y);
        ambient_ && surface && marks_.count(i) == 0)
      exitance += ambient_->at(*surface, capture_.material[i] - 1u);
    return exitance / glm::dvec3(rho[0], rho[1], rho[2]);
  }

  // Light that comes through is diffused with the irradiance.
  Result diffused() {
    addIrradiance();
    Result result;
    std::vector<glm::dvec3> output = values_;
    if (settings_.features & PELLUCID_FEATURE_DIFFUSION) {
      const Diffusion diffusion(capture_, surfaces_, materials_, values_);
      forEachWanted("diffusion", [&](int x, int y, std::size_t i) { output[i] = diffusion.at(x, y); });
    }
    if (!capture_.albedo.empty())
      forEachPixel("albedo",
                   [&](int x, int y, std::size_t i) { output[i] *= readColor(capture_.albedo.at(x, y)); });
    result.image = toImage(output);
    return result;
  }

  Image toImage(const std::vector<glm::dvec3>& values) const {
    Image image(capture_.width, capture_.height, 3);
    for (std::size_t i = 0; i < values.size(); ++i)
      for (std::size_t c = 0; c < 3 && wanted(i); ++c)
        image.data[3 * i + c] = static_cast<float>(values[i][static_cast<glm::length_t>(c)]);
    return image;
  }

  const Capture& capture_;
  const std::unordered_set<std::size_t>& marks_;
  const std::vector<PellucidMaterial>& materials_;
  const Settings& settings_;
  SurfaceReader surfaces_;
  Translucency translucency_;
  std::optional<Ambient> ambient_;
  std::vector<glm::dvec3> values_;  // 0 where there is no material
};

}  // namespace

Result compute(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const Settings& settings) {
  const std::uint32_t mark = settings.translucency.materialMarkBit;
  if (mark == 0) {
    validate(capture, materials, settings);
    return Pass(capture, {}, materials, settings).run();
  }
  Capture unmarked = capture;
  std::unordered_set<std::size_t> marks;
  for (std::size_t i = 0; i < capture.material.size(); ++i) {
    if ((capture.material[i] & mark) != 0) marks.insert(i);
    unmarked.material[i] = static_cast<std::uint8_t>(capture.material[i] & ~mark);
  }
  validate(unmarked, materials, settings);
  return Pass(unmarked, marks, materials, settings).run();
}

}  // namespace pellucid::harness::reference
