// What the makers of the documentation's tables share.
#pragma once

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/error.h"

namespace pellucid::bench {

using Json = nlohmann::json;
using harness::InputError;

template <class... Values>
std::string format(const char* pattern, Values... values) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

// Device, commit and repeats, for a table's heading.
inline std::string runOf(const Json& results) {
  return format("%s, commit `%s`, median of %d runs", results.at("device").get<std::string>().c_str(),
                results.at("commit").get<std::string>().c_str(), results.at("repeat").get<int>());
}

// Tables of the section "frames", and of "context creation". Each throws InputError for a run without its
// rows.
std::string framesTable(const Json& results);     // whole frames at two sizes beside their errors
std::string frameHostTable(const Json& results);  // CPU times, memory, dispatches
std::string truthTable(const Json& results);      // of captures with path-traced truth: error and metrics
std::string engineTable(const Json& results);  // of captures as engines make them, with turned lights beside
std::string contextTable(const Json& results);

// The README's tables, of the first run with times and the first with path-traced truth. Both throw likewise.
std::string headlineTable(const std::vector<Json>& runs);  // times and errors beside others'
std::string samplesTable(const std::vector<Json>& runs);   // time, error and memory by samples

}  // namespace pellucid::bench
