// SPIR-V for devices that write no storage image without a format.
#pragma once

#include <cstddef>
#include <cstdint>

namespace pellucid {

// Gives the storage image that has no format one of 16 or 32 bits a channel, in place.
void fixOutputFormat(uint32_t* words, std::size_t wordCount, bool wide);

}  // namespace pellucid
