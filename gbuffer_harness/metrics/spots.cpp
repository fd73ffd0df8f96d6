#include "metrics/spots.h"

#include <algorithm>
#include <cmath>

#include "common/parallel.h"

namespace pellucid::harness {

namespace {

constexpr int kReach = 4;  // pixels to either side: 9x9
constexpr int kAcross = 2 * kReach + 1;
constexpr std::size_t kFewestAround = (kAcross * kAcross + 1) / 2;  // as along a straight silhouette
// Standard deviations of fine grain. Path-traced noise has tails: at 5 a truth of 3 % noise has a hundred
// spots.
constexpr double kBeyondNoise = 8;
constexpr int kSpread = 2;  // pixels that diffusion takes a contrast of the input along

constexpr std::array<std::array<int, 2>, 8> kSteps = {
    {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, -1}, {1, -1}, {-1, 1}}};
constexpr std::size_t kStraightSteps = 4;  // the first of them

// The median of |value - mean of four neighbors| over the standard deviation of the value, for normal noise.
const double kGrainOfNoise = 0.6745 * std::sqrt(1 + 1.0 / 4);

// Pixels of the 9x9 around (x, y) that steps reach, (x, y) first.
class Surroundings {
public:
  void find(const std::vector<std::uint8_t>& steps, int width, int x, int y) {
    std::array<bool, kAcross* kAcross> isSeen = {};
    places_.assign(1, {x, y});
    isSeen[kReach * kAcross + kReach] = true;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto [px, py] = places_[i];
      const std::uint8_t open = steps[static_cast<std::size_t>(py) * static_cast<std::size_t>(width) +
                                      static_cast<std::size_t>(px)];
      for (std::size_t s = 0; s < kSteps.size(); ++s) {
        if ((open >> s & 1) == 0) continue;
        const int nx = px + kSteps[s][0], ny = py + kSteps[s][1];
        const int column = nx - x + kReach, row = ny - y + kReach;
        if (column < 0 || row < 0 || column >= kAcross || row >= kAcross) continue;
        bool& seen = isSeen[static_cast<std::size_t>(row * kAcross + column)];
        if (seen) continue;
        seen = true;
        places_.push_back({nx, ny});
      }
    }
  }
  const std::vector<std::array<int, 2>>& places() const { return places_; }

  template <class Value>
  float median(const Value& value) {
    values_.clear();
    for (const auto& [x, y] : places_) values_.push_back(value(x, y));
    const auto middle = values_.begin() + static_cast<std::ptrdiff_t>(values_.size() / 2);
    std::nth_element(values_.begin(), middle, values_.end());
    return *middle;
  }

private:
  std::vector<std::array<int, 2>> places_;
  std::vector<float> values_;
};

}  // namespace

SpotImage::SpotImage(const Image& image, const Surfaces& surfaces, const Mask& mask)
    : width_(surfaces.width()), height_(surfaces.height()) {
  requireImage("image", image, width_, height_, mask);
  steps_.resize(image.pixels());
  pixels_.resize(image.pixels());
  const std::array<double, 3> rms = rmsOf(image, mask);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x) {
      if (!counts(image, mask, x, y)) continue;
      for (std::size_t s = 0; s < kSteps.size(); ++s) {
        const auto [dx, dy] = kSteps[s];
        if (surfaces.connected(x, y, dx, dy) && counts(image, mask, x + dx, y + dy))
          steps_[index(x, y)] |= static_cast<std::uint8_t>(1 << s);
      }
      for (std::size_t c = 0; c < 3; ++c)
        pixels_[index(x, y)].value[c] =
            std::max(image.at(x, y)[c], static_cast<float>(kDarkestPart * rms[c]));
    }
  // The difference of a pixel from its neighbors, which no slope changes.
  std::vector<Color> grain(image.pixels());
  parallelRows(height_, 0, [&](int y) {
    for (int x = 0; x < width_; ++x) {
      Color sum = {};
      int neighbors = 0;
      for (std::size_t s = 0; s < kStraightSteps; ++s) {
        if ((steps_[index(x, y)] >> s & 1) == 0) continue;
        ++neighbors;
        for (std::size_t c = 0; c < 3; ++c) sum[c] += image.at(x + kSteps[s][0], y + kSteps[s][1])[c];
      }
      for (std::size_t c = 0; c < 3 && neighbors > 0; ++c)
        grain[index(x, y)][c] = std::abs(image.at(x, y)[c] - sum[c] / static_cast<float>(neighbors));
    }
  });
  parallelRows(height_, 0, [&](int y) {
    Surroundings around;
    for (int x = 0; x < width_; ++x) {
      if (steps_[index(x, y)] == 0) continue;
      around.find(steps_, width_, x, y);
      Pixel& pixel = pixels_[index(x, y)];
      pixel.isJudged = around.places().size() >= kFewestAround;
      for (std::size_t c = 0; c < 3; ++c) {
        pixel.median[c] = around.median([&](int px, int py) { return at(px, py).value[c]; });
        pixel.noise[c] = around.median([&](int px, int py) { return grain[index(px, py)][c]; }) /
                         static_cast<float>(kGrainOfNoise);
      }
    }
  });
}

// The largest contrast within kSpread of the pixel, at least 1.
double SpotImage::explained(int x, int y, std::size_t channel, bool bright) const {
  double most = 1;
  for (int py = std::max(y - kSpread, 0); py <= std::min(y + kSpread, height_ - 1); ++py)
    for (int px = std::max(x - kSpread, 0); px <= std::min(x + kSpread, width_ - 1); ++px) {
      const Pixel& pixel = at(px, py);
      if (!(pixel.median[channel] > 0)) continue;
      const double contrast = static_cast<double>(pixel.value[channel]) / pixel.median[channel];
      most = std::max(most, bright ? contrast : 1 / contrast);
    }
  return most;
}

bool SpotImage::standsOut(int x, int y, bool bright, const SpotImage* input) const {
  const Pixel& pixel = at(x, y);
  if (!pixel.isJudged) return false;
  for (std::size_t c = 0; c < 3; ++c) {
    const double value = pixel.value[c], median = pixel.median[c];
    if (std::abs(value - median) <= kBeyondNoise * pixel.noise[c]) continue;
    const double contrast = bright ? value / median : median / value;
    if (contrast <= kSpotContrast) continue;
    if (input == nullptr || contrast > kSpotContrast * input->explained(x, y, c, bright)) return true;
  }
  return false;
}

std::vector<Spot> SpotImage::find(const SpotImage* input) const {
  std::vector<Spot> spots;
  for (const bool bright : {true, false}) {
    std::vector<bool> isOpen(pixels_.size());
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) isOpen[index(x, y)] = standsOut(x, y, bright, input);
    for (int y = 0; y < height_; ++y)
      for (int x = 0; x < width_; ++x) {
        if (!isOpen[index(x, y)]) continue;
        Spot spot{bright, {x, y}, {x, y}, {{x, y}}};
        isOpen[index(x, y)] = false;
        for (std::size_t i = 0; i < spot.pixels.size(); ++i) {
          const auto [px, py] = spot.pixels[i];
          spot.low = {std::min(spot.low[0], px), std::min(spot.low[1], py)};
          spot.high = {std::max(spot.high[0], px), std::max(spot.high[1], py)};
          for (std::size_t s = 0; s < kSteps.size(); ++s) {
            const int nx = px + kSteps[s][0], ny = py + kSteps[s][1];
            if ((steps_[index(px, py)] >> s & 1) == 0 || !isOpen[index(nx, ny)]) continue;
            isOpen[index(nx, ny)] = false;
            spot.pixels.push_back({nx, ny});
          }
        }
        if (spot.high[0] - spot.low[0] < kLargestSpot && spot.high[1] - spot.low[1] < kLargestSpot)
          spots.push_back(std::move(spot));
      }
  }
  return spots;
}

double SpotImage::contrast(const Spot& spot, std::size_t channel) const {
  double values = 0, medians = 0;
  for (const auto& [x, y] : spot.pixels) {
    values += at(x, y).value[channel];
    medians += at(x, y).median[channel];
  }
  if (!(values > 0) || !(medians > 0)) return 1;
  return spot.isBright ? values / medians : medians / values;
}

std::vector<Spot> SpotImage::lackedBy(const SpotImage& other, const std::vector<Spot>& spots) const {
  std::vector<Spot> lacked;
  for (const Spot& spot : spots)
    for (std::size_t c = 0; c < 3; ++c)
      if (contrast(spot, c) > kSpotContrast * std::max(1.0, other.contrast(spot, c))) {
        lacked.push_back(spot);
        break;
      }
  return lacked;
}

Image litAlbedo(const Capture& capture) {
  Image lit = capture.irradiance;
  for (std::size_t i = 0; i < lit.data.size() && !capture.albedo.empty(); ++i)
    lit.data[i] *= capture.albedo.data[i];
  return lit;
}

}  // namespace pellucid::harness
