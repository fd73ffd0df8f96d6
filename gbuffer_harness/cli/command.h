// What a subcommand of `pellucid` throws besides the harness's errors.
#pragma once

#include <stdexcept>

namespace pellucid::harness {

// A comparison is over a limit the user set (exit code 1). The sentence names the limit and the value.
class LimitExceeded : public std::runtime_error {
public:
  using std::runtime_error::runtime_error;
};

}  // namespace pellucid::harness
