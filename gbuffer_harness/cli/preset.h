// --preset of the commands that read captures.
#pragma once

#include "capture/manifest.h"
#include "cli/command.h"

namespace pellucid::harness {

inline void addPresetOption(const Command& command, ManifestPreset& preset) {
  command.choice(
      "--preset", preset, {{"blender", ManifestPreset::Blender}},
      "blender: the capture is a multilayer EXR of Cycles with a JSON beside it (docs/captures.md)");
}

}  // namespace pellucid::harness
