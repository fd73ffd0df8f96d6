// How far a frame's image is from what is right.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
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
// into `count` equal runs, of each of which a fixed seed takes one. On all cores. `cache`: folder that
// results are kept in by a hash of the inputs; empty: none.
DiffusionTruth diffusionTruth(const harness::Capture& capture, const std::vector<PellucidMaterial>& materials,
                              int count, const std::filesystem::path& cache);

// One number a channel: root mean square of the difference over that of the truth.
using ChannelErrors = std::array<double, 3>;
ChannelErrors diffusionErrors(const harness::Image& result, const DiffusionTruth& truth);
double rootMeanSquare(const ChannelErrors& errors);

// The fields that a row gets of its image, which albedo has not multiplied, and the capture's path-traced
// truth: "truth_relative_rmse" and "truth_relative_rmse_rgb", over 4x4 averages, and "isolated", "tint",
// "tint_red_green", "flip" and "flip_p99" of metrics/eye.h. Every measure of whole images belongs here. The
// capture has a truth.
nlohmann::json errorFields(harness::Image result, const harness::Capture& capture);

}  // namespace pellucid::bench
