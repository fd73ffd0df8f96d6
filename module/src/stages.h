// The passes that run for a frame.
#pragma once

#include <algorithm>
#include <cstdint>

#include "blocks.h"

namespace pellucid {

struct Stages {
  bool nothing = false;  // the output is the irradiance image, and nothing is added to it
  bool lights = false;   // the fused dispatches carry lights
  bool diffusion = false;
  uint32_t fused = 0;         // fused dispatches
  uint32_t walls = 0;         // beside a gather: dispatches of thin walls' light, before what is diffused
  uint32_t gathered = 0;      // groups of lights that are gathered from
  bool keepsHistory = false;  // the frame keeps its transmitted light in options.history:
  bool keepsProbes = false;   // the gather's filtered probes, which the diffusion reads, or
  bool history = false;       // that of pixels: the fused dispatches write it, and one more adds it
  bool copies = false;  // the diffusion alone reads the irradiance and writes the output, which may be one
                        // image and whose pixels read their neighbors: it copies the irradiance first
  bool lists = false;   // groups run where the GPU finds material

  Stages(const Inputs& inputs, const Materials& materials, const GatherChoice& gather, const Lights& all,
         const Blocks& blocks);

  // Dispatches that write a color transient or the output.
  uint32_t writers() const { return walls + (history ? 1 : fused) + (diffusion ? 1 : 0) + (copies ? 1 : 0); }
  uint32_t colorTransients() const { return nothing ? 0 : std::min(writers() - 1, 2u); }
  // Images of packed texels: the pyramid's; the gather's probes and entry points.
  uint32_t pyramidImages() const { return diffusion ? kPyramidImages : 0; }
  uint32_t texelTransients() const { return pyramidImages() + (gathered > 0 ? 2 : 0); }
  uint32_t transients() const { return colorTransients() + texelTransients() + (diffusion ? 1 : 0); }
  uint32_t blocksTransient() const { return transients() - 1; }  // with diffusion
};

}  // namespace pellucid
