// Numbers in text.
#pragma once

#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace pellucid::harness {

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
