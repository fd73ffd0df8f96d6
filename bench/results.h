// The JSON file of a run.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace pellucid::bench {

// To a file, or to standard output for "-". Throws InputError where it cannot be written.
void writeResults(nlohmann::json results, const std::string& file);

}  // namespace pellucid::bench
