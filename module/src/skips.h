// All that a plan leaves out, and why.
#pragma once

#include <array>

#include "pellucid/pellucid.h"

namespace pellucid {

struct Skips {
  std::array<PellucidSkip, PELLUCID_MAX_SKIPS> list{};
  uint32_t size = 0;

  // Static strings. Equal ones are counted.
  void add(const char* what, const char* reason) {
    for (uint32_t i = 0; i < size; ++i)
      if (list[i].what == what && list[i].reason == reason) {
        ++list[i].count;
        return;
      }
    if (size < list.size()) list[size++] = {what, reason, 1};
  }
};

}  // namespace pellucid
