// Bounds of the errors that docs/accuracy.md shows.
#include "accuracy.h"
#include "gpu_fixture.h"

namespace {

using namespace pellucid::test;

class Accuracy : public GpuTest {};

TEST_F(Accuracy, ThicknessFromDeviceDepthKeepsWhatTheDepthsHold) {
  for (const DepthErrors& e : measureDepths(replayer())) {
    SCOPED_TRACE(e.format + ", " + std::to_string(e.nearPlane) + " .. " + std::to_string(e.farPlane));
    EXPECT_GT(e.pixels, 1000);
    // A subtraction that is exact, or rounds once, two products of denominators that round once each, a
    // quotient, and the length of the ray: some ten roundings of 6e-8.
    EXPECT_LT(e.shader, 1e-6);
    // Linearized depths near 5 m are off by 3e-7 m each; the thinnest surface is 5e-4 m thick.
    EXPECT_GT(e.naive, 5e-5) << "surfaces are too thick to tell the two apart";
    EXPECT_GT(e.naive, 50 * e.shader);
  }
}

TEST_F(Accuracy, SixteenBitColorsRoundAFewTimes) {
  for (const HalfErrors& e : measureHalves(replayer())) {
    SCOPED_TRACE(std::to_string(e.irradiance) + ", " + std::to_string(e.samples) + " samples");
    // A half rounds by 2^-11 = 4.9e-4 down to 6e-5. The output rounds once, its irradiance and levels before
    // once each: averages of many, whose errors do not add up.
    EXPECT_LT(e.worst, 2e-3);
    EXPECT_LT(e.rmse, 5e-4);
    EXPECT_GT(e.worst, 1e-4) << "nothing was stored in 16 bits";
  }
}

}  // namespace
