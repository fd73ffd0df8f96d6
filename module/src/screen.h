// The camera, the part of the image that is rendered, and how colors are kept there.
#pragma once

#include "camera.h"
#include "inputs.h"
#include "pyramid.h"
#include "rect.h"

namespace pellucid {

struct Screen {
  explicit Screen(const Inputs& inputs);  // whose fields were checked

  Rect rect;
  bool wide;             // colors of 32 bits a channel
  VkFormat colorFormat;  // of transients and histories that hold colors
  glm::dmat4 clipFromView, viewFromWorld;
  DepthRange depthRange{};
  shared::Camera camera;
  Pyramid pyramid;
};

}  // namespace pellucid
