// How far a frame's image is from what is right.
#pragma once

#include <array>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "capture/capture.h"
#include "pellucid/pellucid.h"

namespace pellucid::bench {

// Brute-force diffusion in float64 at some pixels.
struct DiffusionTruth {
  std::vector<std::uint32_t> pixels;  // y * width + x, ascending
  std::vector<std::array<double, 3>> values;
};

// At `count` pixels with a material, or all of them if there are fewer: covered pixels, by tiles, are split
// into `count` equal runs, of each of which a fixed seed takes one. On all cores.
DiffusionTruth diffusionTruth(const harness::Capture& capture, const std::vector<PellucidMaterial>& materials,
                              int count);

// One number a channel: root mean square of the difference over that of the truth.
using ChannelErrors = std::array<double, 3>;
ChannelErrors diffusionErrors(const harness::Image& result, const DiffusionTruth& truth);
double rootMeanSquare(const ChannelErrors& errors);

// The fields that a row gets of its image, which albedo has not multiplied, and the capture's path-traced
// truth: "truth_relative_rmse" and "truth_relative_rmse_rgb", over 4x4 averages, and "isolated", "spots",
// "tint", "tint_red_green", "flip" and "flip_p99" of metrics/eye.h. Every measure of whole images belongs
// here. The capture has a truth.
nlohmann::json errorFields(harness::Image result, const harness::Capture& capture);

// The fields that a row gets of its image and of that of `turned`, the frame after its lights turned a
// little: "flicker_rgb" and "flicker_irradiance_rgb", relative RMSE of compareTurned(), and "spots_appear"
// and "spots_vanish". Albedo has multiplied neither image.
nlohmann::json flickerFields(harness::Image result, harness::Image turnedResult,
                             const harness::Capture& capture, const harness::Capture& turned);

}  // namespace pellucid::bench
