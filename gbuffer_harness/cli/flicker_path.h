// Frames of a moving camera, of moving lights and of a body that turns, for `pellucid flicker --path`.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "capture/capture.h"
#include "cli/capture_options.h"
#include "common/device.h"
#include "metrics/flicker.h"

namespace pellucid::harness {

inline constexpr const char* kPathSyntax = "pan, dolly, orbit, head, lights or blink";

// Steps of a path: the angle by which the camera, the body or the lights turn from frame to frame, and the part of the distance to
// the model's center by which a dolly moves.
inline constexpr double kPathDegrees = 0.5, kPathDolly = 0.01;
// Frames for which the last light of a blink stays on or off.
inline constexpr int kBlinkFrames = 6;

struct PathStep {
  Flicker result, irradiance;
};

// Runs the frames of a path through `replay` and compares each with the one before. Frames around a switch of the blinking light are
// not compared. Throws UsageError for an unknown path, and for one whose scene lacks lights.
std::vector<PathStep> followPath(const std::string& path, int frames, const CaptureModel& scene,
                                 const std::optional<Environment>& sky, Device& device,
                                 const std::function<Image(const Capture&)>& replay);

}  // namespace pellucid::harness
