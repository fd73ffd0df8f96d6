// Lists in text.
#pragma once

#include <string>
#include <vector>

namespace pellucid::harness {

// The parts between separators; empty ones count, so that there is at least one.
inline std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts = {""};
  for (const char c : text) {
    if (c == separator)
      parts.emplace_back();
    else
      parts.back() += c;
  }
  return parts;
}

}  // namespace pellucid::harness
