// --tonemap of the commands that write pictures.
#pragma once

#include <cstddef>

#include "cli/command.h"
#include "common/tone_map.h"

namespace pellucid::harness {

// `map`: a ToneMap, or an optional one, which stays empty without the option.
template <class Map>
void addToneMapOption(const Command& command, Map& map) {
  command.word(
      "--tonemap", toneMapNames(), [&map](std::size_t index) { map = static_cast<ToneMap>(index); },
      "of PNGs: none (default), agx (Sobotka) or aces (Narkowicz's fit); exposure comes before");
}

}  // namespace pellucid::harness
