#pragma once

#include <cstddef>
#include <cstdint>

namespace pellucid {

struct Shader {
  const uint32_t* words;
  std::size_t wordCount;
};

// `pipeline` < PELLUCID_PIPELINE_COUNT.
Shader shaderOf(uint32_t pipeline);

}  // namespace pellucid
