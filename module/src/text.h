// Text without allocation: appends into a caller's buffer, counts what did not fit.
#pragma once

#include <charconv>
#include <concepts>
#include <cstddef>
#include <string_view>
#include <type_traits>

namespace pellucid {

class Text {
public:
  Text(char* buffer, std::size_t capacity) : buffer_(buffer), capacity_(buffer ? capacity : 0) {
    if (capacity_ > 0) buffer_[0] = '\0';
  }

  Text& operator<<(std::string_view s);
  Text& operator<<(const char* s) { return *this << std::string_view(s); }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) &&
      (!std::same_as<Number, char>)Text& operator<<(Number value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return *this << std::string_view(digits, static_cast<std::size_t>(end - digits));
  }

  // Bytes the whole text needs, terminator included.
  std::size_t needed() const { return size_ + 1; }

private:
  char* buffer_;
  std::size_t capacity_, size_ = 0;
};

}  // namespace pellucid
