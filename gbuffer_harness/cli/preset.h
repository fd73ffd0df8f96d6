// --preset of the commands that read captures.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>

#include "capture/manifest.h"

namespace pellucid::harness {

inline void addPresetOption(CLI::App& command, ManifestPreset& preset) {
  const std::map<std::string, ManifestPreset> presets = {{"blender", ManifestPreset::Blender}};
  command
      .add_option(
          "--preset", preset,
          "blender: the capture is a multilayer EXR of Cycles with a JSON beside it (docs/captures.md)")
      ->transform(CLI::CheckedTransformer(presets));
}

}  // namespace pellucid::harness
