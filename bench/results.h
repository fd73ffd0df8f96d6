// The JSON of a run: files, and comparison with an earlier run.
#pragma once

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

namespace pellucid::bench {

// Throws InputError for a file that is no results.
nlohmann::json readResults(const std::filesystem::path& path);

// To a file, or to standard output for "-". Throws InputError where it cannot be written.
void writeResults(nlohmann::json results, const std::string& file);

// Prints to `out` every row of both runs whose time or error grew, and how many rows there were; rows that
// one of them lacks are counted. A time grew when its 10th percentile lies above the 90th of before and its
// median by more than kSameTime; an error by more than kSameError, as the same frames have the same errors.
// Runs without times are compared by errors. Returns how many grew. Throws InputError for files that are no
// results, and of times of two devices.
inline constexpr double kSameTime = 0.03;   // what a device repeats times within
inline constexpr double kSameError = 0.02;  // what drivers' rounding of halves may make of it
int printWhatGrew(const nlohmann::json& before, const nlohmann::json& now, std::FILE* out);

}  // namespace pellucid::bench
