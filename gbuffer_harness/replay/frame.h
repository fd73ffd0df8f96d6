// Capture -> PellucidFrame: what an engine does with its own scene description.
#pragma once

#include <vector>

#include "capture/capture.h"
#include "pellucid/pellucid.h"

namespace pellucid::harness {

struct ReplaySettings {
  uint32_t features = PELLUCID_FEATURE_TRANSLUCENCY | PELLUCID_FEATURE_DIFFUSION;
  PellucidThicknessSource thicknessSource = PELLUCID_THICKNESS_LIGHT;
  PellucidDebugView debugView = PELLUCID_DEBUG_NONE;
  VkFormat outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
  bool aliasOutput = false;  // output is the irradiance image; ignored for debug views
  std::array<uint32_t, 4> renderRect = {0, 0, 0, 0};  // width 0: everything
};

// A frame and the arrays it points to. `shadowDepths[i]` is what shadowImages[i] must hold.
struct FrameData {
  PellucidFrame frame;
  std::vector<PellucidMaterial> materials;
  std::vector<PellucidLight> lights;
  std::vector<PellucidShadowMap> shadowMaps;
  std::vector<PellucidImage> shadowImages;
  std::vector<const Image*> shadowDepths;

  FrameData() = default;
  FrameData(const FrameData&) = delete;  // frame points into the vectors
  FrameData& operator=(const FrameData&) = delete;
};

// Fills all but the views; gives optional inputs that the capture has a placeholder view, so that the
// frame can be planned without a device. `capture` must outlive `data`.
void makeFrame(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const ReplaySettings& settings, FrameData& data);

// Throws InputError with every sentence of pellucidValidateFrame's errors when `result` is not OK.
void requireOk(PellucidResult result, const PellucidFrame& frame, const std::string& name);

}  // namespace pellucid::harness
