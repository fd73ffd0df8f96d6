// How far images are from what the checks ask for: pure functions, 0 where nothing is wrong.
#pragma once

#include <cstdint>
#include <vector>

#include "common/image.h"

namespace pellucid::harness::stress {

struct Worst {
  double value = 0;
  int x = -1, y = -1, channel = -1;  // where
};

// Nonzero for the pixels to look at.
using Pixels = std::vector<std::uint8_t>;

// Images are RGBA unless said otherwise.

// Values of RGB that are NaN or infinite: their number.
Worst notFinite(const Image& image, const Pixels& pixels);
// The most negative value of RGB, without its sign.
Worst negative(const Image& image, const Pixels& pixels);
// Pixels outside `pixels` in which a bit differs: their number.
Worst changedOutside(const Image& before, const Image& after, const Pixels& pixels);
// Pixels in which all bits are still those of the 0xFF bytes from before: their number.
Worst unwritten(const Image& after, const Pixels& pixels);
// The largest difference of RGB, relative to the larger value; infinite where bits differ and one is not
// finite.
Worst differentBits(const Image& a, const Image& b, const Pixels& pixels);
// The largest difference of alpha, likewise; infinities and NaN are alike.
Worst differentAlpha(const Image& a, const Image& b, const Pixels& pixels);

// Relative differences of RGB. Values below `kFloor` count as kFloor in the divisor, as halves have fewer
// bits there. Values from kCeiling on in either image are left out: outputs end at 65504.
inline constexpr double kFloor = 1e-3, kCeiling = 65000;

// `value` over what stands for 1.
double relative(double value, double scale);

// |image - expected|.
Worst apart(const Image& image, const Image& expected, const Pixels& pixels);
// |two - 2 one|.
Worst notTwice(const Image& one, const Image& two, const Pixels& pixels);
// How much less `more` is than `less`.
Worst less(const Image& less, const Image& more, const Pixels& pixels);
// |all - without - sum of (part - without)|, relative to the largest of the images. Pixels that are 0 in an
// image are left out, as outputs end there.
Worst notSum(const Image& without, const std::vector<Image>& parts, const Image& all, const Pixels& pixels);

}  // namespace pellucid::harness::stress
