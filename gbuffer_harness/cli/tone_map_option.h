// --tonemap of the commands that write pictures.
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <string>
#include <utility>

#include "common/tone_map.h"

namespace pellucid::harness {

// `map`: a ToneMap, or an optional one, which stays empty without the option.
template <class Map>
void addToneMapOption(CLI::App& command, Map& map) {
  std::map<std::string, int> names;
  for (const std::string& name : toneMapNames()) {
    const int index = static_cast<int>(names.size());
    names[name] = index;
  }
  command
      .add_option_function<int>(
          "--tonemap", [&map](int index) { map = static_cast<ToneMap>(index); },
          "of PNGs: none (default), agx (Sobotka) or aces (Narkowicz's fit); exposure comes before")
      ->transform(CLI::CheckedTransformer(names));
}

}  // namespace pellucid::harness
