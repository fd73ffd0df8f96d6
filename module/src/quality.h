// How far a frame's diffusion reaches in pixels, and what its quality means.
#pragma once

#include <iterator>

#include "pellucid/pellucid.h"

namespace pellucid {

struct FrameFacts;

// Reach of all materials that diffuse, at frame.nearestDistance; all 0 where that does not say how large a
// pixel is.
struct DiffusionReach {
  double pixelsPerMm;
  double radius;     // pixels; the largest PellucidMaterial::radius
  double deviation;  // pixels; standard deviation of the widest Gaussian
};

// Reads what the facts have of the view and the materials.
DiffusionReach diffusionReach(const FrameFacts& facts);

// Standard deviation of a material's widest Gaussian, mm; 0 if it has none.
double widestDeviation(const PellucidMaterial& material);

// That of what a level of the pyramid stands for, pixels.
double levelDeviation(uint32_t level);

// The widest Gaussian that has nothing in coarser levels than this one, from 3 on; pixels.
double deviationWithin(uint32_t level);

// Settings that frame.quality chooses, from the cheapest on.
struct Quality {
  uint32_t gatherSamples;  // of each probe; 0: one thickness a pixel
  uint32_t finer;          // the spacing of probes is divided by it
  bool fineFilter;  // a pixel's neighbors are filtered one by one, and do not give their part to it and level
                    // 2
};
constexpr Quality kQualities[] = {{0, 1, false}, {8, 1, true}, {16, 2, true}};
constexpr uint32_t kBestQuality = std::size(kQualities) - 1;

// Samples of each probe of the gather at a quality: frame.gatherSamples, if that does not leave them to the
// quality. Reads what the facts have of the materials and of the gather's obstacles.
uint32_t gatherSamplesAt(const FrameFacts& facts, uint32_t quality);

// The least quality whose measured error is below frame.targetError. False, and the best quality, if there is
// none. Reads what the facts have of the materials and of the gather's obstacles.
bool qualityOfTarget(const FrameFacts& facts, uint32_t* quality);

}  // namespace pellucid
