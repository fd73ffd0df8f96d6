// Facts of a frame that do not depend on its lights: the camera, its materials together, and the gather.
#pragma once

#include "camera.h"
#include "inputs.h"
#include "pyramid.h"

namespace pellucid {

// Pixels of passes: the image's, counted from up to 127 before its first one, so that cells and texels lie alike around
// options.anchor in all frames.
struct Lattice {
  glm::ivec2 first{0};            // the image's first pixel
  glm::uvec2 extent;              // that images of cells and texels cover
  glm::ivec2 period{0};           // pixels from the first one of the patterns of samples to the lattice's
};

struct Setup : Inputs {
  explicit Setup(const Inputs& inputs);  // whose fields were checked

  // ---- Camera and colors
  Lattice lattice;
  Rect rect;             // of the lattice: the part of the images that is rendered
  bool wide;             // colors of 32 bits a channel
  VkFormat colorFormat;  // of transients and histories that hold colors
  glm::dmat4 clipFromView, viewFromWorld;
  DepthRange depthRange{};
  shared::Camera camera;
  Pyramid pyramid;

  // ---- All materials together
  bool diffuses = false;                   // a material does
  bool thinWalls = false, solids = false;  // a material is thin-walled; one is not
  double pixelsPerMm;          // of an orthographic camera; 0: perspective, where distances are not known
  double widestDeviation = 0;  // pixels; standard deviation of a Gaussian

  // ---- The gather
  const char* whyNotGathered;  // NULL: lights with a map can be. Static string
  uint32_t gatherSamples;      // of each probe, 0 where no light can be gathered
  uint32_t gatherSpacing;      // pixels a side of what one probe stands for
  bool gathers;                // lights with a map are gathered from
  bool shapes;                 // curved surfaces return more or less light than planes, as probes find
  // Of an entry point across the light, scene units: half of the frame's shortest diffusion length. A half
  // costs heads 3 % of the gather's error, twice as much 60 % (docs/lab.md).
  float longestEntrySide;

  bool isGathered(const PellucidLight& light) const {
    return light.shadowMapCount > 0 && gathers && !holdsBackFaces(light);
  }
};

// Standard deviation of a material's widest Gaussian, mm; 0 if it has none.
double deviationOf(const PellucidMaterial& material);

}  // namespace pellucid
