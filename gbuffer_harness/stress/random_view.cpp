#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <limits>
#include <numbers>

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
  v.mm = std::clamp(v.mm, 1e-5, 1e11);
  if (wild && random.chance(0.1)) v.mm = random.magnitude(1e-5, 1e11);
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
  const glm::dmat4 inverse = glm::inverse(world);
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) capture.viewFromWorld[static_cast<std::size_t>(4 * c + r)] = inverse[c][r];
  for (int r = 0; r < 3; ++r) capture.viewFromWorld[static_cast<std::size_t>(4 * r + 3)] = 0;
  capture.viewFromWorld[15] = 1;
  return v;
}

}  // namespace pellucid::harness::stress
