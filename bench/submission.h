// A run's frame table in one small file, for a contributor to attach to an issue.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>

namespace pellucid::bench {

// Device, driver, Vulkan version, commit, repeats, and of each frame and size the median time of every whole
// frame in microseconds. Throws InputError where the results lack frames with times, or the device.
nlohmann::ordered_json submission(const nlohmann::json& results);

// Throws InputError likewise, and for a file that cannot be written.
void writeSubmission(const nlohmann::json& results, const std::filesystem::path& file);

}  // namespace pellucid::bench
