#include "stress/measures.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace pellucid::harness::stress {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool sameBits(float a, float b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// The place of element `i` of an RGBA image.
Worst at(const Image& image, std::size_t i, double value) {
  const std::size_t pixel = i / 4, width = static_cast<std::size_t>(image.width);
  return {value, static_cast<int>(pixel % width), static_cast<int>(pixel / width), static_cast<int>(i % 4)};
}

// The largest of error(i) over elements first..last of the pixels. A NaN is the largest.
template <class Error>
Worst largest(const Image& image, const Pixels& pixels, std::size_t first, std::size_t last,
              const Error& error) {
  Worst worst;
  for (std::size_t p = 0; p < pixels.size(); ++p) {
    if (!pixels[p]) continue;
    for (std::size_t i = 4 * p + first; i <= 4 * p + last; ++i) {
      const double value = error(i);
      if (!(value <= worst.value)) worst = at(image, i, std::isnan(value) ? kInfinity : value);
    }
  }
  return worst;
}

// How many pixels are bad, at the place of the first.
template <class IsBad>
Worst badPixels(const Image& image, const IsBad& isBad) {
  Worst worst;
  double count = 0;
  for (std::size_t p = 0; p < image.pixels(); ++p)
    if (isBad(p) && count++ == 0) worst = at(image, 4 * p, 0);
  worst.value = count;
  return worst;
}

double relativeDifference(float a, float b) {
  if (sameBits(a, b)) return 0;
  if (!std::isfinite(a) || !std::isfinite(b)) return kInfinity;
  const double x = static_cast<double>(a), y = static_cast<double>(b);
  // 0 and -0, too, are no same bits.
  return std::max(std::abs(x - y) / std::max({std::abs(x), std::abs(y), 1e-30}), 1e-30);
}

double number(const Image& image, std::size_t i) { return static_cast<double>(image.data[i]); }

}  // namespace

double relative(double value, double scale) { return value / std::max(scale, kFloor); }

Worst notFinite(const Image& image, const Pixels& pixels) {
  double count = 0;
  Worst worst = largest(image, pixels, 0, 2, [&](std::size_t i) {
    const bool bad = !std::isfinite(image.data[i]);
    count += bad;
    return bad ? 1.0 : 0.0;
  });
  worst.value = count;
  return worst;
}

Worst negative(const Image& image, const Pixels& pixels) {
  return largest(image, pixels, 0, 2,
                 [&](std::size_t i) { return image.data[i] < 0 ? -number(image, i) : 0.0; });
}

Worst changedOutside(const Image& before, const Image& after, const Pixels& pixels) {
  return badPixels(after, [&](std::size_t p) {
    return !pixels[p] && std::memcmp(&before.data[4 * p], &after.data[4 * p], 4 * sizeof(float)) != 0;
  });
}

Worst unwritten(const Image& after, const Pixels& pixels) {
  // 0xFF bytes are NaN with the sign bit and all of the mantissa, in half that has become float, too.
  const auto isGarbage = [](float value) {
    return (std::bit_cast<std::uint32_t>(value) & 0xFFFFE000u) == 0xFFFFE000u;
  };
  return badPixels(after, [&](std::size_t p) {
    const float* const pixel = &after.data[4 * p];
    return pixels[p] && std::all_of(pixel, pixel + 4, isGarbage);
  });
}

Worst differentBits(const Image& a, const Image& b, const Pixels& pixels) {
  return largest(a, pixels, 0, 2, [&](std::size_t i) { return relativeDifference(a.data[i], b.data[i]); });
}

Worst differentAlpha(const Image& a, const Image& b, const Pixels& pixels) {
  return largest(a, pixels, 3, 3, [&](std::size_t i) {
    // Vulkan promises to keep neither infinity nor NaN without float controls: SwiftShader reads NaN from
    // infinite halves.
    if (!std::isfinite(a.data[i]) && !std::isfinite(b.data[i])) return 0.0;
    return relativeDifference(a.data[i], b.data[i]);
  });
}

Worst apart(const Image& image, const Image& expected, const Pixels& pixels) {
  return largest(image, pixels, 0, 2, [&](std::size_t i) {
    const double value = number(image, i), wanted = number(expected, i);
    if (value >= kCeiling || wanted >= kCeiling) return 0.0;
    return relative(std::abs(value - wanted), wanted);
  });
}

Worst notTwice(const Image& one, const Image& two, const Pixels& pixels) {
  return largest(one, pixels, 0, 2, [&](std::size_t i) {
    const double wanted = 2 * number(one, i), value = number(two, i);
    if (wanted >= kCeiling || value >= kCeiling) return 0.0;
    return relative(std::abs(value - wanted), std::max(value, wanted));
  });
}

Worst less(const Image& less, const Image& more, const Pixels& pixels) {
  return largest(less, pixels, 0, 2, [&](std::size_t i) {
    const double wanted = number(less, i), value = number(more, i);
    if (wanted >= kCeiling) return 0.0;
    return relative(std::max(wanted - value, 0.0), wanted);
  });
}

Worst notSum(const Image& without, const std::vector<Image>& parts, const Image& all, const Pixels& pixels) {
  return largest(all, pixels, 0, 2, [&](std::size_t i) {
    const double base = number(without, i), whole = number(all, i);
    double sum = base, scale = std::max(base, whole), least = std::min(base, whole), most = scale;
    for (const Image& part : parts) {
      const double value = number(part, i);
      sum += value - base;
      scale = std::max(scale, value);
      least = std::min(least, value);
      most = std::max(most, value);
    }
    if (least <= 0 || most >= kCeiling || sum >= kCeiling) return 0.0;
    return relative(std::abs(whole - sum), scale);
  });
}

}  // namespace pellucid::harness::stress
