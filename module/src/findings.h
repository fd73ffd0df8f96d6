// Faults of a frame, in sentences without allocation.
#pragma once

#include "pellucid/pellucid.h"
#include "text.h"

namespace pellucid {

class Findings {
public:
  Findings(PellucidMessageFn fn, void* user) : fn_(fn), user_(user) {}

  // Of the errors so far.
  PellucidResult result() const { return result_; }

  template <class... Parts>
  void error(const char* field, const Parts&... sentence) {
    if (result_ == PELLUCID_OK) result_ = PELLUCID_ERROR_INVALID_ARGUMENT;
    say(PELLUCID_SEVERITY_ERROR, field, sentence...);
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

}  // namespace pellucid
