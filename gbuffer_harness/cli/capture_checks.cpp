#include "cli/capture_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "capture/manifest_parts.h"
#include "capture/material.h"
#include "common/error.h"
#include "reference/camera.h"
#include "replay/exposure.h"
#include "replay/frame.h"

namespace pellucid::harness {

namespace {

// Neighboring pixels of one material.
struct Piece {
  std::size_t pixels = 0;
  bool isWhole = true;  // not cut by the image's edge
  glm::dvec3 low = glm::dvec3(std::numeric_limits<double>::infinity()), high = -low;  // view space
  double thickness = 0;
};

class Pieces {
public:
  explicit Pieces(const Capture& capture)
      : capture_(capture),
        camera_(capture.clipFromView, capture.width, capture.height),
        seen_(capture.material.size()) {}

  // The largest one of each material, by number from 1.
  std::vector<Piece> largest() {
    std::vector<Piece> result(capture_.materials.size());
    for (std::size_t i = 0; i < seen_.size(); ++i) {
      const std::uint8_t material = capture_.material[i];
      if (material == 0 || seen_[i]) continue;
      const Piece piece = pieceAt(i);
      Piece& kept = result.at(material - 1u);
      if (piece.pixels > kept.pixels) kept = piece;
    }
    return result;
  }

private:
  Piece pieceAt(std::size_t start) {
    Piece piece;
    std::vector<std::size_t> open = {start};
    seen_[start] = true;
    const auto width = static_cast<std::size_t>(capture_.width),
               height = static_cast<std::size_t>(capture_.height);
    while (!open.empty()) {
      const std::size_t i = open.back(), x = i % width, y = i / width;
      open.pop_back();
      add(piece, static_cast<int>(x), static_cast<int>(y));
      if (x == 0 || y == 0 || x + 1 == width || y + 1 == height) piece.isWhole = false;
      const auto visit = [&](bool there, std::size_t k) {
        if (!there || seen_[k] || capture_.material[k] != capture_.material[i]) return;
        seen_[k] = true;
        open.push_back(k);
      };
      visit(x > 0, i - 1);
      visit(x + 1 < width, i + 1);
      visit(y > 0, i - width);
      visit(y + 1 < height, i + width);
    }
    return piece;
  }

  void add(Piece& piece, int x, int y) const {
    ++piece.pixels;
    const auto front = camera_.planarDepth(*capture_.frontDepth.image.at(x, y), capture_.frontDepth.encoding);
    if (!front) return;
    const glm::dvec2 center(x + 0.5, y + 0.5);
    const glm::dvec3 position = camera_.position(center, *front);
    piece.low = glm::min(piece.low, position);
    piece.high = glm::max(piece.high, position);
    if (capture_.backDepth.image.empty()) return;
    if (capture_.backDepth.encoding == PELLUCID_DEPTH_THICKNESS) {
      const float mm = *capture_.backDepth.image.at(x, y);
      if (holdsThickness(mm)) piece.thickness = std::max(piece.thickness, double(mm) / (1000 * capture_.metersPerUnit));
      return;
    }
    const auto back = camera_.planarDepth(*capture_.backDepth.image.at(x, y), capture_.backDepth.encoding);
    if (back && *back > *front)
      piece.thickness = std::max(piece.thickness, glm::distance(position, camera_.position(center, *back)));
  }

  const Capture& capture_;
  reference::Camera camera_;
  std::vector<bool> seen_;
};

// Middle extent; a piece without back depths is as thick as it is deep.
double sizeOf(const Piece& piece) {
  const glm::dvec3 extent = piece.high - piece.low;
  std::array<double, 3> sizes = {extent.x, extent.y, std::max(piece.thickness, extent.z)};
  std::sort(sizes.begin(), sizes.end());
  return sizes[1];
}

// mm, of each channel; none where a description does not say it.
std::optional<std::array<double, 3>> transportMeanFreePath(const MaterialSource& source,
                                                           const PellucidMaterial& compiled) {
  std::array<double, 3> lengths{};
  if (compiled.thinWalled) return std::nullopt;
  try {
    const CoefficientMaterial medium = coefficientsOf(source, "");
    for (std::size_t c = 0; c < 3; ++c)
      lengths[c] = 1 / (medium.scattering[c] * (1 - medium.g) + medium.absorption[c]);
    return lengths;
  } catch (const InputError&) {  // a profile, or layers
  }
  for (std::size_t c = 0; c < 3; ++c) {
    // Christensen and Burley 2015, equation 6: d is the transport mean free path over this factor of the
    // albedo.
    const double off = static_cast<double>(compiled.reflectance[c]) - 0.33;
    lengths[c] = static_cast<double>(compiled.burleyDistance[c]) * (3.5 + 100 * off * off * off * off);
    if (!(lengths[c] > 0)) return std::nullopt;
  }
  return lengths;
}

// Collects "COUNT of TOTAL sentence".
class Warnings {
public:
  explicit Warnings(std::vector<std::string>& sentences) : sentences_(sentences) {}
  void count(std::size_t count, std::size_t total, const std::string& sentence) {
    if (count > 0)
      sentences_.push_back(std::to_string(count) + " of " + std::to_string(total) + " " + sentence);
  }

private:
  std::vector<std::string>& sentences_;
};

void checkPixels(const Capture& capture, const reference::Camera& camera, std::vector<std::string>& sentences) {
  const bool hasBack = !capture.backDepth.image.empty();
  std::size_t total = 0, noFront = 0, noBack = 0, noThickness = 0, reversed = 0, badIrradiance = 0,
              badHidden = 0, badAlbedo = 0;
  for (int y = 0; y < capture.height; ++y) {
    for (int x = 0; x < capture.width; ++x) {
      if (capture.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(capture.width) +
                           static_cast<std::size_t>(x)] == 0)
        continue;
      ++total;
      const float* light = capture.irradiance.at(x, y);
      const auto isLight = [](float v) { return v >= 0 && std::isfinite(v); };
      badIrradiance += !std::all_of(light, light + 3, isLight);
      if (!capture.hiddenIrradiance.empty()) {
        const float* hidden = capture.hiddenIrradiance.at(x, y);
        badHidden += !std::all_of(hidden, hidden + 3, isLight);
      }
      if (!capture.albedo.empty()) {
        const float* albedo = capture.albedo.at(x, y);
        badAlbedo += !std::all_of(albedo, albedo + 3, [](float v) { return v >= 0 && v <= 1; });
      }
      const auto front = camera.planarDepth(*capture.frontDepth.image.at(x, y), capture.frontDepth.encoding);
      noFront += !front;
      if (hasBack) {
        const float stored = *capture.backDepth.image.at(x, y);
        if (capture.backDepth.encoding == PELLUCID_DEPTH_THICKNESS) {
          noThickness += !holdsThickness(stored);
          continue;
        }
        const auto back = camera.planarDepth(stored, capture.backDepth.encoding);
        noBack += !back;
        constexpr double kRounding = 1e-5;  // both depths may be floats that went through a matrix
        reversed += front && back && *back < *front * (1 - kRounding);
      }
    }
  }
  Warnings warnings(sentences);
  if (total == 0) sentences.push_back("no pixel has a material: the output is the irradiance");
  warnings.count(noFront, total, "material pixels have no front depth");
  warnings.count(noBack, total, "material pixels have no back depth");
  warnings.count(noThickness, total, "material pixels have no thickness from 0 on: they count as thick");
  warnings.count(reversed, total, "material pixels have their back depth in front of the front depth");
  warnings.count(badIrradiance, total, "material pixels have an irradiance that is negative or not finite");
  warnings.count(badHidden, total, "material pixels have a hiddenIrradiance that is negative or not finite");
  warnings.count(badAlbedo, total, "material pixels have an albedo outside 0..1");
}

}  // namespace

std::vector<std::string> thinBodies(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  std::vector<std::string> sentences;
  const Matrix& clip = capture.clipFromView;
  if (clip[2] != 0 || clip[6] != 0 || clip[3] != 0 || clip[7] != 0) return sentences;  // oblique planes
  const std::vector<Piece> pieces = Pieces(capture).largest();
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Piece& piece = pieces[i];
    if (!piece.isWhole || !(piece.low.x <= piece.high.x)) continue;
    const auto lengths = transportMeanFreePath(capture.materials[i], materials[i]);
    if (!lengths) continue;
    const std::size_t c =
        static_cast<std::size_t>(std::max_element(lengths->begin(), lengths->end()) - lengths->begin());
    const double size = sizeOf(piece) * capture.metersPerUnit * 1000;
    // docs/accuracy.md#small-bodies has the errors.
    constexpr double kFewestPaths = 4;
    if (!(kFewestPaths * (*lengths)[c] > size)) continue;
    char sentence[320];
    std::snprintf(
        sentence, sizeof sentence,
        "materials[%zu]: the body's size, %.3g mm, is less than %g transport mean free paths, which are %.3g "
        "mm each in %c: light leaves by the sides, and the body is too dark, by 11 %% at 3 paths and "
        "38 %% at 1",
        i, size, kFewestPaths, (*lengths)[c], "RGB"[c]);
    sentences.emplace_back(sentence);
  }
  return sentences;
}

std::vector<std::string> findingsOf(const Capture& capture, const std::vector<PellucidMaterial>& materials, PellucidSeverity severity) {
  ReplaySettings settings;
  settings.preExposure = preExposureFor(capture);  // as a replay chooses it
  FrameData data;
  makeFrame(capture, materials, settings, data);
  std::pair<PellucidSeverity, std::vector<std::string>> found{severity, {}};
  pellucidValidateFrame(
      &data.frame,
      [](void* user, PellucidSeverity of, const char* field, const char* message) {
        auto& [wanted, sentences] = *static_cast<std::pair<PellucidSeverity, std::vector<std::string>>*>(user);
        if (of == wanted) sentences.push_back(std::string(field) + " " + message);
      },
      &found);
  return found.second;
}

std::vector<std::string> warningsOf(const Capture& capture, const std::vector<PellucidMaterial>& materials) {
  std::vector<std::string> sentences = capture.warnings;
  const Matrix& clip = capture.clipFromView;
  if (clip[2] != 0 || clip[6] != 0 || clip[3] != 0 || clip[7] != 0) return sentences;  // oblique planes: the module refuses them with advice
  checkPixels(capture, reference::Camera(capture.clipFromView, capture.width, capture.height), sentences);
  for (const auto& more : {findingsOf(capture, materials, PELLUCID_SEVERITY_WARNING), strangeMaps(capture), coarseTables(capture), thinBodies(capture, materials)})
    sentences.insert(sentences.end(), more.begin(), more.end());
  return sentences;
}

}  // namespace pellucid::harness
