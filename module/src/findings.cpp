#include "findings.h"

namespace pellucid {

Text& Text::operator<<(std::string_view s) {
  for (char c : s) {
    if (size_ + 1 < capacity_) {
      buffer_[size_] = c;
      buffer_[size_ + 1] = '\0';
    }
    ++size_;
  }
  return *this;
}

}  // namespace pellucid
