// Faults of a frame or a context, in sentences without allocation.
#pragma once

#include <charconv>
#include <concepts>
#include <string_view>

#include "pellucid/pellucid.h"

namespace pellucid {

// Appends into a caller's buffer, and leaves out what does not fit.
class Text {
public:
  Text(char* buffer, std::size_t capacity) : buffer_(buffer), capacity_(capacity) { buffer_[0] = '\0'; }

  Text& operator<<(std::string_view s);
  Text& operator<<(const char* s) { return *this << std::string_view(s); }
  template <class Number>
  requires(std::integral<Number> || std::floating_point<Number>) &&
      (!std::same_as<Number, char>)Text& operator<<(Number value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value).ptr;
    return *this << std::string_view(digits, static_cast<std::size_t>(end - digits));
  }

private:
  char* buffer_;
  std::size_t capacity_, size_ = 0;
};

// "lights[3].color" without allocation.
class Field {
public:
  template <class... Parts>
  explicit Field(const Parts&... parts) {
    Text text(name_, sizeof name_);
    (text << ... << parts);
  }
  operator const char*() const { return name_; }

private:
  char name_[64];
};

class Findings {
public:
  explicit Findings(PellucidMessageFn fn = nullptr, void* user = nullptr) : fn_(fn), user_(user) {}

  // Of the errors so far.
  PellucidResult result() const { return result_; }
  bool ok() const { return result_ == PELLUCID_OK; }

  template <class... Parts>
  void error(const char* field, const Parts&... sentence) {
    fail(result_ == PELLUCID_OK ? PELLUCID_ERROR_INVALID_ARGUMENT : result_, field, sentence...);
  }
  // An error with another result than INVALID_ARGUMENT.
  template <class... Parts>
  void fail(PellucidResult result, const char* field, const Parts&... sentence) {
    result_ = result;
    say(PELLUCID_SEVERITY_ERROR, field, sentence...);
  }
  template <class... Parts>
  void warning(const char* field, const Parts&... sentence) {
    say(PELLUCID_SEVERITY_WARNING, field, sentence...);
  }

private:
  template <class... Parts>
  void say(PellucidSeverity severity, const char* field, const Parts&... sentence) {
    if (!fn_) return;
    char message[256];
    Text text(message, sizeof message);
    (text << ... << sentence);
    fn_(user_, severity, field, message);
  }

  PellucidMessageFn fn_;
  void* user_;
  PellucidResult result_ = PELLUCID_OK;
};

}  // namespace pellucid
