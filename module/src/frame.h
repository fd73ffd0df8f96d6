// Facts of a frame, each found once: a stage is made from the stages before it, and planning, image needs and
// constants read all of them.
#pragma once

#include <algorithm>
#include <optional>

#include "constants.h"
#include "lights.h"

namespace pellucid {

// Blocks of 64 x 64 pixels, in which the passes of the diffusion and of the gather run where the GPU finds
// material (compute/frame/blocks.glsl).
struct Blocks {
  uint32_t columns, rows;  // that the rect and PELLUCID_BLOCK_BORDER pixels around touch
  uint32_t touched;        // that the rect touches: no other block holds material
  uint32_t maps;           // shadow maps whose entry points are listed
  uint32_t entryGroups;    // at most, in the list of groups of entry points

  Blocks(const Lights& lights, const Rect& rect);

  uint32_t count() const { return columns * rows; }
  // Index of the lists' first word in the image of blocks, and the number of words of that image.
  uint32_t listWord() const { return PELLUCID_BLOCK_WORDS * count(); }
  uint32_t words() const { return listWord() + 2 * count() + entryGroups; }
  static constexpr uint32_t kColumns = 1u << PELLUCID_BLOCK_WORDS_SHIFT;
  // Words behind BlockLists.
  uint32_t listWords() const;
};

// Words of the lists' buffer: counters of as many blocks, and bits of the groups of as many maps' entry points.
constexpr VkDeviceSize listWords(VkDeviceSize blocks, VkDeviceSize maps) {
  return (blocks + 1) / 2 + maps * PELLUCID_ENTRY_GROUP_WORDS;
}

// The passes that run.
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
  bool accumulates = false;   // probes are averaged with those of earlier frames: the history holds two frames of them
  bool copies = false;  // the diffusion alone reads the irradiance and writes the output, which may be one
                        // image and whose pixels read their neighbors: it copies the irradiance first
  bool lists = false;   // groups of the diffusion run where the GPU finds material
  const char* whyNoLists = nullptr;  // or why over all blocks. Static string

  Stages(const Setup& setup, const Lights& all, const Blocks& blocks);

  // Dispatches that write colors; the last one writes the output.
  uint32_t writers() const { return walls + (history ? 1 : fused) + (diffusion ? 1 : 0) + (copies ? 1 : 0); }
};

struct FrameFacts : Setup {
  // `out` gets warnings.
  FrameFacts(const Setup& setup, Findings& out);

  Lights lights;
  Blocks blocks;
  Stages stages;
  uint32_t coarsestLevel;  // of the pyramid that the diffusion needs
  ConstantsLayout constants;

  // `active`: index among the lights that contribute.
  const PellucidLight& light(uint32_t active) const { return lights.light(*this, active); }
};

// The facts where nothing is wrong that a plan relies on: image views are not among it. Else errors.
std::optional<FrameFacts> readFrame(const PellucidFrame* frame, Findings& out);

// Validation, in the order in which a frame is read: each check relies on those before it.
void checkFields(const Inputs& inputs, Findings& out);
void checkMaterials(const Inputs& inputs, Findings& out);
void checkShadowMaps(const Inputs& inputs, Findings& out);
void checkLights(const Setup& setup, Findings& out);
void checkGroups(const FrameFacts& facts, Findings& out);

}  // namespace pellucid
