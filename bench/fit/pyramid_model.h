// The diffusion pyramid on a plane that faces the camera, in float64: what each of its elements makes of an
// image. All its filters are products of one along rows and one along columns, so a kernel here is along one
// axis.
#pragma once

#include <vector>

namespace pellucid::fit {

// Weights of consecutive pixels or texels, from `first` on.
struct Kernel {
  int first = 0;
  std::vector<double> weights;
};

// Elements of a kernel: the pixel, the fine filter, and level e for e > 1.
constexpr int kPixel = 0, kFineFilter = 1, kFirstLevelElement = 2, kLastElement = 7,
              kElementCount = kLastElement + 1;

// How element e weights pixels around a pixel; 0 is the pixel. `phase`: its place, pixels; the kernel repeats
// every 2^e of them.
Kernel elementKernel(int element, int phase);

// Variance of a kernel around pixel 0, squared pixels.
double varianceOf(const Kernel& kernel);

// How a Gaussian of that deviation, integrated over the pixels as the references do, weights pixels around a
// pixel. Reaches `reach` pixels to both sides; what lies beyond is left out.
Kernel gaussianKernel(double deviation, int reach);

}  // namespace pellucid::fit
