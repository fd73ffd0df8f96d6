// Numbers, lists and assignments in command-line options.
#pragma once

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
