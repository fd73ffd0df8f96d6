// How far a frame's diffusion reaches in pixels, and what error its samples have.
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

// Samples of each probe that frame.targetError chooses among.
constexpr uint32_t kTargetSamples[] = {0, 8, 16};

// The least of them whose measured error is below frame.targetError. False, and the most, if there is none.
// Reads what the facts have of the materials and of the gather's obstacles.
bool samplesOfTarget(const FrameFacts& facts, uint32_t* samples);

}  // namespace pellucid
