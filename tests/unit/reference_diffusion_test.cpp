// The brute-force diffusion against closed forms (Burley and Gaussian profiles on planes).
#include "reference/diffusion.h"

#include <gtest/gtest.h>

#include "common/error.h"
#include "reference_captures.h"

namespace pellucid::harness::reference {
namespace {

// Quadrature plus what the cut-off and the border of the capture leave out.
constexpr double kTolerance = 1e-4;

TEST(ReferenceDiffusion, ConstantIrradianceComesBackOnAnyGeometry) {
  Capture c = facingPlane(24, 24, 0.2);
  for (int y = 0; y < c.height; ++y)
    for (int x = 0; x < c.width; ++x)
      *c.frontDepth.image.at(x, y) =
          100 + 2 * std::sin(0.9f * static_cast<float>(x)) * std::cos(static_cast<float>(y));
  const DiffusedCapture diffused(c, burleyMaterial(1));
  for (int y = 0; y < c.height; y += 5)
    for (int x = 0; x < c.width; x += 5) EXPECT_NEAR(diffused.at(x, y), 1, 1e-12);
}

// At an angle the pixels of the edge hold a mean of light and dark: the capture itself differs from the
// step by O(pixel), most next to the edge. Farther than 3 pixels 0.1 mm wide that is below 5e-4.
TEST(ReferenceDiffusion, HalfPlaneStep) {
  struct Row {
    double pixel, degrees;
    std::vector<int> offsets;  // of pixels from the edge
    double burley, gaussian;   // tolerances
  };
  const std::vector<int> near = {-10, -7, -4, -2, -1, 0, 1, 3, 6, 9}, far = {-40, -15, -5, 5, 15, 40};
  for (const auto& [pixel, degrees, offsets, burleyLimit, gaussianLimit] :
       {Row{0.25, 0, near, kTolerance, kTolerance}, Row{1, 0, near, kTolerance, kTolerance},
        Row{2, 0, near, kTolerance, kTolerance}, Row{0.1, 30, far, 5e-4, 2e-4}, Row{0.1, 45, far, 5e-4, 2e-4}}) {
    const int middle = static_cast<int>(34 / pixel);
    const glm::dvec2 direction(std::cos(glm::radians(degrees)), std::sin(glm::radians(degrees)));
    Capture c = facingPlane(2 * middle, 2 * middle, pixel);
    paint(c, [&, side = pixel](glm::dvec2 corner) { return halfPlaneCoverage(corner, side, direction); });
    const DiffusedCapture burley(c, burleyMaterial(1)), gaussian(c, gaussianMaterial(1));
    for (const int offset : offsets) {
      const int x = middle + offset;
      const double inside = glm::dot(direction, planePoint(c, x + 0.5, middle + 0.5));
      EXPECT_NEAR(burley.at(x, middle), burleyStep(inside, 1), burleyLimit) << degrees << " degrees, x " << x;
      EXPECT_NEAR(gaussian.at(x, middle), gaussianStep(inside, 1), gaussianLimit) << degrees << " degrees, x " << x;
    }
  }
}

TEST(ReferenceDiffusion, OwnPixelOfAnImpulseIsIntegratedNotSampled) {
  for (const double pixel : {0.1, 0.5, 2.0, 20.0}) {
    const int size = 2 * static_cast<int>(std::max(3.0, 34 / pixel)) + 1;
    Capture c = facingPlane(size, size, pixel);
    c.irradiance = Image(size, size, 3);
    for (int k = 0; k < 3; ++k) c.irradiance.at(size / 2, size / 2)[k] = 1;
    double exact = 0;  // mean over the angle of cumulative(distance to the pixel's edge)
    constexpr int kAngles = 2000;
    for (int i = 0; i < kAngles; ++i)
      exact +=
          burleyCumulative(pixel / 2 / std::cos((i + 0.5) / kAngles * std::numbers::pi / 4), 1) / kAngles;
    EXPECT_NEAR(DiffusedCapture(c, burleyMaterial(1)).at(size / 2, size / 2), exact, kTolerance) << pixel;
  }
}

// An edge along the tilt axis of a tilted plane: distances on the surface are x / cos(tilt).
TEST(ReferenceDiffusion, TiltedPlaneIsMeasuredAlongTheSurface) {
  constexpr double kPixel = 0.25;
  const int width = 204, height = 272;
  const double tilt = std::numbers::pi / 4;
  Capture c = facingPlane(width, height, kPixel);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      *c.frontDepth.image.at(x, y) = static_cast<float>(100 + std::tan(tilt) * planePoint(c, x + 0.5, 0).x);
  paint(c, [&](glm::dvec2 corner) { return halfPlaneCoverage(corner, kPixel, {1, 0}); });
  const DiffusedCapture burley(c, burleyMaterial(1));
  for (int x = width / 2 - 6; x < width / 2 + 6; ++x) {
    const double inside = planePoint(c, x + 0.5, 0).x / std::cos(tilt);
    EXPECT_NEAR(burley.at(x, height / 2), burleyStep(inside, 1), kTolerance) << "x " << x;
  }
}

TEST(ReferenceDiffusion, LittleLeaksAcrossADepthGap) {
  const int size = 136;
  for (const double gap : {0.4, 2.0, 8.0}) {
    Capture c = facingPlane(size, size, 0.5);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        if (x < size / 2) {
          *c.frontDepth.image.at(x, y) += static_cast<float>(gap);
          for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = 0;
        }
    const DiffusedCapture burley(c, burleyMaterial(1));
    const double leakToDark = burley.at(size / 2 - 1, size / 2),
                 leakToLit = 1 - burley.at(size / 2, size / 2);
    EXPECT_GT(leakToDark, 0) << gap;
    EXPECT_LE(leakToDark, 1 - burleyCumulative(gap, 1)) << gap;
    EXPECT_NEAR(leakToDark, leakToLit, 1e-9) << gap;
  }
}

TEST(ReferenceDiffusion, OtherMaterialsAndEmptyPixelsTakeNoPart) {
  Capture c = facingPlane(32, 32, 0.25);
  *c.frontDepth.image.at(20, 3) = kNoDepth;
  for (int k = 0; k < 3; ++k) c.irradiance.at(20, 3)[k] = 7;
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 16; ++x) {
      c.material[static_cast<std::size_t>(32 * y + x)] = 0;
      for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = 1000;
    }
  const DiffusedCapture burley(c, burleyMaterial(1));
  EXPECT_NEAR(burley.at(16, 16), 1, 1e-12);
  EXPECT_EQ(burley.at(15, 16), 1000) << "unchanged";
  EXPECT_EQ(burley.at(20, 3), 7);
  EXPECT_NEAR(burley.at(21, 3), 1, 1e-12);
}

// Perspective: pixels nearer to the eye may reach farther in pixels than the receiver's own depth says.
TEST(ReferenceDiffusion, CutOffLeavesNoMoreThanItStates) {
  Capture c = facingPlane(48, 48, 1);
  c.clipFromView = {2, 0, 0, 0, 0, -2, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0};
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 48; ++x) {
      *c.frontDepth.image.at(x, y) = 20.0f + 0.5f * static_cast<float>(x);
      for (int k = 0; k < 3; ++k) c.irradiance.at(x, y)[k] = x % 2 ? 1.0f : 0.0f;
    }
  const DiffusedCapture all(c, burleyMaterial(0.5), 1e-10), most(c, burleyMaterial(0.5), 1e-3);
  EXPECT_LT(most.diffusion().radius(), all.diffusion().radius());
  for (int x = 0; x < 48; x += 5) EXPECT_NEAR(most.at(x, 24), all.at(x, 24), 2e-3) << x;
}

TEST(ReferenceDiffusion, ChannelsOfZeroWidthKeepTheirIrradiance) {
  Capture c = facingPlane(16, 16, 0.5);
  c.irradiance = Image(16, 16, 3);
  for (int k = 0; k < 3; ++k) c.irradiance.at(8, 8)[k] = 1;
  PellucidMaterial m = burleyMaterial(1);
  m.burleyDistance[2] = 0;
  const DiffusedCapture diffused(c, m);
  const glm::dvec3 value = diffused.diffusion().at(8, 8);
  EXPECT_LT(value.x, 0.5);
  EXPECT_EQ(value.z, 1);
}

TEST(ReferenceDiffusion, RefusesWhatNoProfileCanHave) {
  const Capture c = facingPlane(4, 4, 1);
  PellucidMaterial m = gaussianMaterial(1);
  m.gaussianVariance[1][0] = -1;
  EXPECT_THROW(DiffusedCapture(c, m), InputError);
}

}  // namespace
}  // namespace pellucid::harness::reference
