// Text in lower case.
#pragma once

#include <algorithm>
#include <cctype>
#include <string>

namespace pellucid::harness {

// ASCII letters in lower case.
inline std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace pellucid::harness
