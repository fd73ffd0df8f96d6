// Numbers, lists and assignments in command-line options.
#pragma once

#include <array>
#include <string>

#include "common/error.h"
#include "common/parse.h"

namespace pellucid::harness {

// Throws UsageError, naming `option`, unless all of `text` is one finite number.
template <class T>
T parseNumber(const std::string& option, const std::string& text) {
  const std::optional<T> value = numberIn<T>(text);
  if (!value) throw UsageError(option + ": \"" + text + "\" is not a number");
  return *value;
}

// N of them with commas between. `syntax` says in an error how they are written.
template <std::size_t N>
std::array<double, N> parseNumbers(const std::string& option, const std::string& text,
                                   const std::string& syntax) {
  const std::vector<std::string> parts = split(text, ',');
  if (parts.size() != N) throw UsageError(option + ": \"" + text + "\" is not " + syntax);
  std::array<double, N> numbers;
  for (std::size_t i = 0; i < N; ++i) numbers[i] = parseNumber<double>(option, parts[i]);
  return numbers;
}

// WIDTHxHEIGHT.
inline std::array<int, 2> parseSize(const std::string& option, const std::string& text) {
  const std::vector<std::string> parts = split(text, 'x');
  if (parts.size() != 2) throw UsageError(option + ": \"" + text + "\" is not WIDTHxHEIGHT");
  return {parseNumber<int>(option, parts[0]), parseNumber<int>(option, parts[1])};
}

struct Assignment {
  std::string key, value;
};
inline Assignment parseAssignment(const std::string& option, const std::string& text) {
  // Names may have an equals sign in them, values do not.
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos) throw UsageError(option + ": \"" + text + "\" is not key=value");
  return {text.substr(0, equals), text.substr(equals + 1)};
}

}  // namespace pellucid::harness
