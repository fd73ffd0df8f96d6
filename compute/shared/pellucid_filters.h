// The diffusion pyramid's filters, read by GLSL and C++. `./run fit` fits module/src/material/pyramid_energy_table.h to them after a
// change; docs/how-it-works.md, "Fitted tables". Weights are along one axis.
#ifndef PELLUCID_FILTERS_H
#define PELLUCID_FILTERS_H

// Downsampling: outer, inner, inner, outer, which are 3 5 5 3 over 16. Measured: scenes of `./run sweep`, radius of 128 pixels.
#define PELLUCID_DOWNSAMPLE_OUTER (3.0 / 16.0)
#define PELLUCID_DOWNSAMPLE_INNER (0.5 - PELLUCID_DOWNSAMPLE_OUTER)
// Variance of these taps, at 1/2 and 3/2 texels of the finer level to both sides, in squared texels of that level.
#define PELLUCID_DOWNSAMPLE_VARIANCE (4.5 * PELLUCID_DOWNSAMPLE_OUTER + 0.5 * PELLUCID_DOWNSAMPLE_INNER)

// Upsampling: the weight of the nearer coarser texel; the other one beside it has the rest. Linear interpolation has these weights.
#define PELLUCID_REFINEMENT_NEAR (3.0 / 4.0)
#define PELLUCID_REFINEMENT_FAR (1.0 - PELLUCID_REFINEMENT_NEAR)

// The fine filter: the pixel, its neighbors on both sides and theirs, 9 4 1 over 19. They are squares of the distance to the first
// pixel beyond the filter, so that weights end smoothly.
#define PELLUCID_FINE_NEXT (4.0 / 19.0)
#define PELLUCID_FINE_LAST (1.0 / 19.0)
#define PELLUCID_FINE_OWN (1.0 - 2.0 * (PELLUCID_FINE_NEXT + PELLUCID_FINE_LAST))

// Octaves by which the shares of pixels follow the longer side of a foreshortened kernel, of each octave that it is longer.
// Level 2 and coarser ones, of a kernel along a diagonal. Measured: tilted planes of `./run sweep`.
#define PELLUCID_FORESHORTENED_COARSER 0.3
// How much less of it along rows or columns. Measured: tilted planes of `./run sweep`.
#define PELLUCID_FORESHORTENED_STRAIGHT 0.15
// The fine filter is as wide on all sides: it follows the geometric mean of both sides.
#define PELLUCID_FORESHORTENED_FINE 0.5

// Variance of a refinement, squared texels of the finer level: the coarser centers are 1/2 and 3/2 of its texels away.
#define PELLUCID_REFINEMENT_VARIANCE (0.25 * PELLUCID_REFINEMENT_NEAR + 2.25 * PELLUCID_REFINEMENT_FAR)

// Variance of level l's kernel along an axis, squared pixels: SCALE 4^l + REST. Terms: 1/4 for the base level's 2 x 2 pixels, the
// downsampling's times 4^j from each level j < l, the refinement's times 4^j to each level j from 2 to l - 1, and 4 for the
// last interpolation, whose quadratic B-spline has 1/4 of squared texels of level 2.
#define PELLUCID_LEVEL_VARIANCE_SCALE ((PELLUCID_DOWNSAMPLE_VARIANCE + PELLUCID_REFINEMENT_VARIANCE) / 3.0)
#define PELLUCID_LEVEL_VARIANCE_REST (4.25 - (4.0 * PELLUCID_DOWNSAMPLE_VARIANCE + 16.0 * PELLUCID_REFINEMENT_VARIANCE) / 3.0)

// Factors x and y of tangentPlaneWeight (compute/diffusion/texel.glsl). `./run sweep CONSTANT VALUE...` measures others.

// Falloff of downsampling. Measured: scenes of `./run sweep`.
#ifndef PELLUCID_DOWNSAMPLE_FALLOFF
#define PELLUCID_DOWNSAMPLE_FALLOFF 0.2, 0.5
#endif
// Falloff of levels that foreshortening widens. Measured: scenes of `./run sweep`.
#ifndef PELLUCID_STRETCH_FALLOFF
#define PELLUCID_STRETCH_FALLOFF 0.5, 2.5
#endif
// Falloff of upsampling. Measured: scenes of `./run sweep`.
#ifndef PELLUCID_UPSAMPLE_FALLOFF
#define PELLUCID_UPSAMPLE_FALLOFF 0.55, 3.5
#endif
// Falloff of the last pass. Measured: scenes of `./run sweep`.
#ifndef PELLUCID_PIXEL_FALLOFF
#define PELLUCID_PIXEL_FALLOFF 0.45, 1.2
#endif

#endif
