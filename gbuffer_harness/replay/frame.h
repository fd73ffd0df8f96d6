// Capture -> PellucidFrame: what an engine does with its own scene description.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "capture/capture.h"
#include "replay/settings.h"

namespace pellucid::harness {

// `materials` with T(d) exchanged as `choice` says.
std::vector<PellucidMaterial> withTransmittance(std::vector<PellucidMaterial> materials,
                                                TransmittanceChoice choice);

inline float preExposureOf(const ReplaySettings& settings) {
  return settings.preExposure > 0 ? settings.preExposure : 1;
}

// A frame and the arrays it points to. shadowImages are as shadowImages() of the capture's lights has them.
struct FrameData {
  PellucidFrame frame;
  PellucidThesisOptions thesis;
  std::vector<PellucidMaterial> materials;
  std::vector<PellucidLight> lights;
  std::vector<PellucidShadowMap> shadowMaps;
  std::vector<PellucidImage> shadowImages;
  std::vector<float> ambient;
  std::vector<PellucidLightTable> lightTables;

  FrameData() = default;
  FrameData(const FrameData&) = delete;  // frame points to the others
  FrameData& operator=(const FrameData&) = delete;
};

// Facts that a frame knows of its images besides their content.
struct FrameShape {
  struct Map {
    // Indices into the frame's shadow images of depth, exit depth and caster material; -1: none.
    std::array<int, 3> images = {-1, -1, -1};
    std::array<int, 2> extent = {0, 0};  // texels, of the map's tile
  };

  bool backDepth = false, hiddenIrradiance = false, albedo = false;
  std::vector<Map> maps;  // of all lights, in their order
  std::size_t shadowImages = 0;
};

FrameShape shapeOf(const Capture& capture);

// The most images that pellucidGetImageNeeds lists: transients and a history.
inline constexpr uint32_t kMaxImageNeeds = PELLUCID_MAX_TRANSIENTS + 1;

// The frame that a replay of the capture records, complete but for its views: each image has a placeholder,
// so that the frame can be planned and validated without a device. `capture` must outlive `data`.
void makeFrame(const Capture& capture, const std::vector<PellucidMaterial>& materials,
               const ReplaySettings& settings, FrameData& data);

// Makes that frame of a capture whose images are elsewhere, and as `shape` says.
void makeFrame(const Capture& capture, const FrameShape& shape,
               const std::vector<PellucidMaterial>& materials, const ReplaySettings& settings,
               FrameData& data);

// Without shadow maps and tables.
PellucidLight pellucidLight(const Light& light);

// A PellucidMessageFn that collects errors. `user`: the std::string that they are added to.
void appendError(void* user, PellucidSeverity severity, const char* field, const char* message);

// Throws InputError with every sentence of pellucidValidateFrame's errors when `result` is not OK.
void requireOk(PellucidResult result, const PellucidFrame& frame, const std::string& name);

}  // namespace pellucid::harness
