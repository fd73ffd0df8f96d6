// The sentence of the material compiler about a description that it refuses.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "pellucid/pellucid_material.h"

namespace pellucid::test {

struct Complaint {
  std::string field, sentence;
};

inline void note(void* user, PellucidSeverity severity, const char* field, const char* sentence) {
  EXPECT_EQ(severity, PELLUCID_SEVERITY_ERROR);
  *static_cast<Complaint*>(user) = {field, sentence};
}

}  // namespace pellucid::test
