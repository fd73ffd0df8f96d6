// Faults of a result that the eye sees: FLIP, isolated pixels, spots, and places that are brighter, darker or
// of another color than in the truth.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "capture/capture.h"
#include "metrics/masked_image.h"
#include "metrics/spots.h"
#include "metrics/surface.h"

namespace pellucid::harness {

// LDR-FLIP: the difference that a person sees when one image is exchanged for the other.
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.

// A display of 3840 pixels and 0.7 m width seen from 0.7 m, as in the paper.
inline constexpr double kPixelsPerDegree = 67;

// FLIP of each pixel, one channel, 0 (no difference) .. 1. The images are linear RGB; what is compared is
// `exposure` times them, clamped to 0 .. 1, as a display of the sRGB primaries shows it. Symmetric. Pixels
// that are not finite are black. pixelsPerDegree: > 0. Throws InputError when the images are not of one size
// with three channels.
Image flipImage(const Image& test, const Image& reference, double exposure,
                double pixelsPerDegree = kPixelsPerDegree);

// Over the mask, 0 .. 1.
struct Flip {
  double mean = 0, p99 = 0;  // p99: 99 % of the pixels are at or below (nearest rank)
};

// Both images have the exposure that brings the reference's 99th percentile inside the mask to 0.8. The pixels outside
// of the mask are black in both images.
Flip measureFlip(const Image& test, const Image& reference, const Mask& mask);

// Isolated pixels: single pixels that stick out of their surface, as dots.

struct IsolatedPixels {
  std::size_t count = 0;
  Mask marks;  // one value a pixel; 1: bright in some channel, 2: dark, 3: both
};

// A pixel is isolated when one of its channels is above 1.3 times the largest, or below 1/1.3 of the least, of the
// neighbors that show its surface, of which there must be at least 5 of 8 (as along a silhouette). The brighter of the
// two values must be above kDarkestPart of that channel's RMS over the mask. Pixels that do not count are neither judged
// nor neighbors. Throws InputError when the image has not three channels and the surfaces' size.
IsolatedPixels findIsolated(const Image& image, const Surfaces& surfaces, const Mask& mask);

inline constexpr int kTintBlock = 8;  // pixels a side
inline constexpr double kTintDarkestPart = 0.1;

struct Tint {
  // Standard deviations over blocks: 0 for a result that is the truth times a color; NaN without blocks.
  std::array<double, 3> channel = {};  // of the ratio a / b
  double redOverGreen = 0;             // of the ratio of red to that of green
  std::size_t blocks = 0;              // that were judged
};

// Ratios of means over 8x8 blocks, counted from pixel (0, 0), all of whose pixels count and whose mean of b
// is above kTintDarkestPart of the RMS of b over the mask in every channel: truth is noisy where it is dark.
// With a mask of material these are the lit blocks wholly of surface. Throws InputError when the images are
// not of one size with three channels.
Tint measureTint(const Image& a, const Image& b, const Mask& mask);

inline constexpr int kRatioBlock = 4;           // pixels a side
inline constexpr double kRatioFullColor = 0.1;  // deviation at which a channel reaches black or 255

// 3 bytes a pixel, row 0 first. Each block of 4x4 pixels, counted from (0, 0), shows e = (A - B) /
// max(B, kDarkestPart * RMS(B)) of the means over its pixels that count: 127.5 + 127.5 e / kRatioFullColor in
// each channel, clamped. So gray is right, white 10 % too bright, red 10 % too red, cyan 10 % too little red.
// Pixels that do not count are black. Throws InputError when the images are not of one size with three
// channels.
std::vector<std::uint8_t> ratioMap(const Image& a, const Image& b, const Mask& mask);

struct EyeMetrics {
  std::size_t isolated = 0, isolatedInTruth = 0;  // pixels
  std::size_t spots = 0;                          // that irradiance and truth lack
  Tint tint;
  Flip flip;
};

// `capture`: says which pixels show one surface, and what the irradiance explains; null: all pixels show one. Throws
// InputError unless both images have three channels and the mask's size.
EyeMetrics measureEye(const Image& result, const Image& truth, const Mask& mask, const Capture* capture);

}  // namespace pellucid::harness
