// The camera of a random frame, and the images that it sees.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/packing.hpp>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

#include "scene/vector.h"
#include "stress/random_parts.h"

namespace pellucid::harness::stress {

namespace {

// Mostly well below the limit, near 64 x 64 without one, so that there are many; now and then one pixel, a
// strip, or the largest.
void randomSize(Random& random, const FrameLimits& limits, int& width, int& height) {
  const double kind = random.real();
  const int most = std::min(limits.side, limits.pixels);
  if (kind < 0.03) {
    width = random.whole(1, 3);
    height = random.whole(1, 3);
  } else if (kind < 0.07) {
    width = static_cast<int>(random.magnitude(64, most));
    height = random.whole(1, std::min(4, std::max(1, limits.pixels / width)));
    if (random.chance(0.5)) std::swap(width, height);
  } else {
    const double pixels = random.magnitude(16, kind < 0.1 ? limits.pixels : limits.pixels / 8.0) +
                          random.real(0, limits.pixels / 32.0);
    const double aspect = random.magnitude(0.25, 4);
    width = static_cast<int>(std::sqrt(pixels * aspect)) + 1;
    height = static_cast<int>(std::sqrt(pixels / aspect)) + 1;
  }
  width = std::clamp(width, 1, most);
  height = std::clamp(height, 1, std::min(most, std::max(1, limits.pixels / width)));
}

}  // namespace

glm::dvec3 View::point(double x, double y, double p) const {
  const double scale = perspective ? p : 1;
  const double u = ((x + 0.5) / width * 2 - 1 - ox) / fx, v = ((y + 0.5) / height * 2 - 1 - oy) / fy;
  return {u * scale, v * scale, sign * p};
}

glm::dvec3 View::normal(int x, int y) const {
  const auto planarAt = [&](int column, int row) {
    return planar[static_cast<std::size_t>(row * width + column)];
  };
  const double here = planarAt(x, y);
  const auto pointAt = [&](int column, int row) {
    column = std::clamp(column, 0, width - 1);
    row = std::clamp(row, 0, height - 1);
    const double p = planarAt(column, row);
    return point(column, row, p == 0 ? here : p);
  };
  const glm::dvec3 axis(0, 0, -sign);
  const glm::dvec3 cross =
      glm::cross(pointAt(x + 1, y) - pointAt(x - 1, y), pointAt(x, y + 1) - pointAt(x, y - 1));
  const double length = glm::length(cross);
  if (!(length > 0)) return axis;
  const glm::dvec3 toEye = perspective ? -point(x, y, here) : axis;
  return cross / length * (glm::dot(cross, toEye) < 0 ? -1.0 : 1.0);
}

View randomView(Random& random, bool wild, const FrameLimits& limits, Capture& capture) {
  View v{};
  randomSize(random, limits, v.width, v.height);
  v.perspective = random.chance(0.8);
  v.sign = random.chance(0.8) ? -1 : 1;
  const bool reversed = random.chance(0.5), infinite = v.perspective && random.chance(0.4);
  v.near = wild ? random.magnitude(1e-4, 1e3) : random.magnitude(0.01, 1);
  v.distance = v.near * random.magnitude(1.5, wild ? 1e5 : 300);
  v.far =
      infinite ? std::numeric_limits<double>::infinity() : v.distance * random.magnitude(3, wild ? 1e6 : 1e3);
  v.ox = random.chance(0.3) ? random.real(-0.7, 0.7) : 0;
  v.oy = random.chance(0.3) ? random.real(-0.7, 0.7) : 0;
  const double aspect = static_cast<double>(v.width) / v.height;
  const double up = random.chance(0.8) ? -1 : 1;  // of y in the image
  if (v.perspective) {
    const double degrees = wild ? random.real(1, 170) : random.real(15, 90);
    v.fx = 1 / std::tan(degrees * std::numbers::pi / 360);
    v.pixel = 2 * v.distance / (v.fx * v.width);
    v.a = infinite ? 1 : v.far / (v.far - v.near);
    v.b = infinite ? -v.near : -v.near * v.a;
    if (reversed) v.a = 1 - v.a, v.b = -v.b;
  } else {
    v.pixel = v.distance / v.width * random.magnitude(0.1, 3);
    v.fx = 2 / (v.pixel * v.width);
    v.a = 1 / (v.far - v.near);
    v.b = -v.near * v.a;
    if (reversed) v.a = -v.a, v.b = 1 - v.b;
  }
  v.fy = up * v.fx * aspect;
  if (random.chance(0.1)) v.fy *= random.magnitude(0.3, 3);  // pixels that are no squares

  capture.width = v.width;
  capture.height = v.height;
  v.mm = (wild ? random.magnitude(1e-5, 1e4) : random.magnitude(0.02, 3)) / v.pixel;
  v.mm = std::clamp(v.mm, 1.001e-3, 0.999e6);  // the domain of metersPerUnit
  if (wild && random.chance(0.1)) v.mm = random.magnitude(1.001e-3, 0.999e6);
  capture.metersPerUnit = v.mm / 1000;
  Matrix& m = capture.clipFromView = {};
  m[0] = v.fx;
  m[5] = v.fy;
  m[v.perspective ? 8 : 12] = v.perspective ? v.ox * v.sign : v.ox;
  m[v.perspective ? 9 : 13] = v.perspective ? v.oy * v.sign : v.oy;
  m[10] = v.a * v.sign;
  m[14] = v.b;
  m[11] = v.perspective ? v.sign : 0;
  m[15] = v.perspective ? 0 : 1;

  glm::dquat turn(1, 0, 0, 0);
  if (random.chance(0.8))
    turn = glm::normalize(
        glm::dquat(random.real(-1, 1), random.real(-1, 1), random.real(-1, 1), random.real(0.1, 1)));
  const double away = wild && random.chance(0.2) ? 1e6 : random.chance(0.5) ? 10 * v.distance : 0;
  glm::dmat4 world = glm::mat4_cast(turn);
  world[3] = {away * random.real(-1, 1), away * random.real(-1, 1), away * random.real(-1, 1), 1};
  v.worldFromView = world;
  capture.viewFromWorld = fromGlm(glm::inverse(world));
  for (int r = 0; r < 3; ++r) capture.viewFromWorld[static_cast<std::size_t>(4 * r + 3)] = 0;
  capture.viewFromWorld[15] = 1;
  return v;
}

namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN(),
                kFloatInfinity = std::numeric_limits<float>::infinity();

// A function of the pixel, which costs little: waves, steps, noise, or nothing.
class Pattern {
public:
  Pattern(Random& random, int width, int height) : kind_(random.whole(0, 4)), random_(random) {
    const double x = random.magnitude(0.02, 3), y = random.magnitude(0.02, 3), phase = random.real(0, 6);
    for (int i = 0; i < width; ++i) column_.push_back(std::sin(x * i + phase));
    for (int i = 0; i < height; ++i) row_.push_back(std::sin(y * i - phase));
    block_ = random.whole(1, 16);
  }
  // -1..1
  double at(int x, int y) {
    const auto column = static_cast<std::size_t>(x), row = static_cast<std::size_t>(y);
    switch (kind_) {
      case 0:
        return column_[column] * row_[row];
      case 1:
        return (x / block_ + y / block_) % 2 == 0 ? 1 : -1;
      case 2:
        return random_.real(-1, 1);
      case 3:
        return 0.5 * (column_[column] + row_[row]);
      default:
        return 0;
    }
  }

private:
  int kind_, block_;
  Random& random_;
  std::vector<double> column_, row_;
};

// Planar distances of the front; 0: nothing there.
std::vector<double> randomFront(Random& random, const View& v) {
  std::vector<double> front(static_cast<std::size_t>(v.width) * static_cast<std::size_t>(v.height));
  const double least = std::max(v.near * 1.001, v.distance * 0.3),
               most = std::min(v.far * 0.999, v.distance * 3);
  const double size = v.pixel * std::max(v.width, v.height);
  const bool sphere = random.chance(0.35);
  const double slopeX = random.chance(0.7) ? random.real(-2, 2) : 0,
               slopeY = random.chance(0.7) ? random.real(-2, 2) : 0;
  const double rough = random.chance(0.5) ? v.pixel * random.magnitude(0.01, 10) : 0;
  const double radius = size * random.real(0.1, 0.6);
  const glm::dvec3 middle =
      v.point(v.width * random.real(0.2, 0.8), v.height * random.real(0.2, 0.8), v.distance);
  Pattern pattern(random, v.width, v.height);
  std::size_t i = 0;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x, ++i) {
      const glm::dvec3 at = v.point(x, y, v.distance) - middle;
      double p = v.distance + slopeX * at.x + slopeY * at.y;
      if (sphere) {
        const double square = radius * radius - at.x * at.x - at.y * at.y;
        p = square > 0 ? v.distance - std::sqrt(square) : 0;
        if (square <= 0) continue;
      }
      if (rough > 0) p += rough * pattern.at(x, y);
      front[i] = std::clamp(p, least, most);
    }
  return front;
}

float encoded(const View& v, PellucidDepthEncoding encoding, double p) {
  return static_cast<float>(encoding == PELLUCID_DEPTH_DEVICE ? v.deviceDepth(p) : p);
}

float nothing(Random& random, const View& v, PellucidDepthEncoding encoding) {
  if (encoding == PELLUCID_DEPTH_DEVICE)
    return v.deviceDepth(1e30 * v.distance) > v.deviceDepth(v.distance) ? 1.0f : 0.0f;
  return random.of({0.0f, kNoDepth, kFloatInfinity});
}

float quantized(float depth, PellucidDepthEncoding encoding, int bits) {
  if (bits == 32) return depth;
  if (encoding != PELLUCID_DEPTH_DEVICE)
    return glm::unpackHalf1x16(glm::packHalf1x16(std::min(depth, 65504.0f)));
  const double steps = std::exp2(bits) - 1;
  return static_cast<float>(std::round(static_cast<double>(depth) * steps) / steps);
}

float badDepth(Random& random, float front) {
  return random.chance(0.3) ? std::nextafter(front, random.of({0.0f, 2.0f * front})) : badFloat(random);
}

void addDepths(Random& random, bool wild, const View& v, const std::vector<double>& front, Capture& c) {
  c.frontDepth.encoding = random.of({PELLUCID_DEPTH_DEVICE, PELLUCID_DEPTH_VIEW_Z});
  c.backDepth.encoding = random.chance(0.1)   ? PELLUCID_DEPTH_THICKNESS
                         : random.chance(0.9) ? c.frontDepth.encoding
                                              : PELLUCID_DEPTH_VIEW_Z;
  c.frontDepth.image = Image(v.width, v.height, 1);
  const int bits = random.chance(0.7) ? 32 : random.of({16, 24});
  const float frontNothing = nothing(random, v, c.frontDepth.encoding);
  for (std::size_t i = 0; i < front.size(); ++i)
    c.frontDepth.image.data[i] =
        front[i] > 0 ? quantized(encoded(v, c.frontDepth.encoding, front[i]), c.frontDepth.encoding, bits)
                     : frontNothing;
  if (random.chance(0.75)) {
    c.backDepth.image = Image(v.width, v.height, 1);
    const double thickness = random.magnitude(0.1, 30) / v.mm;
    const bool stored = c.backDepth.encoding == PELLUCID_DEPTH_THICKNESS;
    const float backNothing = stored ? -1.0f : nothing(random, v, c.backDepth.encoding);
    Pattern pattern(random, v.width, v.height);
    std::size_t i = 0;
    for (int y = 0; y < v.height; ++y)
      for (int x = 0; x < v.width; ++x, ++i) {
        const double p = front[i] + thickness * (1 + 0.9 * pattern.at(x, y));
        const double mm = (p - front[i]) * v.mm;
        c.backDepth.image.data[i] = !(front[i] > 0 && p < v.far) ? backNothing
                                    : stored                     ? static_cast<float>(mm)
                                                                 : encoded(v, c.backDepth.encoding, p);
      }
  }
  if (!wild || random.chance(0.4)) return;
  const double share = random.magnitude(1e-4, 1);
  for (std::size_t i = 0; i < front.size(); ++i) {
    if (random.chance(share)) c.frontDepth.image.data[i] = badDepth(random, c.frontDepth.image.data[i]);
    if (!c.backDepth.image.empty() && random.chance(share))
      c.backDepth.image.data[i] = badDepth(random, c.frontDepth.image.data[i]);
  }
}

void addMaterial(Random& random, bool wild, const View& v, int materials, const std::vector<double>& front,
                 Capture& c) {
  c.material.assign(front.size(), static_cast<std::uint8_t>(random.whole(1, materials)));
  const int kind = random.whole(0, 4), block = random.whole(2, 24);
  const double share = random.real();
  const glm::dvec2 middle(v.width * random.real(), v.height * random.real());
  const double radius = std::max(v.width, v.height) * random.real(0.1, 0.7);
  std::size_t i = 0;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x, ++i) {
      std::uint8_t& m = c.material[i];
      if (kind == 1 && glm::length(glm::dvec2(x, y) - middle) > radius) m = 0;
      if (kind == 2) m = static_cast<std::uint8_t>((x / block + y / block) % (materials + 1));
      if (kind == 3 && random.chance(share)) m = static_cast<std::uint8_t>(random.whole(0, materials));
      if (front[i] == 0 && (!wild || block % 2 == 0)) m = 0;
    }
}

void addIrradiance(Random& random, bool wild, const View& v, Capture& c) {
  c.irradiance = Image(v.width, v.height, 4);
  const double level = random.magnitude(0.01, 20), contrast = random.chance(0.5) ? 1 : random.real();
  const glm::dvec3 color(random.real(0.1, 1), random.real(0.1, 1), random.real(0.1, 1));
  const double share = wild && random.chance(0.7) ? random.magnitude(1e-4, 1) : 0;
  Pattern pattern(random, v.width, v.height);
  std::size_t i = 0;
  for (int y = 0; y < v.height; ++y)
    for (int x = 0; x < v.width; ++x, i += 4) {
      const double e = level * (1 + contrast * pattern.at(x, y));
      for (int k = 0; k < 3; ++k)
        c.irradiance.data[i + static_cast<std::size_t>(k)] = static_cast<float>(e * color[k]);
      c.irradiance.data[i + 3] = static_cast<float>(random.real());
      if (share > 0 && random.chance(share))
        for (std::size_t k = 0; k < 4; ++k) c.irradiance.data[i + k] = badFloat(random);
    }
  if (random.chance(0.15)) {  // a firefly
    const std::size_t at = static_cast<std::size_t>(random.whole(0, v.width * v.height - 1)) * 4;
    for (std::size_t k = 0; k < 3; ++k)
      c.irradiance.data[at + k] = wild ? 65504.0f : static_cast<float>(random.magnitude(1, 1000));
  }
}

void addAlbedo(Random& random, bool wild, const View& v, Capture& c) {
  if (random.chance(0.5)) return;
  c.albedo = Image(v.width, v.height, 3);
  const bool constant = random.chance(0.5);
  const double share = wild && random.chance(0.5) ? random.magnitude(1e-4, 1) : 0;
  const float color[3] = {static_cast<float>(random.real()), static_cast<float>(random.real()),
                          static_cast<float>(random.real())};
  for (std::size_t i = 0; i < c.albedo.data.size(); ++i) {
    c.albedo.data[i] = constant ? color[i % 3] : static_cast<float>(random.real());
    if (share > 0 && random.chance(share)) c.albedo.data[i] = badFloat(random);
  }
}

}  // namespace

float badFloat(Random& random) {
  return random.of({kNaN,   -kNaN, kFloatInfinity, -kFloatInfinity, 0.0f,
                    -0.0f,  1.0f,  -1.0f,     1e-40f,     -1e-40f,
                    1e-20f, 6e-8f, 65504.0f,  65520.0f,   1e9f,
                    1e10f,  1e30f, 3.4e38f,   -3.4e38f,   static_cast<float>(random.real(0, 2))});
}

void addRandomImages(Random& random, bool wild, View& view, int materials, Capture& capture) {
  const std::vector<double>& front = view.planar = randomFront(random, view);
  addDepths(random, wild, view, front, capture);
  addMaterial(random, wild, view, materials, front, capture);
  addIrradiance(random, wild, view, capture);
  addAlbedo(random, wild, view, capture);
}

}  // namespace pellucid::harness::stress
