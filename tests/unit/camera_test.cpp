// The camera read from the projection matrix alone, over every convention: the module's and the reference's.
#include "camera.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "reference/camera.h"

namespace {

using pellucid::DepthRange;

struct Convention {
  bool rightHanded, reversed, perspective;
  double nearest, farthest;  // planar distances; farthest may be infinite
  glm::dvec2 offset;

  double forward() const { return rightHanded ? -1 : 1; }

  // Built from the definitions, not from a library: x right, y up in view, y down in clip.
  glm::dmat4 clipFromView() const {
    const double n = nearest, f = farthest, s = forward();
    glm::dmat4 m(0);
    m[0][0] = 1.2;
    m[1][1] = -1.7;
    if (!perspective) {
      m[2][2] = (reversed ? -1 : 1) / (f - n) * s;
      m[3] = glm::dvec4(offset, reversed ? f / (f - n) : -n / (f - n), 1);
      return m;
    }
    // Forward: depth p = f/(f-n) p - fn/(f-n). Reversed swaps near and far.
    const bool infinite = std::isinf(f);
    double a = infinite ? 1 : f / (f - n), b = infinite ? -n : -f * n / (f - n);
    if (reversed) {
      a = infinite ? 0 : -n / (f - n);
      b = infinite ? n : f * n / (f - n);
    }
    m[2] = glm::dvec4(offset * s, a * s, s);
    m[3][2] = b;
    return m;
  }
};

std::vector<Convention> conventions() {
  std::vector<Convention> all;
  for (const bool rightHanded : {true, false})
    for (const bool reversed : {true, false}) {
      for (const double farthest : {100.0, static_cast<double>(INFINITY)})
        for (const glm::dvec2 offset : {glm::dvec2(0), glm::dvec2(0.07, -0.11)})
          all.push_back({rightHanded, reversed, true, 0.1, farthest, offset});
      for (const double nearest : {0.5, -3.0})
        all.push_back({rightHanded, reversed, false, nearest, 50, {0.03, 0}});
    }
  return all;
}

// Project a view-space point, then go back through the shader's own arithmetic in double.
TEST(Camera, InvertsTheProjectionOfEveryConvention) {
  for (const Convention& c : conventions()) {
    SCOPED_TRACE(testing::Message() << (c.perspective ? "perspective" : "orthographic")
                                    << (c.rightHanded ? " RH" : " LH")
                                    << (c.reversed ? " reversed " : " forward ") << c.nearest << " .. "
                                    << c.farthest << ", offset " << c.offset.x);
    const glm::dmat4 clipFromView = c.clipFromView();
    DepthRange range;
    ASSERT_EQ(pellucid::readDepthRange(clipFromView, &range), nullptr);
    EXPECT_EQ(range.forward, c.forward());
    EXPECT_EQ(range.nothing, c.reversed ? 0 : 1);
    const glm::uvec2 extent(640, 360);
    const pellucid::shared::Camera camera = pellucid::makeCamera(clipFromView, range, extent, 0.01);
    pellucid::harness::Matrix columns;
    std::copy_n(&clipFromView[0][0], columns.size(), columns.begin());
    const pellucid::harness::reference::Camera exact(columns, 640, 360);
    const bool isOfReference = c.perspective || c.rightHanded;  // its orthographic cameras look along -z
    for (const double p : {0.75, 3.0, 40.0}) {
      const glm::dvec4 view(0.11 * p, -0.07 * p, c.forward() * p, 1);
      const glm::dvec4 clip = clipFromView * view;
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
      if (!isOfReference) continue;
      EXPECT_NEAR(glm::distance(exact.position(pixel + 0.5, p), glm::dvec3(view)), 0, 1e-12 * (1 + p));
      // A float holds 6e-8 of a device depth, and perspective ones lie close beside the far end.
      EXPECT_NEAR(exact.planarDepth(static_cast<float>(depth), PELLUCID_DEPTH_DEVICE).value_or(0), p, 1e-3 * p);
    }
    // The cleared value, what lies beyond 0..1 and what is not a number hold no surface; the near end does.
    const float cleared = c.reversed ? 0.0f : 1.0f, nan = std::numeric_limits<float>::quiet_NaN();
    for (const float nothing : {cleared, -0.5f, 1.5f, nan})
      EXPECT_FALSE(isOfReference && exact.planarDepth(nothing, PELLUCID_DEPTH_DEVICE)) << nothing;
    if (c.perspective) {
      EXPECT_NEAR(exact.planarDepth(1 - cleared, PELLUCID_DEPTH_DEVICE).value_or(0), c.nearest, 1e-9);
    }
    for (const float nothing : {0.0f, -1.0f, 1e9f, std::numeric_limits<float>::infinity(), nan})
      EXPECT_FALSE(exact.planarDepth(nothing, PELLUCID_DEPTH_VIEW_Z)) << nothing;
    EXPECT_FLOAT_EQ(camera.range.w, 10.0f) << "mm per unit";
  }
}

TEST(Camera, MatricesThatAreNoProjectionAreRefused) {
  DepthRange range;
  const glm::dmat4 good = conventions().front().clipFromView();
  glm::dmat4 notFinite = good, oneDepth = good, oblique = good;
  notFinite[0][0] = NAN;
  oneDepth[2][2] = oneDepth[3][2] = 0;
  oblique[0][2] = 0.1;
  for (const glm::dmat4& m : {notFinite, glm::dmat4(0), oneDepth, oblique})
    EXPECT_NE(pellucid::readDepthRange(m, &range), nullptr);
}

}  // namespace
