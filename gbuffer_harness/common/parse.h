// Words, lists and numbers in text.
#pragma once

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pellucid::harness {

// ASCII letters in lower case.
inline std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

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

// None unless all of `text` is one finite number of the type.
template <class T>
std::optional<T> numberIn(std::string_view text) {
  T value{};
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, value);
  const bool finite = std::abs(static_cast<double>(value)) <= std::numeric_limits<double>::max();
  if (error != std::errc() || stop != end || !finite) return std::nullopt;
  return value;
}

}  // namespace pellucid::harness
