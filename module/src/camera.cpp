#include "camera.h"

#include <algorithm>
#include <cmath>

namespace pellucid {

glm::dmat4 toMatrix(const float (&columns)[16]) {
  glm::dmat4 m;
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r) m[c][r] = static_cast<double>(columns[c * 4 + r]);
  return m;
}

bool isRigid(const glm::dmat4& m) {
  const glm::dmat3 r(m);
  const glm::dmat3 shouldBeIdentity = glm::transpose(r) * r;
  for (int c = 0; c < 3; ++c)
    for (int i = 0; i < 3; ++i)  // 1e-3 forgives float matrices built in several steps
      if (!(std::abs(shouldBeIdentity[c][i] - (c == i ? 1.0 : 0.0)) <= 1e-3)) return false;
  return m[0][3] == 0 && m[1][3] == 0 && m[2][3] == 0 && m[3][3] == 1;
}

const char* readDepthRange(const glm::dmat4& m, DepthRange* range) {
  for (int c = 0; c < 4; ++c)
    for (int r = 0; r < 4; ++r)
      if (!std::isfinite(m[c][r])) return "has an element that is not finite";
  if (m[0][2] != 0 || m[1][2] != 0 || m[0][3] != 0 || m[1][3] != 0)
    return "has depth or w depend on x or y; pass view z (DEPTH_VIEW_Z) and the matrix without its oblique near plane";
  const double scale = std::abs(m[0][0] * m[1][1] - m[1][0] * m[0][1]);
  if (scale == 0) return "maps the image to a line";
  // Pixels keep a size that floats can square.
  if (!(scale >= 1e-24 && scale <= 1e24)) return "scales the image by less than 1e-12 or more than 1e12";
  const double a = m[2][2], b = m[3][2], c = m[2][3], d = m[3][3];
  const double slope = a * d - b * c;
  if (slope == 0) return "gives every distance the same depth";

  DepthRange r{};
  r.perspective = c != 0;
  if (r.perspective) {
    // w grows in front of the eye.
    r.forward = c > 0 ? 1 : -1;
  } else {
    // Depth 0..1 is what the camera sees; its middle is in front of the eye even when the near plane
    // of an orthographic camera lies behind it.
    const double middle = (0.5 * d - b) / a;
    if (middle == 0)
      return "is orthographic with its depth range centered on the eye: front and back cannot be told apart";
    r.forward = middle > 0 ? 1 : -1;
  }
  r.a = a * r.forward;
  r.b = b;
  r.c = c * r.forward;
  r.d = d;
  // The planar distance of depth 0 and of depth 1; the denominator is 0 at infinity.
  const auto distance = [&](double depth) {
    const double denominator = r.c * depth - r.a;
    return denominator == 0 ? INFINITY : (b - depth * d) / denominator;
  };
  const double at0 = distance(0), at1 = distance(1);
  if (r.perspective && (at0 <= 0 || at1 <= 0)) {
    // A negative distance beyond infinity appears only when far was rounded past it.
    const double visible = at0 > 0 ? at0 : at1;
    if (visible <= 0) return "shows nothing in front of the eye";
    r.nothing = at0 > 0 ? 1 : 0;
  } else {
    r.nothing = at1 > at0 ? 1 : 0;
  }
  *range = r;
  return nullptr;
}

shared::Camera makeCamera(const glm::dmat4& m, const DepthRange& range, glm::uvec2 extent,
                          double metersPerUnit, glm::ivec2 firstPixel) {
  // clip.xy = K (x, y) + q p + t with w = C p + D; solving for (x, y) at planar distance p makes every
  // pixel's view ray an affine function of p, and both its coefficients affine in the pixel.
  const glm::dmat2 k(m[0][0], m[0][1], m[1][0], m[1][1]);
  const glm::dmat2 inverse = glm::inverse(k);
  const glm::dvec2 q = glm::dvec2(m[2][0], m[2][1]) * range.forward;
  const glm::dvec2 t(m[3][0], m[3][1]);
  const glm::dvec2 step(2.0 / extent.x, 2.0 / extent.y);
  const glm::dvec2 first = (0.5 - glm::dvec2(firstPixel)) * step - 1.0;

  const auto pack = [](glm::dvec2 direction, glm::dvec2 origin) { return glm::vec4(direction, origin); };
  shared::Camera camera;
  camera.rayBase = pack(inverse * (first * range.c - q), inverse * (first * range.d - t));
  camera.rayX = pack(inverse * glm::dvec2(step.x * range.c, 0), inverse * glm::dvec2(step.x * range.d, 0));
  camera.rayY = pack(inverse * glm::dvec2(0, step.y * range.c), inverse * glm::dvec2(0, step.y * range.d));
  camera.depth = glm::vec4(glm::dvec4(range.a, range.b, range.c, range.d));
  camera.range = glm::vec4(glm::dvec4(range.forward, range.a * range.d - range.b * range.c, range.nothing,
                                      metersPerUnit * 1000.0));
  return camera;
}

double pixelSide(const glm::dmat4& m, const DepthRange& range, glm::uvec2 extent) {
  if (range.perspective) return 0;
  // clip.xy / w spans 2 over the image; see makeCamera.
  const glm::dmat2 inverse = glm::inverse(glm::dmat2(m[0][0], m[0][1], m[1][0], m[1][1]));
  return std::min(glm::length(inverse[0]) * 2 / extent.x, glm::length(inverse[1]) * 2 / extent.y) *
         std::abs(range.d);
}

}  // namespace pellucid
