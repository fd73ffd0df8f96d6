// How far a frame's diffusion reaches in pixels, and what its quality means.
#pragma once

#include "frame.h"

namespace pellucid {

// Of all materials that diffuse, at frame.nearestDistance; all 0 where that does not say how large a pixel
// is.
struct DiffusionReach {
  double pixelsPerMm;
  double radius;     // pixels; the largest PellucidMaterial::radius
  double deviation;  // pixels; standard deviation of the widest Gaussian
};

DiffusionReach diffusionReach(const PellucidFrame& frame);

// Standard deviation of a material's widest Gaussian, mm; 0 if it has none.
double widestDeviation(const PellucidMaterial& material);

// That of what a level of the pyramid stands for, pixels.
double levelDeviation(uint32_t level);

// The widest Gaussian that has nothing in coarser levels than this one, from 3 on; pixels.
double deviationWithin(uint32_t level);

// The best frame.quality.
constexpr uint32_t kBestQuality = 2;

// True where a pixel's neighbors are filtered one by one, in place of giving their part to it and to level 2.
inline bool hasFineFilter(uint32_t quality) { return quality > 0; }

// The least quality whose measured error at radii up to `radius` pixels (0: all) is below `error`. False, and
// the best quality, if there is none.
bool qualityFor(float error, double radius, uint32_t* quality);

}  // namespace pellucid
