// The passes that run for a frame.
#pragma once

#include <algorithm>
#include <cstdint>

#include "pyramid.h"

namespace pellucid {

struct FrameFacts;

struct Stages {
  bool nothing = false;  // the output is the irradiance image, and nothing is added to it
  bool lights = false;   // the fused dispatches carry lights
  bool diffusion = false;
  uint32_t fused = 0;         // fused dispatches
  uint32_t walls = 0;         // beside a gather: dispatches of thin walls' light, before what is diffused
  uint32_t gathered = 0;      // groups of lights that are gathered from
  bool keepsHistory = false;  // the frame keeps its transmitted light in frame.history:
  bool keepsProbes = false;   // the gather's filtered probes: the fused dispatches read them, or
  bool history = false;       // that of pixels: the fused dispatches write it, and one more adds it
  bool copies = false;        // the diffusion is all there is: it copies the irradiance before it writes the
                              // output, which may be the same image and whose pixels read their neighbors
  bool overlaps = false;  // the gather runs beside the diffusion, which it does not wait for, with images of
                          // its own
  bool addsProbes =
      false;  // the diffusion's last dispatch adds what was gathered: no other light comes through
  bool skipsLight = false;  // the GPU says whether anything was gathered
  bool tiles = false;       // groups run where the GPU finds material

  Stages() = default;
  explicit Stages(const FrameFacts& facts);

  // Dispatches that write a color transient or the output.
  uint32_t writers() const { return walls + (history ? 1 : fused) + (diffusion ? 1 : 0) + (copies ? 1 : 0); }
  uint32_t colorTransients() const { return nothing ? 0 : std::min(writers() - 1, 2u); }
  // Images of packed texels: the pyramid's; the gather's probes; entry points, if they do not lie where level
  // 1 was.
  uint32_t pyramidImages() const { return diffusion ? kPyramidImages : 0; }
  bool entriesApart() const { return gathered > 0 && (overlaps || !diffusion); }
  uint32_t texelTransients() const {
    return pyramidImages() + (gathered > 0 ? 1 : 0) + (entriesApart() ? 1 : 0);
  }
  uint32_t transients() const { return colorTransients() + texelTransients() + (tiles ? 1 : 0); }
  uint32_t tilesTransient() const { return transients() - 1; }  // with tiles
};

}  // namespace pellucid
