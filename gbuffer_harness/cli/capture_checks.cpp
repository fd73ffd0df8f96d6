#include "cli/capture_checks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "capture/material.h"
#include "common/error.h"
#include "reference/camera.h"

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

}  // namespace pellucid::harness
