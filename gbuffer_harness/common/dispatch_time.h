// GPU timestamps of what a frame records.
#pragma once

#include <string>

namespace pellucid::harness {

struct DispatchTime {
  std::string name;
  double microseconds;
};

}  // namespace pellucid::harness
