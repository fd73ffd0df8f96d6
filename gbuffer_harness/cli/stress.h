// A random frame as files that replay it.
#pragma once

#include <filesystem>
#include <string>

#include "stress/random_frame.h"

namespace pellucid::harness {

// Writes the frame's capture and its settings into `folder`, which is made where it is not there. The command
// that replays them. It renders the frame but for what StressFrame::notInCapture names, and alphas.
std::string writeFailure(const std::filesystem::path& folder, const stress::StressFrame& frame);

}  // namespace pellucid::harness
