// The difference that a person sees when one image is exchanged for the other: LDR-FLIP.
// Andersson, Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: "FLIP: A Difference Evaluator for
// Alternating Images", Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2), 2020.
#pragma once

#include "metrics/masked_image.h"

namespace pellucid::harness {

// A display of 3840 pixels and 0.7 m width seen from 0.7 m, as in the paper.
inline constexpr double kPixelsPerDegree = 67;

// FLIP of each pixel, one channel, 0 (no difference) .. 1. The images are linear RGB; what is compared is
// `exposure` times them, clamped to 0 .. 1, as a display of the sRGB primaries shows it. Symmetric. Pixels
// that are not finite are black. pixelsPerDegree: > 0. Throws InputError when the images are not of one size
// with three channels.
Image flipImage(const Image& test, const Image& reference, double exposure,
                double pixelsPerDegree = kPixelsPerDegree);

struct Flip {
  double mean = 0, p99 = 0;  // 0 .. 1, over the mask; p99: 99 % of the pixels are at or below (nearest rank)
  double exposure = 1;       // that both images were multiplied by
};

// The pixels outside of the mask are black in both images. exposure: > 0, or 0: autoExposure() of the
// reference inside the mask, which brings its 99th percentile to 0.8.
Flip measureFlip(const Image& test, const Image& reference, const Mask& mask, double exposure = 0);

}  // namespace pellucid::harness
