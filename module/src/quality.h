// How far a frame's diffusion reaches in pixels, and which variant of it that asks for.
#pragma once

#include "frame.h"
#include "pyramid_energy.h"

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

// Whether a frame at this quality sums edges by their distances in space, in a dispatch of its own.
inline bool sumsEdges(const PellucidFrame& frame, uint32_t quality) {
  return quality == 3 && given(frame.normal);
}

// Whether it sums them over the pyramid, with less to do for each pixel, beside the resolve: not where what a
// gather found, which is not known by then, is added to them.
inline bool sumsEdgesFast(const PellucidFrame& frame, uint32_t quality) {
  return quality == 2 && given(frame.normal) && frame.gatherSamples == 0;
}

inline FineFilters fineFilters(const PellucidFrame& frame, uint32_t quality) {
  if (sumsEdges(frame, quality)) return FineFilters::TwoOfPlanes;
  return quality > 0 ? FineFilters::One : FineFilters::None;
}

// The least quality whose measured error at radii up to `radius` pixels (0: all) is below `error`. False, and
// the best quality, if there is none. The best one is what it is by the frame's normals.
bool qualityFor(float error, double radius, bool normals, uint32_t* quality);

}  // namespace pellucid
