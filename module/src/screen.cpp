#include "screen.h"

namespace pellucid {

Screen::Screen(const Inputs& inputs)
    : rect(renderRect(inputs.frame)),
      wide(inputs.frame.options.outputFormat == VK_FORMAT_R32G32B32A32_SFLOAT),
      colorFormat(wide ? VK_FORMAT_R32G32B32A32_SFLOAT : VK_FORMAT_R16G16B16A16_SFLOAT),
      clipFromView(toMatrix(inputs.frame.clipFromView)),
      viewFromWorld(toMatrix(inputs.frame.viewFromWorld)),
      pyramid(inputs.frame.imageExtent, rect) {
  readDepthRange(clipFromView, &depthRange);
  camera = makeCamera(clipFromView, depthRange, {inputs.frame.imageExtent[0], inputs.frame.imageExtent[1]},
                      inputs.frame.metersPerUnit);
}

}  // namespace pellucid
