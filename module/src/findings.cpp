#include "findings.h"

namespace pellucid {

Text& Text::operator<<(std::string_view s) {
  for (char c : s.substr(0, capacity_ - size_ - 1)) {
    buffer_[size_++] = c;
    buffer_[size_] = '\0';
  }
  return *this;
}

}  // namespace pellucid
