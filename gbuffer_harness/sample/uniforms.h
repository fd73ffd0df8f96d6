// Frame of shaders/frame.glsl.
#pragma once

#include <glm/glm.hpp>

#include "sample/frame.h"

namespace pellucid::sample {

struct UniformLight {
  glm::vec4 position, direction, color;
  glm::uvec4 tiles;
};
struct UniformTile {
  glm::mat4 clipFromWorld;
  glm::vec4 rect, places;
};
struct Uniforms {
  glm::mat4 worldFromClip, previousFromCurrent;
  glm::vec4 eye, rect, extent, jitter, scale;
  glm::uvec4 flags;
  glm::vec4 ambient[9];
  UniformLight lights[kMostLights];
  UniformTile tiles[kMostTiles];
};

}  // namespace pellucid::sample
