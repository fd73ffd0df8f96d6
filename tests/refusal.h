// The sentence that a call is refused with.
#pragma once

#include <exception>
#include <string>

namespace pellucid::test {

template <class Call>
std::string refusalOf(const Call& call) {
  try {
    call();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

}  // namespace pellucid::test
