// The camera read from the projection matrix alone, over every convention.
#include "camera.h"

#include <gtest/gtest.h>

#include <ostream>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <string>

namespace {

using pellucid::DepthRange;

struct Convention {
  std::string name;
  glm::dmat4 clipFromView;
  double forward;
  double nearest, farthest;  // planar distances the matrix was made for; farthest may be infinite
  bool reversed;
};

// GoogleTest would print the bytes.
void PrintTo(const Convention& value, std::ostream* out) { *out << value.name; }

// Built from the definitions, not from a library: x right, y up in view, y down in clip.
Convention perspective(bool rightHanded, bool reversed, bool infinite, glm::dvec2 offset = {}) {
  const double n = 0.1, f = infinite ? INFINITY : 100.0, s = rightHanded ? -1 : 1;
  // Forward: depth p = f/(f-n) p - fn/(f-n). Reversed swaps near and far.
  double a = infinite ? 1 : f / (f - n), b = infinite ? -n : -f * n / (f - n);
  if (reversed) {
    a = infinite ? 0 : -n / (f - n);
    b = infinite ? n : f * n / (f - n);
  }
  glm::dmat4 m(0);
  m[0][0] = 1.2;
  m[1][1] = -1.7;
  m[2][0] = offset.x * s;
  m[2][1] = offset.y * s;
  m[2][2] = a * s;
  m[2][3] = s;
  m[3][2] = b;
  return {std::string("perspective") + (rightHanded ? " RH" : " LH") + (reversed ? " reversed" : " forward") +
              (infinite ? " infinite" : " finite") + (offset.x != 0 ? " off center" : ""),
          m,
          s,
          n,
          f,
          reversed};
}

Convention orthographic(bool rightHanded, bool reversed, double n) {
  const double f = 50, s = rightHanded ? -1 : 1;
  const double a = (reversed ? -1 : 1) / (f - n), b = reversed ? f / (f - n) : -n / (f - n);
  glm::dmat4 m(1);
  m[0][0] = 0.25;
  m[1][1] = -0.5;
  m[2][2] = a * s;
  m[3][0] = 0.03;
  m[3][2] = b;
  return {std::string("orthographic") + (rightHanded ? " RH" : " LH") +
              (reversed ? " reversed" : " forward") + " near " + std::to_string(n),
          m,
          s,
          n,
          f,
          reversed};
}

std::vector<Convention> conventions() {
  std::vector<Convention> all;
  for (bool rightHanded : {true, false})
    for (bool reversed : {true, false}) {
      for (bool infinite : {true, false})
        for (glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(0.07, -0.11)})
          all.push_back(perspective(rightHanded, reversed, infinite, offset));
      for (double n : {0.5, -3.0}) all.push_back(orthographic(rightHanded, reversed, n));
    }
  return all;
}

class Camera : public testing::TestWithParam<Convention> {};

TEST_P(Camera, ReadsHandednessAndClearValue) {
  DepthRange range;
  ASSERT_EQ(pellucid::readDepthRange(GetParam().clipFromView, &range), nullptr);
  EXPECT_EQ(range.forward, GetParam().forward);
  EXPECT_EQ(range.nothing, GetParam().reversed ? 0 : 1);
}

// Project a view-space point, then go back through the shader's own arithmetic in double.
TEST_P(Camera, InvertsTheProjection) {
  const Convention& c = GetParam();
  DepthRange range;
  ASSERT_EQ(pellucid::readDepthRange(c.clipFromView, &range), nullptr);
  const glm::uvec2 extent(640, 360);
  const pellucid::shared::Camera camera = pellucid::makeCamera(c.clipFromView, range, extent, 0.01);
  for (double p : {0.75, 3.0, 40.0}) {
    const glm::dvec4 view(0.11 * p, -0.07 * p, c.forward * p, 1);
    const glm::dvec4 clip = c.clipFromView * view;
    const double depth = clip.z / clip.w;
    const glm::dvec2 pixel = (glm::dvec2(clip) / clip.w * 0.5 + 0.5) * glm::dvec2(extent) - 0.5;
    const double back = (range.b - depth * range.d) / (range.c * depth - range.a);
    EXPECT_NEAR(back, p, 1e-9 * p) << "planar distance";
    const glm::dvec4 ray =
        glm::dvec4(camera.rayBase) + pixel.x * glm::dvec4(camera.rayX) + pixel.y * glm::dvec4(camera.rayY);
    // Float constants: 2^-24 of the image's half width at that distance.
    const double tolerance = 3e-7 * (1 + p);
    EXPECT_NEAR(ray.z + ray.x * p, view.x, tolerance);
    EXPECT_NEAR(ray.w + ray.y * p, view.y, tolerance);
  }
  EXPECT_FLOAT_EQ(camera.range.w, 10.0f) << "mm per unit";
}

// The difference formula of thickness.glsl against the difference of distances.
TEST_P(Camera, SubtractsInDepthSpace) {
  const Convention& c = GetParam();
  DepthRange r;
  ASSERT_EQ(pellucid::readDepthRange(c.clipFromView, &r), nullptr);
  const auto depthOf = [&](double p) { return (r.a * p + r.b) / (r.c * p + r.d); };
  const double front = 5, thickness = 1e-3;
  const double d1 = depthOf(front + thickness), d0 = depthOf(front);
  const double slope = r.a * r.d - r.b * r.c;
  EXPECT_NEAR((d1 - d0) * slope / ((r.c * d1 - r.a) * (r.c * d0 - r.a)), thickness, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Conventions, Camera, testing::ValuesIn(conventions()), [](const auto& test) {
  std::string name;
  for (char c : test.param.name) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name + std::to_string(test.index);
});

TEST(CameraErrors, NamesWhatIsWrong) {
  DepthRange range;
  glm::dmat4 m = perspective(true, false, false).clipFromView;
  m[0][0] = NAN;
  EXPECT_STREQ(pellucid::readDepthRange(m, &range), "has an element that is not finite");
  EXPECT_STREQ(pellucid::readDepthRange(glm::dmat4(0), &range), "maps the image to a line");
  m = perspective(true, false, false).clipFromView;
  m[2][2] = m[3][2] = 0;
  EXPECT_STREQ(pellucid::readDepthRange(m, &range), "gives every distance the same depth");
  m = perspective(true, false, false).clipFromView;
  m[0][2] = 0.1;
  EXPECT_NE(std::string(pellucid::readDepthRange(m, &range)).find("oblique"), std::string::npos);
}

}  // namespace
